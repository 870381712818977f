// Based on: glTF 2.0, EXT_mesh_gpu_instancing, KHR_node_visibility, MSFT_lod, CESIUM_RTC.
// Differs: nodes that share a child are refused. The coarser levels of MSFT_lod are read only when
// they are asked for. What stands in many places is bounded (GltfReader::spend).
#include "gltf.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "formats.h"
#include "split.h"

namespace colod::mesh_io {

namespace {

using Matrix = Eigen::Matrix4d;
using tinygltf::Value;

Matrix placement(const double* translation, const double* rotation, const double* scale) {
  Eigen::Affine3d t = Eigen::Affine3d::Identity();
  if (translation) t.translate(Vec3(translation));
  if (rotation)
    t.rotate(Eigen::Quaterniond(rotation[3], rotation[0], rotation[1], rotation[2]).normalized());
  if (scale) t.scale(Vec3(scale));
  return t.matrix();
}

Matrix local_matrix(const tinygltf::Node& node) {
  const std::vector<double>&t = node.translation, &r = node.rotation, &s = node.scale;
  if (node.matrix.size() == 16) return Eigen::Map<const Matrix>(node.matrix.data());
  return placement(t.size() == 3 ? t.data() : nullptr, r.size() == 4 ? r.data() : nullptr,
                   s.size() == 3 ? s.data() : nullptr);
}

bool is_hidden(const tinygltf::Node& node) {
  const Value* visibility = extension_of(node.extensions, "KHR_node_visibility");
  return visibility && visibility->Has("visible") && visibility->Get("visible").IsBool() &&
         !visibility->Get("visible").Get<bool>();
}

/// One file while its nodes are walked; all methods throw Error{kInput} naming the mesh or
/// accessor.
class SceneReader {
 public:
  SceneReader(const std::string& path, GltfDocument& document, double input_memory)
      : gltf_(path, document.model, input_memory),
        model_(document.model),
        look_(document.look),
        warnings_(document.warnings),
        is_visited_(model_.nodes.size(), 0),
        is_coarser_(model_.nodes.size(), 0) {}

  RawFile read(int coarser);

 private:
  const tinygltf::Node& node(int i) const { return gltf_.at(model_.nodes, i, "node"); }
  const std::vector<int>& checked(const std::vector<int>& nodes) const;
  std::vector<int> level_ids(int node) const;
  std::vector<int> children(const tinygltf::Node& node) const;
  std::vector<int> top_nodes() const;
  int coarser_node(int node, int levels) const;
  std::vector<Matrix> instances(const tinygltf::Node& node) const;
  void visit(int node);
  int new_part(const std::string& name, int parent);
  std::vector<int> parts_of(const std::vector<int>& children, int part);
  void add_top(int node, const Matrix& above);
  void add_node(int node, const Matrix& parent, int part);
  void add_mesh(const tinygltf::Node& node, const std::vector<Matrix>& places, int part,
                bool is_one_each);
  void place(const GltfPrimitive& own, const Matrix& matrix, int part, int material);
  void place_look(const GltfPrimitive& own, int corner, int material);
  void drop_missing_look();
  void set_origin();

  GltfReader gltf_;
  const tinygltf::Model& model_;
  const GltfLook& look_;
  std::vector<std::string>& warnings_;
  std::vector<char> is_visited_, is_coarser_;
  RawFile raw_;
  bool has_targets_ = false, has_colors_ = false;
};

/// The same nodes; all of them are there.
const std::vector<int>& SceneReader::checked(const std::vector<int>& nodes) const {
  for (const int i : nodes) node(i);
  return nodes;
}

/// The coarser levels that MSFT_lod names for a node, finest first.
std::vector<int> SceneReader::level_ids(int index) const {
  const Value* lod = extension_of(node(index).extensions, "MSFT_lod");
  if (!lod) return {};
  std::vector<int> ids;
  const auto count = static_cast<double>(model_.nodes.size());
  for (const double id : gltf_.numbers(*lod, "ids"))
    ids.push_back(id >= 0 && id < count ? static_cast<int>(id) : -1);
  return checked(ids);
}

/// Without the coarser levels of others.
std::vector<int> SceneReader::children(const tinygltf::Node& node) const {
  std::vector<int> out = checked(node.children);
  std::erase_if(out, [&](int child) { return is_coarser_[child]; });
  return out;
}

/// The nodes of the scene that is shown; all of them when the file names no scene.
std::vector<int> SceneReader::top_nodes() const {
  std::vector<int> tops;
  if (!model_.scenes.empty()) {
    tops = checked(gltf_.at(model_.scenes, std::max(model_.defaultScene, 0), "scene").nodes);
  } else {
    std::vector<char> is_child(is_visited_.size(), 0);
    for (const tinygltf::Node& above : model_.nodes)
      for (const int child : checked(above.children)) is_child[child] = 1;
    for (std::size_t i = 0; i < is_child.size(); ++i)
      if (!is_child[i]) tops.push_back(static_cast<int>(i));
  }
  std::erase_if(tops, [&](int top) { return is_coarser_[top]; });
  return tops;
}

/// The node that MSFT_lod names for a node, that many levels down.
int SceneReader::coarser_node(int index, int levels) const {
  if (levels == 0) return index;
  const std::vector<int> ids = level_ids(index);
  if (static_cast<int>(ids.size()) < levels) gltf_.fail("has fewer levels of detail");
  return ids[static_cast<std::size_t>(levels) - 1];
}

/// Where a node's mesh stands in the node's own frame: once, or as EXT_mesh_gpu_instancing says.
std::vector<Matrix> SceneReader::instances(const tinygltf::Node& node) const {
  const Value* extension = extension_of(node.extensions, "EXT_mesh_gpu_instancing");
  if (!extension) return {Matrix::Identity()};
  const Value attributes = extension->Has("attributes") ? extension->Get("attributes") : Value();
  const auto read = [&](const char* name, int components) {
    const int accessor = gltf_.integer(attributes, name);
    return accessor < 0 ? std::vector<double>() : gltf_.values(accessor, components);
  };
  const std::vector<double> t = read("TRANSLATION", 3), r = read("ROTATION", 4),
                            s = read("SCALE", 3);
  const std::size_t count = std::max({t.size() / 3, r.size() / 4, s.size() / 3});
  for (const std::size_t n : {t.size() / 3, r.size() / 4, s.size() / 3})
    if (n != 0 && n != count)
      gltf_.fail("EXT_mesh_gpu_instancing: attributes of " + std::to_string(n) + " and " +
                 std::to_string(count) + " instances");
  std::vector<Matrix> out;
  for (std::size_t i = 0; i < count; ++i)
    out.push_back(placement(t.empty() ? nullptr : &t[3 * i], r.empty() ? nullptr : &r[4 * i],
                            s.empty() ? nullptr : &s[3 * i]));
  return out;
}

void SceneReader::visit(int index) {
  if (is_visited_[index]) gltf_.fail("node " + std::to_string(index) + " hangs in two places");
  is_visited_[index] = 1;
}

int SceneReader::new_part(const std::string& name, int parent) {
  raw_.parts.push_back(name);
  raw_.part_parent.push_back(parent);
  return static_cast<int>(raw_.parts.size()) - 1;
}

/// Siblings whose names differ by a level of detail alone become parts of their own below `part`.
std::vector<int> SceneReader::parts_of(const std::vector<int>& children, int part) {
  std::vector<std::string> bases;
  for (const int child : children) {
    const auto base = name_without_level(node(child).name);
    bases.push_back(base ? "level of " + *base : "");
  }
  std::vector<int> parts;
  for (std::size_t i = 0; i < children.size(); ++i) {
    const bool is_level = !bases[i].empty() && std::count(bases.begin(), bases.end(), bases[i]) > 1;
    parts.push_back(is_level ? new_part(node(children[i]).name, part) : part);
  }
  return parts;
}

/// How the last corner looks.
void SceneReader::place_look(const GltfPrimitive& own, int corner, int material) {
  const auto i = static_cast<std::size_t>(corner);
  Vec2f uv(NAN, NAN);
  if (i < own.uvs.size() && material >= 0)
    uv = (look_.materials[static_cast<std::size_t>(material)].place *
          Vec3(own.uvs[i].x(), own.uvs[i].y(), 1))
             .cast<float>();
  raw_.corner_uvs.push_back(uv);
  raw_.corner_colors.push_back(i < own.colors.size() ? own.colors[i] : Rgb{255, 255, 255});
  has_colors_ = has_colors_ || i < own.colors.size();
}

void SceneReader::place(const GltfPrimitive& own, const Matrix& matrix, int part, int material) {
  gltf_.spend(own.points.size() + own.corners.size());
  const bool is_mirrored = matrix.topLeftCorner<3, 3>().determinant() < 0;
  const int base = static_cast<int>(raw_.points.size());
  for (const Vec3& v : own.points) {
    const Vec3 w = (matrix * v.homogeneous()).head<3>();
    raw_.points.emplace_back(w.x(), -w.z(), w.y());
  }
  for (std::size_t c = 0; c < own.corners.size(); c += 3) {
    raw_.face_begin.push_back(static_cast<int>(raw_.corners.size()));
    raw_.face_part.push_back(part);
    raw_.face_material.push_back(material);
    for (std::size_t k = 0; k < 3; ++k) {
      const int corner = own.corners[c + (is_mirrored ? 2 - k : k)];
      raw_.corners.push_back(base + corner);
      place_look(own, corner, material);
    }
  }
}

/// The mesh of a node at its places, all of one part or, from `part` on, one each.
void SceneReader::add_mesh(const tinygltf::Node& node, const std::vector<Matrix>& places, int part,
                           bool is_one_each) {
  if (node.mesh < 0) return;
  for (const tinygltf::Primitive& p : gltf_.at(model_.meshes, node.mesh, "mesh").primitives) {
    has_targets_ = has_targets_ || !p.targets.empty();
    const int material = p.material < static_cast<int>(look_.materials.size()) ? p.material : -1;
    const GltfPrimitive own = gltf_.primitive(
        p, material < 0 ? 0 : look_.materials[static_cast<std::size_t>(material)].uv_set);
    for (std::size_t i = 0; i < places.size(); ++i)
      place(own, places[i], is_one_each ? part + static_cast<int>(i) : part, material);
  }
}

void SceneReader::add_node(int index, const Matrix& parent, int part) {
  struct Step {
    int node;
    Matrix above;
    int part;
  };
  std::vector<Step> stack = {{index, parent, part}};
  while (!stack.empty()) {
    const Step step = stack.back();
    stack.pop_back();
    visit(step.node);
    const tinygltf::Node& at = node(step.node);
    if (is_hidden(at)) continue;
    const Matrix matrix = step.above * local_matrix(at);
    std::vector<Matrix> places = instances(at);
    for (Matrix& place : places) place = matrix * place;
    add_mesh(at, places, step.part, false);
    const std::vector<int> below = children(at), parts = parts_of(below, step.part);
    for (std::size_t i = below.size(); i-- > 0;) stack.push_back({below[i], matrix, parts[i]});
  }
}

/// A node that may be a building; where it only says where its mesh stands, each place may be one.
void SceneReader::add_top(int index, const Matrix& above) {
  const tinygltf::Node& top = node(index);
  const std::string name = top.name.empty() ? "node" + std::to_string(index) : top.name;
  std::vector<Matrix> places = instances(top);
  if (places.size() < 2 || !children(top).empty() || is_hidden(top)) {
    add_node(index, above, new_part(name, -1));
    return;
  }
  visit(index);
  const int first = static_cast<int>(raw_.parts.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    places[i] = above * local_matrix(top) * places[i];
    new_part(name + " " + std::to_string(i + 1), -1);
  }
  add_mesh(top, places, first, true);
}

/// Our own files say where their origin lies, and CESIUM_RTC does; both z up.
void SceneReader::set_origin() {
  if (model_.asset.generator == "colod") {
    const std::vector<double> own = gltf_.numbers(model_.asset.extras, "origin");
    if (own.size() == 3) raw_.origin += Vec3(own.data());
  }
  const Value* rtc = extension_of(model_.extensions, "CESIUM_RTC");
  const std::vector<double> center = rtc ? gltf_.numbers(*rtc, "center") : std::vector<double>();
  if (rtc && center.size() != 3) gltf_.fail("CESIUM_RTC: its center is not three numbers");
  if (!rtc) return;
  raw_.origin += Vec3(center.data());
}

/// Arrays that say nothing are none.
void SceneReader::drop_missing_look() {
  raw_.images = look_.images;
  for (const GltfMaterial& m : look_.materials) raw_.materials.push_back(m.material);
  if (raw_.materials.empty()) raw_.face_material.clear();
  if (raw_.images.empty()) raw_.corner_uvs.clear();
  if (!has_colors_) raw_.corner_colors.clear();
}

RawFile SceneReader::read(int coarser) {
  raw_.is_soup = raw_.is_turned = true;
  for (std::size_t i = 0; i < is_coarser_.size(); ++i)
    for (const int id : level_ids(static_cast<int>(i)))
      if (id != static_cast<int>(i)) is_coarser_[id] = 1;
  std::vector<int> tops = top_nodes();
  Matrix above = Matrix::Identity();
  for (std::size_t depth = 0; tops.size() == 1 && depth < is_visited_.size(); ++depth) {
    const tinygltf::Node& wrapper = node(tops[0]);
    const std::vector<int> below = children(wrapper);
    if (wrapper.mesh >= 0 || below.empty() || is_hidden(wrapper)) break;
    above = above * local_matrix(wrapper);  // around the buildings
    tops = below;
  }
  for (const int top : tops) add_top(coarser_node(top, coarser), above);
  set_origin();
  drop_missing_look();
  if (has_targets_)
    warnings_.push_back("has morph targets, which are not read: shapes are those at rest");
  raw_.warnings = warnings_;
  return std::move(raw_);
}

}  // namespace

RawFile read_gltf(const std::string& path, std::string_view bytes, const ReadOptions& options,
                  std::size_t begin) {
  try {
    GltfDocument document = open_gltf(path, bytes, begin, options.input_memory);
    return SceneReader(path, document, options.input_memory).read(options.coarser);
  } catch (const nlohmann::json::exception& e) {  // a member of another type than the format's
    fail(path, std::string("glTF: ") + e.what());
  }
}

}  // namespace colod::mesh_io
