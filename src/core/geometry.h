// The vocabulary that all rooms share: plain values, small pure helpers.
//
// Units are metres, square metres and degrees unless a name says otherwise. Coordinates are
// doubles. Inside the pipeline every building lives in its own local frame (read/frame.h); only
// `read` reads and only exporters write world coordinates.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "appearance.h"

namespace colod {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Face =
    std::array<int, 3>;  ///< counter-clockwise seen from outside; indices into the vertices

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// An axis-parallel box; empty when min > max.
struct Box {
  Vec3 min = Vec3::Constant(kInfinity);
  Vec3 max = Vec3::Constant(-kInfinity);

  bool is_empty() const { return !(min.array() <= max.array()).all(); }
  void extend(const Vec3& p) { min = min.cwiseMin(p), max = max.cwiseMax(p); }
  void extend(const Box& b) { min = min.cwiseMin(b.min), max = max.cwiseMax(b.max); }
  Vec3 size() const { return is_empty() ? Vec3(Vec3::Zero()) : Vec3(max - min); }
  Vec3 center() const { return 0.5 * (min + max); }
  double diagonal() const { return size().norm(); }
};

/// An indexed triangle mesh. No invariant beyond indices in range.
struct Mesh {
  std::vector<Vec3> vertices;
  std::vector<Face> faces;
};

/// Points with unit normals. `normals` is as long as `points`, or empty: none known.
struct PointCloud {
  std::vector<Vec3> points;
  std::vector<Vec3> normals;
};

/// What of a building's source no layer stands for.
struct LeftOut {
  enum class Reason {
    kGround,   ///< terrain, and what stands about on it
    kFloater,  ///< pieces afloat, also far away
    kInside,   ///< what nobody sees from outside
    kLost      ///< a body of the building that no layer stands for: a failure
  };
  Reason reason = Reason::kFloater;
  double area = 0;           ///< m²; 0 for points
  double share = 0;          ///< 0..1 of the input's area, or of its points
  double farthest = 0;       ///< metres, of its surface from what was kept
  double volume = -1;        ///< m³ that it encloses; −1: it is open
  double volume_share = -1;  ///< 0..1 of the volume of the input; −1: unknown
};

/// One building as it was read. Exactly one of `mesh` and `cloud` is non-empty.
struct Source {
  std::string name;        ///< unique within a scene, safe as a file name
  std::string given_name;  ///< as its file writes it, in UTF-8; else the file's name
  std::string path;        ///< the file it came from
  Mesh mesh;
  PointCloud cloud;
  std::vector<int> face_object;  ///< per face of `mesh`: the file's object number (OBJ group, PLY
                                 ///< property `object`); empty: none
  Appearance look;               ///< of the faces of `mesh`; empty: none
  std::vector<std::string> warnings;  ///< what the reader mended or doubts, one line each
  std::vector<LeftOut> left_out;      ///< what is no longer in it
  double read_seconds = 0;            ///< wall clock that reading its file took
  bool is_found = false;  ///< cut out of a place by a plan that the program found, not one given
  bool is_turned_back = false;  ///< a glTF that was read z up, whatever its format says

  bool is_mesh() const { return !mesh.faces.empty(); }
};

/// A planar region's border and its triangulation, all on the region's plane.
struct Outline {
  std::vector<Vec3> vertices;
  std::vector<std::vector<int>>
      rings;  ///< closed, indices into `vertices`; outer rings counter-clockwise about the plane's
              ///< normal, holes clockwise
  std::vector<Face>
      triangles;  ///< covers the rings' inside; counter-clockwise about the plane's normal
};

/// A detected planar region: the points x with normal·x = offset inside its outline.
struct Plane {
  Vec3 normal = Vec3::UnitZ();   ///< unit length, points out of the building
  double offset = 0;             ///< metres along `normal`
  double area = 0;               ///< m² of the region (faces of a mesh; outline of a cloud)
  Vec3 centroid = Vec3::Zero();  ///< area-weighted, on the plane
  std::vector<int> items;        ///< faces (mesh) or points (cloud) of the source, rising
  Outline outline;

  double signed_distance(const Vec3& x) const { return normal.dot(x) - offset; }
};

/// A polygonal mesh: facets are planar polygons with holes, `triangles` is the same surface
/// triangulated.
struct PolygonMesh {
  std::vector<Vec3> vertices;
  struct Facet {
    Vec3 normal;  ///< unit, outward
    int plane =
        -1;  ///< index into the layer's planes; −1: a plane that no region supports (box, base)
    std::vector<std::vector<int>> rings;  ///< first outer (ccw), then holes (cw)
  };
  std::vector<Facet> facets;
  std::vector<Face> triangles;
  std::vector<int> facet_of_triangle;  ///< as long as `triangles`

  Mesh mesh() const { return {vertices, triangles}; }
};

Box bounding_box(const std::vector<Vec3>& points);

/// Twice the area-weighted normal has this direction; zero for a degenerate face.
inline Vec3 face_cross(const Mesh& m, const Face& f) {
  return (m.vertices[f[1]] - m.vertices[f[0]]).cross(m.vertices[f[2]] - m.vertices[f[0]]);
}
inline double face_area(const Mesh& m, const Face& f) { return 0.5 * face_cross(m, f).norm(); }
/// Of a face, the weights of its corners that give the point of its plane nearest to a point;
/// thirds where the face has no area.
class CornerWeights {
 public:
  CornerWeights() = default;
  CornerWeights(const Mesh& m, const Face& f);
  Vec3 at(const Vec3& p) const {
    if (is_flat_) return Vec3::Constant(1.0 / 3);
    const double b = (p - first_).dot(rise_[0]), c = (p - first_).dot(rise_[1]);
    return {1 - b - c, b, c};
  }

 private:
  Vec3 first_ = Vec3::Zero();
  std::array<Vec3, 2> rise_ = {};  // how the second and third weight grow
  bool is_flat_ = true;
};
inline Vec3 barycentric(const Mesh& m, const Face& f, const Vec3& p) {
  return CornerWeights(m, f).at(p);
}
double surface_area(const Mesh& m);
/// Signed volume enclosed by a closed mesh (positive when faces point outward); meaningless for an
/// open one.
double signed_volume(const Mesh& m);

/// Two unit vectors that complete `normal` to a right-handed frame (u, v, normal); u is horizontal
/// unless the normal is vertical.
std::array<Vec3, 2> plane_basis(const Vec3& normal);

}  // namespace colod
