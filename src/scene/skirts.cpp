// Based on: the skirts of terrain tiles (T. Ulrich, Rendering massive terrains, 2002).
#include "skirts.h"

#include <map>

#include "parameters.h"

namespace colod {

namespace {

using namespace parameters::closing;

/// A corner of a face, and with the next one an edge of it.
struct RimEdge {
  std::size_t face, corner;
};

/// Edges that one face alone has.
std::vector<RimEdge> rim_of(const Mesh& mesh) {
  std::map<std::array<int, 2>, RimEdge> open;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = mesh.faces[f][k], b = mesh.faces[f][(k + 1) % 3];
      if (open.erase({b, a}) == 0) open[{a, b}] = {f, k};
    }
  std::vector<RimEdge> out;
  for (const auto& [edge, at] : open) out.push_back(at);
  return out;
}

/// Whether one side of it, seen from above, is a building's and the other one is not.
bool is_on_border(const Territories& territories, const Vec3& a, const Vec3& b) {
  const Vec2 along = (b - a).head<2>();
  if (along.norm() < kLeastEdge) return false;  // upright: what is above it hangs down there
  const Vec2 middle = (a + b).head<2>() / 2;
  const Vec2 aside = kAside * Vec2(-along.y(), along.x()).normalized();
  return territories.covers(middle + aside) != territories.covers(middle - aside);
}

class Skirts {
 public:
  Skirts(const ClosingGround& ground, Source& s, double depth)
      : ground_(ground), s_(s), depth_(depth) {}

  void hang(const RimEdge& edge) {
    const std::size_t k = edge.corner, next = (k + 1) % 3;
    const Face face = s_.mesh.faces[edge.face];
    const int a = face[k], b = face[next], below_a = below(a), below_b = below(b);
    add({b, a, below_a}, edge.face, {next, k, k});
    add({b, below_a, below_b}, edge.face, {next, k, next});
  }

 private:
  int below(int v) {
    const auto [at, is_new] = below_.try_emplace(v, static_cast<int>(s_.mesh.vertices.size()));
    if (!is_new) return at->second;
    Vec3 p = s_.mesh.vertices[static_cast<std::size_t>(v)];
    p.z() = std::min(p.z(), ground_.lowest(p.head<2>())) - depth_;
    s_.mesh.vertices.push_back(p);
    return at->second;
  }

  /// With the looks of three corners of the face above.
  void add(const Face& face, std::size_t from, const std::array<std::size_t, 3>& corners) {
    Appearance& look = s_.look;
    s_.mesh.faces.push_back(face);
    if (!s_.face_object.empty()) s_.face_object.push_back(s_.face_object[from]);
    if (!look.face_material.empty()) look.face_material.push_back(look.face_material[from]);
    if (!look.uvs.empty()) {
      const auto uvs = look.uvs[from];
      look.uvs.push_back({uvs[corners[0]], uvs[corners[1]], uvs[corners[2]]});
    }
    if (!look.colors.empty()) {
      const auto rgb = look.colors[from];
      look.colors.push_back({rgb[corners[0]], rgb[corners[1]], rgb[corners[2]]});
    }
  }

  const ClosingGround& ground_;
  Source& s_;
  double depth_;
  std::map<int, int> below_;
};

}  // namespace

std::vector<char> add_skirts(const Territories& territories, const ClosingGround& ground,
                             Source& cut, double deeper) {
  Skirts skirts(ground, cut, kSkirt + deeper);
  std::vector<char> is_joint(cut.mesh.vertices.size(), 0);
  for (const RimEdge& edge : rim_of(cut.mesh)) {
    const Face& face = cut.mesh.faces[edge.face];
    const auto a = static_cast<std::size_t>(face[edge.corner]),
               b = static_cast<std::size_t>(face[(edge.corner + 1) % 3]);
    if (is_on_border(territories, cut.mesh.vertices[a], cut.mesh.vertices[b]))
      skirts.hang(edge);
    else
      is_joint[a] = is_joint[b] = 1;
  }
  is_joint.resize(cut.mesh.vertices.size(), 0);
  return is_joint;
}

}  // namespace colod
