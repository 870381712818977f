// Based on: ZIP (PKWARE's APPNOTE 6.3), the 3TZ profile (vnd.maxar.archive.3tz+zip), MD5 (RFC
// 1321). Differs: stored, not deflated, since GLBs are packed inside already and readers may seek;
// no time stamps, so that the same tileset gives the same bytes.
#include "archive.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "core/bytes.h"
#include "core/error.h"

namespace colod {

namespace {

constexpr std::uint64_t k32Bits = 0xFFFFFFFF, k16Bits = 0xFFFF;
constexpr std::uint16_t kVersion = 20, kVersion64 = 45;
constexpr std::uint16_t kUtf8Names = 1 << 11;
constexpr std::uint16_t kNoTime = 0, kFirstDay = 0x21;  // 1980-01-01

std::uint32_t crc32(const std::string& bytes) {
  static const auto remainders = [] {
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t i = 0; i < 256; ++i) {
      std::uint32_t c = i;
      for (int bit = 0; bit < 8; ++bit) c = c & 1 ? 0xEDB88320u ^ (c >> 1) : c >> 1;
      table[i] = c;
    }
    return table;
  }();
  std::uint32_t crc = ~0u;
  for (const char c : bytes)
    crc = remainders[(crc ^ static_cast<unsigned char>(c)) & 255] ^ (crc >> 8);
  return ~crc;
}

using Digest = std::array<std::uint32_t, 4>;

void digest_block(Digest& state, const char* block) {
  static constexpr int kTurns[4][4] = {
      {7, 12, 17, 22}, {5, 9, 14, 20}, {4, 11, 16, 23}, {6, 10, 15, 21}};
  std::uint32_t words[16];
  std::memcpy(words, block, sizeof words);
  auto [a, b, c, d] = state;
  for (int i = 0; i < 64; ++i) {
    std::uint32_t f;
    int g;
    switch (i / 16) {
      case 0:
        f = (b & c) | (~b & d), g = i;
        break;
      case 1:
        f = (d & b) | (~d & c), g = (5 * i + 1) % 16;
        break;
      case 2:
        f = b ^ c ^ d, g = (3 * i + 5) % 16;
        break;
      default:
        f = c ^ (b | ~d), g = (7 * i) % 16;
    }
    const auto sine = static_cast<std::uint32_t>(std::abs(std::sin(i + 1.0)) * 4294967296.0);
    const std::uint32_t sum = a + f + sine + words[g];
    a = d, d = c, c = b;
    b += std::rotl(sum, kTurns[i / 16][i % 4]);
  }
  state[0] += a, state[1] += b, state[2] += c, state[3] += d;
}

Digest md5(std::string text) {
  const std::uint64_t bits = 8 * text.size();
  text += '\x80';
  while (text.size() % 64 != 56) text += '\0';
  put(text, bits);
  Digest state = {0x67452301, 0xEFCDAB89, 0x98BADCFE, 0x10325476};
  for (std::size_t at = 0; at < text.size(); at += 64) digest_block(state, text.data() + at);
  return state;
}

using Entry = ArchiveWriter::Entry;

/// What local and central headers share: flags to the length of the name.
void put_common(std::string& out, const Entry& e) {
  put(out, kUtf8Names);
  put(out, std::uint16_t{0});  // stored
  put(out, kNoTime);
  put(out, kFirstDay);
  put(out, e.crc);
  put(out, e.size);
  put(out, e.size);
  put(out, static_cast<std::uint16_t>(e.path.size()));
}

void put_central(std::string& out, const Entry& e) {
  const bool is_far = e.offset >= k32Bits;
  put(out, std::uint32_t{0x02014b50});
  put(out, is_far ? kVersion64 : kVersion);
  put(out, is_far ? kVersion64 : kVersion);
  put_common(out, e);
  put(out, static_cast<std::uint16_t>(is_far ? 12 : 0));
  out.append(10, '\0');  // comment, disk, attributes
  put(out, static_cast<std::uint32_t>(std::min(e.offset, k32Bits)));
  out += e.path;
  if (!is_far) return;
  put(out, std::uint16_t{1});
  put(out, std::uint16_t{8});
  put(out, e.offset);
}

/// The central directory lies from `start` to `end`.
void put_end(std::string& out, std::uint64_t count, std::uint64_t start, std::uint64_t end) {
  const std::uint64_t size = end - start;
  if (count >= k16Bits || end >= k32Bits) {
    put(out, std::uint32_t{0x06064b50});
    put(out, std::uint64_t{44});
    put(out, kVersion64);
    put(out, kVersion64);
    out.append(8, '\0');
    put(out, count);
    put(out, count);
    put(out, size);
    put(out, start);
    put(out, std::uint32_t{0x07064b50});
    put(out, std::uint32_t{0});
    put(out, end);
    put(out, std::uint32_t{1});
  }
  put(out, std::uint32_t{0x06054b50});
  put(out, std::uint32_t{0});
  put(out, static_cast<std::uint16_t>(std::min(count, k16Bits)));
  put(out, static_cast<std::uint16_t>(std::min(count, k16Bits)));
  put(out, static_cast<std::uint32_t>(std::min(size, k32Bits)));
  put(out, static_cast<std::uint32_t>(std::min(start, k32Bits)));
  put(out, std::uint16_t{0});
}

/// Sorted as two little-endian 64-bit numbers, which is how readers search.
std::string index_of(const std::vector<Entry>& entries) {
  struct Row {
    std::uint64_t low, high, offset;
  };
  std::vector<Row> rows;
  for (const Entry& e : entries) {
    const Digest d = md5(e.path);
    rows.push_back({d[0] | std::uint64_t{d[1]} << 32, d[2] | std::uint64_t{d[3]} << 32, e.offset});
  }
  std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) {
    return a.low != b.low ? a.low < b.low : a.high < b.high;
  });
  std::string out;
  for (const Row& row : rows) put(out, row.low), put(out, row.high), put(out, row.offset);
  return out;
}

}  // namespace

void ArchiveWriter::put(const std::string& bytes) {
  append_(bytes);
  end_ += bytes.size();
}

void ArchiveWriter::add(const std::string& path, const std::string& bytes) {
  if (bytes.size() >= k32Bits || path.size() > k16Bits)
    throw Error(Stage::kOutput, path, "too large for the archive: use --format 3dtiles");
  entries_.push_back({path, end_, crc32(bytes), static_cast<std::uint32_t>(bytes.size())});
  std::string header;
  colod::put(header, std::uint32_t{0x04034b50});
  colod::put(header, kVersion);
  put_common(header, entries_.back());
  colod::put(header, std::uint16_t{0});
  put(header + path);
  put(bytes);
}

void ArchiveWriter::finish() {
  add("@3dtilesIndex1@", index_of(entries_));
  const std::uint64_t start = end_;
  for (const Entry& e : entries_) {
    std::string central;
    put_central(central, e);
    put(central);
  }
  std::string end;
  put_end(end, entries_.size(), start, end_);
  put(end);
}

Encoded encode_3tz(const std::vector<Encoded>& files) {
  std::string out;
  ArchiveWriter archive([&](const std::string& bytes) { out += bytes; });
  for (const Encoded& file : files) archive.add(file.path, file.bytes);
  archive.finish();
  return {kArchiveName, std::move(out)};
}

}  // namespace colod
