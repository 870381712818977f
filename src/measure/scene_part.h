// Beside the rooms: is this a building at all, or a patch that was cut out of a scene?
#pragma once

#include <string>
#include <vector>

#include "core/geometry.h"
#include "solid.h"

namespace colod {

/// What was measured to judge by. A roof alone has its tops on the source, flat tops or creases,
/// and walls and base that are invented, which is right: airborne clouds and roof models show no
/// more. Shares are of areas.
struct SceneFacts {
  bool is_open = false;       ///< the source has a border: nothing that is closed is ever refused
  double upright = 0;         ///< of the source: faces steeper than 60°
  double enclosed = 0;        ///< solid volume of the source by the layer's
  double thickness = 0;       ///< metres: twice the layer's volume by its area
  double extent = 0;          ///< metres: the root of the layer's area
  double reach = 0;           ///< metres from the source, beyond which the layer is invented
  double invented = 0;        ///< of the layer
  double invented_tops = 0;   ///< likewise, of what looks up
  double invented_sides = 0;  ///< likewise, of what is upright
  int tops = 0;               ///< planar pieces that look up …
  double gentle = 0;          ///< … of the length of edges between them: those under 30° …
  double concave = 0;         ///< … and those that are valleys
};

/// `source`: the surface of the input, a cloud's as outlines of its planes. `finest` is closed.
/// `solid`: m³ that the source encloses (lost_bodies.h). Of a closed source nothing else is
/// measured. In parallel.
SceneFacts survey_layer(const Surface& source, const PolygonMesh& finest, double solid);

/// How much of a layer is invented.
struct InventedShare {
  double share = 0;          ///< of all of its surface: 0.79 on an airborne cloud of a house, and
                             ///< more on one of a tower, which is right
  bool is_too_much = false;  ///< over half of the tops and 30 % of the sides: the layer stands
                             ///< elsewhere than its source
};

/// Of each layer, in parallel.
std::vector<InventedShare> invented_shares(const Surface& source, const std::vector<Mesh>& layers);

/// Why it looks like a part of a scene, as a clause; empty: it does not.
///   terrain: nothing upright, many planar pieces that meet gently, in valleys as often as in
///     ridges; a plane patch may be a flat roof, and passes;
///   a wall: all upright, nothing enclosed, the layer a thin slab behind it;
///   invention: most tops are invented and so are many sides; walls all round without a roof pass,
///     and so does a roof without walls.
/// What is closed always passes.
std::string judge_scene(const SceneFacts& facts);

}  // namespace colod
