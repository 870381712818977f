// Based on: 3D Tiles 1.0 and 1.1 (OGC 22-025r4).
// Differs: no file outside the scene's own folder is opened, whatever a URI says; bounding volumes
// are not asked, since writers get them wrong: where a tile is, its vertices tell.
#include "tile_tree.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/error.h"
#include "files.h"
#include "formats.h"
#include "implicit.h"
#include "look.h"

namespace colod {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using Matrix = Eigen::Matrix4d;

namespace {

constexpr std::size_t kMostTiles = 2'000'000;
constexpr int kDeepest = 2000;   // nested lists and objects of one tileset: 3 a level of tiles
constexpr int kMostNested = 64;  // tilesets within tilesets

Json parse(const std::string& path, const ReadOptions& options) {
  const std::string text = mesh_io::as_text(mesh_io::read_bytes(path, options.input_memory));
  bool is_too_deep = false;
  Json json = Json::parse(
      text,
      [&](int depth, Json::parse_event_t, Json&) {
        is_too_deep |= depth > kDeepest;
        return !is_too_deep;
      },
      false);
  if (is_too_deep) mesh_io::fail(path, "JSON nested too deeply");
  if (!json.is_object() || !json.contains("root") || !json["root"].is_object())
    mesh_io::fail(path, "is no tileset: not JSON with a root tile");
  return json;
}

/// A member that is an object, else an empty one.
const Json& object(const Json& json, const char* key) {
  static const Json none = Json::object();
  const auto found = json.find(key);
  return found != json.end() && found->is_object() ? *found : none;
}

std::string text(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? found->get<std::string>() : "";
}

Matrix transform_of(const std::string& path, const Json& tile) {
  const auto found = tile.find("transform");
  if (found == tile.end() || found->is_null()) return Matrix::Identity();
  Matrix out;
  bool is_whole = found->is_array() && found->size() == 16;
  for (std::size_t i = 0; is_whole && i < 16; ++i) {
    is_whole = (*found)[i].is_number();
    if (is_whole) out(static_cast<int>(i)) = (*found)[i].get<double>();
  }
  if (!is_whole || !out.allFinite()) mesh_io::fail(path, "a tile's transform is not 16 numbers");
  return out;
}

/// Of its content or contents, as written.
std::vector<std::string> uris_of(const Json& tile) {
  std::vector<std::string> out;
  const auto add = [&](const Json& content) {
    const std::string uri = text(content, "uri"), url = text(content, "url");
    if (!uri.empty() || !url.empty()) out.push_back(uri.empty() ? url : uri);
  };
  add(object(tile, "content"));
  const auto several = tile.find("contents");
  if (several != tile.end() && several->is_array())
    for (const Json& content : *several)
      if (content.is_object()) add(content);
  return out;
}

bool is_within(const fs::path& folder, const fs::path& file) {
  return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first ==
         folder.end();
}

class TreeReader {
 public:
  /// `archive`: that its files were unpacked from, or nullptr.
  TreeReader(const std::string& path, const ReadOptions& options, Unpacked* archive)
      : options_(options), archive_(archive) {
    tree_.path = path;
    tree_.is_tileset = true;
    folder_ = fs::canonical(fs::absolute(path).parent_path());
  }

  TileTree read() {
    tree_.nodes.emplace_back();
    add_tileset(tree_.path, 0);
    tell_failures();
    if (std::all_of(tree_.nodes.begin(), tree_.nodes.end(),
                    [](const TileNode& n) { return n.contents.empty(); })) {
      const std::string first =
          tree_.failures.empty() ? ""
                                 : "; " + tree_.failures[0].path + ": " + tree_.failures[0].message;
      mesh_io::fail(tree_.path, "names no tile that can be read" + first);
    }
    return std::move(tree_);
  }

 private:
  struct Step {
    const Json* tile;
    int node;  // that is already there
  };
  struct Failure {
    ReadFailure failure;
    int node;
  };

  /// The tiles of a tileset below a node, whose place its root takes.
  void add_tileset(const std::string& path, int node) {
    const Json json = parse(path, options_);
    const std::string axis = text(object(json, "asset"), "gltfUpAxis");
    TileUp up = TileUp::kY;
    if (axis == "Z" || axis == "z") up = TileUp::kZ;
    if (axis == "X" || axis == "x") up = TileUp::kX;
    open_.push_back(fs::canonical(path).string());
    std::vector<Step> steps = {{&json["root"], node}};
    while (!steps.empty()) {
      const Step step = steps.back();
      steps.pop_back();
      add_tile(path, *step.tile, up, step.node);
      const auto children = step.tile->find("children");
      if (children == step.tile->end() || !children->is_array()) continue;
      for (const Json& child : *children)
        if (child.is_object()) steps.push_back({&child, new_node(step.node)});
      if (tree_.nodes.size() > kMostTiles)
        mesh_io::fail(tree_.path, "has more than " + std::to_string(kMostTiles) + " tiles");
    }
    open_.pop_back();
  }

  int new_node(int parent) {
    const int node = static_cast<int>(tree_.nodes.size());
    tree_.nodes.emplace_back();
    tree_.nodes.back().parent = parent;
    tree_.nodes[static_cast<std::size_t>(parent)].children.push_back(node);
    return node;
  }

  void add_tile(const std::string& path, const Json& tile, TileUp up, int index) {
    TileNode& node = tree_.nodes[static_cast<std::size_t>(index)];
    if (node.parent >= 0) {
      const TileNode& above = tree_.nodes[static_cast<std::size_t>(node.parent)];
      node.to_root = above.to_root;
      node.is_added = above.is_added;
    }
    node.to_root = node.to_root * transform_of(path, tile);
    node.up = up;
    if (const auto error = tile.find("geometricError"); error != tile.end() && error->is_number())
      node.geometric_error = error->get<double>();
    const std::string refine = text(tile, "refine");
    if (refine == "ADD" || refine == "add") node.is_added = true;
    if (refine == "REPLACE" || refine == "replace") node.is_added = false;
    if (tile.contains("implicitTiling") ||
        object(tile, "extensions").contains("3DTILES_implicit_tiling"))
      return add_implicit(path, tile, index);
    for (const std::string& uri : uris_of(tile)) add_content(path, uri, index);
  }

  void fail(const std::string& path, const std::string& cause, int node) {
    failures_.push_back({{path, cause}, node});
  }

  /// A coarse tile that finer ones stand for costs nothing but the view from afar.
  void tell_failures() {
    std::vector<char> is_shown(tree_.nodes.size(), 0);  // by something below
    for (std::size_t i = tree_.nodes.size(); i-- > 1;)
      if (is_shown[i] || !tree_.nodes[i].contents.empty())
        is_shown[static_cast<std::size_t>(tree_.nodes[i].parent)] = 1;
    for (Failure& f : failures_) {
      const auto node = static_cast<std::size_t>(f.node);
      if (is_shown[node] && !tree_.nodes[node].is_added)
        tree_.warnings.push_back(f.failure.path + ": " + f.failure.message +
                                 "; finer tiles stand for it");
      else
        tree_.failures.push_back(std::move(f.failure));
    }
  }

  /// Where a URI leads, if it may be opened; else a failure of the node's own.
  std::optional<fs::path> file_of(const std::string& path, const std::string& uri, int node) {
    const std::string shown = "'" + uri.substr(0, 120) + "'";
    const std::string name = mesh_io::percent_decoded(uri.substr(0, uri.find_first_of("?#")));
    const fs::path relative = name;
    std::string cause;
    std::error_code error;
    const fs::path file = fs::weakly_canonical(fs::absolute(path).parent_path() / relative, error);
    if (name.empty() || relative.is_absolute() || name.find(':') != name.npos)
      cause = "names " + shown + ", which is not a file of the scene: it is not read";
    else if (error || !is_within(folder_, file))
      cause = "names " + shown + ", outside of the scene's folder: it is not read";
    else if (!fs::is_regular_file(file, error))
      cause = "its tile " + shown + " " + fault_of(file);
    else
      return file;
    fail(path, cause, node);
    return {};
  }

  /// Why a file is not there.
  std::string fault_of(const fs::path& file) {
    const std::string fault = archive_ ? archive_->tell_fault(file.string()) : "";
    return fault.empty() ? "is missing" : fault;
  }

  void add_content(const std::string& path, const std::string& uri, int node) {
    const std::optional<fs::path> file = file_of(path, uri, node);
    if (!file) return;
    if (mesh_io::lower(file->extension().string()) == ".json")
      return add_external(path, *file, node);
    tree_.nodes[static_cast<std::size_t>(node)].contents.push_back(file->string());
  }

  /// A subtree that waits to be read: where its root is, among tiles and among nodes.
  struct Waiting {
    mesh_io::ImplicitPlace place;
    int node;
  };

  /// Tiles that the tileset does not list, below a node that is there.
  void add_implicit(const std::string& path, const Json& tile, int index) {
    try {
      const mesh_io::ImplicitTiling tiling = mesh_io::implicit_tiling(path, tile);
      const std::vector<std::string> contents = uris_of(tile);
      std::vector<Waiting> open = {{{0, 0, 0, 0}, index}};
      for (std::size_t done = 0; !open.empty() && done < kMostTiles; ++done) {
        const Waiting next = open.back();
        open.pop_back();
        add_subtree(path, tiling, contents, next, open);
      }
    } catch (const Error& e) {
      fail(path, std::string(e.what()).substr(e.item.size() + 2), index);
    }
  }

  void add_subtree(const std::string& path, const mesh_io::ImplicitTiling& tiling,
                   const std::vector<std::string>& contents, const Waiting& root,
                   std::vector<Waiting>& open) {
    const auto file = file_of(path, mesh_io::filled(tiling.subtrees, root.place), root.node);
    if (!file) return;
    const auto read = [&](const std::string& uri) {
      const auto buffer = file_of(file->string(), uri, root.node);
      return buffer ? mesh_io::read_bytes(buffer->string(), options_.input_memory) : std::string();
    };
    try {
      const mesh_io::Subtree subtree(
          file->string(), mesh_io::read_bytes(file->string(), options_.input_memory), tiling, read);
      add_levels(path, tiling, contents, subtree, root, open);
    } catch (const Error& e) {
      fail(file->string(), std::string(e.what()).substr(e.item.size() + 2), root.node);
    }
  }

  /// A subtree's tiles, level by level.
  void add_levels(const std::string& path, const mesh_io::ImplicitTiling& tiling,
                  const std::vector<std::string>& contents, const mesh_io::Subtree& subtree,
                  const Waiting& root, std::vector<Waiting>& open) {
    struct At {
      Waiting tile;
      std::uint64_t morton;
    };
    std::vector<At> level, below;
    if (subtree.has_tile(0, 0)) level.push_back({root, 0});
    for (int depth = 0; depth < tiling.subtree_levels && !level.empty(); ++depth, level = below) {
      below.clear();
      for (const At& at : level) {
        for (std::size_t c = 0; c < contents.size(); ++c)
          if (subtree.has_content(c, depth, at.morton))
            add_content(path, mesh_io::filled(contents[c], at.tile.place), at.tile.node);
        if (at.tile.place[0] + 1 >= static_cast<std::uint64_t>(tiling.levels)) continue;
        const bool is_last = depth + 1 == tiling.subtree_levels;
        for (int b = 0; b < tiling.branches; ++b) {
          const std::uint64_t morton = at.morton * static_cast<std::uint64_t>(tiling.branches) +
                                       static_cast<std::uint64_t>(b);
          if (!(is_last ? subtree.has_subtree(morton) : subtree.has_tile(depth + 1, morton)))
            continue;
          const Waiting child{mesh_io::child_of(at.tile.place, b, tiling.branches),
                              half_of(at.tile.node)};
          if (is_last)
            open.push_back(child);
          else
            below.push_back({child, morton});
        }
      }
    }
  }

  /// A child of a node as implicit tiling has it: half as far off, all else alike.
  int half_of(int parent) {
    if (tree_.nodes.size() > kMostTiles)
      mesh_io::fail(tree_.path, "has more than " + std::to_string(kMostTiles) + " tiles");
    const int node = new_node(parent);
    const TileNode& above = tree_.nodes[static_cast<std::size_t>(parent)];
    TileNode& own = tree_.nodes[static_cast<std::size_t>(node)];
    own.to_root = above.to_root, own.up = above.up, own.is_added = above.is_added;
    own.geometric_error = above.geometric_error / 2;
    return node;
  }

  /// A tileset that is a tile's content: its root is the tile's only child.
  void add_external(const std::string& path, const fs::path& file, int node) {
    if (std::count(open_.begin(), open_.end(), file.string()) > 0)
      return fail(path, "leads back to '" + file.filename().string() + "', which it is part of",
                  node);
    if (open_.size() > kMostNested) return fail(path, "too many tilesets within tilesets", node);
    try {
      add_tileset(file.string(), new_node(node));
    } catch (const Error& e) {
      fail(file.string(), std::string(e.what()).substr(e.item.size() + 2), node);
    }
  }

  const ReadOptions& options_;
  Unpacked* archive_;
  fs::path folder_;  // that nothing leaves
  TileTree tree_;
  std::vector<Failure> failures_;
  std::vector<std::string> open_;  // tilesets from the first to the one in hand
};

}  // namespace

TileTree read_tile_tree(const std::string& path, const ReadOptions& options, Unpacked* archive) {
  return TreeReader(path, options, archive).read();
}

}  // namespace colod
