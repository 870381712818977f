// Based on: IEC 61966-2-1 (sRGB).
#include "appearance.h"

#include <algorithm>
#include <cmath>

namespace colod {

namespace {

template <typename T>
void pick_from(std::vector<T>& values, std::span<const int> faces) {
  if (values.empty()) return;
  std::vector<T> picked;
  picked.reserve(faces.size());
  for (const int f : faces) picked.push_back(values[static_cast<std::size_t>(f)]);
  values = std::move(picked);
}

double decode(double s) { return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4); }

std::array<float, 256> make_decoded() {
  std::array<float, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i)
    table[i] = static_cast<float>(decode(static_cast<double>(i) / 255));
  return table;
}

/// Entry i: from which linear value on a component is i rather than i − 1.
std::array<float, 256> make_borders() {
  std::array<float, 256> table{};
  for (std::size_t i = 1; i < table.size(); ++i)
    table[i] = static_cast<float>(decode((static_cast<double>(i) - 0.5) / 255));
  return table;
}

constexpr std::size_t kSteps = 4096;

/// Entry i: the component of the linear value i / kSteps; those of greater ones are few steps on.
std::array<std::uint8_t, kSteps> make_starts(const std::array<float, 256>& borders) {
  std::array<std::uint8_t, kSteps> starts{};
  for (std::size_t i = 0; i < kSteps; ++i) {
    const float linear = static_cast<float>(i) / kSteps;
    const auto above = std::upper_bound(borders.begin() + 1, borders.end(), linear);
    starts[i] = static_cast<std::uint8_t>(above - borders.begin() - 1);
  }
  return starts;
}

}  // namespace

void Appearance::pick(std::span<const int> faces) {
  pick_from(face_material, faces);
  pick_from(uvs, faces);
  pick_from(colors, faces);
}

float to_linear(std::uint8_t srgb) {
  static const std::array<float, 256> table = make_decoded();
  return table[srgb];
}

std::uint8_t to_srgb(float linear) {
  static const std::array<float, 256> borders = make_borders();
  static const std::array<std::uint8_t, kSteps> starts = make_starts(borders);
  if (!(linear > 0)) return 0;
  if (!(linear < 1)) return 255;
  std::size_t code = starts[static_cast<std::size_t>(linear * kSteps)];
  while (code < 255 && borders[code + 1] <= linear) ++code;
  return static_cast<std::uint8_t>(code);
}

}  // namespace colod
