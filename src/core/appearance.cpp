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

}  // namespace

void Appearance::pick(std::span<const int> faces) {
  pick_from(face_material, faces);
  pick_from(uvs, faces);
  pick_from(colors, faces);
}

SrgbTable::SrgbTable() {
  for (std::size_t i = 0; i < linear_.size(); ++i) {
    linear_[i] = static_cast<float>(decode(static_cast<double>(i) / 255));
    borders_[i] = i == 0 ? 0 : static_cast<float>(decode((static_cast<double>(i) - 0.5) / 255));
  }
  for (std::size_t i = 0; i < kSteps; ++i) {
    const float linear = static_cast<float>(i) / kSteps;
    const auto above = std::upper_bound(borders_.begin() + 1, borders_.end(), linear);
    starts_[i] = static_cast<std::uint8_t>(above - borders_.begin() - 1);
  }
}

const SrgbTable kSrgb;

}  // namespace colod
