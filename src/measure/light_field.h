// How alike two meshes look: the light field distance of Chen, Tian, Shen, Ouhyoung, "On visual
// similarity based 3D model retrieval", Computer Graphics Forum 22(3), 2003.
//
// As there: 10 light fields a model; a light field is 10 silhouettes of 256 × 256 pixels, one from
// each pair of opposite vertices of a regular dodecahedron (orthographic, so opposite ones are each
// other's mirror image); 35 Zernike moments and 10 Fourier coefficients a silhouette, 8 bits each;
// the distance of two models is the sum of |differences| over the 10 × 45 numbers of two light
// fields, least over the 60 rotations of the dodecahedron and over all 10 × 10 pairs of light
// fields, which makes (10 · 9 + 1) · 60 = 5,460 relative rotations.
//
// What the paper leaves open is fixed here: the ten orientations (spread evenly, the same for every
// model), the moments (order 1 to 10, magnitude of the mean of the Zernike polynomial over the
// silhouette, about its centroid, out to its farthest pixel), the Fourier coefficients (of the
// distance from the centroid along the outer contour, over the 0th), and the 8 bits (256 steps over
// 0..1 for moments, over 0..0.5 for Fourier coefficients, as in the authors' program). 0: no
// difference is seen; largest possible: 10 · 45 · 255 = 114,750; a box against a sphere is some
// thousands. Small details hardly count: this is a measure of the outline from all sides.
//
// That program, from which most published numbers are, takes 35 coefficients of the angular radial
// transform for the moments, adds circularity and eccentricity, and counts Fourier coefficients and
// circularity twice: ProgramLightFields, to be set beside those numbers.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/geometry.h"

namespace colod {

constexpr int kSilhouetteSize = 256;  ///< pixels a side
constexpr int kZernikeCount = 35, kFourierCount = 10;
constexpr int kViewCount = 10;        ///< silhouettes a light field
constexpr int kLightFieldCount = 10;  ///< light fields a model

/// kSilhouetteSize² pixels in rows, 1: covered.
using Silhouette = std::vector<char>;
using ViewDescriptor = std::array<std::uint8_t, kZernikeCount + kFourierCount>;

constexpr int kRadialTransformCount = 35;
constexpr int kProgramCount = kRadialTransformCount + kFourierCount + 2;
/// Radial transform, Fourier coefficients, circularity, eccentricity.
using ProgramDescriptor = std::array<std::uint8_t, kProgramCount>;

struct ProgramLightFields {
  std::array<std::array<ProgramDescriptor, kViewCount>, kLightFieldCount> views{};
};

struct LightFields {
  std::array<std::array<ViewDescriptor, kViewCount>, kLightFieldCount> views{};
};

/// 0..1, by order n = 1..10, then m = n mod 2 .. n; all zero when nothing is covered. Invariant to
/// rotation, place and size up to the pixels; (1, 1) is 0 because the centroid is the centre.
std::array<double, kZernikeCount> zernike_magnitudes(const Silhouette& silhouette);
/// 0..1: |F_k| / |F_0|, k = 1..10, of the outer contour of the largest connected part.
std::array<double, kFourierCount> fourier_magnitudes(const Silhouette& silhouette);

/// 100 silhouettes by ray casting, centred and scaled each model by itself. Needs a finite face
/// with an area, else Error. Deterministic, runs in parallel: about 0.5 s on two cores.
LightFields describe_light_fields(const Mesh& mesh);
int light_field_distance(const LightFields& a, const LightFields& b);

/// Likewise, as the authors' program describes and compares them (light_field_program.cpp says what
/// differs).
ProgramLightFields describe_as_program(const Mesh& mesh);
int light_field_distance(const ProgramLightFields& a, const ProgramLightFields& b);

/// The 60 rotations that map the dodecahedron of the views onto itself.
std::vector<Eigen::Matrix3d> dodecahedron_rotations();

}  // namespace colod
