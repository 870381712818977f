// Based on: GeoTIFF 1.1, OGC 19-008r4. A cloud's keys are those of a GeoTIFF: GDAL reads them from
// an image of one pixel in memory that has nothing else.
#include "geokeys.h"

#include <cpl_vsi.h>
#include <gdal_frmts.h>
#include <gdal_priv.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <memory>

namespace colod {
namespace {

constexpr std::size_t kEntry = 12;  // bytes of a field in a directory of TIFF
enum TiffType : std::uint16_t { kAscii = 2, kShort = 3, kLong = 4, kDouble = 12 };

template <typename T>
void append_bytes(std::string& to, T value) {
  char bytes[sizeof(T)];
  std::memcpy(bytes, &value, sizeof(T));
  to.append(bytes, sizeof(T));
}

/// A field that is one number or lies elsewhere in the file.
void append_field(std::string& to, int tag, TiffType type, std::size_t count, std::size_t value) {
  append_bytes(to, static_cast<std::uint16_t>(tag));
  append_bytes(to, static_cast<std::uint16_t>(type));
  append_bytes(to, static_cast<std::uint32_t>(count));
  append_bytes(to, static_cast<std::uint32_t>(value));
}

/// A grey pixel with the cloud's keys, of the order of bytes of this machine.
std::string tiff_of(const CloudSystem& system) {
  constexpr std::size_t kHead = 8, kFields = 12;
  const std::uint16_t probe = 1;
  const bool is_little = *reinterpret_cast<const unsigned char*>(&probe) == 1;
  std::string numbers, texts = system.texts + '\0';
  for (const std::uint16_t key : system.keys) append_bytes(numbers, key);
  const std::size_t keys_at = kHead + 2 + kFields * kEntry + 4 + 8;
  const std::size_t doubles_at = keys_at + numbers.size();
  for (const double value : system.numbers) append_bytes(numbers, value);
  if (system.numbers.empty()) append_bytes(numbers, 0.0);
  const std::size_t texts_at = keys_at + numbers.size();
  std::string out = is_little ? "II" : "MM";
  append_bytes(out, std::uint16_t{42});
  append_bytes(out, static_cast<std::uint32_t>(kHead));
  append_bytes(out, static_cast<std::uint16_t>(kFields));
  append_field(out, 256, kLong, 1, 1);            // width
  append_field(out, 257, kLong, 1, 1);            // height
  append_field(out, 258, kLong, 1, 8);            // bits
  append_field(out, 259, kLong, 1, 1);            // not packed
  append_field(out, 262, kLong, 1, 1);            // black is zero
  append_field(out, 273, kLong, 1, keys_at - 8);  // where its one pixel is
  append_field(out, 277, kLong, 1, 1);            // samples
  append_field(out, 278, kLong, 1, 1);            // rows a strip
  append_field(out, 279, kLong, 1, 1);            // bytes
  append_field(out, 34735, kShort, system.keys.size(), keys_at);
  append_field(out, 34736, kDouble, std::max<std::size_t>(1, system.numbers.size()), doubles_at);
  append_field(out, 34737, kAscii, texts.size(), texts_at);
  append_bytes(out, std::uint32_t{0});  // no further directory
  out.append(8, '\0');                  // the pixel
  return out + numbers + texts;
}

/// A file of GDAL's memory that goes away.
class MemoryFile {
 public:
  explicit MemoryFile(std::string& bytes) {
    static std::atomic<unsigned> count = 0;
    path_ = "/vsimem/colod_keys_" + std::to_string(count++) + ".tif";
    VSIFCloseL(VSIFileFromMemBuffer(path_.c_str(), reinterpret_cast<GByte*>(bytes.data()),
                                    static_cast<vsi_l_offset>(bytes.size()), FALSE));
  }
  ~MemoryFile() { VSIUnlink(path_.c_str()); }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace

std::string wkt_of_keys(const CloudSystem& system) {
  static const bool is_ready = (GDALRegister_GTiff(), true);
  (void)is_ready;
  CPLPushErrorHandler(CPLQuietErrorHandler);
  std::string bytes = tiff_of(system);
  const MemoryFile file(bytes);
  std::string out;
  const char* const alone[] = {nullptr};
  const std::unique_ptr<GDALDataset> image(
      GDALDataset::Open(file.path().c_str(), GDAL_OF_RASTER, nullptr, nullptr, alone));
  const OGRSpatialReference* found = image ? image->GetSpatialRef() : nullptr;
  if (found && found->IsProjected()) {
    OGRSpatialReference flat(*found);
    if (flat.IsCompound()) flat.StripVertical();
    char* text = nullptr;
    const char* const options[] = {"FORMAT=WKT2_2019", nullptr};
    if (flat.exportToWkt(&text, options) == OGRERR_NONE) out = text;
    CPLFree(text);
  }
  CPLPopErrorHandler();
  return out;
}

}  // namespace colod
