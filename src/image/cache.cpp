// Based on: Williams, Pyramidal parametrics, SIGGRAPH 1983, in linear light.
// Differs: sides that are odd lose no row: a pixel is the mean of those that it covers, by area.
#include "cache.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <map>
#include <mutex>
#include <stdexcept>
#include <tuple>

namespace colod {

namespace {

using Key = std::tuple<std::string, std::size_t, std::size_t, std::size_t, std::size_t>;

constexpr std::size_t kNowhere = std::numeric_limits<std::size_t>::max();

int digit_of(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+' || c == '-') return 62;
  return c == '/' || c == '_' ? 63 : -1;
}

/// What is no digit is passed over: JSON may write a backslash before a slash.
std::string decode_base64(const std::string& text) {
  std::string out;
  unsigned bits = 0;
  int count = 0;
  for (const char c : text) {
    const int digit = digit_of(c);
    if (digit < 0) continue;
    bits = bits << 6 | static_cast<unsigned>(digit);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    out += static_cast<char>(bits >> count & 255);
  }
  return out;
}

}  // namespace

ImagePlace missing_image(const std::string& name) { return {.path = name, .offset = kNowhere}; }

bool is_missing(const ImagePlace& place) { return place.offset == kNowhere; }

std::string read_image(const ImagePlace& place, std::size_t most_bytes) {
  if (is_missing(place)) throw std::runtime_error("is missing");
  std::ifstream in(place.path, std::ios::binary | std::ios::ate);
  if (!in) throw std::runtime_error("is missing or cannot be opened");
  const auto size = static_cast<std::size_t>(in.tellg());
  if (place.offset > size || place.length > size - place.offset)
    throw std::runtime_error("lies beyond the end of its file");
  std::string bytes(place.length > 0 ? place.length : std::min(size - place.offset, most_bytes),
                    '\0');
  in.seekg(static_cast<std::streamoff>(place.offset));
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!in) throw std::runtime_error("cannot be read");
  if (place.is_base64) bytes = decode_base64(bytes);
  if (place.skip > bytes.size() || place.take > bytes.size() - place.skip)
    throw std::runtime_error("lies beyond the end of its buffer");
  return place.skip == 0 && place.take == 0
             ? bytes
             : bytes.substr(place.skip, place.take > 0 ? place.take : bytes.npos);
}

namespace {

std::shared_ptr<const Pyramid> build(Raster raster) {
  auto pyramid = std::make_shared<Pyramid>();
  pyramid->levels.push_back(std::move(raster));
  while (pyramid->levels.back().width > 1 || pyramid->levels.back().height > 1)
    pyramid->levels.push_back(halve(pyramid->levels.back()));
  return pyramid;
}

std::size_t bytes_of(const Pyramid& pyramid) {
  std::size_t bytes = 0;
  for (const Raster& level : pyramid.levels) bytes += level.rgb.size() + level.alpha.size();
  return bytes;
}

/// One image; its own lock lets others be read meanwhile.
struct Slot {
  std::mutex mutex;
  bool is_known = false;
  std::array<int, 2> size = {0, 0};
  bool has_alpha = false;
  ImageCache::Entry entry;
  std::uint64_t used = 0;  // when; under the cache's lock
  std::size_t bytes = 0;   // held for it; under the cache's lock
};

}  // namespace

struct ImageCache::Impl {
  std::size_t budget;
  std::mutex mutex;
  std::uint64_t clock = 0;
  std::size_t bytes = 0;
  std::map<Key, std::shared_ptr<Slot>> slots;

  std::shared_ptr<Slot> slot(const ImagePlace& place) {
    const std::lock_guard lock(mutex);
    std::shared_ptr<Slot>& s =
        slots[{place.path, place.offset, place.length, place.skip, place.take}];
    if (!s) s = std::make_shared<Slot>();
    s->used = ++clock;
    return s;
  }

  /// Counts it in, and lets go of the others that were used longest ago.
  void admit(Slot& fresh, std::size_t size) {
    const std::lock_guard lock(mutex);
    bytes += size - fresh.bytes;
    fresh.bytes = size;
    while (bytes > budget) {
      Slot* oldest = nullptr;
      for (const auto& [key, s] : slots)
        if (s.get() != &fresh && s->bytes > 0 && (!oldest || s->used < oldest->used))
          oldest = s.get();
      if (!oldest || !oldest->mutex.try_lock()) return;  // someone is about to use it
      oldest->entry.pyramid.reset();
      bytes -= oldest->bytes;
      oldest->bytes = 0;
      oldest->mutex.unlock();
    }
  }
};

ImageCache::ImageCache(std::size_t budget) : impl_(std::make_unique<Impl>()) {
  impl_->budget = budget;
}
ImageCache::~ImageCache() = default;
ImageCache::ImageCache(ImageCache&&) noexcept = default;

ImageCache::Entry ImageCache::get(const ImagePlace& place) const {
  const std::shared_ptr<Slot> slot = impl_->slot(place);
  const std::lock_guard lock(slot->mutex);
  if (slot->entry.pyramid || (slot->is_known && slot->size[0] == 0)) return slot->entry;
  slot->is_known = true;
  try {
    DecodedImage decoded = decode_image(read_image(place, impl_->budget), impl_->budget);
    slot->size = {decoded.raster.width, decoded.raster.height};
    slot->has_alpha = !decoded.raster.alpha.empty();
    slot->entry.problem = decoded.remark;
    slot->entry.is_lost = decoded.is_damaged;
    slot->entry.pyramid = build(std::move(decoded.raster));
    impl_->admit(*slot, bytes_of(*slot->entry.pyramid));
  } catch (const std::exception& e) {
    slot->entry.problem = e.what();
    slot->entry.is_lost = true;
  }
  return slot->entry;
}

void ImageCache::put(const ImagePlace& place, Raster raster) {
  const std::shared_ptr<Slot> slot = impl_->slot(place);
  const std::lock_guard lock(slot->mutex);
  slot->is_known = true;
  slot->size = {raster.width, raster.height};
  slot->has_alpha = !raster.alpha.empty();
  slot->entry = {build(std::move(raster)), "", false};
}

ImageCache::Facts ImageCache::facts(const ImagePlace& place) const {
  const std::shared_ptr<Slot> slot = impl_->slot(place);
  const auto known = [&] {
    return Facts{slot->size[0], slot->size[1], slot->entry.problem, slot->entry.is_lost};
  };
  {
    const std::lock_guard lock(slot->mutex);
    if (slot->is_known) return known();
  }
  get(place);
  const std::lock_guard lock(slot->mutex);
  return known();
}

bool ImageCache::has_alpha(const ImagePlace& place) const {
  facts(place);
  const std::shared_ptr<Slot> slot = impl_->slot(place);
  const std::lock_guard lock(slot->mutex);
  return slot->has_alpha;
}

}  // namespace colod
