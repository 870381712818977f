// Based on: LAS 1.4 R15, ASPRS, "Coordinate Reference System VLRs"; GeoTIFF 1.1, OGC 19-008r4.
#include "cloud_system.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "airborne.h"
#include "files.h"

namespace colod {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kRecentHead = 375, kOldestHead = 227;  // bytes, of LAS 1.4 and 1.0
constexpr std::size_t kShortRecord = 54,
                      kLongRecord = 60;            // bytes of a record before what it holds
constexpr std::uint64_t kMostRecords = 10000;      // files have a dozen
constexpr std::uint64_t kLargestRecord = 1 << 20;  // bytes; WKT has some 5,000
constexpr const char* kRecordUser = "LASF_Projection";
constexpr int kWktId = 2112, kKeysId = 34735, kNumbersId = 34736, kTextsId = 34737;
constexpr unsigned kWktBit = 16;  // of the header's global encoding

/// A file of which pieces are asked for.
class FilePieces {
 public:
  explicit FilePieces(const std::string& path) : in_(path, std::ios::binary) {
    std::error_code error;
    size_ = fs::is_regular_file(path, error) ? fs::file_size(path, error) : 0;
    if (error) size_ = 0;
  }
  std::uint64_t size() const { return size_; }

  /// Shorter where the file ends.
  std::string at(std::uint64_t begin, std::uint64_t length) {
    if (begin >= size_) return "";
    std::string bytes(static_cast<std::size_t>(std::min(length, size_ - begin)), '\0');
    in_.clear();
    in_.seekg(static_cast<std::streamoff>(begin));
    in_.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    bytes.resize(static_cast<std::size_t>(in_.gcount()));
    return bytes;
  }

 private:
  std::ifstream in_;
  std::uint64_t size_ = 0;
};

/// Zero where the bytes end before it.
template <typename T>
T field_at(const std::string& bytes, std::size_t at) {
  T value{};
  if (at + sizeof(T) <= bytes.size()) std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

template <typename T>
std::vector<T> values_of(const std::string& bytes) {
  std::vector<T> out(bytes.size() / sizeof(T));
  std::memcpy(out.data(), bytes.data(), out.size() * sizeof(T));
  return out;
}

/// A text up to its first zero.
std::string up_to_zero(const std::string& bytes) { return bytes.substr(0, bytes.find('\0')); }

/// The keys that a directory promises; empty where it is cut.
std::vector<std::uint16_t> directory_of(const std::string& bytes) {
  std::vector<std::uint16_t> all = values_of<std::uint16_t>(bytes);
  if (all.size() < 4 || all.size() < 4 + 4 * std::size_t{all[3]}) return {};
  all.resize(4 + 4 * std::size_t{all[3]});
  return all;
}

void take_record(int id, const std::string& bytes, CloudSystem& out) {
  if (id == kWktId && out.wkt.empty()) {
    out.wkt = up_to_zero(bytes);
    if (out.wkt.empty())
      out.problems.push_back("its record of WKT (LASF_Projection 2112) is empty");
  } else if (id == kKeysId && out.keys.empty()) {
    out.keys = directory_of(bytes);
    if (out.keys.empty())
      out.problems.push_back("its GeoTIFF keys (LASF_Projection 34735) are cut or empty");
  } else if (id == kNumbersId && out.numbers.empty()) {
    out.numbers = values_of<double>(bytes);
  } else if (id == kTextsId && out.texts.empty()) {
    out.texts = up_to_zero(bytes);
  }
}

/// A chain of records between two places; `is_long`: those of LAS 1.4 behind the points.
void take_records(FilePieces& file, std::uint64_t at, std::uint64_t end, std::uint64_t count,
                  bool is_long, CloudSystem& out) {
  const std::uint64_t head = is_long ? kLongRecord : kShortRecord;
  for (std::uint64_t i = 0; i < std::min(count, kMostRecords); ++i) {
    const std::string bytes = file.at(at, head);
    if (at + head > end || bytes.size() < head) {
      out.problems.push_back("its records end before the " + std::to_string(count) +
                             " that its header promises");
      return;
    }
    const std::uint64_t length = is_long ? field_at<std::uint64_t>(bytes, 20)
                                         : std::uint64_t{field_at<std::uint16_t>(bytes, 20)};
    const int id = field_at<std::uint16_t>(bytes, 18);
    at += head;
    const bool is_cut = length > end - at;
    if (up_to_zero(bytes.substr(2, 16)) == kRecordUser) {
      const std::string named = "its record LASF_Projection " + std::to_string(id);
      if (is_cut || length > kLargestRecord)
        out.problems.push_back(named + (is_cut ? " is cut" : " is larger than a mebibyte"));
      else
        take_record(id, file.at(at, length), out);
    }
    if (is_cut) return;
    at += length;
  }
}

/// Where among the keys one stands; 0: nowhere.
std::size_t place_of_key(const std::vector<std::uint16_t>& keys, int id) {
  for (std::size_t i = 4; i + 3 < keys.size(); i += 4)
    if (keys[i] == id) return i;
  return 0;
}

}  // namespace

std::optional<int> CloudSystem::key(int id) const {
  const std::size_t at = place_of_key(keys, id);
  if (at == 0 || keys[at + 1] != 0) return {};
  return keys[at + 3];
}

std::optional<double> CloudSystem::number(int id) const {
  const std::size_t at = place_of_key(keys, id);
  if (at == 0 || keys[at + 1] != kNumbersId || keys[at + 3] >= numbers.size()) return {};
  const double value = numbers[keys[at + 3]];
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

CloudSystem read_cloud_system(const std::string& path) {
  CloudSystem out;
  FilePieces file(path);
  const std::string head = file.at(0, kRecentHead);
  if (head.size() < kOldestHead || !head.starts_with("LASF")) return out;
  const int minor = field_at<std::uint8_t>(head, 25);
  const std::uint64_t begin = field_at<std::uint16_t>(head, 94);
  const std::uint64_t points = field_at<std::uint32_t>(head, 96);
  out.prefers_wkt = (field_at<std::uint16_t>(head, 6) & kWktBit) != 0;
  for (int k = 0; k < 3; ++k) {
    const std::size_t at = 179 + 16 * static_cast<std::size_t>(k);
    out.middle[k] = (field_at<double>(head, at) + field_at<double>(head, at + 8)) / 2;
  }
  if (!out.middle.allFinite()) out.middle.setZero();
  take_records(file, begin, std::min(points, file.size()), field_at<std::uint32_t>(head, 100),
               false, out);
  if (minor >= 4 && head.size() == kRecentHead && field_at<std::uint64_t>(head, 235) > 0)
    take_records(file, field_at<std::uint64_t>(head, 235), file.size(),
                 field_at<std::uint32_t>(head, 243), true, out);
  return out;
}

std::vector<std::string> clouds_alone_in(const std::string& folder) {
  std::vector<std::string> clouds;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const std::string path = entry.path().string();
    std::error_code unknown;
    if (!entry.is_regular_file(unknown) || !mesh_io::is_supported(path) ||
        mesh_io::is_passed_over(path))
      continue;
    if (!is_las(path)) return {};
    clouds.push_back(path);
  }
  std::sort(clouds.begin(), clouds.end());
  return clouds;
}

}  // namespace colod
