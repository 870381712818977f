// Based on: own work.
#include "scene_input.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <set>
#include <sstream>

#include "context.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "read/airborne.h"
#include "scene/cloud_surface.h"
#include "scene/looks_like_scene.h"

namespace colod {

namespace {

constexpr double kLeastCovered = 0.1;  // of a footprint's area, by what faces up over it
constexpr double kFarBeyond =
    1000;  // metres beyond the scene: no footprint that reaches it goes on
constexpr std::size_t kSurveyImages = std::size_t{128} << 20;  // bytes of decoded images
constexpr double kRow = 64;  // metres: buildings are read row by row, so that tiles last

void say(const Tell& tell, Level level, const std::string& text) {
  if (tell) tell({level, text});
}

/// Empty: not a scene.
std::string reason_to_part(const std::vector<std::string>& inputs, const SceneChoice& choice) {
  if (choice.mode == SceneMode::kBuildings) return "";
  if (choice.mode == SceneMode::kScene && inputs.size() == 1) return "--scene scene says so";
  std::string why;
  for (const std::string& input : inputs) {
    if (!is_tiled_scene(input, why)) continue;
    if (inputs.size() > 1)
      throw Error(Stage::kUsage, input,
                  "is a scene (" + why + "), which is built alone: name no other INPUT");
    return why;
  }
  if (choice.mode == SceneMode::kScene)
    throw Error(Stage::kUsage, "--scene", "a scene is one INPUT: a tileset, a folder or a mesh");
  return "";
}

std::string size_text(const Box& box) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(0) << box.size().x() << " x " << box.size().y() << " m";
  return text.str();
}

std::string range_text(const Box& box) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << "x " << box.min.x() << " … " << box.max.x()
       << ", y " << box.min.y() << " … " << box.max.y();
  return text.str();
}

Box box_of(const Footprint& f) {
  Box box;
  for (const auto& part : f.parts)
    for (const auto& ring : part)
      for (const Vec2& p : ring) box.extend(Vec3(p.x(), p.y(), 0));
  return box;
}

bool is_over(const Box& a, const Box& b) {
  return (a.min.head<2>().array() <= b.max.head<2>().array()).all() &&
         (a.max.head<2>().array() >= b.min.head<2>().array()).all();
}

/// Where the scene is: by its own transform, else by options and what lies beside it.
std::optional<Georeference> place_of(const TileTree& tree, const SceneOutput& options,
                                     bool& is_ecef) {
  std::optional<Georeference> own = georeference_of_tileset(tree.path);
  is_ecef = own.has_value();
  const bool is_told = (!options.crs.empty() && options.crs != "local") || !options.origin.empty();
  if (own && is_told)
    throw Error(Stage::kUsage, options.crs.empty() ? "--origin" : "--crs",
                tree.path + " says itself where on Earth it is");
  if (own) return own;
  if (const auto given = georeference_from_options(options.crs, options.origin)) return given;
  return options.crs == "local" ? std::nullopt : georeference_beside(tree.path);
}

/// Of a cloud: what it says itself, or lies beside it, is no place where its own points are outside
/// of it, which is told where the tileset is placed.
std::optional<Georeference> place_of_cloud(const std::string& input, const SceneOutput& options,
                                           const Vec3& at) {
  if (const auto given = georeference_from_options(options.crs, options.origin)) return given;
  if (options.crs == "local") return {};
  try {
    std::optional<Georeference> found = georeference_beside(input);
    if (found) place_on_earth(*found, at).to_ecef(at);
    return found;
  } catch (const Error&) {
    return {};
  }
}

/// A corner that was mistyped would make one plan as large as a country.
bool reaches_far(const Box& footprint, const Box& scene) {
  const Vec3 beyond = (scene.min - footprint.min).cwiseMax(footprint.max - scene.max);
  return beyond.head<2>().maxCoeff() > kFarBeyond;
}

/// Footprints that the scene reaches; the rest is told in one line.
std::vector<Footprint> on_scene(Footprints found, const Box& scene, const std::string& path,
                                bool is_on_earth, Inventory& inventory) {
  std::vector<Footprint> kept;
  std::size_t outside = 0;
  Box all;
  for (Footprint& f : found.all) {
    const Box box = box_of(f);
    all.extend(box);
    if (!is_over(box, scene))
      ++outside;
    else if (reaches_far(box, scene))
      inventory.failures.push_back({path, "footprint '" + f.id +
                                              "' reaches more than a kilometre beyond the scene: "
                                              "it is left out; is one of its corners wrong?"});
    else
      kept.push_back(std::move(f));
  }
  for (const FootprintProblem& p : found.problems)
    inventory.failures.push_back({path, "footprint '" + p.id + "' " + p.message});
  for (const std::string& w : found.warnings) inventory.warnings.push_back(w);
  if (kept.empty())
    throw Error(Stage::kInput, path,
                "none of " + std::to_string(found.all.size()) +
                    " footprints lies on the scene, which has " + range_text(scene) +
                    "; theirs have " + range_text(all) +
                    (is_on_earth ? " there: is their reference system (" +
                                       (found.crs.empty() ? "none is said" : found.crs) + ") right?"
                                 : "; the scene is nowhere on Earth, so that footprints must be in "
                                   "its own metres (--crs and --origin place it)"));
  if (outside > 0)
    inventory.warnings.push_back(path + ": " + std::to_string(outside) + " of " +
                                 std::to_string(found.all.size()) +
                                 " footprints lie outside of the scene and are left out");
  return kept;
}

/// m² of the plan that what faces up covers, what lies twice counted twice.
double covered(const Mesh& mesh) {
  double area = 0;
  for (const Face& f : mesh.faces) area += std::max(0.0, 0.5 * face_cross(mesh, f).z());
  return area;
}

/// The surface over one footprint, as a building of its own.
Source building_of(const PartedScene& scene, std::size_t b) {
  const std::string& name = scene.names[b];
  Source source;
  {
    Stopwatch watch(source.read_seconds);
    std::vector<Source> parts;
    for (const std::size_t t : scene.tiles.over(scene.territories.box(b)))
      parts.push_back(scene.territories.cut_out(*scene.tiles.get(t), static_cast<int>(b)));
    const double seconds = source.read_seconds;
    source = joined(parts);
    source.read_seconds = seconds;
  }
  const Footprint& footprint = scene.footprints[b];
  source.name = name;
  source.given_name = footprint.id;
  source.path = scene.tiles.tree().path;
  source.is_found = scene.is_found;
  if (covered(source.mesh) < kLeastCovered * scene.territories.area(b))
    throw Error(Stage::kInput, name,
                "no surface of the scene lies over its footprint: a gap, or the footprint is "
                "misplaced");
  return source;
}

/// Row by row, so that buildings which follow each other lie over the same tiles.
std::vector<std::size_t> in_rows(const Territories& territories) {
  std::vector<std::size_t> order(territories.count());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto key = [&](std::size_t i) {
    const Box& box = territories.box(i);
    const double row = std::floor((box.min.y() + box.max.y()) / 2 / kRow);
    return std::pair(row, (box.min.x() + box.max.x()) / 2);
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
  return order;
}

/// Names of files, which differ where upper and lower case do not.
std::vector<std::string> names_of(const std::vector<Footprint>& footprints) {
  std::vector<std::string> names;
  std::set<std::string> used;
  for (const Footprint& f : footprints) {
    const std::string base = safe_name(f.id);
    std::string name = base;
    const auto lower = [](std::string s) {
      std::transform(s.begin(), s.end(), s.begin(),
                     [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
      return s;
    };
    for (int i = 2; !used.insert(lower(name)).second; ++i) name = base + "_" + std::to_string(i);
    names.push_back(name);
  }
  return names;
}

/// One building a footprint: a failure of its own where the scene has nothing there.
void list_buildings(const std::shared_ptr<const PartedScene>& scene, Inputs& inputs) {
  const std::vector<std::size_t> order = in_rows(scene->territories);
  for (const std::size_t b : order) {
    inputs.inventory.files.push_back({scene->tiles.tree().path, {scene->names[b]}});
    inputs.attributes[scene->names[b]] = scene->footprints[b].attributes;
  }
  inputs.read = [scene, order](std::size_t file) {
    std::vector<Source> one;
    one.push_back(building_of(*scene, order[file]));
    return one;
  };
  inputs.scene = scene;
}

Error none_found(const std::string& path) {
  return Error(Stage::kInput, path,
               "no building was found on it: --footprints names a file with their plans, --scene "
               "buildings takes each file for one building");
}

/// The footprints of a file, or those that the surface tells.
std::vector<Footprint> footprints_of(const SceneTiles& tiles, const SceneChoice& choice,
                                     const std::optional<Georeference>& place, const HeightMap& map,
                                     const SceneClasses& classes, Inputs& out) {
  if (!choice.footprints.empty())
    return on_scene(read_footprints(choice.footprints, choice.footprint_id, place), tiles.box(),
                    choice.footprints, place.has_value(), out.inventory);
  std::vector<Footprint> found = outline_buildings(map, classes);
  if (found.empty()) throw none_found(tiles.tree().path);
  return found;
}

std::vector<ClassArea> areas_of(const HeightMap& map, const SceneClasses& classes) {
  std::vector<ClassArea> out = {{"ground", 0}, {"building", 0}, {"plant", 0}, {"rest", 0}};
  for (const SceneClass c : classes.of_cell)
    if (c != SceneClass::kNothing) out[static_cast<std::size_t>(c) - 1].area += map.cell * map.cell;
  return out;
}

/// The clouds among a scene's files; none: all are meshes. Throws Error{kInput} for some of each.
std::vector<std::string> clouds_of(const std::string& input, const TileTree& tree) {
  std::vector<std::string> clouds;
  std::size_t meshes = 0;
  for (const TileNode& node : tree.nodes)
    for (const std::string& file : node.contents)
      if (is_cloud(file))
        clouds.push_back(file);
      else
        ++meshes;
  if (!clouds.empty() && meshes > 0)
    throw Error(Stage::kInput, input,
                "holds " + std::to_string(clouds.size()) + " clouds and " + std::to_string(meshes) +
                    " other files: a scene is of one kind");
  return clouds;
}

/// The surface of a cloud as the scene's tiles.
SceneTiles open_cloud(const std::string& input, const std::string& why, CloudSurface surface,
                      Inputs& out, const Tell& tell) {
  SceneTiles tiles(input, std::make_shared<const HeightMap>(std::move(surface.map)));
  out.inventory.warnings = std::move(surface.warnings);
  std::ostringstream text;
  text << input << ": taken for a scene, since " << why << ": " << surface.points << " points, "
       << std::setprecision(2) << surface.density << " a m², read as a surface in cells of "
       << tiles.surface()->cell << " m, " << size_text(tiles.box());
  say(tell, Level::kInfo, text.str());
  return tiles;
}

/// The tiles, in the scene's frame. Throws Error{kInput} where none can be read.
SceneTiles open_tiles(const std::string& input, TileTree tree,
                      const std::optional<Georeference>& place, bool is_ecef, int coarser,
                      const ReadOptions& read) {
  const Eigen::Matrix4d to_scene =
      is_ecef ? local_from_ecef(*place) : Eigen::Matrix4d(Eigen::Matrix4d::Identity());
  SceneTiles tiles(std::move(tree), to_scene, coarser, !is_ecef, read);
  if (tiles.count() > 0) return tiles;
  const std::string first = tiles.failures().empty() ? ": they hold no faces"
                                                     : ": " + tiles.failures()[0].path + ": " +
                                                           tiles.failures()[0].message;
  throw Error(Stage::kInput, input, "none of its tiles can be read" + first);
}

PlaceDoubt doubt_of_cloud(const std::string& path, const ReadOptions& read) {
  try {
    return looks_like_scene(surface_of({path}, read).map);
  } catch (const std::exception&) {
    return {};  // whoever reads it for the work tells of it
  }
}

/// What tells that a file is a place or a piece of one. It is read the way up that it seems to
/// stand.
PlaceDoubt doubt(const InputFile& file, ReadOptions read) {
  if (is_cloud(file.path)) return doubt_of_cloud(file.path, read);
  if (is_tile_format(file.path)) return {"is a tile of a scene by its format", true, ""};
  const bool is_axis_said = read.up != Up::kUnsaid;
  if (!is_axis_said) read.up = Up::kAuto;
  PlaceDoubt found;
  try {
    for (const Source& s : read_file(file, read)) {
      if (found.is_certain) break;
      if (const PlaceDoubt own = looks_like_scene(s); !own.why.empty()) found = own;
      if (!found.is_certain && s.is_turned_back && !is_axis_said && is_wide(s))
        found = {"is as wide as a scene and lies on its side (--up auto turns it)", true, ""};
    }
  } catch (const std::exception&) {
    return {};  // whoever reads it for the work tells of it
  }
  return found;
}

/// Of meshes that nothing says of whether they are scenes.
std::vector<PlaceDoubt> doubts_of(const ReadOptions& read, const Inventory& inventory) {
  std::vector<PlaceDoubt> doubts(inventory.files.size());
  parallel_for(inventory.files.size(),
               [&](std::size_t i) { doubts[i] = doubt(inventory.files[i], read); });
  return doubts;
}

template <typename T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

/// They are taken for buildings: a failure of each that looks like a scene, though it is built, and
/// a warning where it may be.
void tell_doubts(const std::vector<PlaceDoubt>& doubts, Inventory& inventory) {
  for (std::size_t i = 0; i < doubts.size(); ++i) {
    const std::string& path = inventory.files[i].path;
    const std::string text = doubts[i].why +
                             "; it is taken for one building: --scene scene takes it apart, "
                             "--scene buildings says that it is one";
    if (doubts[i].is_certain)
      inventory.failures.push_back({path, text});
    else if (!doubts[i].why.empty())
      inventory.warnings.push_back(path + ": " + text);
  }
}

/// Why the one file that there is, named or in the folder that is, is a scene; empty: it is none,
/// or there are several.
std::string whole_place(const std::vector<PlaceDoubt>& doubts) {
  return doubts.size() == 1 ? doubts[0].place : "";
}

/// The meshes of a scene as its tiles.
SceneTiles open_meshes(const std::string& input, const std::string& why, SceneTiles tiles,
                       Inputs& out, const Tell& tell) {
  out.inventory.failures = tiles.failures();
  out.inventory.warnings = tiles.warnings();
  say(tell, Level::kInfo,
      input + ": taken for a scene, since " + why + ": " + std::to_string(tiles.count()) +
          " tiles, " + std::to_string(tiles.faces()) + " faces, " + size_text(tiles.box()));
  return tiles;
}

/// The surface of the one cloud that is named, where it shows several buildings; `why` says so.
std::optional<CloudSurface> whole_cloud(const std::vector<std::string>& inputs,
                                        const ReadOptions& read, std::string& why) {
  if (inputs.size() != 1 || !is_cloud(inputs[0])) return {};
  try {
    CloudSurface surface = surface_of(inputs, read);
    why = looks_like_scene(surface.map).place;
    if (!why.empty()) return surface;
  } catch (const std::exception&) {
    return {};  // whoever reads it for the work tells of it
  }
  return {};
}

/// The middle of a map, at the height of some cell.
Vec3 point_on(const HeightMap& map) {
  const Vec2 middle = map.middle(map.width / 2, map.height / 2);
  const auto known =
      std::find_if(map.top.begin(), map.top.end(), [](float z) { return !std::isnan(z); });
  return {middle.x(), middle.y(), known == map.top.end() ? 0.0 : *known};
}

/// `cloud`: that is known already.
Inputs open_scene(const std::string& input, const std::string& why, const ReadOptions& read,
                  const SceneChoice& choice, const SceneOutput& options, const Tell& tell,
                  std::optional<CloudSurface> cloud = {}) {
  TileTree tree = list_tiles(input, read);
  Inputs out;
  const std::vector<std::string> clouds = clouds_of(input, tree);
  if (!clouds.empty() && !cloud) cloud = surface_of(clouds, read);
  bool is_ecef = false;
  const std::optional<Georeference> place =
      cloud ? place_of_cloud(input, options, point_on(cloud->map))
            : place_of(tree, options, is_ecef);
  SceneTiles tiles = cloud ? open_cloud(input, why, std::move(*cloud), out, tell)
                           : open_meshes(input, why,
                                         open_tiles(input, std::move(tree), place, is_ecef,
                                                    choice.source_level, read),
                                         out, tell);
  HeightMap map;
  SceneClasses classes;
  if (choice.footprints.empty() || choice.context != ContextMode::kNone) {
    map = tiles.surface() ? *tiles.surface() : survey(tiles, kSurveyImages);
    classes = classify(map);
    if (choice.footprints.empty()) part_rows(map, classes), settle_annexes(map, classes);
    out.classes = areas_of(map, classes);
  }
  std::vector<Footprint> footprints = footprints_of(tiles, choice, place, map, classes, out);
  say(tell, Level::kInfo,
      std::to_string(footprints.size()) +
          (choice.footprints.empty() ? " buildings were found on it" : " footprints lie on it"));
  Territories territories(footprints);
  std::vector<std::string> names = names_of(footprints);
  const auto scene = std::make_shared<const PartedScene>(PartedScene{
      std::move(tiles), place, std::move(footprints), std::move(names), choice.footprints.empty(),
      std::move(territories), std::move(map), std::move(classes)});
  list_buildings(scene, out);
  if (choice.context != ContextMode::kNone)
    out.context = [scene, read, options, mode = choice.context](const std::vector<char>& unbuilt) {
      return context_of(scene, unbuilt, mode, read, options);
    };
  return out;
}

}  // namespace

void add_place(const Inputs& inputs, Scene& built) {
  if (!inputs.scene) return;
  const PartedScene& place = *inputs.scene;
  leave_out_dismissed(built);
  if (built.buildings.empty()) throw none_found(place.tiles.tree().path);
  std::map<std::string, bool> has_mesh;
  for (const Building& b : built.buildings)
    has_mesh[b.source.name] = std::any_of(b.layers.begin(), b.layers.end(),
                                          [](const Layer& l) { return l.failure.empty(); });
  std::vector<char> is_unbuilt;
  std::vector<Footprint> footprints;
  for (std::size_t i = 0; i < place.names.size(); ++i) {
    const auto known = has_mesh.find(place.names[i]);
    is_unbuilt.push_back(known == has_mesh.end() || !known->second);
    if (known != has_mesh.end()) footprints.push_back(place.footprints[i]);
  }
  built.attributes = inputs.attributes;
  built.classes = inputs.classes;
  if (inputs.context) built.context = inputs.context(is_unbuilt);
  if (place.is_found) built.found_footprints = footprints_geojson(footprints, place.place);
}

Inputs open_inputs(const std::vector<std::string>& inputs, const ReadOptions& read,
                   const SceneChoice& choice, const SceneOutput& output, const Tell& tell) {
  if (const std::string why = reason_to_part(inputs, choice); !why.empty())
    return open_scene(inputs[0], why, read, choice, output, tell);
  if (choice.mode == SceneMode::kAuto) {
    std::string why;
    if (auto cloud = whole_cloud(inputs, read, why))
      return open_scene(inputs[0], why, read, choice, output, tell, std::move(cloud));
  }
  Inputs out;
  out.inventory = take_inventory(inputs, read);
  if (choice.mode == SceneMode::kAuto) {
    const std::vector<PlaceDoubt> doubts = doubts_of(read, out.inventory);
    if (const std::string why = whole_place(doubts); !why.empty()) {
      Inputs place = open_scene(out.inventory.files[0].path, why, read, choice, output, tell);
      append(place.inventory.warnings, out.inventory.warnings);
      append(place.inventory.failures, out.inventory.failures);
      return place;
    }
    tell_doubts(doubts, out.inventory);
  }
  if (!choice.footprints.empty())
    throw Error(Stage::kUsage, "--footprints",
                "is for scenes, and these inputs are files of single buildings; --scene scene "
                "takes one for a scene");
  out.read = [files = out.inventory.files, read](std::size_t file) {
    return read_file(files[file], read);
  };
  return out;
}

}  // namespace colod
