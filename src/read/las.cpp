// Based on: LAS 1.4 R15, ASPRS, point data record formats 0 to 10; LAS 1.0 to 1.3.
// Differs: no library. Waveforms, GPS times and extra bytes are passed over; LAZ is unpacked by a
// program of the system.
#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>

#include "core/program.h"
#include "files.h"
#include "formats.h"
#include "streams.h"

namespace colod::mesh_io {

namespace {

constexpr std::size_t kLeastHeader = 227;  // bytes, of LAS 1.0
constexpr std::size_t kNewHeader = 375;    // of LAS 1.4
constexpr int kBuilding = 6;
constexpr int kKindsOfClass = 256;

/// Bytes of a point, and where its colour begins; 0: it has none.
struct PointFormat {
  std::size_t length, color;
};
constexpr std::array<PointFormat, 11> kFormats = {{{20, 0},
                                                   {28, 0},
                                                   {26, 20},
                                                   {34, 28},
                                                   {57, 0},
                                                   {63, 28},
                                                   {30, 0},
                                                   {36, 30},
                                                   {38, 30},
                                                   {59, 0},
                                                   {67, 30}}};

struct LasHeader {
  int format = 0;
  bool is_packed = false;
  std::size_t begin = 0, length = 0;  ///< of the points, and of one of them
  std::uint64_t count = 0;
  Vec3 scale = Vec3::Ones(), offset = Vec3::Zero();
};

template <typename T>
T value_at(std::string_view bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

LasHeader read_las_header(const std::string& path, std::string_view bytes) {
  if (bytes.size() < kLeastHeader || !bytes.starts_with("LASF"))
    fail(path, "LAS: truncated within its header, or another format");
  const int major = value_at<std::uint8_t>(bytes, 24), minor = value_at<std::uint8_t>(bytes, 25);
  if (major != 1 || minor > 4)
    fail(path, "LAS: version " + std::to_string(major) + "." + std::to_string(minor) +
                   " is not read; 1.0 to 1.4 are");
  LasHeader h;
  const int format = value_at<std::uint8_t>(bytes, 104);
  h.is_packed = format >= 64;
  h.format = format & 63;
  h.begin = value_at<std::uint32_t>(bytes, 96);
  h.length = value_at<std::uint16_t>(bytes, 105);
  h.count = value_at<std::uint32_t>(bytes, 107);
  if (minor == 4 && bytes.size() >= kNewHeader && value_at<std::uint64_t>(bytes, 247) > 0)
    h.count = value_at<std::uint64_t>(bytes, 247);
  for (int k = 0; k < 3; ++k) {
    h.scale[k] = value_at<double>(bytes, 131 + 8 * k);
    h.offset[k] = value_at<double>(bytes, 155 + 8 * k);
  }
  if (h.format >= static_cast<int>(kFormats.size()))
    fail(path, "LAS: point format " + std::to_string(h.format) + " is not read; 0 to 10 are");
  if (h.length < kFormats[h.format].length)
    fail(path, "LAS: its header says " + std::to_string(h.length) + " bytes a point, and format " +
                   std::to_string(h.format) + " has " + std::to_string(kFormats[h.format].length));
  if (!((h.scale.array() > 0).all() && is_usable(h.scale) && is_usable(h.offset)))
    fail(path, "LAS: its header's scale or offset is no usable number");
  return h;
}

/// The part of a file that its header promises.
void check_length(const std::string& path, const LasHeader& h, std::size_t size) {
  const std::uint64_t there = h.begin < size ? (size - h.begin) / h.length : 0;
  if (h.begin < kLeastHeader || there < h.count)
    fail(path, "LAS: truncated: its header says " + std::to_string(h.count) + " points from byte " +
                   std::to_string(h.begin) + " on, the file has room for " + std::to_string(there));
  if (h.count > static_cast<std::uint64_t>(std::numeric_limits<int>::max()))
    fail(path, "LAS: more than two thousand million points: cut it into pieces");
}

/// What a point is, and whether it was taken back.
struct PointClass {
  int number;
  bool is_withheld;
};

PointClass class_of(const char* point, int format) {
  const auto byte = [&](int at) { return static_cast<std::uint8_t>(point[at]); };
  if (format >= 6) return {byte(16), (byte(15) & 4) != 0};
  return {byte(15) & 31, (byte(15) & 128) != 0};
}

/// Ground, plants, noise, water, rails, roads, wires, towers, bridges: nothing of a building.
bool is_something_else(int number) {
  return (number >= 2 && number <= 5) || number == 7 || (number >= 9 && number <= 18);
}

/// Which of the classes belong to the building, and how that is said.
std::array<bool, kKindsOfClass> choose_classes(const std::array<std::size_t, kKindsOfClass>& count,
                                               std::vector<std::string>& warnings) {
  std::array<bool, kKindsOfClass> is_taken{};
  const bool has_building = count[kBuilding] > 0;
  std::size_t left_out = 0;
  for (int c = 0; c < kKindsOfClass; ++c) {
    is_taken[c] = has_building ? c == kBuilding : !is_something_else(c);
    if (!is_taken[c]) left_out += count[c];
  }
  if (left_out > 0)
    warnings.push_back(std::to_string(left_out) + " points left out: " +
                       (has_building ? "not of class 6 (building), which the file has"
                                     : "ground, plants, noise and others by their class"));
  return is_taken;
}

/// Colours have 16 bits, but many programs write 8 of them.
std::vector<Rgb> to_bytes(const std::vector<std::array<std::uint16_t, 3>>& colors) {
  bool is_wide = false;
  for (const auto& c : colors) is_wide |= *std::max_element(c.begin(), c.end()) > 255;
  std::vector<Rgb> out;
  out.reserve(colors.size());
  for (const auto& c : colors) {
    Rgb rgb;
    for (int k = 0; k < 3; ++k) rgb[k] = static_cast<std::uint8_t>(is_wide ? c[k] >> 8 : c[k]);
    out.push_back(rgb);
  }
  return out;
}

std::array<std::size_t, kKindsOfClass> count_classes(const char* first, const LasHeader& h,
                                                     std::size_t& withheld) {
  std::array<std::size_t, kKindsOfClass> count{};
  for (std::uint64_t i = 0; i < h.count; ++i) {
    const PointClass c = class_of(first + i * h.length, h.format);
    ++(c.is_withheld ? withheld : count[c.number]);
  }
  return count;
}

}  // namespace

namespace {

/// Metres in one unit of each axis: by --unit, else by the file's own reference system, which is
/// told.
Vec3 metric_units(const std::string& path, const ReadOptions& options,
                  std::vector<std::string>& warnings) {
  constexpr double kUnlike = 1e-9;  // the two feet differ by 2e-6
  const CloudUnits own =
      options.cloud_units ? options.cloud_units(read_cloud_system(path)) : CloudUnits();
  if (options.unit) {
    if (!own.text.empty() && ((own.metres.array() - *options.unit).abs() > kUnlike).any())
      warnings.push_back("its own reference system is in " + own.text +
                         ", and --unit says otherwise, which is taken");
    return Vec3::Constant(*options.unit);
  }
  if (!own.text.empty())
    warnings.push_back("read in " + own.text + ", as its own reference system says" +
                       (own.doubt.empty() ? "" : "; " + own.doubt) +
                       "; --unit m takes its coordinates for metres");
  return own.metres;
}

}  // namespace

RawFile read_las(const std::string& path, std::string_view bytes, const ReadOptions& options) {
  const LasHeader h = read_las_header(path, bytes);
  if (h.is_packed) fail(path, "LAS: its points are packed, as in LAZ: name it .laz");
  check_length(path, h, bytes.size());
  RawFile raw;
  const Vec3 unit = metric_units(path, options, raw.warnings);
  raw.is_metric = !options.unit && unit != Vec3::Ones();
  const char* first = bytes.data() + h.begin;
  std::size_t withheld = 0;
  const auto count = count_classes(first, h, withheld);
  const auto is_taken = choose_classes(count, raw.warnings);
  if (withheld > 0)
    raw.warnings.push_back(std::to_string(withheld) + " points left out: marked as withheld");
  const std::size_t color_at = kFormats[h.format].color;
  std::vector<std::array<std::uint16_t, 3>> colors;
  for (std::uint64_t i = 0; i < h.count; ++i) {
    const std::string_view point(first + i * h.length, h.length);
    const PointClass c = class_of(point.data(), h.format);
    if (c.is_withheld || !is_taken[c.number]) continue;
    Vec3 p;
    for (int k = 0; k < 3; ++k)
      p[k] = value_at<std::int32_t>(point, 4 * k) * h.scale[k] + h.offset[k];
    raw.points.push_back(raw.is_metric ? Vec3(p.cwiseProduct(unit)) : p);
    if (color_at == 0) continue;
    colors.push_back({value_at<std::uint16_t>(point, color_at),
                      value_at<std::uint16_t>(point, color_at + 2),
                      value_at<std::uint16_t>(point, color_at + 4)});
  }
  if (raw.points.empty()) fail(path, "LAS: no point of it may be of a building, by its classes");
  raw.point_colors = to_bytes(colors);
  return raw;
}

namespace {

/// Unpacks a file into a folder; the path of what came out.
std::string unpack_laz(const std::string& path, const Workplace& place) {
  std::string program;
  bool is_pdal = false;
  for (const char* name : {"laszip", "laszip64", "las2las", "las2las64", "pdal"}) {
    if (program = find_program(name); program.empty()) continue;
    is_pdal = std::string(name) == "pdal";
    break;
  }
  if (program.empty())
    fail(path,
         "LAZ is read where laszip, las2las or pdal is on the PATH, and none is: `pdal "
         "translate IN.laz OUT.las` converts it elsewhere");
  const std::string out = place / "out.las", in = std::filesystem::absolute(path).string();
  const int code = is_pdal ? run_program({program, "translate", in, out})
                           : run_program({program, "-i", in, "-o", out});
  std::error_code error;
  if (code != 0 || !std::filesystem::is_regular_file(out, error))
    fail(path, "LAZ: " + program + " could not unpack it (exit code " + std::to_string(code) + ")");
  return out;
}

}  // namespace

RawFile read_laz(const std::string& path, std::string_view bytes, const ReadOptions& options) {
  const LasHeader h = read_las_header(path, bytes);
  if (!h.is_packed) return read_las(path, bytes, options);
  constexpr double kMebi = 1 << 20;
  if (static_cast<double>(h.count) * static_cast<double>(h.length) > options.input_memory * kMebi)
    fail(path, "LAZ: it unpacks to more than --input-memory allows");
  const Workplace place;
  return read_las(path, read_bytes(unpack_laz(path, place), options.input_memory), options);
}

namespace {

/// The first bytes of a file.
std::string las_head(const std::string& file) {
  std::string head(kNewHeader, '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(in.gcount()));
  return head;
}

AirbornePoint las_point(std::string_view point, const LasHeader& h, int kind) {
  const std::size_t color_at = kFormats[static_cast<std::size_t>(h.format)].color;
  AirbornePoint p{Vec3::Zero(), kind, {}};
  for (int k = 0; k < 3; ++k)
    p.at[k] =
        value_at<std::int32_t>(point, 4 * static_cast<std::size_t>(k)) * h.scale[k] + h.offset[k];
  for (std::size_t k = 0; color_at > 0 && k < 3; ++k)
    p.color[k] = value_at<std::uint16_t>(point, color_at + 2 * k);
  return p;
}

/// All points but those that were withheld.
void visit_las(const std::string& file, const LasHeader& h, const TakePoint& take) {
  constexpr std::uint64_t kBlock = 1 << 15;  // points that are in memory
  std::ifstream in(file, std::ios::binary);
  in.seekg(static_cast<std::streamoff>(h.begin));
  std::string block;
  for (std::uint64_t done = 0; done < h.count; done += kBlock) {
    block.resize(static_cast<std::size_t>(std::min(kBlock, h.count - done)) * h.length);
    in.read(block.data(), static_cast<std::streamsize>(block.size()));
    if (!in) fail(file, "LAS: cannot be read to its end");
    for (std::size_t at = 0; at < block.size(); at += h.length) {
      const std::string_view point(block.data() + at, h.length);
      const PointClass c = class_of(point.data(), h.format);
      if (!c.is_withheld) take(las_point(point, h, c.number));
    }
  }
}

}  // namespace

PointStream stream_las(const std::string& path, const ReadOptions& options) {
  PointStream out;
  out.unit = metric_units(path, options, out.warnings);
  std::string file = path;
  std::shared_ptr<Workplace> place;  // where a LAZ was unpacked
  LasHeader header = read_las_header(path, las_head(path));
  if (header.is_packed) {
    place = std::make_shared<Workplace>();
    file = unpack_laz(path, *place);
    header = read_las_header(path, las_head(file));
  }
  check_length(path, header, std::filesystem::file_size(file));
  out.has_color = kFormats[static_cast<std::size_t>(header.format)].color > 0;
  out.visit = [file, place, header](const TakePoint& take) { visit_las(file, header, take); };
  return out;
}

}  // namespace colod::mesh_io
