// Every option of the pipeline, once: default, unit, range. The command line, the config file, the
// report and docs/options.md are made from this table (options.cpp), so that none of them can
// disagree.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "rules.h"

namespace colod {

/// What finds the first plane along each ray (docs/performance.md): Embree in packets of rays, one
/// ray at a time (to measure against), or the sweep over the slices' outlines, which asks Embree
/// where rounding leaves a doubt.
enum class Visibility { kEmbree, kEmbreeSingle, kSweep };

/// As on the command line: "embree", "sweep"; "embree-single" is for measuring only.
const char* name_of(Visibility visibility);
/// Anything but "sweep": Embree.
Visibility visibility_of(const std::string& name);

struct Options {
  RuleSet rules = RuleSet::all();              ///< docs/rules.md says what each changes
  Visibility visibility = Visibility::kSweep;  ///< the hits are the same
  int layers = 3;                              ///< l_n, 1..8
  int ns = 100;             ///< n_s: voxels along each side of the box, 8..1000; the paper has 150
  int nr = 100;             ///< n_r: rays a voxel, 4..1000
  double alcove_area = 80;  ///< A_eps, m²: planes below it may form alcoves
  double beta = 0.3;        ///< weight of simplicity f_s
  double lambda = 0.4;      ///< weight of consistency f_co
  double eta = 4.0;         ///< weight of shape against scale
  double gap = 0.001;       ///< of layer 0's program: good enough
  bool is_size_layering = false;  ///< layers beyond 0 by thresholds on size, not by the spectrum
  double distance =
      0.2;  ///< region growing: metres from the plane. Robust: an upper bound (planes/planes.h)
  double angle_deg = 30;  ///< region growing: normals' deviation
  int min_points =
      20;  ///< region growing: least items of a region. Robust: by area as well (planes/planes.h)
  std::uint64_t seed = 1;  ///< of everything drawn at random
};

/// One row of the table.
struct OptionInfo {
  std::string name;  ///< as on the command line, without dashes
  std::string unit;  ///< "", "m", "m2", "deg"
  double min, max;   ///< allowed range, both ends included
  std::string help;
  double (*get)(const Options&);
  void (*set)(Options&, double);
  bool is_integer;
};

/// The numeric options, in the order in which they are documented.
const std::vector<OptionInfo>& option_table();

/// What holds when only the rules are chosen: without any, the paper's n_s of 150 and its rays;
/// with them the same objects are found with 100 in a third of the time
/// (docs/log/rules-measured.md).
Options default_options(const RuleSet& rules);

/// Throws Error{kUsage} naming the option when a value is NaN or out of its range.
void validate(const Options& options);

}  // namespace colod
