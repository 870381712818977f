// When a coarser layer may stand for the finest one: one quantity, the ground sample distance (GSD)
// g_k in metres per pixel. Layer k may be shown where one pixel covers at least g_k. All switch
// metadata follow from it: geometricError = target_sse · g_k, screen coverage D / (g_k · H), switch
// distance g_k · H / (2 tan(fovy / 2)).
#pragma once

#include <vector>

#include "core/geometry.h"

namespace colod {

/// What a viewer sees of a layer against the finest one where a pixel covers `gsd` metres.
struct VisibleStep {
  double gsd = 0;     ///< metres per pixel
  double pixels = 0;  ///< PictureDifference::pixels(), in all but a tenth of the views
};

/// Steps by rising gsd. Empty: the layer is the finest one's like.
using VisibleProfile = std::vector<VisibleStep>;

/// What one layer of one building brings to the decision.
struct LayerSight {
  bool is_like_finer = false;  ///< no farther than a centimetre from the next finer layer, which is
                               ///< what files round to: nothing to switch
  double deviation = 0;        ///< metres: two-sided Hausdorff distance to the finest layer, never
                               ///< less than the next finer one's; 0: the finest
  VisibleProfile profile;
};

/// Draws every layer against the last one and measures deviations. `layers`: coarsest first, the
/// finest last, in one frame with z up; none empty. Pictures are orthographic, flat shaded and
/// antialiased, from 18 directions at eye height (8°), 30° and 60° above; a sample is 2 cm or a
/// 768th of the building's diagonal, whichever is more. Deterministic, runs in parallel.
std::vector<LayerSight> measure_sights(const std::vector<Mesh>& layers);

/// One mesh against another in the same way, with samples of this size in metres.
VisibleProfile measure_profile(const Mesh& mesh, const Mesh& finest, double sample);

/// The smallest gsd from which on the profile stays within `pixels`: between steps by
/// interpolation, never below the first step; beyond the last as the difference falls with the gsd.
/// 0: empty.
double visible_gsd(const VisibleProfile& profile, double pixels);

enum class SwitchMeasure {
  kVisual,    ///< by pictures: the difference stays within `visual_error` pixels
  kDeviation  ///< strict: the deviation is at most `pixel_error` pixels
};
enum class SwitchScope {
  kScene,    ///< one g_k a layer for all buildings, so that all stand on one layer at any distance
  kBuilding  ///< each building its own
};

/// As on the command line.
const char* to_string(SwitchMeasure measure);
const char* to_string(SwitchScope scope);

struct SwitchOptions {
  SwitchMeasure measure = SwitchMeasure::kVisual;
  SwitchScope scope = SwitchScope::kScene;
  double visual_error = 14;  ///< pixels: N of PictureDifference
  double pixel_error = 2;    ///< pixels
  double share = 0.9;        ///< of the buildings whose own bound the scene's g_k keeps
  double rounding = 0;       ///< metres that vertices are moved by; no g is below its share
};

/// The smallest value that at least this share of the values do not exceed. \pre not empty
double value_at_share(std::vector<double> values, double share);

/// The scene's g of one layer and what it means for its buildings.
struct SceneSwitch {
  double gsd = 0;
  int buildings = 0;         ///< that have something to switch here
  double too_coarse = 0;     ///< share of them whose own g is larger …
  double coarse_factor = 1;  ///< … by up to this factor
  double too_fine = 0;       ///< share of them whose own g is smaller …
  double fine_factor = 1;    ///< … by up to this factor
};

/// Per building: its layers' sights, coarsest first; layers that failed have none.
struct BuildingSights {
  std::vector<int> layers;  ///< 0 = coarsest, rising; the last is the finest that there is
  std::vector<LayerSight> sights;
};

/// g of each of the building's layers by itself, strictly falling where layers differ (visual: by a
/// factor of 1.5 at least, so that no level is worth less than that in distance), the finest's 0.
std::vector<double> own_gsds(const BuildingSights& building, const SwitchOptions& options);

/// Per layer 0 … layers − 1 the smallest g that keeps the own g of `options.share` of the buildings
/// that count, the finest's 0. Where none of them counts those of `others` do; where none of these
/// does either, nobody switches, and g is the next finer layer's. \pre layers lie below `layers`.
std::vector<SceneSwitch> plan_scene_switches(const std::vector<BuildingSights>& buildings,
                                             int layers, const SwitchOptions& options,
                                             const std::vector<BuildingSights>& others = {});

}  // namespace colod
