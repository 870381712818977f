// Based on: ray casting; the measures are those of picture_errors.cpp.
// Differs: the same under both rules.
#include "appearance.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "core/rays.h"
#include "image/look_sampler.h"
#include "picture_errors.h"
#include "switching_views.h"

namespace colod {
namespace {

constexpr int kDirections = 24;
constexpr std::array<double, 3> kViewElevations_deg = {10, 35, 60};
constexpr int kAcrossPixel = 3;     // along a pixel's side
constexpr int kSkyPixels = 12;      // pixels of sky: filters of pictures reach so far
constexpr double kMostSide = 4096;  // pixels
constexpr double kGrazing = 0.1;    // cosine: what is seen flatter is as sharp as this
const Light kSkyLight = Light::Constant(0.2f);

/// A mesh that rays find, with its look.
struct Model {
  const Mesh& mesh;
  const LookSampler& look;
  RayScene rays;

  Model(const Mesh& m, const LookSampler& l) : mesh(m), look(l), rays(m) {}
};

/// What a ray sees; false: sky, or a surface's back.
bool look_along(const Model& model, const Vec3& from, const FarView& view, Lens& lens,
                Light& light) {
  const RayHit hit = model.rays.first_hit(from, view.forward);
  if (!hit || hit.is_inside) return false;
  const Vec3 turn = face_cross(model.mesh, model.mesh.faces[hit.triangle]);
  const double facing = std::max(kGrazing, -turn.dot(view.forward) / std::max(turn.norm(), 1e-300));
  light = model.look.sample(hit.triangle, from + hit.distance * view.forward,
                            view.sample / std::sqrt(facing), lens);
  return true;
}

ColorPicture draw(const Model& model, const FarView& view, double before) {
  ColorPicture out{view.width / kAcrossPixel, view.height / kAcrossPixel, {}, {}};
  const auto count = static_cast<std::size_t>(out.width) * out.height;
  out.linear.resize(count), out.coverage.resize(count);
  constexpr float kShare = 1.0f / (kAcrossPixel * kAcrossPixel);
  parallel_for(static_cast<std::size_t>(out.height), [&](std::size_t row) {
    Lens lens(model.look.cache());
    for (int x = 0; x < out.width; ++x) {
      Light sum = Light::Zero();
      int seen = 0;
      for (int k = 0; k < kAcrossPixel * kAcrossPixel; ++k) {
        const double u = x * kAcrossPixel + k % kAcrossPixel;
        const double v = static_cast<double>(row) * kAcrossPixel + k / kAcrossPixel;
        const Vec3 from = view.corner + view.sample * (u * view.right - v * view.up);
        Light light = kSkyLight;
        seen += look_along(model, from - before * view.forward, view, lens, light);
        sum += light;
      }
      out.linear[row * out.width + x] = kShare * sum;
      out.coverage[row * out.width + x] = kShare * static_cast<float>(seen);
    }
  });
  return out;
}

}  // namespace

AppearanceDifference compare_appearance(const Mesh& reference, const LookSampler& reference_look,
                                        const Mesh& model, const LookSampler& model_look,
                                        double gsd) {
  const Model a(reference, reference_look), b(model, model_look);
  Box box = bounding_box(reference.vertices);
  box.extend(bounding_box(model.vertices));
  if (box.diagonal() > (kMostSide - 2 * kSkyPixels) * gsd)
    throw Error(Stage::kUsage, "--gsd",
                std::to_string(gsd) + " m makes pictures of more than " +
                    std::to_string(static_cast<int>(kMostSide)) + " pixels a side: give more");
  Box frame = box;
  frame.min -= Vec3::Constant(kSkyPixels * gsd), frame.max += Vec3::Constant(kSkyPixels * gsd);
  PictureErrors sum;
  for (const Vec3& direction : ring_directions(kDirections, kViewElevations_deg)) {
    const FarView view = far_view(frame, direction, gsd / kAcrossPixel);
    const double before = 2 * frame.diagonal();
    sum.add(compare_colors(draw(a, view, before), draw(b, view, before)));
  }
  const double pixels = static_cast<double>(std::max<std::int64_t>(1, sum.pixels));
  AppearanceDifference d{kDirections, gsd, sum.pixels};
  d.psnr = -10 * std::log10(sum.squares / pixels);
  d.ssim = sum.ssim / pixels, d.flip = sum.flip / pixels;
  d.only_reference = static_cast<double>(sum.only_a) / pixels;
  d.only_model = static_cast<double>(sum.only_b) / pixels;
  return d;
}

}  // namespace colod
