// *Based on:* airborne laser scanning, discrete returns.
//
// *Differs:* all beams are plumb, and walls have no points; no --rules here.
//
// *Notation:* none.
#include "scene_points.h"

#include <cmath>

#include "materials.h"

namespace colod::synth {
namespace {

constexpr double kNoise = 0.03;   // metres
constexpr double kThrough = 0.3;  // of beams that leaves let through
constexpr int kGroundClass = 2, kPlantClass = 5, kBuildingClass = 6, kRestClass = 1;

/// About normal, of variance one.
double bell(long a, long b, long seed) {
  double sum = 0;
  for (long k = 0; k < 4; ++k) sum += noise(a, b, seed + k) - 0.5;
  return sum * std::sqrt(3.0);
}

class Beams {
 public:
  Beams(const Town& town, const std::map<int, Standing>& standing, const SkyView& view)
      : town_(town), standing_(standing), view_(view) {}

  SynthPoint hit(const Vec2& p, bool is_through) const {
    const SynthPoint ground{Vec3(p.x(), p.y(), town_.ground(p)), kGroundClass};
    const int object = view_.object_at(p);
    const int plots = static_cast<int>(town_.plots().size());
    if (object == SkyView::kGround) return ground;
    if (object < plots) return on_roof(standing_.at(object), p, ground);
    const Prop& prop = town_.props()[static_cast<std::size_t>(object - plots)];
    const bool is_plant = prop.kind == PropKind::kTree || prop.kind == PropKind::kHedge;
    const double top = prop.top(p);
    if ((is_plant && is_through) || !(top > ground.at.z())) return ground;
    return {Vec3(p.x(), p.y(), top), is_plant ? kPlantClass : kRestClass};
  }

 private:
  static SynthPoint on_roof(const Standing& house, const Vec2& p, const SynthPoint& ground) {
    const double above = house.box.max.z() + 5;
    const Vec2 own = p - house.plot->origin;
    const RayHit hit = house.rays.first_hit(Vec3(own.x(), own.y(), above), -Vec3::UnitZ());
    if (!hit) return ground;
    return {Vec3(p.x(), p.y(), house.plot->foot + above - hit.distance), kBuildingClass};
  }

  const Town& town_;
  const std::map<int, Standing>& standing_;
  const SkyView& view_;
};

}  // namespace

std::vector<SynthPoint> scan_from_above(const Town& town, const std::map<int, Standing>& standing,
                                        const SkyView& view, const TilePlace& place, double density,
                                        std::uint64_t seed) {
  const Beams beams(town, standing, view);
  const double step = 1 / std::sqrt(density);
  const Vec2 low = place.cell * Vec2(place.i0, place.j0);
  const Vec2 high = low + place.cell * Vec2(place.columns, place.rows);
  const auto salt = static_cast<long>(seed % 1000003) * 16;
  std::vector<SynthPoint> out;
  for (long j = std::lround(std::floor(low.y() / step)); j * step < high.y(); ++j)
    for (long i = std::lround(std::floor(low.x() / step)); i * step < high.x(); ++i) {
      const Vec2 p = step * Vec2(i + noise(i, j, salt), j + noise(i, j, salt + 1));
      if ((p.array() < low.array()).any() || (p.array() >= high.array()).any()) continue;
      SynthPoint point = beams.hit(p, noise(i, j, salt + 2) < kThrough);
      point.at.z() += kNoise * bell(i, j, salt + 3);
      out.push_back(point);
    }
  return out;
}

}  // namespace colod::synth
