// The program from outside: what a textured source becomes.
#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>

#include "image/image.h"
#include "meshes.h"
#include "program.h"
#include "temporary_folder.h"

using namespace colod;
using Catch::Contains;
using test::slurp;
namespace fs = std::filesystem;
using Files = std::map<std::string, std::string>;

namespace {

class Folder : public test::TemporaryFolder {
 public:
  void write(const std::string& name, const std::string& bytes) const {
    fs::create_directories((path() / name).parent_path());
    std::ofstream(path() / name, std::ios::binary) << bytes;
  }

  /// A gabled house whose walls and roof show their own places; without `mtl` a bare one.
  void write_house(const std::string& name, const std::string& mtl) const {
    const Mesh m = test::gable_house(10, 8, 6, 3);
    std::ostringstream out;
    if (!mtl.empty()) out << "mtllib house.mtl\nusemtl wall\n";
    for (const Vec3& v : m.vertices) {
      out << "v " << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
      if (!mtl.empty()) out << "vt " << (v.x() + v.y()) / 20 << ' ' << v.z() / 10 << '\n';
    }
    for (const Face& f : m.faces) {
      out << 'f';
      for (const int v : f) mtl.empty() ? out << ' ' << v + 1 : out << ' ' << v + 1 << '/' << v + 1;
      out << '\n';
    }
    write(name + "/house.obj", out.str());
    if (!mtl.empty()) write(name + "/house.mtl", mtl);
  }

  int run(const std::string& arguments, const std::string& environment = "") const {
    return test::run_colod(path(), arguments, environment).exit_code;
  }
  /// All files that a build writes but its report.
  Files built(const std::string& input, const std::string& options = "", int ends = 0) const {
    fs::remove_all(path() / "out");
    REQUIRE(run("build " + input + " -o out --ns 24 --nr 40 --no-report-html " + options) == ends);
    return files("out");
  }
  Files files(const std::string& folder) const {
    Files all;
    for (const auto& entry : fs::recursive_directory_iterator(path() / folder))
      if (entry.is_regular_file() && entry.path().filename() != "report.json")
        all[fs::relative(entry.path(), path() / folder).string()] = slurp(entry.path());
    return all;
  }
  std::string err() const { return slurp(path() / "stderr"); }
  nlohmann::json report() const { return nlohmann::json::parse(slurp(path() / "out/report.json")); }
};

std::string checkers() {
  Raster raster(128, 128);
  for (int y = 0; y < 128; ++y)
    for (int x = 0; x < 128; ++x)
      for (int c = 0; c < 3; ++c) raster.at(x, y)[c] = (x / 8 + y / 8) % 2 ? 220 : 40;
  return encode_image(raster, ImageFormat::kPng, 0);
}

constexpr const char* kMtl = "newmtl wall\nKd 0.9 0.3 0.2\nmap_Kd wall.png\n";
constexpr const char* kAll = "--format glb,3dtiles,engine,obj,ply ";

/// The coordinates of an OBJ's points.
std::string points_of(const std::string& obj) {
  std::string out;
  std::istringstream in(obj);
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("v ")) out += line + "\n";
  return out;
}

}  // namespace

TEST_CASE("a textured house is textured in every output, and the report says from what") {
  const Folder folder;
  folder.write_house("in", kMtl);
  folder.write("in/wall.png", checkers());
  const Files files = folder.built("in", kAll);
  for (const char* name :
       {"buildings/house.glb", "engine/house_LOD0.glb", "buildings/house.layer2.obj"})
    CHECK_THAT(files.at(name),
               Contains(std::string(name).ends_with("obj") ? "mtllib" : "image/jpeg"));
  CHECK(files.contains("buildings/house.layer2.jpg"));
  int textured_tiles = 0;
  for (const auto& [name, bytes] : files)
    textured_tiles += name.starts_with("tiles/") && bytes.find("image/jpeg") != bytes.npos;
  CHECK(textured_tiles >= 1);
  double coarser = 0;
  const auto told = folder.report();
  for (const auto& layer : told["buildings"][0]["layers"]) {
    const auto& texture = layer["texture"];
    CHECK(texture["seen"].get<double>() > 0.9);
    CHECK(texture["seen"].get<double>() + texture["nearest"].get<double>() +
              texture["filled"].get<double>() + texture["unseen"].get<double>() ==
          Approx(1));
    CHECK(texture["texel"].get<double>() >= layer["gsd"].get<double>());
    CHECK(texture["bytes"].get<double>() >= coarser);
    coarser = texture["bytes"].get<double>();
  }
}

TEST_CASE("without textures, and in shape, a textured house is the same as a bare one") {
  const Folder folder;
  folder.write_house("bare", "");
  folder.write_house("dressed", kMtl);
  folder.write("dressed/wall.png", checkers());
  const Files bare = folder.built("bare", kAll);
  CHECK(folder.built("dressed", std::string(kAll) + "--texture none") == bare);
  const Files dressed = folder.built("dressed", kAll);
  for (const char* name : {"buildings/house.layer0.obj", "buildings/house.layer2.obj"})
    CHECK(points_of(dressed.at(name)) == points_of(bare.at(name)));
}

TEST_CASE("an image that cannot be shown is a loss, costs no shape, and may be done without") {
  const Folder folder;
  folder.write_house("bare", "");
  folder.write_house("in", kMtl);
  const Files bare = folder.built("bare", kAll);
  const std::string whole = checkers();
  const std::string jpeg = encode_image(Raster(256, 256), ImageFormat::kJpeg, 90);
  const std::pair<std::string, std::string> kinds[] = {
      {"", "missing"},
      {whole.substr(0, whole.size() / 2), "damaged"},
      {jpeg.substr(0, jpeg.size() / 2), "damaged"},
      {"nonsense", "no JPEG, PNG or WebP"},
      {"\xABKTX 20\xBB\r\n\x1A\n", "KTX2"}};
  for (const auto& [bytes, cause] : kinds) {
    INFO(cause);
    if (!bytes.empty()) folder.write("in/wall.png", bytes);
    const Files files = folder.built("in", kAll, 1);
    CHECK_THAT(folder.err(), Contains("house: texture 'wall.png' ") && Contains(cause) &&
                                 Contains("--texture none") && Contains("something is lost"));
    CHECK(points_of(files.at("buildings/house.layer2.obj")) ==
          points_of(bare.at("buildings/house.layer2.obj")));
    const nlohmann::json report = folder.report();
    CHECK(report["buildings"][0]["lost"] == true);
    REQUIRE(report["buildings"][0]["lost_textures"].size() == 1);
    CHECK_THAT(report["buildings"][0]["lost_textures"][0].get<std::string>(), Contains(cause));
    CHECK(report["buildings"][0]["heavy_warnings"] == 1);
    CHECK(report["totals"]["lost_textures"] == 1);
    CHECK(folder.built("in", std::string(kAll) + "--texture none") == bare);
    CHECK_THAT(folder.err(), !Contains("wall.png"));
  }
}

TEST_CASE("the colour of a material stands for a missing image of its") {
  const Folder folder;
  folder.write_house("in", kMtl);  // Kd 0.9 0.3 0.2
  const Files files = folder.built("in", "--format ply,glb", 1);
  CHECK_THAT(folder.err(), Contains("the colour of material 'wall' stands for it"));
  CHECK_THAT(files.at("buildings/house.glb"), Contains("COLOR_0") && !Contains("image/"));
  CHECK_THAT(files.at("buildings/house.layer2.ply"), Contains("red"));
}

TEST_CASE("without its material file a house has lost its textures where it says where they lie") {
  const Folder folder;
  folder.write_house("in", kMtl);
  fs::remove(folder.path() / "in/house.mtl");
  folder.built("in", "--format glb", 1);
  CHECK_THAT(folder.err(), Contains("texture 'of house.mtl' is missing"));
  const std::string obj = slurp(folder.path() / "in/house.obj");
  folder.write("plain/house.obj", std::regex_replace(obj, std::regex("/[0-9]+|vt [^\n]*\n"), ""));
  folder.built("plain", "--format glb");
  CHECK_THAT(folder.err(), Contains("house.mtl"));
}

TEST_CASE("of two houses in one file only the one that wears a missing image has lost it") {
  const Folder folder;
  folder.write_house("in", kMtl);
  const std::string one = slurp(folder.path() / "in/house.obj");
  std::string two = "o left\n" + one + "o right\nusemtl other\n";
  std::istringstream lines(one);
  const int points = static_cast<int>(test::gable_house(10, 8, 6, 3).vertices.size());
  for (std::string line; std::getline(lines, line);) {
    double x = 0, y = 0, z = 0;
    int a = 0, b = 0, c = 0;
    if (std::sscanf(line.c_str(), "v %lf %lf %lf", &x, &y, &z) == 3)
      two +=
          "v " + std::to_string(x + 40) + " " + std::to_string(y) + " " + std::to_string(z) + "\n";
    if (std::sscanf(line.c_str(), "f %d/%*d %d/%*d %d/%*d", &a, &b, &c) == 3)
      two += "f " + std::to_string(a + points) + " " + std::to_string(b + points) + " " +
             std::to_string(c + points) + "\n";
  }
  folder.write("in/house.obj", two);
  folder.write("in/house.mtl", std::string(kMtl) + "newmtl other\nKd 0 0 1\n");
  folder.built("in", "--format glb --split object", 1);
  const nlohmann::json buildings = folder.report()["buildings"];
  REQUIRE(buildings.size() == 2);
  CHECK(buildings[0]["lost"] == true);
  CHECK(buildings[1]["lost"] == false);
}

TEST_CASE("coordinates that are none cost their faces' picture, with a warning, and no shape") {
  const Folder folder;
  folder.write_house("bare", "");
  const std::string bare = points_of(folder.built("bare", kAll).at("buildings/house.layer2.obj"));
  folder.write("in/wall.png", checkers());
  for (const char* bad : {"nan nan", "1e38 0.5", "inf 0", ""}) {
    INFO(bad);
    folder.write_house("in", kMtl);
    std::string obj = slurp(folder.path() / "in/house.obj");
    std::string changed;
    std::istringstream lines(obj);
    bool is_first = true;
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with("vt") && *bad && is_first)
        line = std::string("vt ") + bad, is_first = false;
      if (!*bad && line.starts_with("vt")) continue;
      if (!*bad && line.starts_with("f "))
        line = std::regex_replace(line, std::regex("/[0-9]+"), "");
      changed += line + "\n";
    }
    folder.write("in/house.obj", changed);
    const Files files = folder.built("in", kAll);
    CHECK_THAT(folder.err(),
               Contains("house: texture 'wall.png'") && Contains("without texture coordinates"));
    CHECK(points_of(files.at("buildings/house.layer2.obj")) == bare);
  }
}

TEST_CASE("looks are measured: a textured house beside itself and beside its layers") {
  const Folder folder;
  folder.write_house("in", kMtl);
  folder.write("in/wall.png", checkers());
  const auto judged = [&](const std::string& model, const std::string& options = "") {
    REQUIRE(folder.run("eval in/house.obj " + model + " --samples 100 --appearance " + options) ==
            0);
    return nlohmann::json::parse(slurp(folder.path() / "stdout"))["appearance"];
  };
  const nlohmann::json same = judged("in/house.obj", "--gsd 0.1");
  CHECK(same["psnr"].is_null());  // nothing differs
  CHECK(same["flip"] == 0);
  CHECK(same["gsd"] == 0.1);
  folder.built("in", kAll);
  const nlohmann::json layer = judged("out/buildings/house.layer2.obj");
  CHECK(layer["psnr"].get<double>() > 24);
  CHECK(layer["flip"].get<double>() < 0.1);
  CHECK(folder.run("preview in/house.obj out/buildings/house.layer2.obj -o sheet.png") == 0);
  folder.write_house("bare", "");
  CHECK(folder.run("eval bare/house.obj in/house.obj --appearance") == 3);
  CHECK_THAT(folder.err(), Contains("neither textures nor colours"));
}

TEST_CASE("normal maps lie beside textures in buildings and for engines, which are lit then") {
  const Folder folder;
  folder.write_house("in", kMtl);
  folder.write("in/wall.png", checkers());
  const Files plain = folder.built("in", kAll);
  const Files files = folder.built("in", std::string(kAll) + "--normal-map");
  int mapped = 0;
  for (const auto& [name, bytes] : files) {
    if (!name.ends_with(".glb")) continue;
    INFO(name);
    const bool has_map = bytes.find("normalTexture") != bytes.npos;
    CHECK(has_map == !name.starts_with("tiles/"));
    CHECK((bytes.find("KHR_materials_unlit") == bytes.npos) == has_map);
    if (!has_map) CHECK(bytes == plain.at(name));
    mapped += has_map;
  }
  CHECK(mapped >= 2);
  CHECK(points_of(files.at("buildings/house.layer2.obj")) ==
        points_of(plain.at("buildings/house.layer2.obj")));
  CHECK(folder.run("info --check out") == 0);
}

TEST_CASE("WebP is required of clients unless a JPEG stands beside it") {
  const Folder folder;
  folder.write_house("in", kMtl);
  folder.write("in/wall.png", checkers());
  for (const bool has_fallback : {false, true}) {
    const Files files = folder.built(
        "in", std::string(kAll) + "--texture-format " + (has_fallback ? "webp+jpeg" : "webp"));
    int textured = 0;
    for (const auto& [name, bytes] : files) {
      if (!name.ends_with(".glb") || bytes.find("image/") == bytes.npos) continue;
      INFO(name);
      ++textured;
      CHECK_THAT(bytes, Contains("EXT_texture_webp"));
      CHECK((bytes.find("image/jpeg") != bytes.npos) == has_fallback);
      const std::size_t list = std::min(bytes.find("extensionsRequired"), bytes.size());
      const std::size_t end = std::min(bytes.find(']', list), bytes.size());
      CHECK((bytes.substr(list, end - list).find("webp") == std::string::npos) == has_fallback);
    }
    CHECK(textured >= 3);  // the building's, the engine's, a tile
    CHECK(files.contains(has_fallback ? "buildings/house.layer2.jpg"
                                      : "buildings/house.layer2.webp"));
    CHECK(folder.run("info --check out") == 0);
  }
}

TEST_CASE("KTX2 is what the program basisu makes, and is refused before the work without it") {
  const Folder folder;
  folder.write_house("in", kMtl);
  folder.write("in/wall.png", checkers());
  const std::string build =
      "build in -o out --ns 24 --nr 40 --no-report-html --format glb,obj --texture-format ktx2";
  CHECK(folder.run(build, "PATH=/nowhere") == 2);
  CHECK_THAT(folder.err(), Contains("--texture-format") && Contains("basisu"));
  CHECK(!fs::exists(folder.path() / "out"));
  CHECK(folder.run(build + " --texture none", "PATH=/nowhere") == 0);
  const auto stands_in = [&](const std::string& script) {
    folder.write("bin/basisu", "#!/bin/sh\n" + script);
    fs::permissions(folder.path() / "bin/basisu", fs::perms::owner_all);
    fs::remove_all(folder.path() / "out");
    return folder.run(build + " --texture-quality 50", "PATH=$PWD/bin:$PATH");
  };
  CHECK(stands_in(
            "echo \"$@\" >> \"${0%/*}/../words\"\n"
            "while [ \"$1\" != -file ]; do shift; done; head -c 4 \"$2\" >> \"${0%/*}/../begin\"\n"
            "printf '\\253KTX 20\\273\\r\\n\\032\\nmade' > \"$4\"\n") == 0);
  const Files files = folder.files("out");
  CHECK_THAT(files.at("buildings/house.glb"), Contains("KHR_texture_basisu") &&
                                                  Contains("image/ktx2") && Contains("KTX 20") &&
                                                  Contains("made"));
  CHECK(files.contains("buildings/house.layer2.jpg"));  // of OBJ hardly a reader knows KTX2
  CHECK_THAT(slurp(folder.path() / "words"), Contains("-ktx2 -q 126 -mipmap"));
  CHECK_THAT(slurp(folder.path() / "begin"), Contains("PNG"));
  CHECK(stands_in("exit 3\n") == 1);
  CHECK_THAT(folder.err(), Contains("house: is written without textures") && Contains("code 3"));
  CHECK(stands_in("exit 0\n") == 1);
  CHECK_THAT(folder.err(), Contains("wrote no KTX2"));
}

TEST_CASE("a changed image is segmented anew, an unchanged one is not") {
  const Folder folder;
  folder.write_house("in", kMtl);
  folder.write("in/wall.png", checkers());
  const auto segment = [&] {
    REQUIRE(folder.run("segment in -o s.colod --ns 24 --nr 40 --log-json") == 0);
    return folder.err();
  };
  segment();
  CHECK_THAT(segment(), Contains("already there"));
  Raster other(128, 128);
  other.at(5, 5)[0] = 200;
  folder.write("in/wall.png", encode_image(other, ImageFormat::kPng, 0));
  CHECK_THAT(segment(), !Contains("already there"));
  CHECK_THAT(segment(), Contains("already there"));
}

TEST_CASE("a coloured cloud wears its colours: a texture where it is dense, else one a facet") {
  const Folder folder;
  for (const double size : {1.0, 2.5}) {
    for (const auto& [spacing, is_dense] : {std::pair(0.15, true), {0.4, false}}) {
      INFO(size << " " << spacing);
      std::ostringstream out;
      const double w = 8 * size, d = 6 * size, h = 5 * size;
      const auto put = [&](double x, double y, double z, const char* more) {
        out << x << ' ' << y << ' ' << z << ' ' << more << '\n';
      };
      for (double a = 0; a <= 1; a += spacing / w)
        for (double b = 0; b <= 1; b += spacing / d) put(a * w, b * d, h, "0 0 1 40 60 200");
      for (double b = 0; b <= 1; b += spacing / h) {
        for (double a = 0; a <= 1; a += spacing / w) {
          put(a * w, 0, b * h, a < 0.5 ? "0 -1 0 200 40 40" : "0 -1 0 40 200 40");
          put(a * w, d, b * h, "0 1 0 90 90 90");
        }
        for (double a = 0; a <= 1; a += spacing / d) {
          put(0, a * d, b * h, "-1 0 0 150 150 60");
          put(w, a * d, b * h, "1 0 0 60 150 150");
        }
      }
      folder.write("in/cloud.xyz", out.str());
      const Files files = folder.built("in", "--format glb,ply");
      const std::string& glb = files.at("buildings/cloud.glb");
      CHECK((glb.find("image/jpeg") != glb.npos) == is_dense);
      CHECK((glb.find("COLOR_0") != glb.npos) == !is_dense);
      CHECK(folder.built("in", "--texture none").at("buildings/cloud.glb").find("COLOR_0") ==
            std::string::npos);
      std::string bare = std::regex_replace(out.str(),
                                            std::regex("( [0-9-]+ [0-9-]+ [0-9-]+) [0-9]+ "
                                                       "[0-9]+ [0-9]+\n"),
                                            "$1\n");
      folder.write("bare/cloud.xyz", bare);
      const Files plain = folder.built("bare", "--format obj");
      const Files colored = folder.built("in", "--format obj");
      for (const auto& [name, bytes] : plain)
        CHECK(points_of(colored.at(name)) == points_of(bytes));
    }
  }
}

TEST_CASE("threads and stages change no texel") {
  const Folder folder;
  folder.write_house("in", kMtl);
  folder.write("in/wall.png", checkers());
  const Files one = folder.built("in", std::string(kAll) + "--threads 1");
  CHECK(folder.built("in", std::string(kAll) + "--threads 3") == one);
  REQUIRE(folder.run("segment in -o s.colod --ns 24 --nr 40") == 0);
  REQUIRE(folder.run("analyze s.colod") == 0);
  REQUIRE(folder.run("mesh s.colod") == 0);
  REQUIRE(folder.run(std::string("export s.colod -o staged --no-report-html ") + kAll) == 0);
  CHECK(folder.files("staged") == one);
}

TEST_CASE("colors gives each facet one, also where a source has plain materials") {
  const Folder folder;
  folder.write_house("in", "newmtl wall\nKd 0.9 0.3 0.2\n");
  const Files plain = folder.built("in");
  CHECK(plain.at("buildings/house.glb").find("COLOR_0") == std::string::npos);
  const Files colored = folder.built("in", "--texture colors");
  CHECK_THAT(colored.at("buildings/house.glb"), Contains("COLOR_0") && !Contains("image/"));
  CHECK_THAT(colored.at("tiles/root.glb"), Contains("COLOR_0"));
}
