// A made-up place: hills, roads, buildings, plants, cars and fences as one photogrammetry mesh in
// tiles, with its ground truth.
#pragma once

#include <memory>

#include "image/image.h"
#include "synth.h"

namespace colod {

struct SynthSceneOptions {
  int buildings = 100;
  std::uint64_t seed = 1;
  double edge = 0.6;    ///< metres, of the surface's mesh before flat places are thinned
  double texel = 0.1;   ///< metres
  double density = 10;  ///< points a m², of a cloud
};

/// What a place of the surface belongs to: numbers of the truth's files.
enum class SynthClass : std::uint8_t { kGround = 1, kBuilding = 2, kPlant = 3, kRest = 4 };

/// A square piece of the surface. Neighbours have the same vertices on their common border.
struct SynthTile {
  std::string name;                       ///< Tile_+003_+001
  Mesh mesh;                              ///< in the scene's frame, z up, whole millimetres
  std::vector<std::array<Vec2f, 3>> uvs;  ///< per face's corners; 0,0 is the picture's upper left
  Raster picture;
  std::vector<std::uint8_t> face_class;  ///< SynthClass, per face
  Raster truth;  ///< seen from straight above, one pixel a cell, the northernmost row first: red
                 ///< the SynthClass, green and blue the building's number from 1 on, 0: none
  Vec2 truth_corner = Vec2::Zero();  ///< the least x and y of the truth's cells
};

/// Of an airborne cloud, classes as LAS numbers them.
struct SynthPoint {
  Vec3 at;   ///< metres, in the scene's frame
  int kind;  ///< 1 what is none of these, 2 ground, 5 plants, 6 buildings
};

struct SynthSceneBuilding {
  std::string id, kind;                  ///< b0001; house, row_house, court, hall, office, shed
  std::uint64_t row = 0;                 ///< shared by the houses of one row; 0: stands free
  double height = 0;                     ///< metres over its foot
  std::vector<std::vector<Vec2>> rings;  ///< of its plan with eaves: the outer one, then the court
  SynthBuilding model;                   ///< clean, closed, in the scene's frame
};

/// Lists what stands where; tiles and buildings are made when they are asked for, so that memory
/// follows those alone. Thread-safe. The same options give the same bytes.
class SynthScene {
 public:
  /// Throws Error{kUsage} without a building.
  explicit SynthScene(const SynthSceneOptions& options);
  ~SynthScene();

  int tile_count() const;
  SynthTile tile(int index) const;
  /// The same piece as a laser in an aeroplane sees it, straight from above: noise of 3 cm, three
  /// of ten beams through leaves down to the ground.
  std::vector<SynthPoint> points(int tile) const;
  int building_count() const;
  SynthSceneBuilding building(int index) const;
  /// In x and y.
  Box box() const;
  /// Metres a side of the truth's cells.
  double truth_cell() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace colod
