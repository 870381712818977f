// All segments beyond layer 0 → layers (paper section 3.2, Spectral Clustering).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/rules.h"
#include "planes/planes.h"
#include "segments/segments.h"
#include "similarity.h"

namespace colod {

enum class Layering {
  kSpectral,
  kSize
};  ///< size: one threshold per layer on the longest extent, the baseline to beat

struct ClusteringOptions {
  RuleSet rules = RuleSet::all();  ///< without Rule::kKinds clusters of the spectrum are layers,
                                   ///< by falling mean volume
  Layering layering = Layering::kSpectral;
  int layers = 3;  ///< l_n
  double eta = 4.0;
  double size_threshold = 0.8;  ///< metres of extent (standard deviation along the longest axis):
                                ///< the middle of size's thresholds, which are a factor of 2 apart
  std::uint64_t seed = 1;
};

/// A kind of segments, which stands on one layer.
struct KindFacts {
  int layer = 1;
  std::size_t segments = 0;
  double extent = 0;  ///< metres, the median
};

struct Clustering {
  std::vector<int> layer;        ///< per given segment, 1..l_n − 1 (0 everywhere when l_n is 1)
  std::vector<KindFacts> kinds;  ///< largest first; empty: size decided, or the paper's rules did
  std::vector<double> eigenvalues;  ///< the smallest of L_norm, rising, at most 10
  std::vector<std::string> warnings;
};

/// `segments` are those beyond layer 0 of all buildings together. Fewer segments than clusters, or
/// none, is
/// defined: size decides. Deterministic; uses threads.
Clustering cluster_segments(const std::vector<Descriptor>& segments,
                            const ClusteringOptions& options = {});

/// The layer that a prior gives to segments beyond layer 0: a vote of the 5 most similar segments
/// beyond its layer 0, by similarity; ties go to the coarser layer. A prior that has none: size
/// decides. `options.layers` is that of the prior.
Clustering classify_segments(const std::vector<Descriptor>& segments, const Prior& prior,
                             const ClusteringOptions& options = {});

struct LayerPlanesOptions {
  RuleSet rules = RuleSet::none();  ///< Rule::kSmallPlanes: they wait for the finest layer
  int layers = 3;                   ///< l_n: the finest layer is l_n − 1
};

/// The planes of layer k of one building: those of segments on layers ≤ k, and planes of no segment
/// that touch one of those (outlines nearer than 0.3 m or twice the planes' distance). With
/// Rule::kSmallPlanes, and k not the finest: without the smallest planes of the segments on layer
/// 0, as many as have 3 % of those segments' area, and without planes of no segment that are no
/// larger than the largest of them. `layer_of_segment` per segment of the building. Rising plane
/// indices; those of k are among those of k + 1.
std::vector<int> layer_planes(const Planes& planes, const Segments& segments,
                              const std::vector<int>& layer_of_segment, int k,
                              const LayerPlanesOptions& options = {});

/// Larger planes that layer 0 lacks, as they could join it: those of each finer segment that is no
/// kind of its own (ElementKind::kPlain), then those that layer 0's own segments, or none, leave to
/// finer layers. Rising plane indices; planes under 0.5 % of all area and sets under 1 % stay out.
std::vector<std::vector<int>> spare_planes(const Planes& planes, const Segments& segments,
                                           const std::vector<int>& layer_of_segment,
                                           const std::vector<int>& layer0_planes);

}  // namespace colod
