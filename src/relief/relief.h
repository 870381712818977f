// A melted mesh, as drones and planes give it, → roofs and upright walls.
#pragma once

#include <optional>
#include <vector>

#include "core/geometry.h"

namespace colod {

/// What a building is that no more than its relief is known of: planes over parts of its plan, and
/// upright walls where they step. Nothing of it is smaller than what noise can tell.
struct Relief {
  struct Part {
    Vec3 normal = Vec3::UnitZ();  ///< unit, outward
    double offset = 0;
    bool is_wall = false;
    /// Closed; counter-clockwise about the normal. A wall's are four corners each; a roof's may
    /// cross itself in places: what it winds around is covered.
    std::vector<std::vector<Vec3>> rings;
    std::vector<int> faces;  ///< of the mesh, rising
  };
  std::vector<Part> parts;
  std::vector<char> is_left_out;  ///< per face: ground, and what stands about on it
  double foot = 0;                ///< metres: where the walls end
  double noise = 0;               ///< metres: of its roofs
};

/// Metres: side of the cells of a mesh that is heights on a square grid, cut at its rim perhaps, as
/// scene/cloud_surface.h makes of an airborne cloud and a GIS writes surface models: no more is
/// known than roofs, and its walls are steps from cell to cell. 0: it is none. O(faces).
double raster_cell(const Mesh& mesh);

/// `mesh` in its local frame (read/frame.h). None: it has more than one level above another, or its
/// surface is known more exactly than this, which no raster is; or it shows no roof or no walls, as
/// terrain does. Deterministic.
std::optional<Relief> find_relief(const Mesh& mesh);

}  // namespace colod
