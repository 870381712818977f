// A tileset as clients stream it: its tree with all contents decoded, the rule by which they choose
// tiles, and what buildings show by it.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "core/geometry.h"

namespace colod::bench {

/// One row of a content's property table.
struct Part {
  std::string name;         ///< a building, or those that a stand-in box stands for
  int coarsest_layer = -1;  ///< layers from here …
  int layer = -1;           ///< … to here share this mesh; −1: a stand-in box
};

struct Tile {
  std::string uri;            ///< of the content, relative to the tileset's folder
  bool is_external = false;   ///< the content is a tileset, whose root is the only child
  int above = -1;             ///< the nearest tile above that can be drawn; −1: none
  std::vector<int> children;  ///< indices into Tileset::tiles
  std::size_t frame = 0;      ///< index into Tileset::frames
  Box box;                    ///< in its frame, about all that is below
  double error = 0;           ///< geometricError, metres
  std::size_t bytes = 0;      ///< of the content's file
  std::vector<Part> parts;
  std::vector<int> buildings;  ///< that the content and all below show, rising
  Mesh mesh;                   ///< in the tileset's frame
};

struct Place {
  std::string name;
  Box box;  ///< of its finest mesh, in the tileset's frame
};

struct Tileset {
  Vec3 offset = Vec3::Zero();           ///< from the tileset's frame to the input's coordinates
  double limit = 16;                    ///< pixels: the screen-space error that it is made for
  double bound = 14;                    ///< pixels: what a switch may show, by --visual-error
  std::vector<Eigen::Affine3d> frames;  ///< to the tileset's frame; the first is that frame itself
  std::vector<Tile> tiles;              ///< the root first, parents before children
  std::vector<Place> buildings;
  std::vector<std::string> findings;  ///< of `colod info --check` on the contents, a line each
};

/// With external tilesets. A transform of the root, which leads to the Earth, is left out. Throws
/// Error where a file is missing or not as colod writes it.
Tileset read_tileset(const std::string& path);

/// Sets the errors that colod gave before levels switched by what is seen: `limit` / 2 pixels times
/// the one-sided Hausdorff distance to the source that report.json tells for a building's layer,
/// never less than that of a finer one. Stand-in boxes keep theirs, raised above what is below. A
/// tile that shows what the one above it shows is passed: there was none.
void apply_rule_before(Tileset& tileset, const std::string& report);

/// A place to look from, in the tileset's frame.
struct Stop {
  Vec3 eye = Vec3::Zero(), target = Vec3::Zero();
};

struct Camera {
  Vec3 eye, right, up, forward;  ///< axes of length 1
  double tan_x, tan_y;           ///< of half the angles of view
};

/// The horizon is level. `target` must not lie right above or below the eye.
Camera camera_at(const Stop& stop, double fovy_deg, double aspect);

/// To the nearest point of the tile's box, 0 inside.
double distance_to(const Tileset& tileset, const Tile& tile, const Vec3& eye);

struct Selection {
  std::vector<int> drawn;   ///< rising
  std::vector<int> loaded;  ///< rising: drawn, replaced, and the siblings that REPLACE waits for
};

/// What clients draw on `lines` lines: a tile in view is replaced by its children where its error
/// covers more than `limit` pixels at the nearest point of its box.
Selection select_tiles(const Tileset& tileset, const Camera& camera, int lines, double limit);

/// Whether none of the finest tiles below is in view, so that nothing of the tile is seen. CesiumJS
/// draws such tiles where it would replace them.
bool is_beside_view(const Tileset& tileset, const Tile& tile, const Camera& camera);

/// What one building is shown by.
struct Shown {
  int building = -1;        ///< index into Tileset::buildings
  int coarsest_layer = -1;  ///< as in Part; both −1: a stand-in box
  int layer = -1;
  double error = 0;          ///< of the tile that shows it
  double distance = 0;       ///< from the eye to the building's own box
  double decided_at = 0;     ///< to the box of the tile that this level replaced; 0: the root's own
  double decided_error = 0;  ///< of that tile
};

std::vector<Shown> shown_by(const Tileset& tileset, int tile, const std::vector<Part>& parts,
                            const Vec3& eye);

/// Buildings that show a coarser level than some building farther away, though they have a finer
/// one. Tiles are replaced as a whole, at the nearest point of their boxes. So it is tolerated, as
/// what boxes bring about, when the farther building's level replaced a tile whose box is no
/// farther than the nearer building, and whose error is no larger (but for the hundredth by which
/// errors rise up the tree) than that of the tile which the nearer building waits for.
struct Disorder {
  int layers = 0;     ///< buildings on a layer of theirs
  int stand_ins = 0;  ///< buildings behind a stand-in box
  int tolerated = 0;  ///< buildings that boxes alone put out of order
  std::string worst;  ///< the nearest of the first kind, with the one behind it; empty: none
};
Disorder find_disorder(const Tileset& tileset, const std::vector<Shown>& shown);

}  // namespace colod::bench
