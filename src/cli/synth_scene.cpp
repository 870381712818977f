#include "synth_scene.h"

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "core/error.h"
#include "core/parallel.h"
#include "exporters/files.h"

namespace colod::cli {
namespace {

/// What is known of the tiles after they are written.
struct TileNote {
  std::string name;
  Box box;
  Vec2 corner = Vec2::Zero();
  std::size_t faces = 0;
};

TileNote note_of(const SynthTile& tile) {
  return {tile.name, bounding_box(tile.mesh.vertices), tile.truth_corner, tile.mesh.faces.size()};
}

void write_truth(const SynthTile& tile, const std::string& out) {
  write_file(out,
             {"tiles/" + tile.name + ".png", encode_image(tile.truth, ImageFormat::kPng, 100)});
  write_file(out, {"tiles/" + tile.name + ".faces",
                   std::string(tile.face_class.begin(), tile.face_class.end())});
}

void write_context_capture(const SynthTile& tile, const std::string& out) {
  const std::string folder = "Data/" + tile.name + "/", image = tile.name + "_0.jpg";
  ObjCount count;
  write_file(out, {folder + tile.name + ".obj",
                   "mtllib " + tile.name + ".mtl\n" + tile_obj(tile, tile.name, count)});
  write_file(out, {folder + tile.name + ".mtl", tile_mtl(tile.name, image)});
  write_file(out, {folder + image, tile_jpeg(tile)});
}

/// One OBJ that grows tile by tile, under another name until it is whole.
class OdmWriter {
 public:
  explicit OdmWriter(const std::string& out) : folder_(out + "/odm_texturing") {
    make_folder(folder_);
    obj_.open(folder_ + "/" + kName + ".obj.part", std::ios::binary);
    obj_ << "mtllib " << kName << ".mtl\n";
  }

  void add(const SynthTile& tile) {
    char number[16];
    std::snprintf(number, sizeof number, "%04d", tiles_++);
    const std::string material = "material" + std::string(number);
    const std::string image = std::string(kName) + "_" + material + "_map_Kd.jpg";
    obj_ << tile_obj(tile, material, count_);
    mtl_ += tile_mtl(material, image);
    write_file(folder_, {image, tile_jpeg(tile)});
  }

  void finish() {
    const std::string path = folder_ + "/" + kName + ".obj";
    obj_.close();
    std::error_code error;
    if (obj_) std::filesystem::rename(path + ".part", path, error);
    if (!obj_ || error) throw Error(Stage::kOutput, path, "cannot be written");
    write_file(folder_, {std::string(kName) + ".mtl", mtl_});
  }

 private:
  static constexpr const char* kName = "odm_textured_model_geo";

  std::string folder_, mtl_;
  std::ofstream obj_;
  ObjCount count_;
  int tiles_ = 0;
};

/// One LAS that grows tile by tile, under another name until it is whole.
class LasWriter {
 public:
  explicit LasWriter(const std::string& out) : path_(out + "/scene.las") {
    make_folder(out);
    las_.open(path_ + ".part", std::ios::binary);
    las_ << las_header(0, {});
  }

  void add(const std::vector<SynthPoint>& points) {
    las_ << las_points(points);
    for (const SynthPoint& p : points) box_.extend(p.at);
    count_ += points.size();
  }

  void finish() {
    las_.seekp(0);
    las_ << las_header(count_, box_);
    las_.close();
    std::error_code error;
    if (las_) std::filesystem::rename(path_ + ".part", path_, error);
    if (!las_ || error) throw Error(Stage::kOutput, path_, "cannot be written");
  }

 private:
  std::string path_;
  std::ofstream las_;
  Box box_;
  std::size_t count_ = 0;
};

/// A few tiles at a time, in order.
std::vector<TileNote> write_tiles(const SynthScene& scene, SynthLayout layout,
                                  const std::string& out, const std::string& truth) {
  std::unique_ptr<OdmWriter> odm;
  std::unique_ptr<LasWriter> las;
  if (layout == SynthLayout::kOdm) odm = std::make_unique<OdmWriter>(out);
  if (layout == SynthLayout::kLas) las = std::make_unique<LasWriter>(out);
  const std::size_t all = scene.tile_count(), batch = thread_count();
  std::vector<TileNote> notes;
  for (std::size_t first = 0; first < all; first += batch) {
    std::vector<SynthTile> tiles(std::min(batch, all - first));
    std::vector<std::vector<SynthPoint>> points(tiles.size());
    parallel_for(tiles.size(), [&](std::size_t i) {
      SynthTile& tile = tiles[i] = scene.tile(static_cast<int>(first + i));
      write_truth(tile, truth);
      if (layout == SynthLayout::kObj) write_context_capture(tile, out);
      if (layout == SynthLayout::k3dTiles)
        write_file(out, {"Tiles/" + tile.name + ".b3dm", tile_b3dm(tile)});
      if (las) points[i] = scene.points(static_cast<int>(first + i));
    });
    for (const auto& own : points)
      if (las) las->add(own);
    for (const SynthTile& tile : tiles) {
      if (odm) odm->add(tile);
      notes.push_back(note_of(tile));
    }
  }
  if (odm) odm->finish();
  if (las) las->finish();
  return notes;
}

void write_buildings(const SynthScene& scene, const std::string& out) {
  std::vector<SynthSceneBuilding> buildings(scene.building_count());
  parallel_for(buildings.size(), [&](std::size_t i) {
    buildings[i] = scene.building(static_cast<int>(i));
    write_file(out, {"truth/clean/" + buildings[i].id + ".obj", synth_obj(buildings[i].model)});
    buildings[i].model = {};
  });
  write_file(out, {"truth/footprints.geojson", scene_footprints(scene, buildings)});
}

}  // namespace

void write_synth_scene(const SynthSceneOptions& options, SynthLayout layout,
                       const std::string& out) {
  const SynthScene scene(options);
  const std::vector<TileNote> notes = write_tiles(scene, layout, out + "/scene", out + "/truth");
  write_buildings(scene, out);
  std::vector<std::string> names;
  std::vector<Vec2> corners;
  std::vector<Box> boxes;
  std::size_t faces = 0;
  for (const TileNote& n : notes) {
    names.push_back(n.name), corners.push_back(n.corner), boxes.push_back(n.box);
    faces += n.faces;
  }
  write_file(out, {"truth/scene.json", scene_truth_json(scene, options, names, corners)});
  if (layout == SynthLayout::k3dTiles)
    write_file(out + "/scene", {"tileset.json", tileset_json(names, boxes)});
  std::fprintf(
      stderr,
      "colod: a scene of %d buildings, %zu tiles and %zu faces written to %s, its truth to "
      "%s/truth\n",
      scene.building_count(), notes.size(), faces, out.c_str(), out.c_str());
}

}  // namespace colod::cli
