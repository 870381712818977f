#include "tally.h"

#include <algorithm>

#include "pipeline/losses.h"
#include "scene/left_out.h"

namespace colod {

Tally& Tally::operator+=(const Tally& other) {
  for (std::size_t Tally::*count :
       {&Tally::buildings, &Tally::done, &Tally::lossy, &Tally::amiss, &Tally::failed,
        &Tally::failed_layers, &Tally::stand_in_layers, &Tally::lost_bodies, &Tally::lost_textures,
        &Tally::segments, &Tally::beyond_layer0})
    this->*count += other.*count;
  rays += other.rays;
  ray_seconds += other.ray_seconds;
  return *this;
}

Tally tally_of(const Building& b) {
  Tally t;
  if (b.is_dismissed) return t;
  t.buildings = 1;
  t.amiss = b.has_failed() || b.has_lost();
  t.failed = !b.failure.empty();
  t.done = b.failure.empty();
  t.lossy = t.done && t.amiss;
  t.lost_textures = b.lost_looks.size();
  for (const LeftOut& l : b.left_out) t.lost_bodies += is_loss(l);
  for (const Layer& layer : b.layers)
    t.failed_layers += !layer.failure.empty(), t.stand_in_layers += is_failure(layer.stand_in);
  t.segments = b.segments.segments.size();
  t.beyond_layer0 = static_cast<std::size_t>(std::count_if(
      b.layer_of_segment.begin(), b.layer_of_segment.end(), [](int l) { return l > 0; }));
  t.rays = b.segments.rays;
  t.ray_seconds = b.segments.visibility_seconds;
  return t;
}

Tally tally_of(const Scene& scene) {
  Tally all;
  for (const Building& b : scene.buildings) all += tally_of(b);
  return all;
}

}  // namespace colod
