// Based on: own work.
// Differs: paper rules measure, but refuse nothing.
// Notation: none.
#include "losses.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "core/flat.h"
#include "measure/lost_bodies.h"
#include "measure/scene_part.h"
#include "relief/relief.h"
#include "scene/left_out.h"

namespace colod {
namespace {

constexpr double kLevel = 0.5;  // upright component of a roof's normal at least

/// Metres that the steps of a grid of heights stand off straight walls: the diagonal of a cell. 0:
/// the source is none.
double grain_of(const Mesh& source) { return std::numbers::sqrt2 * raster_cell(source); }

/// What may be asked for of a cloud. Its outlines of steep planes are guesses from few points: of
/// 72 airborne clouds they made most of what seemed to be missed.
Mesh roofs_of(Mesh surface) {
  std::erase_if(surface.faces, [&](const Face& f) {
    const Vec3 cross = face_cross(surface, f);
    return !(std::abs(cross.z()) > kLevel * cross.norm());
  });
  return surface;
}

std::string percent(double share) {
  char text[16];
  std::snprintf(text, sizeof text, "%.*f %%", share < 0.0995 ? 1 : 0, 100 * share);
  return text;
}

std::string describe(const LeftOut& l) {
  char text[280];
  switch (l.reason) {
    case LeftOut::Reason::kLost:
      if (l.volume < 0) {
        std::snprintf(
            text, sizeof text,
            "%.3g m2, %s of the surface, is on no layer: up to %.1f m from the finest one; "
            "is it one building? --split component meshes pieces one by one, in a place "
            "--footprints parts them",
            l.area, percent(l.share).c_str(), l.farthest);
        return text;
      }
      std::snprintf(
          text, sizeof text,
          "a body of %.3g m3, %s of the volume, is on no layer: %.3g m2 of surface, up to "
          "%.1f m from the finest one; --split component meshes bodies one by one, in a place "
          "--footprints parts them",
          l.volume, percent(l.volume_share).c_str(), l.area, l.farthest);
      return text;
    case LeftOut::Reason::kGround:
      std::snprintf(text, sizeof text,
                    "%s of the surface is taken for ground and what stands about on it, and left "
                    "out: is this a piece of a scene, or its footprint too large?",
                    percent(l.share).c_str());
      return text;
    default:
      std::snprintf(text, sizeof text,
                    "%s of the source in pieces afloat is left out, up to %.1f m away; --split "
                    "component keeps pieces as buildings",
                    percent(std::max(l.share, l.volume_share)).c_str(), l.farthest);
      return text;
  }
}

std::string describe_ragged(const Looks& looks) {
  char text[320];
  std::snprintf(
      text, sizeof text,
      "%.3g m2 of its finest layer stand where the source shows nothing or are thin sheets, beside "
      "%.3g m2 of walls: is this a building, and whole? --scene scene takes a file for a place, "
      "where --footprints tells what buildings are",
      looks.ragged, looks.wall_area);
  return text;
}

}  // namespace

Surface surface_of(const Building& b) {
  if (!b.source.is_mesh()) return outline_soup(b.planes.planes);
  Mesh surface{b.source.mesh.vertices, {}};
  for (std::size_t f = 0; f < b.source.mesh.faces.size(); ++f)
    if (const int p = b.planes.plane_of_item[f]; p != kFloater && p != kAround)
      surface.faces.push_back(b.source.mesh.faces[f]);
  return surface;
}

void forget_losses(Building& b) {
  std::erase_if(b.left_out, [](const LeftOut& l) { return l.reason == LeftOut::Reason::kLost; });
}

void weigh_finest(const Surface& source, Building& b) {
  forget_losses(b);
  if (b.layers.empty() || !b.layers.back().failure.empty()) return;
  const Mesh finest = b.layers.back().mesh.mesh();
  const Holdings holdings = b.source.is_mesh()
                                ? weigh_layer(source, finest, grain_of(b.source.mesh))
                                : weigh_layer(roofs_of(source.mesh), finest);
  b.solid = holdings.solid;
  double whole = holdings.whole;
  for (const LeftOut& l : b.left_out) whole += std::max(0.0, l.volume);
  for (LeftOut& l : b.left_out)
    if (l.volume >= 0 && whole > 0) l.volume_share = l.volume / whole;
  double of_input = 1;  // the surface that was weighed
  for (const LeftOut& l : b.left_out) of_input -= l.share;
  for (LeftOut l : holdings.lost) {
    l.share *= std::max(0.0, of_input);
    if (l.volume >= 0) l.volume_share = l.volume / whole;
    b.left_out.push_back(l);
  }
}

std::string judge_building(const Surface& source, const Building& b) {
  if (b.layers.empty() || !b.layers.back().failure.empty()) return "";
  const std::string why = judge_scene(survey_layer(source, b.layers.back().mesh, b.solid));
  if (why.empty()) return "";
  return b.source.name + ": this looks like a part of a scene: " + why +
         (b.source.is_found ? "; it is left as the source shows it"
                            : "; nothing is written for it") +
         ", --rules paper meshes it all the same";
}

std::vector<std::string> loss_warnings(const Building& b) {
  std::vector<const LeftOut*> heavy;
  for (const LeftOut& l : b.left_out)
    if (warning_weight(l) > 0) heavy.push_back(&l);
  std::stable_sort(heavy.begin(), heavy.end(), [](const LeftOut* x, const LeftOut* y) {
    return warning_weight(*x) > warning_weight(*y);
  });
  std::vector<std::string> warnings;
  if (b.is_ragged()) warnings.push_back(describe_ragged(b.layers.back().looks));
  for (const LeftOut* l : heavy) warnings.push_back(describe(*l));
  return warnings;
}

}  // namespace colod
