// Based on: own work.
// Differs: a source's own coarse tiles are taken as they are: they were made from the photographs,
// and what is cut out of them has the same borders on all levels.
#include "context.h"

#include <algorithm>
#include <cmath>

namespace colod {

namespace {

constexpr double kLongest = 1.5;  // metres: the closing ground follows banks as fine as this
constexpr double kAlways = 16;    // pixels that clients refine at, times what covers one
constexpr double kBare = 0.7;     // metres over the terrain: what is seen there is ground

/// Triangles of the plan, halved until their sides are short.
class Ground {
 public:
  Ground(const HeightMap& map, const std::vector<float>& terrain) : map_(map), terrain_(terrain) {}

  Source close(const std::vector<Territories::Piece>& pieces) {
    for (const Territories::Piece& piece : pieces) add(piece.corners);
    color_hidden();
    return std::move(out_);
  }

 private:
  void add(const std::array<Vec2, 3>& first) {
    std::vector<std::array<Vec2, 3>> open = {first};
    while (!open.empty()) {
      const std::array<Vec2, 3> t = open.back();
      open.pop_back();
      int longest = 0;
      for (int k = 1; k < 3; ++k)
        if (side(t, k) > side(t, longest)) longest = k;
      if (side(t, longest) <= kLongest) {
        add_face(t);
        continue;
      }
      const auto a = static_cast<std::size_t>(longest);
      const Vec2 middle = 0.5 * (t[a] + t[(a + 1) % 3]);
      open.push_back({t[a], middle, t[(a + 2) % 3]});
      open.push_back({middle, t[(a + 1) % 3], t[(a + 2) % 3]});
    }
  }

  static double side(const std::array<Vec2, 3>& t, int k) {
    const auto a = static_cast<std::size_t>(k);
    return (t[a] - t[(a + 1) % 3]).norm();
  }

  std::size_t cell_at(const Vec2& p) const {
    const Vec2 at = (p - map_.origin) / map_.cell;
    return map_.at(std::clamp(static_cast<int>(at.x()), 0, map_.width - 1),
                   std::clamp(static_cast<int>(at.y()), 0, map_.height - 1));
  }

  /// The surface where it is bare, else the terrain below what stands there.
  bool is_bare(std::size_t cell) const { return std::abs(map_.top[cell] - terrain_[cell]) < kBare; }

  void add_face(const std::array<Vec2, 3>& t) {
    Face face;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t cell = cell_at(t[k]);
      face[k] = static_cast<int>(out_.mesh.vertices.size());
      out_.mesh.vertices.emplace_back(t[k].x(), t[k].y(),
                                      is_bare(cell) ? map_.top[cell] : terrain_[cell]);
    }
    out_.mesh.faces.push_back(face);
    if (map_.color.empty()) return;
    const std::size_t cell = cell_at((t[0] + t[1] + t[2]) / 3);
    const Rgb rgb = map_.color[cell];
    out_.look.colors.push_back({rgb, rgb, rgb});
    is_hidden_.push_back(!is_bare(cell));
  }

  /// What nobody has seen looks like the mean of what is bare.
  void color_hidden() {
    std::array<double, 3> sum{};
    double count = 0;
    for (std::size_t f = 0; f < is_hidden_.size(); ++f) {
      if (is_hidden_[f]) continue;
      for (std::size_t k = 0; k < 3; ++k) sum[k] += out_.look.colors[f][0][k];
      ++count;
    }
    Rgb mean = {128, 128, 128};
    for (std::size_t k = 0; k < 3 && count > 0; ++k)
      mean[k] = static_cast<std::uint8_t>(sum[k] / count);
    for (std::size_t f = 0; f < is_hidden_.size(); ++f)
      if (is_hidden_[f]) out_.look.colors[f] = {mean, mean, mean};
  }

  const HeightMap& map_;
  const std::vector<float>& terrain_;
  Source out_;
  std::vector<char> is_hidden_;
};

}  // namespace

std::shared_ptr<const Context> context_of(const std::shared_ptr<const PartedScene>& scene,
                                          const ReadOptions& options) {
  auto context = std::make_shared<Context>();
  for (const TileNode& node : scene->tiles.tree().nodes)
    context->nodes.push_back({node.parent, node.geometric_error, node.is_added});
  if (!scene->tiles.tree().is_tileset)  // of one level: it is seen from wherever the whole is
    context->nodes[0].geometric_error = kAlways * scene->tiles.box().diagonal();
  const std::size_t closing = context->nodes.size();
  context->nodes.push_back({-1, 0, false});
  context->read = [scene, options, closing](std::size_t i) {
    if (i == closing)
      return Ground(scene->map, scene->classes.ground).close(scene->territories.pieces());
    const TileNode& node = scene->tiles.tree().nodes[i];
    std::vector<Source> parts;
    for (const std::string& content : node.contents) {
      try {
        parts.push_back(scene->territories.cut_out(
            read_tile(node, content, scene->tiles.to_scene(), options), -1));
      } catch (const Error&) {
        continue;  // a finest tile is told of already; of coarser ones the finer are there
      }
    }
    return joined(parts);
  };
  return context;
}

}  // namespace colod
