// Inside appearance: what differs between two colour pictures.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace colod {

/// Rows from the top.
struct ColorPicture {
  int width = 0, height = 0;
  std::vector<Eigen::Vector3f> linear;  ///< width × height, 0..1
  std::vector<float> coverage;          ///< width × height: the share of a pixel that is no sky
};

/// Sums over the pixels that either picture covers by half.
struct PictureErrors {
  std::int64_t pixels = 0, only_a = 0, only_b = 0;
  double squares = 0;  ///< of the differences of sRGB, 0..1, means of three channels
  double ssim = 0, flip = 0;

  void add(const PictureErrors& e);
};

/// Pictures of the same size; else an assertion fails. O(pixels).
PictureErrors compare_colors(const ColorPicture& a, const ColorPicture& b);

}  // namespace colod
