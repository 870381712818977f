// Inside room `bake` only: one colour a facet.
#pragma once

#include <vector>

#include "panes.h"
#include "probe.h"

namespace colod::bake {

/// What a source shows within `reach` metres of a layer. Keeps references.
struct Outlook {
  const Probe& probe;
  const LookSampler& sampler;
  const ImageCache& cache;
  double reach;
};

/// The mean of what is seen of each; of a facet that nobody saw that of all, grey where nothing is
/// seen at all.
std::vector<Rgb> colors_of_facets(const PolygonMesh& mesh, const Outlook& outlook);

}  // namespace colod::bake
