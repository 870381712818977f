// Based on: PROJ 9's CRS to CRS operations; pugixml; ContextCapture's metadata.xml, OpenDroneMap's
// odm_georeferencing_model_geo.txt, Pix4D's offset and prj files.
// Differs: never an invented place, and no ballpark operation without a warning.
// Notation: phi, lambda latitude and longitude in radians; e2 the ellipsoid's eccentricity squared.
#include "place.h"

#include <proj_experimental.h>  // proj_crs_promote_to_3D

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <mutex>
#include <pugixml.hpp>
#include <regex>
#include <sstream>

#include "cloud_place.h"
#include "core/error.h"
#include "local.h"
#include "proj_objects.h"

namespace colod {

namespace fs = std::filesystem;

namespace {

constexpr const char* kGeocentric = "EPSG:4978";
constexpr std::uintmax_t kLargestSidecar = 1 << 20;  // bytes
constexpr std::size_t kLongestCrs = 16384;           // WKT of compound systems has some 5,000
constexpr std::size_t kLongestQuote = 80;

}  // namespace

std::string shortened(const std::string& text) {
  return text.size() <= kLongestQuote ? text : text.substr(0, kLongestQuote) + "…";
}

std::optional<std::vector<double>> numbers(const std::string& text) {
  std::vector<double> out;
  std::string part;
  for (std::istringstream in(text); std::getline(in, part, ',');) {
    std::size_t used = 0;
    try {
      out.push_back(std::stod(part, &used));
    } catch (const std::exception&) {
      return {};
    }
    if (part.find_first_not_of(" \t\r\n", used) != part.npos || !std::isfinite(out.back()))
      return {};
  }
  if (out.size() < 2 || out.size() > 3) return {};
  return out;
}

namespace {

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == text.npos) return "";
  return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

[[noreturn]] void refuse(const fs::path& path, const std::string& cause) {
  throw Error(Stage::kInput, path.string(), cause);
}

/// False also for links that lead to themselves.
bool is_there(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

/// Files beside the input are small; anything else under their names is refused unread.
std::string slurp(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) refuse(path, "is no regular file");
  const std::uintmax_t size = fs::file_size(path, error);
  if (error || size > kLargestSidecar) refuse(path, "is larger than a mebibyte");
  std::ifstream in(path, std::ios::binary);
  if (!in) refuse(path, "cannot be opened");
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A system's name or definition; a longer one is none.
const std::string& checked_crs(const fs::path& path, const std::string& crs) {
  if (crs.size() > kLongestCrs)
    refuse(path, "a reference system of " + std::to_string(crs.size()) + " characters");
  return crs;
}

std::optional<Georeference> from_metadata_xml(const fs::path& path) {
  const std::string text = slurp(path);
  pugi::xml_document xml;
  if (const pugi::xml_parse_result result = xml.load_buffer(text.data(), text.size()); !result)
    refuse(path, "is no XML: " + std::string(result.description()) + " at byte " +
                     std::to_string(result.offset));
  const auto element = [&xml](std::string_view name) {
    const pugi::xml_node found = xml.find_node([&](pugi::xml_node n) { return n.name() == name; });
    return trimmed(found.child_value());
  };
  const std::string srs = element("SRS"), at = element("SRSOrigin");
  if (srs.empty() || srs.starts_with("LOCAL")) return {};  // another program's, or no place
  Georeference out{checked_crs(path, srs), Vec3::Zero(), path.string()};
  if (at.empty()) return out;
  const auto values = numbers(at);
  if (!values || values->size() != 3)
    refuse(path, "SRSOrigin is not three numbers: " + shortened(at));
  out.offset = {(*values)[0], (*values)[1], (*values)[2]};
  return out;
}

/// "WGS84 UTM 32N", then easting and northing.
Georeference from_odm(const fs::path& path) {
  std::istringstream in(slurp(path));
  std::string line;
  std::getline(in, line);
  line = trimmed(line).substr(0, kLongestQuote);  // the expression below recurses on its length
  static const std::regex utm("WGS84 UTM (\\d{1,2})([NS])");
  std::smatch match;
  if (!std::regex_match(line, match, utm)) refuse(path, "not 'WGS84 UTM <zone>N|S': " + line);
  const int zone = std::stoi(match[1]);
  Vec3 offset = Vec3::Zero();
  if (zone < 1 || zone > 60 || !(in >> offset.x() >> offset.y()))
    refuse(path, "zone or offset cannot be read");
  const int code = (match[2] == "N" ? 32600 : 32700) + zone;
  return {"EPSG:" + std::to_string(code), offset, path.string()};
}

/// x, y and z of what was taken off, and the CRS as WKT in the file of the same name.
std::optional<Georeference> from_pix4d(const fs::path& path) {
  std::string stem = path.filename().string();
  stem.resize(stem.size() - std::string("_offset.xyz").size());
  for (const char* ending : {"_wkt.prj", ".prj"}) {
    const fs::path prj = path.parent_path() / (stem + ending);
    if (!is_there(prj)) continue;
    std::istringstream in(slurp(path));
    Vec3 offset;
    if (!(in >> offset.x() >> offset.y() >> offset.z())) refuse(path, "not three numbers");
    return Georeference{checked_crs(prj, trimmed(slurp(prj))), offset, path.string()};
  }
  return {};
}

/// The input's folder and, from tiles of a ContextCapture set, those above.
std::vector<fs::path> folders_of(const fs::path& input) {
  std::error_code error;
  fs::path folder = fs::absolute(input, error).lexically_normal();
  if (!fs::is_directory(folder, error) || folder.filename().empty()) folder = folder.parent_path();
  std::vector<fs::path> out = {folder};
  for (int up = 0; up < 3; ++up) {
    const std::string name = folder.filename().string();
    if (name != "Data" && !name.starts_with("Tile_")) break;
    folder = folder.parent_path();
    out.push_back(folder);
  }
  return out;
}

/// Axes east, north and up at a place.
EarthMap local_at(const Georeference& g) {
  EarthMap map;
  map.name = g.crs;
  map.to_ecef = [place = local_place(g), offset = g.offset](const Vec3& world) -> Vec3 {
    return place.centre + place.axes * (world + offset);
  };
  return map;
}

/// One operation with the context it lives in; used by one thread at a time.
struct Operation {
  ContextPtr context;  // outlives the operation
  PjPtr pj;
};

/// What transforms coordinates of a CRS; without the heights' reference when `is_flat`.
class Transformer {
 public:
  Transformer(const Georeference& g, bool is_flat) : georeference_(g), is_flat_(is_flat) {
    Operation first = make();
    if (first.pj) free_.push_back(std::move(first));
  }

  bool is_ready() const { return !free_.empty(); }
  bool is_compound() const { return is_compound_; }
  const std::string& name() const { return name_; }

  /// Infinite where there is no result.
  Vec3 to_ecef(const Vec3& world) {
    Operation operation;
    {
      const std::lock_guard lock(mutex_);
      if (!free_.empty()) operation = std::move(free_.back()), free_.pop_back();
    }
    if (!operation.pj) operation = make();
    const Vec3 p = (world + georeference_.offset).cwiseQuotient(unit_);
    const PJ_COORD out =
        proj_trans(operation.pj.get(), PJ_FWD, proj_coord(p.x(), p.y(), p.z(), HUGE_VAL));
    const Vec3 result(out.xyz.x, out.xyz.y, out.xyz.z);
    const std::lock_guard lock(mutex_);
    free_.push_back(std::move(operation));
    return result;
  }

 private:
  Operation make() {
    Operation out{make_context(), nullptr};
    PJ_CONTEXT* context = out.context.get();
    PjPtr crs(proj_create(context, georeference_.crs.c_str()));
    if (!crs || !proj_is_crs(crs.get()))
      throw Error(Stage::kUsage, georeference_.source,
                  "unknown coordinate reference system: " + shortened(georeference_.crs));
    const PjPtr flat = horizontal_part(context, crs.get(), false);
    const PjPtr own = horizontal_part(context, crs.get(), true);
    if (!own || proj_get_type(own.get()) != PJ_TYPE_PROJECTED_CRS)
      throw Error(Stage::kUsage, georeference_.source,
                  shortened(georeference_.crs) +
                      " is not a projected system in metres; for a place in degrees use --origin "
                      "latitude,longitude,height");
    name_ = proj_get_name(crs.get());
    is_compound_ = proj_get_type(crs.get()) == PJ_TYPE_COMPOUND_CRS;
    const double horizontal = axis_unit(context, own.get(), 0);
    double vertical = axis_unit(context, own.get(), 2);
    if (is_compound_ && !is_flat_) {
      const PjPtr heights = vertical_part(context, crs.get());
      if (heights) vertical = axis_unit(context, heights.get(), 0);
    } else {
      crs.reset(proj_crs_promote_to_3D(context, nullptr, flat.get()));
      if (!crs) crs.reset(proj_clone(context, flat.get()));
    }
    unit_ = {horizontal, horizontal, vertical};
    const PjPtr geocentric(proj_create(context, kGeocentric));
    const char* const exact[] = {"ALLOW_BALLPARK=NO", nullptr};
    const PjPtr raw(proj_create_crs_to_crs_from_pj(context, crs.get(), geocentric.get(), nullptr,
                                                   is_flat_ ? nullptr : exact));
    if (raw) out.pj.reset(proj_normalize_for_visualization(context, raw.get()));
    return out;
  }

  const Georeference georeference_;
  const bool is_flat_;
  bool is_compound_ = false;
  std::string name_;
  Vec3 unit_ = Vec3::Ones();  // metres
  std::mutex mutex_;
  std::vector<Operation> free_;
};

}  // namespace

std::optional<Georeference> georeference_from_options(const std::string& crs,
                                                      const std::string& origin) {
  const auto place = numbers(origin);
  if (!origin.empty() && !place)
    throw Error(Stage::kUsage, "--origin", "must be two or three numbers with commas: " + origin);
  for (const double value : place.value_or(std::vector<double>()))
    if (std::abs(value) > kFarthest)
      throw Error(Stage::kUsage, "--origin", "lies beyond any place on Earth: " + origin);
  if (crs.empty() || crs == "local") {
    if (!place) return {};
    if (crs == "local") throw Error(Stage::kUsage, "--origin", "--crs local has no origin");
    if (std::abs((*place)[0]) > 90 || std::abs((*place)[1]) > 180)
      throw Error(Stage::kUsage, "--origin",
                  "without --crs it is latitude,longitude[,height] in degrees: " + origin);
    return Georeference{"ENU:" + origin, Vec3::Zero(), "--origin"};
  }
  Georeference out{crs, Vec3::Zero(), "--crs"};
  if (place) out.offset = {(*place)[0], (*place)[1], place->size() > 2 ? (*place)[2] : 0.0};
  return out;
}

namespace {

/// By files that lie beside the input.
std::optional<Georeference> from_sidecars(const std::string& input) {
  const std::vector<fs::path> folders = folders_of(input);
  for (const fs::path& folder : folders)
    if (is_there(folder / "metadata.xml"))
      if (auto found = from_metadata_xml(folder / "metadata.xml")) return found;
  const fs::path& folder = folders.front();
  const bool is_odm = folder.filename().string().starts_with("odm_");
  for (const fs::path& place : {folder, folder.parent_path() / "odm_georeferencing"})
    if ((place == folder || is_odm) && is_there(place / "odm_georeferencing_model_geo.txt"))
      return from_odm(place / "odm_georeferencing_model_geo.txt");
  std::vector<fs::path> offsets;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (entry.path().filename().string().ends_with("_offset.xyz")) offsets.push_back(entry.path());
  std::sort(offsets.begin(), offsets.end());
  for (const fs::path& path : offsets)
    if (auto found = from_pix4d(path)) return found;
  return {};
}

/// A cloud's own word, unless it is of no use and a file beside it knows better.
std::optional<Georeference> own_or_beside(const std::string& input) {
  std::optional<Georeference> own, beside;
  std::optional<Error> no_use;
  try {
    own = georeference_of_cloud(input);
  } catch (const Error& error) {
    no_use = error;
  }
  if (!own && !no_use) return from_sidecars(input);
  try {
    beside = from_sidecars(input);
  } catch (const Error& error) {
    if (own) own->warnings.push_back(error.what());
  }
  if (no_use && !beside) throw *no_use;
  if (no_use) beside->warnings.push_back(no_use->what());
  if (own && beside && own->crs != beside->crs)
    own->warnings.push_back(own->source + " says itself where it is, which is taken; " +
                            beside->source + " says " + shortened(beside->crs));
  return own ? own : beside;
}

}  // namespace

std::optional<Georeference> georeference_beside(const std::string& input) {
  if (auto own = georeference_of_tileset(input)) return own;
  return own_or_beside(input);
}

EarthMap place_on_earth(const Georeference& g, const Vec3& probe) {
  if (g.crs.starts_with("ENU:")) return local_at(g);
  EarthMap map;
  auto transformer = std::make_shared<Transformer>(g, false);
  const bool works = transformer->is_ready() && transformer->to_ecef(probe).allFinite();
  if (!works && (transformer->is_compound() || !transformer->is_ready())) {
    map.warnings.push_back(
        transformer->is_compound()
            ? transformer->name() +
                  ": the grid for its heights is not installed; heights are taken "
                  "as ellipsoidal"
            : transformer->name() + ": only a rough operation to WGS 84 is known");
    transformer = std::make_shared<Transformer>(g, true);
  }
  if (!transformer->is_ready())
    throw Error(Stage::kUsage, g.source,
                "no operation from " + shortened(g.crs) + " to WGS 84 is known");
  map.name = transformer->name();
  map.to_ecef = [transformer, crs = g.crs](const Vec3& world) {
    const Vec3 p = transformer->to_ecef(world);
    if (!p.allFinite())
      throw Error(Stage::kInput, shortened(crs),
                  "coordinates outside the system's domain: is --origin missing or wrong?");
    return p;
  };
  return map;
}

}  // namespace colod
