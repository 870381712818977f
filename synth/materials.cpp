// *Based on:* own work.
//
// *Differs:* no --rules here.
//
// *Notation:* along, up: on a wall or a roof, in metres.
#include "materials.h"

#include <algorithm>
#include <array>

namespace colod::synth {
namespace {

constexpr double kDot = 0.12;      // metres, of the word's letters
constexpr double kWordEvery = 9;   // metres along a wall
constexpr double kWordFoot = 1.2;  // metres above the house's foot

/// COLOD, seven rows of five dots a letter, highest row first.
constexpr std::array<std::array<int, 7>, 5> kWord = {{{14, 17, 16, 16, 16, 17, 14},
                                                      {14, 17, 17, 17, 17, 17, 14},
                                                      {16, 16, 16, 16, 16, 16, 31},
                                                      {14, 17, 17, 17, 17, 17, 14},
                                                      {30, 17, 17, 17, 17, 17, 30}}};

/// Rows of stones, every other one shifted by half a stone, with joints between them.
Light courses(double along, double up, double length, double height, const Light& stone,
              const Light& joint, long seed) {
  const long row = cell(up / height);
  const double shifted = along / length + (row % 2 ? 0.5 : 0);
  const double in_stone = shifted - std::floor(shifted),
               in_row = up / height - std::floor(up / height);
  if (in_stone * length < 0.012 || in_row * height < 0.012) return joint;
  return (0.75 + 0.5 * noise(cell(shifted), row, seed)) * stone;
}

bool is_in_word(double along, double up) {
  const double x = along - kWordEvery * std::floor(along / kWordEvery);
  const long column = cell(x / kDot), row = 6 - cell((up - kWordFoot) / kDot);
  if (row < 0 || row > 6 || column < 0 || column >= 30 || column % 6 == 5) return false;
  return kWord[static_cast<std::size_t>(column / 6)][static_cast<std::size_t>(row)] >>
             (4 - column % 6) &
         1;
}

Light green(const Vec3& p) {
  return (0.7 + 0.6 * noise(cell(4 * p.x()), cell(4 * p.y()), cell(4 * p.z()))) *
         Light(0.1, 0.14, 0.04);
}

}  // namespace

double noise(long a, long b, long c) {
  std::uint64_t h = static_cast<std::uint64_t>(a) * 0x9E3779B97F4A7C15ULL ^
                    static_cast<std::uint64_t>(b) * 0xC2B2AE3D27D4EB4FULL ^
                    static_cast<std::uint64_t>(c) * 0x165667B19E3779F9ULL;
  h = (h ^ h >> 29) * 0xBF58476D1CE4E5B9ULL;
  return static_cast<double>((h ^ h >> 32) & 0xFFFF) / 65535;
}

double smooth_noise(const Vec3& p, long seed) {
  const std::array<long, 3> base = {cell(p.x()), cell(p.y()), cell(p.z())};
  double sum = 0;
  for (int c = 0; c < 8; ++c) {
    double weight = 1;
    std::array<long, 3> at = base;
    for (int k = 0; k < 3; ++k) {
      const double t = p[k] - static_cast<double>(base[k]);
      weight *= c >> k & 1 ? t : 1 - t;
      at[k] += c >> k & 1;
    }
    sum += weight * noise(at[0], at[1], 31 * at[2] + seed);
  }
  return sum;
}

Light Paint::at(const Spot& spot, const Vec3& p) const {
  const Light sky = (0.7 + 0.3 * spot.normal.z()) * Light::Ones();
  const Light own = spot.is_green ? green(p) : surface(p, spot.normal, spot.kind);
  return own.cwiseProduct(sky).cwiseMin(1).cwiseMax(0);
}

Light Paint::surface(const Vec3& p, const Vec3& normal, ElementKind kind) const {
  const double up = p.z() - foot_;
  if (kind == ElementKind::kWindow) return glass(up);
  if (kind == ElementKind::kDoor) return wood(p, normal);
  if (std::abs(normal.z()) > 0.9 && normal.z() < 0) return {0.25, 0.25, 0.24};
  if (normal.z() > 0.35) return roof(p, normal);
  const Vec3 right = Vec3::UnitZ().cross(normal).normalized();
  const double along = right.dot(p);
  if (is_in_word(along, up)) return {0.03, 0.1, 0.5};
  if (noise(seed_, 1, 0) < 0.5)
    return courses(along, up, 0.5, 0.15, {0.42, 0.12, 0.07}, {0.55, 0.52, 0.48}, seed_);
  const double grain = noise(cell(along * 8), cell(up * 8), seed_);
  return (0.85 + 0.2 * grain) * Light(0.7, 0.6 + 0.2 * noise(seed_, 2, 0), 0.4);
}

Light Paint::glass(double up) const {
  const double in_storey = up / 3 - std::floor(up / 3);
  return (0.4 + 0.8 * in_storey) * Light(0.12, 0.22, 0.35);
}

Light Paint::wood(const Vec3& p, const Vec3& normal) const {
  const double along = Vec3::UnitZ().cross(normal).dot(p);
  return (0.6 + 0.4 * noise(cell(along / 0.12), 5, seed_)) * Light(0.2, 0.1, 0.04);
}

Light Paint::roof(const Vec3& p, const Vec3& normal) const {
  const Vec3 level = Vec3::UnitZ().cross(normal);
  const Vec3 along = level.norm() > 0.05 ? Vec3(level.normalized()) : Vec3(Vec3::UnitX());
  const Light tile = noise(seed_, 3, 0) < 0.6 ? Light(0.4, 0.1, 0.05) : Light(0.14, 0.15, 0.17);
  return courses(along.dot(p), normal.cross(along).dot(p), 0.4, 0.6, tile, 0.3 * tile, seed_);
}

}  // namespace colod::synth
