#include "image.h"

#include <algorithm>

#include "codecs.h"

namespace colod {

namespace codecs {

void check_size(std::size_t width, std::size_t height, std::size_t most_bytes) {
  if (width == 0 || height == 0) throw std::runtime_error("has no pixels");
  if (width > most_bytes / 4 / height)
    throw std::runtime_error("is " + std::to_string(width) + " x " + std::to_string(height) +
                             " pixels, more than --texture-memory allows");
}

Raster split_alpha(const std::vector<std::uint8_t>& rgba, int width, int height) {
  Raster out(width, height);
  std::uint8_t least = 255, most = 0;
  for (std::size_t i = 0; i < rgba.size() / 4; ++i) {
    std::copy_n(&rgba[4 * i], 3, &out.rgb[3 * i]);
    least = std::min(least, rgba[4 * i + 3]), most = std::max(most, rgba[4 * i + 3]);
  }
  if (least == 255 || most < 128) return out;
  for (std::size_t i = 0; i < rgba.size() / 4; ++i) out.alpha.push_back(rgba[4 * i + 3]);
  return out;
}

}  // namespace codecs

const char* mime_of(ImageFormat format) {
  switch (format) {
    case ImageFormat::kJpeg:
      return "image/jpeg";
    case ImageFormat::kWebp:
      return "image/webp";
    case ImageFormat::kPng:
      return "image/png";
    case ImageFormat::kKtx2:
      return "image/ktx2";
  }
  return "";
}

const char* extension_of(ImageFormat format) {
  switch (format) {
    case ImageFormat::kJpeg:
      return "jpg";
    case ImageFormat::kWebp:
      return "webp";
    case ImageFormat::kPng:
      return "png";
    case ImageFormat::kKtx2:
      return "ktx2";
  }
  return "";
}

DecodedImage decode_image(std::string_view bytes, std::size_t most_bytes) {
  if (bytes.empty()) throw std::runtime_error("is empty");
  if (bytes.starts_with("\xFF\xD8")) return codecs::decode_jpeg(bytes, most_bytes);
  if (bytes.starts_with("\x89PNG")) return codecs::decode_png(bytes, most_bytes);
  if (bytes.starts_with("RIFF") && bytes.substr(8).starts_with("WEBP"))
    return codecs::decode_webp(bytes, most_bytes);
  if (bytes.starts_with("\xABKTX 20"))
    throw std::runtime_error("is KTX2, which is not read: write it as JPEG, PNG or WebP");
  throw std::runtime_error("is no JPEG, PNG or WebP");
}

std::string encode_image(const Raster& raster, ImageFormat format, int quality) {
  switch (format) {
    case ImageFormat::kJpeg:
      return codecs::encode_jpeg(raster, quality);
    case ImageFormat::kWebp:
      return codecs::encode_webp(raster, quality);
    case ImageFormat::kKtx2:
      return codecs::encode_ktx2(raster, quality);
    case ImageFormat::kPng:
      break;
  }
  return codecs::encode_png(raster);
}

namespace {

/// Which pixels of a side of n the pixel i of half as many covers, and how much of each.
struct Span {
  int first, count;
  std::array<float, 3> weight;
};

std::vector<Span> spans(int n, int half) {
  std::vector<Span> out;
  const double step = static_cast<double>(n) / half;  // 1, 2 or a little more
  for (int i = 0; i < half; ++i) {
    const double begin = i * step, end = (i + 1) * step;
    Span s{static_cast<int>(begin + 1e-9), 0, {}};
    for (int p = s.first; p < n && p < end - 1e-9 && s.count < 3; ++p) {
      const double covered = std::min(end, p + 1.0) - std::max(begin, static_cast<double>(p));
      s.weight[s.count++] = static_cast<float>(covered / step);
    }
    out.push_back(s);
  }
  return out;
}

/// Where each pixel is the mean of four opaque ones: the same sums, in the same order.
Raster halve_even(const Raster& fine) {
  Raster out(fine.width / 2, fine.height / 2);
  std::uint8_t* to = out.rgb.data();
  for (int y = 0; y < out.height; ++y) {
    const std::uint8_t *upper = fine.at(0, 2 * y), *lower = fine.at(0, 2 * y + 1);
    for (int x = 0; x < out.width; ++x, upper += 6, lower += 6)
      for (int c = 0; c < 3; ++c)
        *to++ = to_srgb(0.25f * (to_linear(upper[c]) + to_linear(upper[c + 3]) +
                                 to_linear(lower[c]) + to_linear(lower[c + 3])));
  }
  return out;
}

}  // namespace

Raster halve(const Raster& fine) {
  if (fine.alpha.empty() && fine.width % 2 == 0 && fine.height % 2 == 0) return halve_even(fine);
  Raster out(std::max(1, fine.width / 2), std::max(1, fine.height / 2));
  if (!fine.alpha.empty()) out.alpha.resize(out.rgb.size() / 3);
  const std::vector<Span> columns = spans(fine.width, out.width);
  const std::vector<Span> rows = spans(fine.height, out.height);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      std::array<float, 3> sum{}, plain{};
      float opaque = 0;
      for (int j = 0; j < rows[y].count; ++j)
        for (int i = 0; i < columns[x].count; ++i) {
          const std::uint8_t* p = fine.at(columns[x].first + i, rows[y].first + j);
          const float weight = rows[y].weight[j] * columns[x].weight[i];
          const float alpha = fine.alpha_at(columns[x].first + i, rows[y].first + j);
          opaque += weight * alpha;
          for (int c = 0; c < 3; ++c) {
            plain[c] += weight * to_linear(p[c]);
            sum[c] += weight * alpha * to_linear(p[c]);
          }
        }
      const bool is_opaque = fine.alpha.empty() || !(opaque > 0);
      for (int c = 0; c < 3; ++c) out.at(x, y)[c] = to_srgb(is_opaque ? plain[c] : sum[c] / opaque);
      if (!out.alpha.empty())
        out.alpha[static_cast<std::size_t>(y) * out.width + x] =
            static_cast<std::uint8_t>(255 * opaque + 0.5f);
    }
  return out;
}

}  // namespace colod
