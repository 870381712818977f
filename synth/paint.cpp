#include "paint.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>

#include "core/parallel.h"
#include "core/rays.h"
#include "image/image.h"
#include "image/packing.h"
#include "materials.h"

namespace colod {

namespace {

using namespace synth;

constexpr double kTurn = 0.8;   // cosine between the normals of a chart's faces
constexpr double kWidest = 5;   // metres, a chart
constexpr int kGutter = 2;      // texels
constexpr int kLargest = 8192;  // texels a side
constexpr int kQuality = 90;
constexpr int kSamples = 3;     // along a texel's side: joints are narrower than texels
constexpr double kShown = 0.5;  // metres from the clean model: what lies farther is none of it
/// Neighbouring faces that look the same way, seen along the first one's normal.
struct Patch {
  std::vector<int> faces;
  Vec3 normal, right, down;
  Vec2 corner = Vec2::Constant(INFINITY), size = Vec2::Zero();
  double texel = 0;

  Vec2 flat(const Vec3& p) const { return {right.dot(p), down.dot(p)}; }
};

/// The faces of a patch on its plane, asked for many places one after another.
class FlatFaces {
 public:
  FlatFaces(const Mesh& mesh, const Patch& patch) : corner_(patch.corner) {
    for (const int f : patch.faces) {
      FlatFace flat;
      for (int k = 0; k < 3; ++k) flat.corner[k] = patch.flat(mesh.vertices[mesh.faces[f][k]]);
      for (int k = 0; k < 3; ++k) {
        flat.side[k] = flat.corner[(k + 1) % 3] - flat.corner[k];
        flat.length[k] = flat.side[k].norm() + kNoLength;
      }
      faces_.push_back(flat);
    }
    cell_ = std::max(kLeastCell, std::sqrt(patch.size.prod() / static_cast<double>(faces_.size())));
    columns_ = static_cast<int>(patch.size.x() / cell_) + 1;
    rows_ = static_cast<int>(patch.size.y() / cell_) + 1;
    cells_.resize(static_cast<std::size_t>(columns_) * rows_);
    for (std::size_t i = 0; i < faces_.size(); ++i) list(i);
  }

  /// The number of the first that holds a place, else of the one that it is least outside of.
  std::size_t at(const Vec2& q) {
    for (const std::size_t i : cells_[cell_of(q)])
      if (outside(i, q, 0) <= 0) return last_ = i;
    double least = outside(last_, q, INFINITY);
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      const double own = outside(i, q, least);
      if (own < least || (own == least && i < last_)) least = own, last_ = i;
    }
    return last_;
  }

 private:
  static constexpr double kNoLength = 1e-9;   // metres: sides of no length divide nothing by zero
  static constexpr double kLeastCell = 0.02;  // metres
  static constexpr double kAbout = 1e-6;      // metres beyond a face's box, against rounding

  struct FlatFace {
    std::array<Vec2, 3> corner, side;
    std::array<double, 3> length;
  };

  /// Metres beyond the farthest side, 0 inside; the plane's axes are mirrored. Some value beyond
  /// `most` where it is beyond that.
  double outside(std::size_t face, const Vec2& q, double most) const {
    const FlatFace& f = faces_[face];
    double far = 0;
    for (int k = 0; k < 3 && far <= most; ++k) {
      const Vec2 to = q - f.corner[k];
      far = std::max(far, (f.side[k].x() * to.y() - f.side[k].y() * to.x()) / f.length[k]);
    }
    return far;
  }

  int along(double metres, int n) const {
    return static_cast<int>(std::clamp<double>(std::floor(metres / cell_), 0, n - 1));
  }

  std::size_t cell_of(const Vec2& q) const {
    return static_cast<std::size_t>(along(q.y() - corner_.y(), rows_)) * columns_ +
           along(q.x() - corner_.x(), columns_);
  }

  void list(std::size_t face) {
    const auto& c = faces_[face].corner;
    const Vec2 about = Vec2::Constant(kAbout);
    const Vec2 least = c[0].cwiseMin(c[1]).cwiseMin(c[2]) - corner_ - about;
    const Vec2 most = c[0].cwiseMax(c[1]).cwiseMax(c[2]) - corner_ + about;
    for (int y = along(least.y(), rows_); y <= along(most.y(), rows_); ++y)
      for (int x = along(least.x(), columns_); x <= along(most.x(), columns_); ++x)
        cells_[static_cast<std::size_t>(y) * columns_ + x].push_back(face);
  }

  Vec2 corner_;
  std::vector<FlatFace> faces_;
  double cell_ = 1;  // metres, a side
  int columns_ = 1, rows_ = 1;
  std::vector<std::vector<std::size_t>> cells_;  // row by row, the faces that come near, in order
  std::size_t last_ = 0;                         // the answer before: the next is mostly the same
};

class Painter {
 public:
  Painter(const SynthBuilding& building, double texel, const SynthBuilding* clean)
      : building_(building), mesh_(building.source.mesh), clean_(clean), texel_(texel) {
    if (clean) clean_surface_.emplace(clean->source.mesh);
    for (const Vec3& v : mesh_.vertices) box_.extend(v);
    for (const Face& f : mesh_.faces) {
      const Vec3 cross = face_cross(mesh_, f);
      normals_.push_back(cross.norm() > 0 ? Vec3(cross.normalized()) : Vec3(Vec3::UnitZ()));
    }
    long seed = 0;
    for (const char c : building.source.name) seed = 31 * seed + c;
    seed_ = seed;
  }

  PaintedModel paint() {
    grow_patches();
    place_patches();
    const std::string name = building_.source.name;
    return {obj(), "newmtl " + name + "\nKd 1 1 1\nillum 0\nmap_Kd " + name + ".jpg\n",
            encode_image(picture(), ImageFormat::kJpeg, kQuality)};
  }

 private:
  std::vector<std::vector<int>> neighbours() const {
    std::map<std::pair<int, int>, int> over_edge;
    std::vector<std::vector<int>> beside(mesh_.faces.size());
    for (int f = 0; f < static_cast<int>(mesh_.faces.size()); ++f)
      for (int k = 0; k < 3; ++k) {
        const int a = mesh_.faces[f][k], b = mesh_.faces[f][(k + 1) % 3];
        const auto [it, is_new] = over_edge.emplace(std::minmax(a, b), f);
        if (!is_new) beside[f].push_back(it->second), beside[it->second].push_back(f);
      }
    return beside;
  }

  void grow_patches() {
    const std::vector<std::vector<int>> beside = neighbours();
    std::vector<char> is_taken(mesh_.faces.size(), 0);
    for (int seed = 0; seed < static_cast<int>(mesh_.faces.size()); ++seed) {
      if (is_taken[seed]) continue;
      Patch patch{{seed}, normals_[seed], {}, {}};
      const auto [u, v] = plane_basis(patch.normal);
      patch.right = u, patch.down = -v;
      is_taken[seed] = 1;
      const Vec3 start = mesh_.vertices[mesh_.faces[seed][0]];
      for (std::size_t i = 0; i < patch.faces.size(); ++i)
        for (const int f : beside[patch.faces[i]]) {
          const bool is_near = (mesh_.vertices[mesh_.faces[f][0]] - start).norm() < kWidest;
          if (is_taken[f] || !is_near || normals_[f].dot(patch.normal) < kTurn) continue;
          is_taken[f] = 1;
          patch.faces.push_back(f);
        }
      patches_.push_back(std::move(patch));
    }
  }

  void place_patches() {
    for (std::size_t i = 0; i < patches_.size(); ++i) {
      Patch& patch = patches_[i];
      Vec2 most = Vec2::Constant(-INFINITY);
      for (const int f : patch.faces)
        for (const int v : mesh_.faces[f]) {
          patch.corner = patch.corner.cwiseMin(patch.flat(mesh_.vertices[v]));
          most = most.cwiseMax(patch.flat(mesh_.vertices[v]));
        }
      patch.size = most - patch.corner;
      patch.texel = texel_ * (1 + std::floor(3 * noise(static_cast<long>(i), 4, seed_)) / 2);
    }
    for (double scale = 1; width_ == 0 && scale < 100; scale *= 1.2) {
      rects_.clear();
      for (Patch& patch : patches_) {
        if (scale > 1) patch.texel *= 1.2;
        const auto side = [&](double metres) {
          return (static_cast<int>(std::ceil(metres / patch.texel)) + 2 * kGutter + 3) / 4 * 4;
        };
        rects_.push_back({side(patch.size.x()), side(patch.size.y())});
      }
      const auto [width, height] = pack_rects(rects_, kLargest);
      width_ = width, height_ = height;
    }
  }

  static ElementKind kind_of(const SynthBuilding& building, int face) {
    const int object = building.source.face_object[face];
    return object < 0 ? ElementKind::kPlain : building.parts[object].kind;
  }

  /// What a place of a patch's plane shows, of the face that lies there.
  Spot spot_at(const Patch& patch, int face, const Vec2& q) const {
    const Vec3 in_plane = q.x() * patch.right + q.y() * patch.down;
    const Vec3 corner = mesh_.vertices[mesh_.faces[face][0]];
    const double slope = std::max(0.2, normals_[face].dot(patch.normal));
    const double depth = normals_[face].dot(corner - in_plane) / slope;
    const Spot own{in_plane + depth * patch.normal, normals_[face], kind_of(building_, face)};
    if (!clean_) return own;
    const NearestPoint near = clean_surface_->nearest(own.place, kShown);
    if (near.triangle < 0 || near.distance > kShown)
      return {own.place, own.normal, ElementKind::kPlain, true};
    const Mesh& mesh = clean_->source.mesh;
    return {near.point, face_cross(mesh, mesh.faces[near.triangle]).normalized(),
            kind_of(*clean_, near.triangle)};
  }

  /// The mean over a texel, on the plane of the place in its middle.
  Light texel_at(const Patch& patch, int face, const Vec2& q, const Paint& paint) const {
    const Spot spot = spot_at(patch, face, q);
    Light sum = Light::Zero();
    for (int k = 0; k < kSamples * kSamples; ++k) {
      const Vec2 to = Vec2(k % kSamples + 0.5, k / kSamples + 0.5) / kSamples - Vec2(0.5, 0.5);
      const Vec3 offset = patch.texel * (to.x() * patch.right + to.y() * patch.down);
      sum += paint.at(spot, spot.place + offset - spot.normal.dot(offset) * spot.normal);
    }
    return sum / (kSamples * kSamples);
  }

  /// Of the clean model: a scan ends above or below it.
  double foot() const {
    return clean_ ? bounding_box(clean_->source.mesh.vertices).min.z() : box_.min.z();
  }

  Raster picture() const {
    Raster out(width_, height_);
    const Paint paint(foot(), seed_);
    parallel_for(patches_.size(), [&](std::size_t i) { draw(patches_[i], rects_[i], paint, out); });
    return out;
  }

  void draw(const Patch& patch, const PackedRect& r, const Paint& paint, Raster& out) const {
    FlatFaces faces(mesh_, patch);
    for (int y = 0; y < r.height; ++y)
      for (int x = 0; x < r.width; ++x) {
        const Vec2 q = patch.corner + patch.texel * Vec2(x + 0.5 - kGutter, y + 0.5 - kGutter);
        const Light light = texel_at(patch, patch.faces[faces.at(q)], q, paint);
        for (int c = 0; c < 3; ++c)
          out.at(r.x + x, r.y + y)[c] = to_srgb(static_cast<float>(light[c]));
      }
  }

  std::string coordinates(const Patch& patch, const PackedRect& r, const Vec3& p) const {
    const Vec2 at =
        (patch.flat(p) - patch.corner) / patch.texel + Vec2(r.x + kGutter, r.y + kGutter);
    char line[80];
    std::snprintf(line, sizeof line, "vt %.6f %.6f\n", at.x() / width_, 1 - at.y() / height_);
    return line;
  }

  std::string obj() const {
    const std::string& name = building_.source.name;
    std::string text = "# " + name + ", " + building_.style + ", metres, z up\nmtllib " + name +
                       ".mtl\nusemtl " + name + "\n";
    char line[160];
    for (const Vec3& v : mesh_.vertices) {
      std::snprintf(line, sizeof line, "v %.5f %.5f %.5f\n", v.x(), v.y(), v.z());
      text += line;
    }
    std::vector<int> patch_of(mesh_.faces.size());
    for (std::size_t i = 0; i < patches_.size(); ++i)
      for (const int f : patches_[i].faces) patch_of[f] = static_cast<int>(i);
    std::vector<std::vector<int>> faces_of(building_.parts.size() + 1);
    for (std::size_t f = 0; f < mesh_.faces.size(); ++f) {
      const int object = building_.source.face_object[f];
      faces_of[object < 0 ? building_.parts.size() : object].push_back(static_cast<int>(f));
    }
    std::map<std::pair<int, int>, int> number;  // of a vertex on a patch
    const auto corner = [&](int patch, int vertex) {
      const auto [it, is_new] =
          number.emplace(std::pair(patch, vertex), static_cast<int>(number.size()) + 1);
      if (is_new) text += coordinates(patches_[patch], rects_[patch], mesh_.vertices[vertex]);
      return std::to_string(vertex + 1) + "/" + std::to_string(it->second);
    };
    for (std::size_t part = 0; part < faces_of.size(); ++part) {
      const bool is_part = part < building_.parts.size();
      text += std::string("g ") + (is_part ? name_of(building_.parts[part].kind) : "floater") +
              "__" + std::to_string(part) + "\n";
      for (const int f : faces_of[part]) {
        std::string face = "f";
        for (const int v : mesh_.faces[f]) face += " " + corner(patch_of[f], v);
        text += face + "\n";
      }
    }
    return text;
  }

  const SynthBuilding& building_;
  const Mesh& mesh_;
  const SynthBuilding* clean_;
  std::optional<RayScene> clean_surface_;
  double texel_;
  Box box_;
  long seed_ = 0;
  std::vector<Vec3> normals_;
  std::vector<Patch> patches_;
  std::vector<PackedRect> rects_;
  int width_ = 0, height_ = 0;
};

}  // namespace

PaintedModel paint(const SynthBuilding& building, double texel, const SynthBuilding* clean) {
  return Painter(building, texel, clean).paint();
}

}  // namespace colod
