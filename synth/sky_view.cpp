// *Based on:* what cameras above see: the highest surface at a place.
//
// *Differs:* no --rules here.
//
// *Notation:* none.
#include <algorithm>
#include <cmath>

#include "scene_surface.h"

namespace colod::synth {
namespace {

constexpr int kRim = 8;           // cells beyond the tile: what the surface's own rims need
constexpr int kMelt = 3;          // cells: half of the gaps that pictures hardly look into
constexpr double kFilled = 0.65;  // of such a gap's depth
constexpr double kLeast = 1.5;    // m of depth from which on gaps are filled

SynthBuilding local_model(const Plot& plot, const Pool& pool) {
  return place_scene_house(make_scene_house(plot, pool), plot, "", true);
}

bool overlaps(const Box& a, const Box& b) {
  return a.min.x() < b.max.x() && b.min.x() < a.max.x() && a.min.y() < b.max.y() &&
         b.min.y() < a.max.y();
}

Box box_of(const SkyView& view) {
  Box box;
  box.extend(Vec3(view.x0 * view.cell, view.y0 * view.cell, 0));
  box.extend(Vec3((view.x0 + view.width) * view.cell, (view.y0 + view.height) * view.cell, 0));
  return box;
}

SkyView empty_view(const TilePlace& place) {
  SkyView view;
  view.cell = place.cell / 2;
  view.x0 = 2 * place.i0 - kRim, view.y0 = 2 * place.j0 - kRim;
  view.width = 2 * place.columns + 2 * kRim;
  view.height = 2 * place.rows + 2 * kRim;
  return view;
}

void raise(SkyView& view, int x, int y, double z, int object) {
  const std::size_t i = view.at(x, y);
  if (z <= view.top[i]) return;
  view.top[i] = z, view.object[i] = object;
}

/// Cells whose middle may lie in the box.
template <typename Visit>
void over_cells(const SkyView& view, const Box& box, const Visit& visit) {
  if (!overlaps(box, box_of(view))) return;
  for (int y = view.row(box.min.y()); y <= view.row(box.max.y()); ++y)
    for (int x = view.column(box.min.x()); x <= view.column(box.max.x()); ++x) visit(x, y);
}

void draw_building(SkyView& view, const Standing& building, int object) {
  const double above = building.box.max.z() + 5;
  Box box = building.box;
  box.min.head<2>() += building.plot->origin, box.max.head<2>() += building.plot->origin;
  over_cells(view, box, [&](int x, int y) {
    const Vec2 p = view.middle(x, y) - building.plot->origin;
    const RayHit hit = building.rays.first_hit(Vec3(p.x(), p.y(), above), -Vec3::UnitZ());
    if (hit) raise(view, x, y, building.plot->foot + above - hit.distance, object);
  });
}

/// The least or the greatest within some cells, along one axis after the other.
template <typename Best>
std::vector<double> within(const SkyView& view, const std::vector<double>& heights,
                           const Best& best) {
  std::vector<double> in = heights, out = heights;
  for (const bool is_x : {true, false}) {
    for (int y = 0; y < view.height; ++y)
      for (int x = 0; x < view.width; ++x) {
        double value = in[static_cast<std::size_t>(y) * view.width + x];
        for (int k = -kMelt; k <= kMelt; ++k) {
          const int i = std::clamp(is_x ? x + k : x, 0, view.width - 1);
          const int j = std::clamp(is_x ? y : y + k, 0, view.height - 1);
          value = best(value, in[static_cast<std::size_t>(j) * view.width + i]);
        }
        out[static_cast<std::size_t>(y) * view.width + x] = value;
      }
    in = out;
  }
  return out;
}

/// Gaps between walls that stand near each other.
void melt(SkyView& view) {
  const auto least = [](double a, double b) { return std::min(a, b); };
  const auto most = [](double a, double b) { return std::max(a, b); };
  const std::vector<double> closed = within(view, within(view, view.top, most), least);
  view.melted = view.top;
  for (std::size_t i = 0; i < closed.size(); ++i)
    if (closed[i] - view.top[i] > kLeast) view.melted[i] += kFilled * (closed[i] - view.top[i]);
}

}  // namespace

Standing::Standing(const Plot& its_plot, const Pool& pool)
    : plot(&its_plot),
      model(local_model(its_plot, pool)),
      rays(model.source.mesh),
      box(bounding_box(model.source.mesh.vertices)) {}

std::map<int, Standing> standing_on(const Town& town, const Pool& pool, const TilePlace& place) {
  std::map<int, Standing> out;
  const Box box = box_of(empty_view(place));
  for (std::size_t i = 0; i < town.plots().size(); ++i)
    if (overlaps(town.plots()[i].around(), box))
      out.emplace(std::piecewise_construct, std::forward_as_tuple(static_cast<int>(i)),
                  std::forward_as_tuple(town.plots()[i], pool));
  return out;
}

SkyView look_down(const Town& town, const std::map<int, Standing>& standing,
                  const TilePlace& place) {
  SkyView view = empty_view(place);
  const std::size_t n = static_cast<std::size_t>(view.width) * view.height;
  view.top.resize(n), view.object.assign(n, SkyView::kGround);
  for (int y = view.y0; y < view.y0 + view.height; ++y)
    for (int x = view.x0; x < view.x0 + view.width; ++x)
      view.top[view.at(x, y)] = town.ground(view.middle(x, y));
  for (const auto& [plot, building] : standing) draw_building(view, building, plot);
  for (std::size_t i = 0; i < town.props().size(); ++i) {
    const Prop& prop = town.props()[i];
    const int object = static_cast<int>(town.plots().size() + i);
    over_cells(view, prop.around(),
               [&](int x, int y) { raise(view, x, y, prop.top(view.middle(x, y)), object); });
  }
  melt(view);
  return view;
}

}  // namespace colod::synth
