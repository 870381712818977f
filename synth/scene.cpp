// *Based on:* own work.
//
// *Differs:* no --rules here.
//
// *Notation:* none.
#include "scene.h"

#include <cmath>
#include <cstdio>

#include "core/error.h"
#include "scene_look.h"
#include "scene_points.h"

namespace colod {

using namespace synth;

namespace {

constexpr int kTileCells = 128;      // of the lattice, a tile's side
constexpr double kCellOfEdge = 0.8;  // diagonals and walls lengthen edges

}  // namespace

struct SynthScene::Impl {
  SynthSceneOptions options;
  Town town;
  Pool pool;
  double cell;
  int i0, j0, columns, rows;  ///< of the lattice

  explicit Impl(const SynthSceneOptions& o)
      : options(o), town(o.buildings, o.seed), pool(o.seed), cell(kCellOfEdge * o.edge) {
    const Box& box = town.box();
    i0 = static_cast<int>(std::floor(box.min.x() / cell));
    j0 = static_cast<int>(std::floor(box.min.y() / cell));
    columns = static_cast<int>(std::ceil(box.max.x() / cell)) - i0;
    rows = static_cast<int>(std::ceil(box.max.y() / cell)) - j0;
  }

  int across() const { return (columns + kTileCells - 1) / kTileCells; }
  int along() const { return (rows + kTileCells - 1) / kTileCells; }

  TilePlace place(int x, int y) const {
    return {i0 + kTileCells * x, j0 + kTileCells * y,
            std::min(kTileCells, columns - kTileCells * x),
            std::min(kTileCells, rows - kTileCells * y), cell};
  }

  std::string id(int building) const {
    char text[16];
    std::snprintf(text, sizeof text, "b%04d", building + 1);
    return text;
  }
};

SynthScene::SynthScene(const SynthSceneOptions& options) {
  if (options.buildings < 1) throw Error(Stage::kUsage, "synth", "needs at least one building");
  if (!(options.density > 0)) throw Error(Stage::kUsage, "synth", "a cloud needs points");
  if (!(options.edge > 0) || !(options.texel > 0))
    throw Error(Stage::kUsage, "synth", "edges and texels of a scene must be longer than nothing");
  impl_ = std::make_unique<Impl>(options);
}
SynthScene::~SynthScene() = default;

int SynthScene::tile_count() const { return impl_->across() * impl_->along(); }
int SynthScene::building_count() const { return static_cast<int>(impl_->town.plots().size()); }
double SynthScene::truth_cell() const { return impl_->cell / 2; }

Box SynthScene::box() const {
  Box box;
  box.extend(impl_->cell * Vec3(impl_->i0, impl_->j0, 0));
  box.extend(impl_->cell * Vec3(impl_->i0 + impl_->columns, impl_->j0 + impl_->rows, 0));
  return box;
}

SynthTile SynthScene::tile(int index) const {
  const int x = index % impl_->across(), y = index / impl_->across();
  const TilePlace place = impl_->place(x, y);
  SynthTile tile;
  char name[32];
  std::snprintf(name, sizeof name, "Tile_+%03d_+%03d", x, y);
  tile.name = name;
  const std::map<int, Standing> standing = standing_on(impl_->town, impl_->pool, place);
  const SkyView view = look_down(impl_->town, standing, place);
  tile.mesh = reconstruct_tile(view, place, impl_->options.seed);
  const Sight sight = {impl_->town, standing, view};
  paint_tile(sight, impl_->options.texel, tile);
  tell_truth(sight, place, tile);
  return tile;
}

std::vector<SynthPoint> SynthScene::points(int index) const {
  const TilePlace place = impl_->place(index % impl_->across(), index / impl_->across());
  const std::map<int, Standing> standing = standing_on(impl_->town, impl_->pool, place);
  return scan_from_above(impl_->town, standing, look_down(impl_->town, standing, place), place,
                         impl_->options.density, impl_->options.seed);
}

SynthSceneBuilding SynthScene::building(int index) const {
  const Plot& plot = impl_->town.plots()[index];
  const SceneHouse made = make_scene_house(plot, impl_->pool);
  SynthSceneBuilding out;
  out.id = impl_->id(index), out.kind = name_of(plot.kind), out.row = plot.row;
  out.model = place_scene_house(made, plot, out.id, false);
  out.height = bounding_box(out.model.source.mesh.vertices).max.z() - plot.foot;
  for (const auto& ring : made.footprint.rings()) {
    out.rings.emplace_back();
    for (const Vec2& p : ring) out.rings.back().push_back(plot.to_world(p));
  }
  return out;
}

}  // namespace colod
