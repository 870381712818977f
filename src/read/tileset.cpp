// Based on: 3D Tiles 1.0 and 1.1 (OGC 22-025r4), .3tz, and folders of meshes.
// Differs: tile_tree.cpp has it.
#include "tileset.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "archive.h"
#include "files.h"
#include "look.h"
#include "tile_tree.h"
#include "whole.h"

namespace colod {

namespace fs = std::filesystem;
using Matrix = Eigen::Matrix4d;

namespace {

constexpr std::size_t kHead = 4096;  // bytes of a tileset.json that tell what it is

/// Whether a tileset.json that begins like this was written by colod.
bool is_own(const std::string& head) { return head.find("\"generator\": \"colod\"") != head.npos; }

/// The tileset of an archive, which is named instead of the folder that it lies in.
TileTree list_archive(const std::string& input, const ReadOptions& options) {
  const auto archive = std::make_shared<Unpacked>(input, options);
  TileTree tree;
  try {
    tree = read_tile_tree(archive->tileset(), options, archive.get());
  } catch (const Error& e) {
    throw Error(e.stage, archive->shown(e.item),
                archive->shown(std::string(e.what()).substr(e.item.size() + 2)));
  }
  tree.path = input;
  tree.archive = archive;
  for (ReadFailure& f : tree.failures) f = {shown(tree, f.path), shown(tree, f.message)};
  for (std::string& w : tree.warnings) w = shown(tree, std::move(w));
  for (std::string& w : archive->untold()) tree.warnings.push_back(std::move(w));
  return tree;
}

TileTree list_meshes(const std::string& input, const ReadOptions& options) {
  const bool is_folder = fs::is_directory(input);
  mesh_io::InputList list = mesh_io::list_files({input}, is_folder || options.is_recursive);
  TileTree tree;
  tree.path = input;
  tree.warnings = std::move(list.warnings);
  tree.nodes.emplace_back();
  tree.nodes[0].is_added = true;
  for (const std::string& file : list.files) {
    tree.nodes[0].children.push_back(static_cast<int>(tree.nodes.size()));
    tree.nodes.emplace_back();
    tree.nodes.back().contents = {file};
    tree.nodes.back().parent = 0;
  }
  return tree;
}

/// Tiles that the formats know and that are no surface.
std::string foreign_tile(const std::string& magic) {
  if (magic == "i3dm") return "i3dm (instances of models) is not read";
  if (magic == "pnts") return "pnts (points) is not read";
  if (magic == "cmpt") return "cmpt (a composite) is not read";
  return "";
}

std::string magic_of(const std::string& path) {
  std::string magic(4, '\0');
  std::ifstream(path, std::ios::binary).read(magic.data(), 4);
  return magic;
}

/// A tile's coordinates, z up by the format, as its tileset says that they are meant.
Vec3 as_meant(TileUp up, const Vec3& p) {
  switch (up) {
    case TileUp::kY:
      return p;
    case TileUp::kZ:
      return {p.x(), p.z(), -p.y()};
    case TileUp::kX:
      return {p.y(), p.z(), p.x()};
  }
  return p;
}

mesh_io::RawFile read_content(const std::string& path, const ReadOptions& options) {
  const std::string magic = magic_of(path);
  if (const std::string cause = foreign_tile(magic); !cause.empty()) mesh_io::fail(path, cause);
  if (magic == "b3dm")
    return mesh_io::read_b3dm(path, mesh_io::read_bytes(path, options.input_memory), options);
  if (magic == "glTF")
    return mesh_io::read_gltf(path, mesh_io::read_bytes(path, options.input_memory), options);
  return mesh_io::read_raw(path, options);
}

}  // namespace

std::string shown(const TileTree& tree, std::string text) {
  return tree.archive ? tree.archive->shown(std::move(text)) : text;
}

bool is_tiled_scene(const std::string& input, std::string& why) {
  std::error_code error;
  if (is_archive(input) && fs::is_regular_file(input, error)) {
    why = "it is an archive of a tileset";
    if (is_own(read_archived(input, "tileset.json").value_or("").substr(0, kHead)))
      throw Error(
          Stage::kInput, input,
          "holds what colod itself wrote, several levels of each building: name the sources");
    return true;
  }
  fs::path file = input;
  if (fs::is_directory(input, error)) file = file / "tileset.json";
  if (mesh_io::lower(file.extension().string()) == ".json" && fs::is_regular_file(file, error)) {
    std::string head(kHead, '\0');
    std::ifstream(file, std::ios::binary).read(head.data(), static_cast<long>(head.size()));
    why = file.filename().string() + " is a tileset";
    const bool is_tileset =
        head.find("\"asset\"") != head.npos || head.find("\"geometricError\"") != head.npos;
    return is_tileset && !is_own(head);
  }
  fs::directory_iterator at(fs::path(input) / "Data", error);
  for (const fs::directory_iterator end; !error && at != end; at.increment(error)) {
    if (!at->path().filename().string().starts_with("Tile_")) continue;
    why = "its folder Data holds " + at->path().filename().string();
    return true;
  }
  return false;
}

bool is_tile_format(const std::string& path) {
  return mesh_io::lower(fs::path(path).extension().string()) == ".b3dm";
}

TileTree list_tiles(const std::string& input, const ReadOptions& options) {
  std::error_code error;
  fs::path file = input;
  if (fs::is_directory(input, error) && fs::is_regular_file(file / "tileset.json", error))
    file = file / "tileset.json";
  if (!fs::exists(file, error)) throw Error(Stage::kInput, input, "no such file or folder");
  if (is_archive(input)) return list_archive(input, options);
  if (mesh_io::lower(file.extension().string()) == ".json")
    return read_tile_tree(file.string(), options, nullptr);
  return list_meshes(input, options);
}

std::vector<int> finest_nodes(const TileTree& tree, int coarser) {
  std::vector<int> height(tree.nodes.size(), 0);  // levels that show something below
  for (std::size_t i = tree.nodes.size(); i-- > 1;) {
    const TileNode& node = tree.nodes[i];
    int& above = height[static_cast<std::size_t>(node.parent)];
    above = std::max(above, height[i] + (node.contents.empty() ? 0 : 1));
  }
  std::vector<int> out, open = {0};
  while (!open.empty()) {
    const int i = open.back();
    open.pop_back();
    const TileNode& node = tree.nodes[static_cast<std::size_t>(i)];
    const bool is_end = height[static_cast<std::size_t>(i)] <= coarser && !node.contents.empty();
    if (!node.contents.empty() && (is_end || node.is_added || node.children.empty()))
      out.push_back(i);
    if (is_end && !node.is_added) continue;
    open.insert(open.end(), node.children.begin(), node.children.end());
  }
  std::sort(out.begin(), out.end());
  return out;
}

Source read_tile(const TileNode& node, const std::string& content, const Matrix& to_scene,
                 const ReadOptions& options) {
  mesh_io::RawFile raw = read_content(content, options);
  if (raw.face_count() == 0) return {};
  mesh_io::check_faces(content, raw);
  const Matrix matrix = to_scene * node.to_root;
  const double unit = options.unit.value_or(1);
  for (Vec3& p : raw.points) {
    const Vec3 own = raw.is_turned ? as_meant(node.up, p) : p;
    p = (matrix * Vec3(own * unit + raw.origin).homogeneous()).head<3>();
  }
  mesh_io::color_corners(raw);
  if (raw.is_soup) {
    const std::vector<int> first = mesh_io::weld(raw.points);
    for (int& c : raw.corners) c = first[static_cast<std::size_t>(c)];
  }
  int dropped = 0;
  const mesh_io::Triangles all = mesh_io::triangulate(raw, dropped);
  std::vector<int> chosen(all.faces.size());
  for (std::size_t i = 0; i < chosen.size(); ++i) chosen[i] = static_cast<int>(i);
  Source source = mesh_io::take(raw, all, chosen);
  source.path = content;
  source.warnings = std::move(raw.warnings);
  if (dropped > 0)
    source.warnings.push_back(std::to_string(dropped) +
                              " faces left out: a coordinate is not finite");
  return source;
}

}  // namespace colod
