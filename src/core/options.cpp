#include "options.h"

#include <cmath>
#include <iomanip>
#include <sstream>

#include "error.h"

namespace colod {
namespace {

template <auto Member>
OptionInfo row(std::string name, std::string unit, double min, double max, std::string help) {
  using Value = std::decay_t<decltype(std::declval<Options>().*Member)>;
  return {std::move(name),
          std::move(unit),
          min,
          max,
          std::move(help),
          [](const Options& o) { return static_cast<double>(o.*Member); },
          [](Options& o, double value) { o.*Member = static_cast<Value>(value); },
          std::is_integral_v<Value>};
}

}  // namespace

const std::vector<OptionInfo>& option_table() {
  static const std::vector<OptionInfo> table = {
      row<&Options::layers>("layers", "", 1, 8,
                            "layers a building gets (l_n); layer 0 is the coarsest"),
      row<&Options::ns>("ns", "", 8, 1000,
                        "voxels along each side of a building's box (n_s); 150 with --rules paper; "
                        "memory grows with its cube: 16 MB a building with 100, 16 GB with 1000"),
      row<&Options::nr>("nr", "", 4, 1000, "rays a voxel (n_r)"),
      row<&Options::alcove_area>("alcove-area", "m2", 0, 1e9,
                                 "planes smaller than this may form alcoves (A_eps)"),
      row<&Options::beta>("beta", "", 0, 1e6, "weight of simplicity in layer 0 (beta)"),
      row<&Options::lambda>("lambda", "", 0, 1e6,
                            "weight of consistency between buildings in layer 0 (lambda)"),
      row<&Options::eta>("eta", "", 0, 1e6,
                         "weight of shape against scale in the similarity (eta)"),
      row<&Options::gap>("gap", "", 0, 1,
                         "layer 0 is good enough when proven to be this near to the best, as a "
                         "share of it"),
      row<&Options::distance>("distance", "m", 1e-4, 1e3,
                              "how far a region's points may lie from its plane"),
      row<&Options::angle_deg>("angle", "deg", 0.1, 89, "how far a region's normals may deviate"),
      row<&Options::min_points>("min-points", "", 1, 1e9, "least points or faces of a region"),
      row<&Options::seed>("seed", "", 0, 9007199254740992.0, "seed of everything drawn at random"),
  };
  return table;
}

const char* name_of(Visibility visibility) {
  if (visibility == Visibility::kSweep) return "sweep";
  return visibility == Visibility::kEmbree ? "embree" : "embree-single";
}

Visibility visibility_of(const std::string& name) {
  return name == "sweep" ? Visibility::kSweep : Visibility::kEmbree;
}

Options default_options(const RuleSet& rules) {
  Options options;
  options.rules = rules;
  if (rules.is_none()) options.ns = 150, options.visibility = Visibility::kEmbree;
  return options;
}

void validate(const Options& options) {
  for (const OptionInfo& info : option_table()) {
    const double value = info.get(options);
    if (value >= info.min && value <= info.max) continue;  // NaN is neither
    std::ostringstream range;
    range << std::setprecision(16) << info.min << " and " << info.max << ", not " << value;
    throw Error(Stage::kUsage, "--" + info.name, "must lie between " + range.str());
  }
}

}  // namespace colod
