// Based on: own work.
// Differs: under the paper's rules a layer of another volume stays, and so does an invented one.
// Notation: none.
#include "stand_ins.h"

#include <algorithm>
#include <cmath>

#include "measure/scene_part.h"
#include "parameters.h"

namespace colod {
namespace {

using namespace parameters::layers;

bool is_richer(const PolygonMesh& a, const PolygonMesh& b) {
  return a.vertices.size() > b.vertices.size() || a.triangles.size() > b.triangles.size() ||
         a.facets.size() > b.facets.size();
}

/// Why a coarser layer cannot stand before a finer one. The volume is asked first: what lost a wing
/// may be richer as well.
StandIn misfit(const PolygonMesh& coarse, const PolygonMesh& fine, bool is_volume_checked) {
  const double volume = signed_volume(fine.mesh());
  const double change = std::abs(signed_volume(coarse.mesh()) - volume);
  if (is_volume_checked && change > kVolumeChange * volume) return StandIn::kVolume;
  return is_richer(coarse, fine) ? StandIn::kRicher : StandIn::kNone;
}

}  // namespace

const char* describe(StandIn reason) {
  switch (reason) {
    case StandIn::kNone:
      return "";
    case StandIn::kRicher:
      return "came out richer than the next finer one and takes its mesh";
    case StandIn::kInvented:
      return "came out with most of its roofs and many walls far from the source: it stands "
             "elsewhere, so that the next finer layer's mesh stands in";
    case StandIn::kVolume:
      return "came out with another volume than the finer ones, by more than a fifth: it lost a "
             "part of the building or invented one, so that the next finer layer's mesh stands in";
  }
  return "";
}

void keep_chain_sound(Building& b, const Options& o) {
  const bool is_volume_checked = o.rules.has(Rule::kVolume);
  for (std::size_t k = b.layers.size() - 1; k-- > 0;) {
    Layer &coarse = b.layers[k], &fine = b.layers[k + 1];
    if (!coarse.failure.empty() || !fine.failure.empty()) continue;
    coarse.stand_in = misfit(coarse.mesh, fine.mesh, is_volume_checked);
    if (coarse.stand_in == StandIn::kNone && b.layers.back().failure.empty())
      coarse.stand_in =
          misfit(coarse.mesh, b.layers.back().mesh, is_volume_checked);  // changes add up
    if (coarse.stand_in == StandIn::kNone) continue;
    if (coarse.stand_in == StandIn::kRicher)
      b.warnings.push_back("layer " + std::to_string(k) + " " + describe(coarse.stand_in));
    coarse.mesh = fine.mesh;
  }
}

/// From the building's frame to axes parallel to the world's.

void replace_invented(const Surface& source, bool is_replaced, Building& b) {
  std::vector<Mesh> meshes;
  std::vector<Layer*> shown;
  for (Layer& layer : b.layers)
    if (layer.failure.empty()) meshes.push_back(layer.mesh.mesh()), shown.push_back(&layer);
  if (shown.empty()) return;
  const std::vector<InventedShare> shares = invented_shares(source, meshes);
  for (std::size_t i = shown.size(); i-- > 0;) {
    shown[i]->invented = shares[i].share;
    if (!is_replaced || !shares[i].is_too_much || i + 1 == shown.size()) continue;
    shown[i]->mesh = shown[i + 1]->mesh;
    shown[i]->invented = shown[i + 1]->invented;
    shown[i]->stand_in = StandIn::kInvented;
  }
}

}  // namespace colod
