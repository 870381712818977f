// Based on: 3D Tiles 1.1.
// Differs: one primitive an image, all unlit, since photogrammetry has its light baked in.
#include "context.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "core/parallel.h"
#include "exporters/gltf/gltf.h"
#include "tile_json.h"

namespace colod {

using OrderedJson = nlohmann::ordered_json;

namespace {

constexpr int kUntextured = -1;
constexpr std::size_t kMostInFile = 32;  // tiles below one: more go to a file of their own
const std::string kFolder = "tiles/context/";

/// The faces of one image, each corner once for each place in it; glTF axes, rounded to the grid.
/// Unlit: nothing ever asks for normals.
FlatMesh flat_of(const ContextMesh& mesh, int image, const std::vector<Vec3>& rounded) {
  using Key = std::tuple<int, float, float, Rgb>;
  FlatMesh out;
  std::map<Key, int> numbers;
  for (std::size_t f = 0; f < mesh.mesh.faces.size(); ++f) {
    if (mesh.face_image[f] != image) continue;
    const Face& face = mesh.mesh.faces[f];
    const auto at = [&](std::size_t c) { return rounded[static_cast<std::size_t>(face[c])]; };
    if (at(0) == at(1) || at(1) == at(2) || at(2) == at(0)) continue;
    Face flat;
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec2f uv = image >= 0 ? mesh.uvs[f][c] : Vec2f(0, 0);
      const Rgb rgb = image >= 0 ? Rgb{} : mesh.colors[f][c];
      const Key key(face[c], uv.x(), uv.y(), rgb);
      const auto [known, is_new] = numbers.try_emplace(key, static_cast<int>(out.positions.size()));
      if (is_new) {
        out.positions.push_back(at(c));
        if (image >= 0) out.uvs.push_back(uv);
        if (image < 0) out.colors.push_back(rgb);
      }
      flat[c] = known->second;
    }
    out.triangles.push_back(flat);
  }
  return out;
}

LevelLook level_look(const ContextMesh& mesh, int image, bool is_farthest) {
  LevelLook look;
  look.has_mip_levels = is_farthest;
  if (image < 0) {
    look.facet_colors = {Rgb{}};  // that there are colours
    return look;
  }
  const ContextImage& own = mesh.images[static_cast<std::size_t>(image)];
  look.uvs.resize(1);  // that there is a texture
  look.image = own.bytes;
  look.format = own.format;
  return look;
}

/// Empty bytes where the mesh shows nothing.
std::string glb_of(ContextMesh mesh, const ContextNode& node, const TileFrame& frame,
                   const std::string& name, Compression compression, double quantization,
                   Box& box) {
  Box gltf_box;
  for (Vec3& p : mesh.mesh.vertices) p = frame.local(p), gltf_box.extend(to_gltf(p));
  if (mesh.mesh.faces.empty()) return {};
  const QuantizationGrid grid = fit_grid(gltf_box, std::max(quantization, node.rounding));
  std::vector<Vec3> rounded;
  for (const Vec3& p : mesh.mesh.vertices) rounded.push_back(grid.round(to_gltf(p)));
  GltfDocument document = start_gltf();
  if (!frame.is_on_earth()) {
    const Vec3& o = frame.origin();
    document.json["asset"]["extras"]["origin"] = {o.x(), o.y(), o.z()};
  }
  OrderedJson primitives = OrderedJson::array();
  for (int image = kUntextured; image < static_cast<int>(mesh.images.size()); ++image) {
    const FlatMesh flat = flat_of(mesh, image, rounded);
    if (flat.triangles.empty()) continue;
    Box seen;
    OrderedJson primitive = add_primitive(document, flat, grid, compression, &seen);
    set_look(document, level_look(mesh, image, node.is_farthest),
             name + "-" + std::to_string(image), primitive);
    primitives.push_back(std::move(primitive));
    box.extend(from_gltf(seen.min)), box.extend(from_gltf(seen.max));
  }
  if (primitives.empty()) return {};
  document.json["meshes"].push_back({{"primitives", primitives}});
  document.json["nodes"].push_back(
      {{"name", name}, {"mesh", 0}, {"extras", {{"class", "context"}}}});
  return finish_glb(std::move(document));
}

/// Where nodes' files lie: subtrees of many tiles are tilesets of their own, so that whoever is far
/// away reads nothing of what lies below them.
class Files {
 public:
  explicit Files(const std::vector<ContextNode>& nodes)
      : is_apart_(nodes.size(), 0), is_below_(nodes.size(), 0) {
    std::vector<std::size_t> tiles(nodes.size(), 1);  // in one file, the node and those below it
    for (std::size_t i = nodes.size(); i-- > 0;) {
      if (nodes[i].parent < 0) continue;
      is_apart_[i] = tiles[i] > kMostInFile;
      tiles[static_cast<std::size_t>(nodes[i].parent)] += is_apart_[i] ? 1 : tiles[i];
    }
    for (std::size_t i = 0; i < nodes.size(); ++i)
      is_below_[i] = is_apart_[i] ||
                     (nodes[i].parent >= 0 && is_below_[static_cast<std::size_t>(nodes[i].parent)]);
  }

  bool is_apart(std::size_t i) const { return is_apart_[i]; }
  static std::string glb(std::size_t i) { return kFolder + std::to_string(i) + ".glb"; }
  static std::string tileset(std::size_t i) { return kFolder + std::to_string(i) + ".json"; }
  /// As the file says that names the node's content.
  std::string uri(std::size_t i) const { return is_below_[i] ? in_folder(glb(i)) : glb(i); }
  /// As the file says that stands above it.
  std::string stub_uri(std::size_t i, int parent) const {
    return parent >= 0 && is_below_[static_cast<std::size_t>(parent)] ? in_folder(tileset(i))
                                                                      : tileset(i);
  }

 private:
  static std::string in_folder(const std::string& path) { return path.substr(kFolder.size()); }
  std::vector<char> is_apart_, is_below_;
};

}  // namespace

std::vector<ContextTile> encode_context(const ContextTiles& context, const TileFrame& frame,
                                        Compression compression, double quantization,
                                        const std::function<void(const Encoded&)>& take) {
  const std::size_t count = context.nodes.size();
  std::vector<ContextTile> tiles(count);
  std::vector<char> is_shown(count, 0);
  const Files files(context.nodes);
  parallel_for(count, [&](std::size_t i) {
    const Encoded file{Files::glb(i), glb_of(context.mesh(i), context.nodes[i], frame,
                                             "context-" + std::to_string(i), compression,
                                             quantization, tiles[i].box)};
    is_shown[i] = !file.bytes.empty();
    if (is_shown[i]) take(file);
  });
  std::vector<OrderedJson> children(count, OrderedJson::array());
  std::vector<ContextTile> tops;
  for (std::size_t i = count; i-- > 0;) {
    ContextTile& tile = tiles[i];
    const ContextNode& node = context.nodes[i];
    const bool is_leaf = children[i].empty();
    if (is_leaf && !is_shown[i]) continue;
    tile.error = is_leaf ? 0 : std::max({kLeastError, node.geometric_error, tile.error});
    tile.json["boundingVolume"] = box_json(tile.box);
    tile.json["geometricError"] = tile.error;
    tile.json["refine"] = node.is_added ? "ADD" : "REPLACE";
    if (is_shown[i]) tile.json["content"]["uri"] = files.uri(i);
    if (!is_leaf) {
      std::reverse(children[i].begin(), children[i].end());
      tile.json["children"] = std::move(children[i]);
    }
    if (files.is_apart(i)) {
      const std::string uri = files.stub_uri(i, node.parent);
      take({Files::tileset(i), put_apart(tile.json, tile.error, uri)});
    }
    if (node.parent < 0) {
      tops.push_back(std::move(tile));
      continue;
    }
    const auto above = static_cast<std::size_t>(node.parent);
    tiles[above].box.extend(tile.box);
    tiles[above].error = std::max(tiles[above].error, kRise * tile.error);
    children[above].push_back(std::move(tile.json));
  }
  return tops;
}

}  // namespace colod
