// Inside room `extraction`: which cells are inside.
#pragma once

#include <string>
#include <vector>

#include "core/rays.h"
#include "elements/elements.h"
#include "extraction.h"
#include "partition/partition.h"

namespace colod {

/// What speaks for and against each cell.
struct Evidence {
  std::vector<Vote> cells;
  std::vector<double> weight;  ///< per cell, m²: its surface, less for thin cells
  std::vector<double> area;    ///< per piece, m²
  std::vector<double>
      coverage;  ///< per piece, 0..1: share under outlines that look along its plane
  std::vector<double> reversed;  ///< per piece, 0..1: under outlines that look against it
  std::vector<char> is_told;     ///< per cell: it lies in a element, and has to stay what it is
};

struct VoteOptions {
  bool is_paper = false;
  int nr = 100;
};

/// Rays from the cells' centroids (and further points of large cells). Parallel over cells.
Evidence gather_evidence(const Partition& partition, Sight& sight, const VoteOptions& options);

/// Per piece the share that the outlines of `planes` cover; `input[i]` is the plane of
/// partition.cuts[i], −1 none.
void measure_coverage(const Partition& partition, const Planes& planes,
                      const std::vector<int>& input, Evidence& evidence);

/// What rays cannot say: air in balconies and loggias is outside, a chimney is solid, thin walls
/// are left to their outlines.
void ask_elements(const Partition& partition, const std::vector<Element>& elements,
                  Evidence& evidence);

/// More than half of the rays; no smoothing.
std::vector<char> threshold_cells(const Evidence& evidence, const std::vector<char>& is_forced_out);

struct CutOptions {
  double smoothness = 0.4;  ///< weight of facet area
  double escape = 1.0;      ///< what an exposed ray counts against the inside
};

/// The labelling of least cost: votes against weight, and smoothness × facet area, less where an
/// outline covers the facet. Of several minima the smallest inside.
std::vector<char> cut_cells(const Partition& partition, const Evidence& evidence,
                            const std::vector<char>& is_forced_out, const CutOptions& options = {});

/// What speaks for the inside, less what speaks against it; an exposed ray counts `escape`.
double inside_vote(const Vote& vote, double escape = 1);

struct SimplifyOptions {
  double facet_volume = 0;          ///< m³ that may change sides for each facet that this saves
  double depth = 0;                 ///< metres that the surface may move
  std::vector<char> is_fixed = {};  ///< per plane of the partition: its facets stay; empty: of none
};

/// Turns the cells under or over a facet round where that leaves fewer facets; never the forced
/// ones. Ends after a few rounds over all facets. Returns how many facets went, components and
/// pinches aside.
int simplify_cells(const Partition& partition, const Evidence& evidence,
                   const std::vector<char>& is_forced_out, const SimplifyOptions& options,
                   std::vector<char>& is_inside);

/// Share of the outlines' area that lies on the surface of the inside, looking outward.
double explained_share(const Partition& partition, const Evidence& evidence,
                       const std::vector<char>& is_inside);

/// Keeps the largest face-connected set of inside cells by volume, and besides those of at least
/// `least_share` of its volume that stand in the lower third of its height (> 1: no others); false:
/// there is none.
bool keep_largest_components(const Partition& partition, std::vector<char>& is_inside,
                             double least_share);
/// Turns outside cells that no path of outside cells joins with the space beyond the box.
void fill_cavities(const Partition& partition, std::vector<char>& is_inside);

/// Turns cells round until the boundary is a closed 2-manifold, smallest first, each at most once,
/// then only by adding cells, which always ends. Returns the volume turned, m³.
double mend_pinches(const Partition& partition, std::vector<char>& is_inside);

}  // namespace colod
