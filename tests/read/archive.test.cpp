// 3TZ: an archive of a tileset is read as the tileset, and nothing that it says is trusted.
#include "read/archive.h"

#include <sys/stat.h>

#include <catch2/catch.hpp>

#include "archives.h"
#include "core/error.h"
#include "exporters/tiles3d/archive.h"
#include "read/tileset.h"
#include "scenes.h"
#include "temporary_folder.h"

using namespace colod;
using namespace colod::test;
using Catch::Contains;
using Entries = std::vector<ArchiveEntry>;

namespace {

const std::string kTile = glb_of(y_up(box_mesh({0, 0, 0}, {4, 2, 3})));
const std::string kTileset = tileset_of(
    tile_of("", R"(,"children":[)" + tile_of("a.glb") + "," + tile_of("sub/b.glb") + "]"));
const Entries kGood = {{"tileset.json", kTileset}, {"a.glb", kTile}, {"sub/b.glb", kTile, false}};

/// The good one with more, in a file of its own.
std::string with(const TempFolder& folder, const Entries& more) {
  Entries all = kGood;
  all.insert(all.end(), more.begin(), more.end());
  return write_archive((folder.path / "place.3tz").string(), all);
}

std::size_t count_contents(const TileTree& tree) {
  std::size_t count = 0;
  for (const TileNode& n : tree.nodes) count += n.contents.size();
  return count;
}

/// What is told of the good one with an entry that is left out; its tiles are all there.
std::string told_of(const ArchiveEntry& entry) {
  const TempFolder folder;
  const TileTree tree = list_tiles(with(folder, {entry}));
  CHECK(tree.failures.empty());
  CHECK(count_contents(tree) == 2);
  REQUIRE(tree.warnings.size() == 1);
  return tree.warnings[0];
}

/// What is told of an archive whose tile a.glb is another entry.
std::string told_of_tile(const ArchiveEntry& entry, const ReadOptions& options = {}) {
  const TempFolder folder;
  const std::string path =
      write_archive((folder.path / "place.3tz").string(), {kGood[0], entry, kGood[2]});
  const TileTree tree = list_tiles(path, options);
  CHECK(tree.warnings.empty());
  CHECK(count_contents(tree) == 1);
  REQUIRE(tree.failures.size() == 1);
  CHECK(tree.failures[0].path == path + "/tileset.json");
  return tree.failures[0].message;
}

}  // namespace

TEST_CASE("an archive is read as its tileset, packed, stored, as ZIP64 and as colod writes it") {
  const TempFolder folder;
  Entries large = kGood;
  for (ArchiveEntry& e : large) e.is_zip64 = true;
  const std::string own =
      encode_3tz({{"tileset.json", kTileset}, {"a.glb", kTile}, {"sub/b.glb", kTile}}).bytes;
  for (const std::string& path :
       {with(folder, {{"sub/", ""}}), write_archive((folder.path / "64.3TZ").string(), large),
        folder.write("own.3tz", own)}) {
    INFO(path);
    std::string why, unpacked;
    CHECK(is_tiled_scene(path, why));
    {
      const TileTree tree = list_tiles(path);
      CHECK(tree.path == path);
      CHECK(tree.warnings.empty());
      CHECK(tree.failures.empty());
      REQUIRE(count_contents(tree) == 2);
      unpacked = tree.nodes.back().contents[0];
      CHECK(slurp(unpacked) == kTile);
      CHECK(shown(tree, "in " + unpacked).starts_with("in " + path + "/"));
    }
    CHECK_FALSE(std::filesystem::exists(unpacked));  // gone with the tree
  }
}

TEST_CASE("names that lead out of an archive, links and what comes twice are left out and told") {
  CHECK_THAT(told_of({"../out.glb", kTile}),
             Contains("'../out.glb' is left out") && Contains("'..'"));
  CHECK_THAT(told_of({"sub/../../out.glb", kTile}), Contains("'..' in its name"));
  CHECK_THAT(told_of({"/tmp/out.glb", kTile}), Contains("absolute name"));
  CHECK_THAT(told_of({"C:/out.glb", kTile}), Contains("absolute name"));
  CHECK_THAT(told_of({"..\\out.glb", kTile}), Contains("backslash"));
  CHECK_THAT(told_of({"a\nb.glb", kTile}), Contains("'a?b.glb'") && Contains("control characters"));
  CHECK_THAT(told_of({std::string(2000, 'x'), kTile}), Contains("a name of 2000 bytes"));
  CHECK_THAT(told_of({std::string(300, 'x'), kTile}), Contains("that no file can have"));
  CHECK_THAT(told_of({"a.glb/c.glb", kTile}), Contains("that no file can have"));
  CHECK_THAT(told_of({"link.glb", "/etc/passwd", false, S_IFLNK | 0777}), Contains("a link"));
  CHECK_THAT(told_of({"a.glb", "other"}), Contains("comes twice: the first one is taken"));
  CHECK_THAT(told_of({"./sub//b.glb", "other"}), Contains("comes twice"));
  const TempFolder folder;
  const TileTree tree = list_tiles(with(folder, {{"../x", ""}, {"../y", ""}, {"/z", ""}}));
  REQUIRE(tree.warnings.size() == 2);
  CHECK_THAT(tree.warnings[0], Contains("'../x'") && Contains("(and 1 more entries)"));
}

TEST_CASE("a tile that an archive cannot give is a failure of its own, which says why") {
  CHECK_THAT(told_of_tile({"b.glb", kTile}), Contains("its tile 'a.glb' is missing"));
  CHECK_THAT(told_of_tile({"a.glb", kTile, true, 0, "secret"}), Contains("'a.glb' is encrypted"));
  CHECK_THAT(told_of_tile({"a.glb", "b.glb", false, S_IFLNK | 0777}),
             Contains("'a.glb' is a link"));
  CHECK_THAT(told_of_tile({"a.glb", "no flate", true, 0, nullptr, 5000}), Contains("is damaged"));
  CHECK_THAT(told_of_tile({"a.glb", kTile, false, 0, nullptr, kTile.size()}),  // no checksum
             Contains("contradict its length or checksum"));
  ReadOptions options;
  options.input_memory = 1;
  CHECK_THAT(told_of_tile({"a.glb", std::string(2 << 20, 'x')}, options),
             Contains("takes 2 MiB, more than --input-memory 1"));
}

TEST_CASE("what is packed with Zstandard is told, with what unpacks it") {
  const TempFolder folder;
  const std::string path = with(folder, {});
  std::string bytes = slurp(path);
  // Method 8 → 93 in the local header of the first entry and in the list of entries.
  for (const std::string& mark : {std::string("PK\3\4"), std::string("PK\1\2")}) {
    const std::size_t at = bytes.find(mark) + (mark[2] == 3 ? 8 : 10);
    REQUIRE(bytes[at] == 8);
    bytes[at] = 93;
  }
  CHECK_THROWS_WITH(list_tiles(folder.write("place.3tz", bytes)),
                    Contains("its tileset.json is packed with Zstandard") && Contains("bsdtar"));
}

TEST_CASE("an archive that is cut, empty, a bomb or another one's is refused in one line") {
  const TempFolder folder;
  const std::string whole = slurp(with(folder, {}));
  const auto refused = [&](const std::string& bytes, const std::string& why) {
    CHECK_THROWS_WITH(list_tiles(folder.write("bad.3tz", bytes)),
                      Contains("bad.3tz: ") && Contains(why));
  };
  refused(whole.substr(0, whole.size() - 30), "is cut");
  refused(whole.substr(0, 100), "is cut");
  refused("no archive", "is no ZIP archive");
  std::string nothing = std::string("PK\5\6") + std::string(18, '\0');
  refused(nothing, "is an empty archive");
  refused(nothing.substr(0, 20), "is cut");
  nothing[20] = 5;
  refused(nothing + "words", "is an empty archive");
  refused(nothing, "is cut");
  refused(whole.substr(whole.size() / 2), "");  // its first half is missing
  std::string many = whole;
  const std::size_t end = many.rfind("PK\5\6");
  many[end + 8] = many[end + 10] = 100;
  refused(many, "ends after 3 of 100");
  std::string bomb = slurp(with(folder, {{"x", "x", true, 0, nullptr, 3u << 30}}));
  refused(bomb, "would unpack to 3072 MiB");
  // Many entries that share one piece of the file, each of a size that is allowed.
  Entries shared(60, {"x", "x", true, 0, nullptr, 2u << 20});
  refused(slurp(with(folder, shared)), "more than 100 times what it takes");
  write_archive((folder.path / "bad.3tz").string(), {{"deep/tileset.json", kTileset}});
  refused(slurp(folder.path / "bad.3tz"), "holds no tileset.json at its root");
  std::string why;
  const std::string own =
      write_archive((folder.path / "own.3tz").string(),
                    {{"tileset.json", tileset_of(tile_of("a.glb"), R"(,"generator": "colod")")}});
  CHECK_THROWS_WITH(is_tiled_scene(own, why), Contains("what colod itself wrote"));
}

TEST_CASE("any changed byte of an archive ends in an error or a tree of tiles") {
  const TempFolder folder;
  const std::string whole = slurp(with(folder, {{"../x", "x"}}));
  std::size_t refused = 0, read = 0;
  for (std::size_t i = 0; i < whole.size(); i += i < 60 || i + 500 > whole.size() ? 1 : 29) {
    std::string bytes = whole;
    bytes[i] = static_cast<char>(bytes[i] ^ 0x81);
    try {
      list_tiles(folder.write("x.3tz", bytes));
      ++read;
    } catch (const Error& e) {
      ++refused;
      CHECK_THAT(e.what(), Contains("x.3tz"));
    }
  }
  CHECK(refused > 10);
  CHECK(read > 10);
}
