// The numbers of the rules segments.*.
// The registry in room `rules` says what each does and why it has its value.
#pragma once

#include <cstddef>
#include <cstdint>

namespace colod::parameters::segments {

constexpr std::int64_t kLeastVoxels = 20;
constexpr double kSmallRatio = 0.1;  // of the largest plane: the most a plane of an alcove may be
constexpr double kFrontShare = 0.4;  // of a plane's area in front of which an alcove must lie
constexpr double kDetailShare = 0.005;        // of the enclosed voxels: the most a detail may have
constexpr double kDetailContact = 0.2;        // of the surface of one of two details that are one
constexpr double kMergeOverlap = 0.5;         // the paper's
constexpr double kSteps[] = {1.0, 1.7, 2.4};  // voxels
constexpr double kFacing = -0.7;              // cosine between normals that face each other
constexpr double kParallel = 0.94;            // cosine (20°) up to which normals are not parallel
constexpr std::size_t kLeastPlanes = 3;
constexpr double kMostOthers = 2.0;    // of the element's area: planes of others in its segment
constexpr double kSameElement = 0.5;   // of its area that an earlier one has taken: it is that one
constexpr int kMostTogether = 6;       // segments of a set: more are never dropped together
constexpr double kOutlineShare = 0.3;  // of the fidelity

}  // namespace colod::parameters::segments
