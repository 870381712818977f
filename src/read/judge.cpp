// Based on: own work: how large buildings are, and that hardly any face of one slopes downward.
// Differs: --rules does not matter here.
// Notation: S+ and S− = area of the faces that slope up and down along an axis, that is whose
// normal's component along it lies between kSteep and kFlat, or between −kFlat and −kSteep.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "files.h"
#include "formats.h"

namespace colod::mesh_io {

namespace {

constexpr double kSteep = 0.2, kFlat = 0.98;  // 12 degrees: above noise, below low roofs
constexpr double kLeastOverhang = 0.04;       // of the surface, read z up, before y is thought of
constexpr double kBalance = 0.35;        // of what slopes; 0.5 on a side, 0.2 on airborne roofs
constexpr double kOverhangRatio = 0.25;  // what may slope downward read y up, of that
constexpr double kOneSided = 0.6;        // of the area, as one vector: no house faces one way …
constexpr double kAlongAxis = 0.94;      // … along an axis, to 20 degrees
constexpr double kDegreeExtent = 1;      // no scene is larger in degrees
constexpr double kNeedle = 200;          // height over width: no mast has more; at 0,0 …
constexpr double kSureNeedle = 1000;     // … even more is asked for
constexpr double kLargestSystem = 1;     // MiB
constexpr double kSmallest = 0.5, kTallest = 600;     // metres
constexpr double kLowHouse = 2.5, kHighHouse = 60;    // metres: what a unit is proposed for
constexpr double kBroad = 100, kTall = 120;           // both at once is suspicious …
constexpr double kLikeHouse = 0.4, kLikeTower = 1.2;  // … at a house's height over width

/// What there is in a file, in its own axes, strays apart.
struct Facts {
  Box box;
  double area = 0;
  Vec3 up = Vec3::Zero(), down = Vec3::Zero();  // S+ and S− along each axis
  Vec3 facing = Vec3::Zero();                   // normals times areas

  void add(const Vec3& normal, double weight) {
    area += weight;
    facing += weight * normal;
    for (int k = 0; k < 3; ++k) {
      const double steepness = std::abs(normal[k]);
      if (steepness > kSteep && steepness < kFlat) (normal[k] > 0 ? up : down)[k] += weight;
    }
  }
  /// Share of the surface that hangs over if the axis is up, or down: whatever the winding.
  double overhang(int axis) const { return area > 0 ? std::min(up[axis], down[axis]) / area : 0; }
};

std::vector<Face> fans(const RawFile& raw) {
  std::vector<Face> faces;
  for (int f = 0; f < raw.face_count(); ++f) {
    const int begin = raw.face_begin[f], end = raw.face_end(f);
    const bool is_good = std::all_of(raw.corners.begin() + begin, raw.corners.begin() + end,
                                     [&](int v) { return is_usable(raw.points[v]); });
    for (int c = begin + 1; is_good && c + 1 < end; ++c)
      faces.push_back({raw.corners[begin], raw.corners[c], raw.corners[c + 1]});
  }
  return faces;
}

Facts gather(const RawFile& raw) {
  const std::vector<Face> faces = fans(raw);
  const std::vector<char> is_stray = find_strays(raw.points, faces);
  const auto is_kept = [&](int v) {
    return is_usable(raw.points[v]) && (is_stray.empty() || !is_stray[v]);
  };
  Facts facts;
  for (const Face& f : faces) {
    if (!is_kept(f[0]) || !is_kept(f[1]) || !is_kept(f[2])) continue;
    for (const int v : f) facts.box.extend(raw.points[v]);
    const Vec3& a = raw.points[f[0]];
    const Vec3 cross = (raw.points[f[1]] - a).cross(raw.points[f[2]] - a);
    if (const double length = cross.norm(); length > 0) facts.add(cross / length, 0.5 * length);
  }
  for (std::size_t i = 0; i < raw.points.size() && faces.empty(); ++i) {
    if (!is_kept(static_cast<int>(i))) continue;
    facts.box.extend(raw.points[i]);
    if (raw.normals.size() == raw.points.size() && !raw.has_doubtful_normals)
      facts.add(raw.normals[i].normalized(), 1);
  }
  return facts;
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  if (std::abs(value) >= 1000 && std::abs(value) < 1e9)
    std::snprintf(text, sizeof text, "%.0f", value);
  return text;
}

std::string size_text(const Vec3& size) {
  return number(size.x()) + " x " + number(size.y()) + " x " + number(size.z());
}

/// A program that writes OBJ y up unless told otherwise, by the comments at the head of a file. The
/// same programs write PLY and STL z up.
std::string y_up_writer(const std::string& path, const RawFile& raw) {
  const std::string remarks = lower(raw.remarks);
  if (lower(std::filesystem::path(path).extension().string()) != ".obj") return "";
  if (remarks.find("blender") != remarks.npos) return "Blender";
  if (remarks.find("sketchup") != remarks.npos) return "SketchUp";
  return "";
}

/// Does much hang over if `up` is up, about as much as slopes upward, and next to nothing if
/// `other` is?
bool is_contradicted(const Facts& facts, int up, int other) {
  const double over = facts.overhang(up), sloped = (facts.up[up] + facts.down[up]) / facts.area;
  return over > kLeastOverhang && over > kBalance * sloped &&
         facts.overhang(other) < kOverhangRatio * over;
}

/// A sheet that faces the way that is up where the content of a glTF is z up: terrain on its side.
/// A house has walls all round, and a roof over them.
bool is_sheet_on_its_side(const Facts& facts) {
  const double length = facts.facing.norm();
  return length > kOneSided * facts.area && facts.facing.y() < -kAlongAxis * length;
}

/// Do the faces tell that y is up (1), z (−1), or nothing (0)?
int slopes_say_y(const Facts& facts) {
  if (!(facts.area > 0)) return 0;
  if (is_contradicted(facts, 2, 1)) return 1;
  return is_contradicted(facts, 1, 2) ? -1 : 0;
}

/// glTF is y up by its format, and was turned by that; some converters write z up all the same,
/// which --up z says.
/// Returns the axis that seems to be up, 1 or 2, of what was turned.
int judge_turned_axis(const Facts& facts, const ReadOptions& options, Reading& how) {
  how.is_turned_back = options.up == Up::kZ;
  if (how.is_turned_back) return 1;
  const bool is_sheet = is_sheet_on_its_side(facts);
  if (options.up == Up::kY || (slopes_say_y(facts) <= 0 && !is_sheet)) return 2;
  const std::string why =
      is_sheet ? "read y up, as glTF is, it is a sheet that faces sideways; read z up, it faces up"
               : "read y up, as glTF is, a large part of its faces hangs over; read z up, next to "
                 "none does";
  how.is_turned_back = options.up == Up::kAuto;
  how.doubts.push_back(how.is_turned_back
                           ? "taken as z up: " + why + "; --up y reads it as it stands"
                           : "looks z up, so that it lies on its side: " + why +
                                 "; --up auto turns it, --up y says that it is right");
  return 1;
}

/// Returns the axis that seems to be up, 1 or 2.
int judge_axis(const std::string& path, const RawFile& raw, const Facts& facts,
               const ReadOptions& options, Reading& how) {
  if (raw.is_turned) return judge_turned_axis(facts, options, how);
  how.is_y_up = options.up == Up::kY;
  if (options.up == Up::kY || options.up == Up::kZ) return how.is_y_up ? 1 : 2;
  const int slopes = slopes_say_y(facts);
  const std::string writer = y_up_writer(path, raw);
  if (slopes < 0 || (slopes == 0 && writer.empty())) return 2;
  const std::string why =
      slopes > 0 ? "read z up, a large part of its faces hangs over; read y up, next to none does"
                 : "its head names " + writer + ", which writes y up";
  if (options.up == Up::kAuto) {
    how.is_y_up = true;
    how.doubts.push_back("taken as y up: " + why + "; --up z reads it as it stands");
  } else {
    how.doubts.push_back("looks y up, so that it lies on its side: " + why +
                         "; --up y turns it, --up z says that it is right");
  }
  return 1;
}

/// Longitude and latitude in two axes, height in the third. `up`: 1 or 2.
bool looks_like_degrees(const Facts& facts, int up) {
  const Vec3 size = facts.box.size(), middle = facts.box.center();
  const int other = 3 - up;
  const double wide = std::max(size[0], size[other]);
  if (!(wide < kDegreeExtent) || !(size[up] > kNeedle * wide)) return false;
  if (std::abs(middle[0]) > 180 || std::abs(middle[other]) > 180) return false;
  const bool is_off_zero = std::max(std::abs(middle[0]), std::abs(middle[other])) >= 1;
  return wide > 0 && (is_off_zero || size[up] > kSureNeedle * wide);
}

/// The reference system that a .prj of the same name holds as WKT, in small letters; or nothing.
std::string system_beside(const std::string& path) {
  std::filesystem::path prj = path;
  prj.replace_extension(".prj");
  try {
    return lower(as_text(read_bytes(prj.string(), kLargestSystem)));
  } catch (const Error&) {
    return "";  // not there, or nothing to learn from
  }
}

void judge_degrees(const std::string& path, const Facts& facts, const ReadOptions& options,
                   const std::string& system, Reading& how) {
  const bool can_be = facts.box.center().head<2>().cwiseAbs().maxCoeff() <= 360;
  const bool is_said = can_be && (system.starts_with("geogc") || system.starts_with("geodc"));
  if (!is_said && !looks_like_degrees(facts, 2) && !looks_like_degrees(facts, 1)) return;
  const std::string message =
      "extents of " + size_text(facts.box.size()) +
      " look like degrees of longitude and latitude beside a height in metres: project the "
      "coordinates first (PROJ's cs2cs, QGIS), e.g. to UTM";
  if (!options.unit) fail(path, message + "; --unit m says that they are metres");
  how.doubts.push_back(message);
}

/// "--unit mm (9 m high) or --unit in (22.9 m high)": units that make a house of that height.
std::string units_for(double height) {
  static constexpr std::pair<const char*, double> kUnits[] = {
      {"mm", 0.001}, {"cm", 0.01}, {"in", 0.0254}, {"ft", 0.3048}};
  std::string text;
  for (const auto& [name, unit] : kUnits)
    if (const double metres = height * unit; metres >= kLowHouse && metres <= kHighHouse)
      text += (text.empty() ? "" : " or ") + std::string("--unit ") + name + " (" + number(metres) +
              " m high)";
  return text.empty() ? "--unit mm, cm, in or ft" : text;
}

/// The unit that a text names: mm, cm, in, ft; empty: none, or metres.
std::string unit_in(const std::string& text) {
  static constexpr std::pair<const char*, const char*> kWords[] = {
      {"millimet", "mm"}, {"centimet", "cm"}, {"inch", "in"}, {"feet", "ft"}, {"foot", "ft"}};
  for (const auto& [word, unit] : kWords)
    if (text.find(word) != text.npos) return unit;
  return "";
}

/// By a line like SketchUp's "File units = inches" in the head, or the last unit of a projected
/// system beside the file, which is that of its axes.
std::string named_unit(const RawFile& raw, const std::string& system) {
  const std::string remarks = lower(raw.remarks);
  const std::size_t in_head = remarks.find("units"), in_system = system.rfind("unit[");
  if (in_head != remarks.npos) return unit_in(remarks.substr(in_head, 40));
  return in_system != system.npos ? unit_in(system.substr(in_system, 40)) : "";
}

void judge_unit(const RawFile& raw, const Facts& facts, const ReadOptions& options, int up,
                const std::string& system, Reading& how) {
  how.unit = options.unit.value_or(1.0);
  if (options.unit) return;
  const Vec3 size = facts.box.size();
  const double height = size[up], wide = std::max(size[0], size[3 - up]);
  const double narrow = std::min(size[0], size[3 - up]);
  const bool is_house_of_giants =
      height > kTall && narrow > kBroad && height > kLikeHouse * wide && height < kLikeTower * wide;
  const std::string unit = raw.is_metric ? "" : named_unit(raw, system);
  if (!unit.empty()) {
    how.doubts.push_back("its head or its .prj says that its unit is " + unit +
                         ", it is read as metres: --unit " + unit + " takes it as such");
  } else if (height > kTallest || is_house_of_giants) {
    how.doubts.push_back("is " + size_text(size) +
                         " m large, too large for a building: " + units_for(height) + " would fit");
  } else if (size.maxCoeff() > 0 && size.maxCoeff() < kSmallest) {
    how.doubts.push_back("is " + size_text(size) +
                         " m large, too small for a building: --unit says what one unit of the "
                         "file is");
  }
}

}  // namespace

Reading judge(const std::string& path, const RawFile& raw, const ReadOptions& options) {
  Reading how;
  const Facts facts = gather(raw);
  const std::string system = raw.is_from_memory ? "" : system_beside(path);
  judge_degrees(path, facts, options, system, how);
  const int up = judge_axis(path, raw, facts, options, how);
  judge_unit(raw, facts, options, up, system, how);
  return how;
}

}  // namespace colod::mesh_io
