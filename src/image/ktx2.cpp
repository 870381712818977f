// Based on: basisu, the Basis Universal compressor, as a program: no library of it is in Debian.
#include <fstream>
#include <iterator>

#include "codecs.h"
#include "core/program.h"

namespace colod {

namespace {

constexpr const char* kMagic = "\xABKTX 20\xBB\r\n\x1A\n";

}  // namespace

bool can_encode_ktx2() { return !find_program("basisu").empty(); }

/// ETC1S, whose quality basisu counts from 1 to 255. One thread: buildings are encoded in parallel,
/// and the bytes do not depend on how many there are.
std::string codecs::encode_ktx2(const Raster& raster, int quality) {
  const std::string program = find_program("basisu");
  if (program.empty()) throw std::runtime_error("KTX2: the program basisu is not on the PATH");
  const Workplace place;
  const std::string in = place / "in.png", out = place / "out.ktx2";
  std::ofstream(in, std::ios::binary) << encode_png(raster);
  const int level = 1 + (quality - 1) * 254 / 99;
  const int code = run_program({program, "-ktx2", "-q", std::to_string(level), "-mipmap",
                                "-no_multithreading", "-file", in, "-output_file", out});
  if (code != 0)
    throw std::runtime_error("KTX2: " + program + " ended with exit code " + std::to_string(code));
  std::ifstream file(out, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (!bytes.starts_with(kMagic))
    throw std::runtime_error("KTX2: " + program + " wrote no KTX2 file");
  return bytes;
}

}  // namespace colod
