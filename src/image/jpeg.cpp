// Based on: libjpeg-turbo's API of libjpeg 6b.
// Differs: an error jumps out of the library, over frames of C only: what has a destructor lives in
// the callers of the functions that jump.
#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <cstring>
// libjpeg's header wants stdio first.
#include <jpeglib.h>

#include "codecs.h"

namespace colod::codecs {

namespace {

struct Failure {
  jpeg_error_mgr base;  // first: libjpeg sees this alone
  std::jmp_buf jump;
  char cause[JMSG_LENGTH_MAX];
  long warnings;
};

void fail(j_common_ptr info) {
  auto* failure = reinterpret_cast<Failure*>(info->err);
  info->err->format_message(info, failure->cause);
  std::longjmp(failure->jump, 1);
}

/// Of warnings the first is kept: that of a file that ends too early, mostly.
void take_note(j_common_ptr info, int level) {
  if (level >= 0) return;
  auto* failure = reinterpret_cast<Failure*>(info->err);
  if (failure->warnings++ == 0) info->err->format_message(info, failure->cause);
}

void set_up(Failure& failure) {
  jpeg_std_error(&failure.base);
  failure.base.error_exit = fail;
  failure.base.emit_message = take_note;
  failure.cause[0] = 0;
  failure.warnings = 0;
}

struct Reader {
  jpeg_decompress_struct info;
  Failure failure;
};

bool start(Reader& r, std::string_view bytes) {
  if (setjmp(r.failure.jump)) return false;
  jpeg_create_decompress(&r.info);
  jpeg_mem_src(&r.info, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  jpeg_read_header(&r.info, TRUE);
  const bool is_ink = r.info.num_components == 4;
  r.info.out_color_space = is_ink ? JCS_CMYK : JCS_RGB;
  return true;
}

bool read_rows(Reader& r, std::uint8_t* out) {
  if (setjmp(r.failure.jump)) return false;
  jpeg_start_decompress(&r.info);
  const std::size_t stride = static_cast<std::size_t>(r.info.output_width) *
                             static_cast<std::size_t>(r.info.output_components);
  while (r.info.output_scanline < r.info.output_height) {
    JSAMPROW row = out + stride * r.info.output_scanline;
    jpeg_read_scanlines(&r.info, &row, 1);
  }
  jpeg_finish_decompress(&r.info);
  return true;
}

/// Programs that write CMYK write it inverted, and say so by Adobe's marker.
void mix_ink(const std::vector<std::uint8_t>& ink, bool is_inverted, Raster& raster) {
  for (std::size_t i = 0; i < ink.size() / 4; ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      const int a = is_inverted ? ink[4 * i + c] : 255 - ink[4 * i + c];
      const int k = is_inverted ? ink[4 * i + 3] : 255 - ink[4 * i + 3];
      raster.rgb[3 * i + c] = static_cast<std::uint8_t>((a * k + 127) / 255);
    }
}

struct Writer {
  jpeg_compress_struct info;
  Failure failure;
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
};

bool write_rows(Writer& w, const Raster& raster, int quality) {
  if (setjmp(w.failure.jump)) return false;
  jpeg_create_compress(&w.info);
  jpeg_mem_dest(&w.info, &w.bytes, &w.size);
  w.info.image_width = static_cast<JDIMENSION>(raster.width);
  w.info.image_height = static_cast<JDIMENSION>(raster.height);
  w.info.input_components = 3;
  w.info.in_color_space = JCS_RGB;
  jpeg_set_defaults(&w.info);
  jpeg_set_quality(&w.info, quality, TRUE);
  w.info.optimize_coding = TRUE;
  // Neighbours in an atlas are other facets: colours at half the resolution would run over.
  w.info.comp_info[0].h_samp_factor = w.info.comp_info[0].v_samp_factor = 1;
  jpeg_start_compress(&w.info, TRUE);
  while (w.info.next_scanline < w.info.image_height) {
    JSAMPROW row = const_cast<std::uint8_t*>(raster.at(0, static_cast<int>(w.info.next_scanline)));
    jpeg_write_scanlines(&w.info, &row, 1);
  }
  jpeg_finish_compress(&w.info);
  return true;
}

}  // namespace

DecodedImage decode_jpeg(std::string_view bytes, std::size_t most_bytes) {
  Reader r{};
  r.info.err = &r.failure.base;
  set_up(r.failure);
  std::vector<std::uint8_t> ink;
  DecodedImage out;
  std::string cause;
  bool is_read = start(r, bytes);
  try {
    if (is_read) {
      check_size(r.info.image_width, r.info.image_height, most_bytes);
      out.raster =
          Raster(static_cast<int>(r.info.image_width), static_cast<int>(r.info.image_height));
      const bool is_ink = r.info.out_color_space == JCS_CMYK;
      if (is_ink) ink.resize(out.raster.rgb.size() / 3 * 4);
      is_read = read_rows(r, is_ink ? ink.data() : out.raster.rgb.data());
      if (is_ink) mix_ink(ink, r.info.saw_Adobe_marker != 0, out.raster);
      if (is_ink) out.remark = "is CMYK: its colours are converted without a profile";
    }
  } catch (const std::exception& e) {
    cause = e.what();
  }
  jpeg_destroy_decompress(&r.info);
  if (!cause.empty()) throw std::runtime_error(cause);
  if (!is_read) throw std::runtime_error(std::string("is damaged: ") + r.failure.cause);
  out.is_damaged = r.failure.warnings > 0;
  if (out.is_damaged) out.remark = std::string("is damaged: ") + r.failure.cause;
  return out;
}

std::string encode_jpeg(const Raster& raster, int quality) {
  Writer w{};
  w.info.err = &w.failure.base;
  set_up(w.failure);
  const bool is_written = write_rows(w, raster, quality);
  jpeg_destroy_compress(&w.info);
  std::string out;
  if (is_written) out.assign(reinterpret_cast<const char*>(w.bytes), w.size);
  std::free(w.bytes);
  if (!is_written) throw std::runtime_error(std::string("JPEG: ") + w.failure.cause);
  return out;
}

}  // namespace colod::codecs
