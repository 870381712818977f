// Based on: LAS 1.4 R15, ASPRS; GeoTIFF 1.0 and 1.1, OGC 19-008r4; PROJ 9's reference systems.
#include "cloud_place.h"

#include <proj_experimental.h>  // proj_create_compound_crs

#include <filesystem>
#include <limits>

#include "core/error.h"
#include "geokeys.h"
#include "local.h"
#include "proj_objects.h"
#include "read/airborne.h"

namespace colod {
namespace {

// Numbers of GeoTIFF keys.
constexpr int kProjected = 3072, kProjection = 3075, kProjectedUnit = 3076, kUnitSize = 3077;
constexpr int kModel = 1024, kDegreesModel = 2, kGeographic = 2048;
constexpr int kVertical = 4096, kVerticalUnit = 4099;
constexpr int kFirstCode = 1024, kUserDefined = 32767;    // codes of EPSG lie between
constexpr int kEllipsoids = 5001, kLastEllipsoid = 5033;  // of GeoTIFF 1.0: no geoid
constexpr int kDatums = 5101, kLastDatum = 5199;  // of GeoTIFF 1.0: EPSG's systems are 600 beyond
constexpr int kSystemBeyondDatum = 600;
constexpr std::size_t kLongestWkt = 16384;  // of compound systems it has some 5,000

bool is_code(std::optional<int> key) { return key && *key >= kFirstCode && *key < kUserDefined; }

/// What a text or a code says of a reference system.
struct Understood {
  std::string crs;                ///< for place_on_earth; empty: nothing
  PjPtr flat, heights;            ///< parts; null: none
  std::vector<std::string> left;  ///< what of it is not understood
  bool is_wkt = false;
};

PjPtr system_of(PJ_CONTEXT* context, const std::string& text) {
  PjPtr crs(proj_create(context, text.c_str()));
  if (crs && !proj_is_crs(crs.get())) crs.reset();
  return crs;
}

Understood understand_wkt(PJ_CONTEXT* context, const std::string& wkt) {
  Understood out;
  out.is_wkt = true;
  const PjPtr crs = wkt.size() > kLongestWkt ? nullptr : system_of(context, wkt);
  if (!crs) {
    out.left.push_back("its WKT is no reference system that PROJ knows: " + shortened(wkt));
    return out;
  }
  out.crs = wkt;
  out.flat = horizontal_part(context, crs.get(), true);
  out.heights = vertical_part(context, crs.get());
  return out;
}

/// The code of a vertical system that keys name; none: ellipsoidal heights, or nothing is said.
std::optional<int> code_of_heights(const CloudSystem& system) {
  const std::optional<int> code = system.key(kVertical);
  if (!is_code(code) || (*code >= kEllipsoids && *code <= kLastEllipsoid)) return {};
  return *code >= kDatums && *code <= kLastDatum ? *code + kSystemBeyondDatum : *code;
}

/// The horizontal system that keys name by a number or define.
void understand_plan(PJ_CONTEXT* context, const CloudSystem& system, Understood& out) {
  const std::optional<int> code = system.key(kProjected), degrees = system.key(kGeographic);
  if (is_code(code))
    out.crs = "EPSG:" + std::to_string(*code);
  else if (code || system.key(kProjection))
    out.crs = wkt_of_keys(system);
  else if (system.key(kModel) == kDegreesModel && is_code(degrees))
    out.crs = "EPSG:" + std::to_string(*degrees);
  if (!out.crs.empty()) out.flat = system_of(context, out.crs);
  if (out.flat) return;
  out.left.push_back(out.crs.empty() ? "its GeoTIFF keys name no reference system"
                                     : "its GeoTIFF keys name " + shortened(out.crs) +
                                           ", which PROJ does not know");
  out.crs.clear();
}

/// Puts the heights of keys onto the plan's system.
void add_heights(PJ_CONTEXT* context, const CloudSystem& system, Understood& out) {
  const std::optional<int> code = code_of_heights(system);
  if (!code) return;
  const std::string name = "EPSG:" + std::to_string(*code);
  out.heights = system_of(context, name);
  if (!out.heights || proj_get_type(out.heights.get()) != PJ_TYPE_VERTICAL_CRS) {
    out.heights.reset();
    out.left.push_back("its GeoTIFF keys name " + name +
                       " for heights, which is no vertical system: they are taken as ellipsoidal");
    return;
  }
  if (out.crs.starts_with("EPSG:")) {
    out.crs += "+" + std::to_string(*code);
    return;
  }
  const PjPtr both(proj_create_compound_crs(context, "cloud", out.flat.get(), out.heights.get()));
  const char* text = both ? proj_as_wkt(context, both.get(), PJ_WKT2_2019, nullptr) : nullptr;
  if (text) out.crs = text;
}

Understood understand_keys(PJ_CONTEXT* context, const CloudSystem& system) {
  Understood out;
  try {
    understand_plan(context, system, out);
  } catch (const Error& error) {
    out.left.push_back("its " + std::string(error.what()));
  }
  if (out.flat) add_heights(context, system, out);
  return out;
}

bool is_in_degrees(PJ* flat) {
  const PJ_TYPE type = proj_get_type(flat);
  return type == PJ_TYPE_GEOGRAPHIC_2D_CRS || type == PJ_TYPE_GEOGRAPHIC_3D_CRS;
}

/// The one of both kinds of records that can be used; the one that the header prefers first.
Understood understand(PJ_CONTEXT* context, const CloudSystem& system) {
  Understood out;
  out.left = system.problems;
  const bool is_wkt_first = system.prefers_wkt || system.keys.empty();
  for (const bool is_wkt : {is_wkt_first, !is_wkt_first}) {
    if (is_wkt ? system.wkt.empty() : system.keys.empty()) continue;
    Understood one =
        is_wkt ? understand_wkt(context, system.wkt) : understand_keys(context, system);
    one.left.insert(one.left.begin(), out.left.begin(), out.left.end());
    if (one.flat) return one;
    out.left = std::move(one.left);
  }
  return out;
}

/// A unit that GeoTIFF's keys name; false: none.
bool unit_of_key(PJ_CONTEXT* context, std::optional<int> key, std::optional<double> size,
                 double& metres, std::string& name) {
  if (key == kUserDefined && size && *size > 0) {
    metres = *size;
    name = std::to_string(*size) + " m";
    return true;
  }
  if (!is_code(key)) return false;
  const char *text = nullptr, *category = nullptr;
  double factor = 0;
  const std::string code = std::to_string(*key);
  if (!proj_uom_get_info_from_database(context, "EPSG", code.c_str(), &text, &factor, &category) ||
      std::string(category) != "linear" || !(factor > 0))
    return false;
  metres = factor;
  name = text;
  return true;
}

std::string joined_lines(const std::vector<std::string>& lines) {
  std::string all;
  for (const std::string& line : lines) all += (all.empty() ? "" : "; ") + line;
  return all;
}

/// Of one file; none: it says nothing. Throws for what names no place.
std::optional<Georeference> georeference_of_file(const std::string& path, Vec3& middle) {
  const CloudSystem system = read_cloud_system(path);
  if (system.is_empty() && system.problems.empty()) return {};
  const ContextPtr context = make_context();
  const Understood found = understand(context.get(), system);
  const std::string left = joined_lines(found.left);
  if (!found.flat) throw Error(Stage::kInput, path, left);
  if (is_in_degrees(found.flat.get()))
    throw Error(Stage::kInput, path,
                "its own reference system, " + std::string(proj_get_name(found.flat.get())) +
                    ", is in degrees: a place is told by one in metres or feet");
  if (proj_get_type(found.flat.get()) != PJ_TYPE_PROJECTED_CRS)
    throw Error(Stage::kInput, path,
                "its own reference system, " + std::string(proj_get_name(found.flat.get())) +
                    ", is no projected one");
  middle = system.middle.cwiseProduct(units_of_cloud(system).metres);
  Georeference out{found.crs, Vec3::Zero(), path, {}};
  if (!left.empty()) out.warnings.push_back(path + ": " + left);
  return out;
}

}  // namespace

CloudUnits units_of_cloud(const CloudSystem& system) {
  CloudUnits out;
  if (system.is_empty()) return out;
  const ContextPtr context = make_context();
  const Understood found = understand(context.get(), system);
  if (found.flat && is_in_degrees(found.flat.get())) return out;
  double plan = 1, height = 1;
  std::string plan_name, height_name;
  const CloudSystem keys = found.is_wkt ? CloudSystem() : system;
  const bool is_keyed =
      unit_of_key(context.get(), keys.key(kProjectedUnit), keys.number(kUnitSize), plan, plan_name);
  if (!is_keyed && found.flat) plan = axis_unit(context.get(), found.flat.get(), 0, &plan_name);
  bool is_said = unit_of_key(context.get(), keys.key(kVerticalUnit), {}, height, height_name);
  if (!is_said && found.heights) {
    height = axis_unit(context.get(), found.heights.get(), 0, &height_name);
    is_said = true;
  } else if (!is_said && found.flat) {
    height = axis_unit(context.get(), found.flat.get(), 2, &height_name);
    is_said = !height_name.empty();
  }
  if (!is_said) height = plan, height_name = plan_name;
  out.metres = {plan, plan, height};
  if (plan == 1 && height == 1) return out;
  out.text = plan_name == height_name ? plan_name : plan_name + ", heights in " + height_name;
  if (!is_said) out.doubt = "of heights it says nothing: they are taken to be in the same unit";
  return out;
}

double metres_apart(const Georeference& a, const Georeference& b, const Vec3& at) {
  try {
    return (place_on_earth(a, at).to_ecef(at) - place_on_earth(b, at).to_ecef(at)).norm();
  } catch (const Error&) {
    return std::numeric_limits<double>::infinity();
  }
}

std::optional<Georeference> georeference_of_cloud(const std::string& input) {
  std::error_code error;
  const std::vector<std::string> files = std::filesystem::is_directory(input, error)
                                             ? clouds_alone_in(input)
                                         : is_las(input) ? std::vector{input}
                                                         : std::vector<std::string>();
  std::optional<Georeference> found;
  for (const std::string& file : files) {
    Vec3 middle = Vec3::Zero();
    std::optional<Georeference> one = georeference_of_file(file, middle);
    if (!one) continue;
    if (!found)
      found = std::move(one);
    else if (found->crs != one->crs && metres_apart(*found, *one, middle) > kSamePlace)
      throw Error(Stage::kInput, file,
                  "says of itself that it lies elsewhere on Earth than " + found->source);
  }
  return found;
}

}  // namespace colod
