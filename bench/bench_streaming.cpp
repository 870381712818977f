// What a viewer draws and loads on the way over a tileset, by our own model of the clients' rule or
// as real clients said, and how that looks beside the finest layers from the same place.
//
//   bench_streaming paths TILESET -o PATHS.json                where to look from
//   bench_streaming drive TILESET --paths PATHS.json [...]     the model, stop by stop, as JSON
//   bench_streaming judge TILESET --run RUN.json [...]         what a client said, likewise
//   bench_streaming compare A.png B.png                        two screenshots of clients
//   bench_streaming look A.png B.png                           two in colours, before a blue sky
//
// bench/streaming runs the first four and writes a table, bench/places runs the last.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/error.h"
#include "core/parallel.h"
#include "streaming_paths.h"
#include "streaming_pictures.h"
#include "streaming_tileset.h"

using namespace colod;
using namespace colod::bench;
using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

namespace {

constexpr double kFovy_deg = 60, kAspect = 16.0 / 9;

struct Settings {
  std::string tileset, paths, out, before, run, folder, first, second;
  int lines = 1080;  ///< of the screen whose errors count
  int every = 1;     ///< stop that is drawn; 0: none
  int samples = 2;   ///< along a pixel's side
  int threads = 0;
};

void write_file(const std::string& path, const std::string& bytes) {
  std::ofstream out(path, std::ios::binary);
  out << bytes;
  if (!out.flush()) throw Error(Stage::kOutput, path, "cannot be written");
}

void write_json(const std::string& path, const Json& json) {
  write_file(path, json.dump(1) + "\n");
}

Json read_json(const std::string& path) {
  std::ifstream in(path);
  if (!in) throw Error(Stage::kInput, path, "cannot be read");
  return Json::parse(in);
}

Json vec_json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

/// Stops are written in the input's coordinates: tilesets of one scene may differ in their origins.
Json stop_json(const Stop& stop, const Vec3& offset) {
  return {{"eye", vec_json(stop.eye + offset)}, {"target", vec_json(stop.target + offset)}};
}

Stop read_stop(const Json& json, const Vec3& offset) {
  const auto vec = [&](const char* name) {
    const Json& v = json.at(name);
    return Vec3(Vec3(v.at(0), v.at(1), v.at(2)) - offset);
  };
  return {vec("eye"), vec("target")};
}

int write_paths(const Settings& s) {
  const Tileset tileset = read_tileset(s.tileset);
  Json out = {{"fovy_deg", kFovy_deg}, {"aspect", kAspect}, {"paths", Json::array()}};
  for (const Path& path : plan_paths(tileset)) {
    Json stops = Json::array();
    for (const Stop& stop : path.stops) stops.push_back(stop_json(stop, tileset.offset));
    out["paths"].push_back({{"name", path.name}, {"stops", stops}});
  }
  write_json(s.out, out);
  return 0;
}

Json difference_json(const PictureDifference& d) {
  return {{"piece", d.piece}, {"outline", d.outline}, {"pixels", d.pixels()}};
}

/// What buildings show, and whether in order.
void add_buildings(Json& row, const Tileset& tileset, const std::vector<Shown>& shown) {
  Json buildings = Json::array();
  for (const Shown& b : shown)
    buildings.push_back({{"name", tileset.buildings[b.building].name},
                         {"coarsest_layer", b.coarsest_layer},
                         {"layer", b.layer},
                         {"distance", b.distance},
                         {"decided_at", b.decided_at},
                         {"error", b.error},
                         {"decided_error", b.decided_error}});
  const Disorder disorder = find_disorder(tileset, shown);
  row["disorder"] = {{"layers", disorder.layers},
                     {"stand_ins", disorder.stand_ins},
                     {"tolerated", disorder.tolerated},
                     {"worst", disorder.worst}};
  row["buildings"] = std::move(buildings);
}

/// The model at work: what it has loaded so far, and the pictures' sceneries.
class Drive {
 public:
  Drive(const Settings& s, const Tileset& tileset)
      : s_(s), tileset_(tileset), picture_{.width = 0, .height = s.lines, .samples = s.samples} {
    picture_.width = static_cast<int>(std::lround(s.lines * kAspect));
  }

  Json path(const Json& path) {
    Json out = {{"name", path.at("name")}, {"stops", Json::array()}};
    is_loaded_.assign(tileset_.tiles.size(), false);
    loaded_bytes_ = 0;
    int number = 0;
    for (const Json& stop : path.at("stops")) {
      const bool is_drawn = s_.every > 0 && number % s_.every == 0;
      const std::string name = path.at("name").get<std::string>() + "-" + std::to_string(number++);
      out["stops"].push_back(this->stop(read_stop(stop, tileset_.offset), name, is_drawn));
    }
    return out;
  }

 private:
  Json stop(const Stop& place, const std::string& name, bool is_drawn) {
    const Camera camera = camera_at(place, kFovy_deg, kAspect);
    const Selection selection = select_tiles(tileset_, camera, s_.lines, tileset_.limit);
    std::size_t triangles = 0, bytes = 0;
    std::vector<Shown> shown;
    for (const int t : selection.drawn) {
      const Tile& tile = tileset_.tiles[t];
      triangles += tile.mesh.faces.size();
      bytes += tile.bytes;
      for (const Shown& b : shown_by(tileset_, t, tile.parts, place.eye)) shown.push_back(b);
    }
    for (const int t : selection.loaded)
      if (!is_loaded_[t]) is_loaded_[t] = true, loaded_bytes_ += tileset_.tiles[t].bytes;
    Json row = stop_json(place, tileset_.offset);
    row["triangles"] = triangles;
    row["tiles"] = selection.drawn.size();
    row["bytes"] = bytes;
    row["loaded_bytes"] = loaded_bytes_;
    if (is_drawn) row["difference"] = look(camera, selection.drawn, shown, name);
    add_buildings(row, tileset_, shown);
    return row;
  }

  Json look(const Camera& camera, const std::vector<int>& drawn, const std::vector<Shown>& shown,
            const std::string& name) {
    const Window window = window_of_change(tileset_, drawn, camera, picture_);
    if (window.is_empty()) return difference_json({});
    if (!shown_ || drawn != shown_tiles_) shown_.emplace(tileset_, drawn), shown_tiles_ = drawn;
    if (!finest_) finest_.emplace(tileset_, finest_tiles());
    const GreyPicture a = draw(*shown_, camera, window, picture_);
    const GreyPicture b = draw(*finest_, camera, window, picture_);
    if (!s_.folder.empty())
      write_file((fs::path(s_.folder) / (name + ".png")).string(), encode_png(side_by_side(a, b)));
    Json out = difference_json(compare_pictures(a, b));
    int coarse = 0, within = 0;  // buildings that are not on their finest level
    for (const Shown& building : shown) {
      const Box& box = tileset_.buildings[building.building].box;
      const Window own = window_of(box, camera, picture_, window);
      if (building.error == 0 || own.is_empty()) continue;
      const PictureDifference d =
          compare_pictures(cropped(a, window, own), cropped(b, window, own));
      ++coarse;
      within += d.pixels() <= tileset_.bound;
    }
    out["coarse"] = coarse;
    out["within"] = within;
    return out;
  }

  std::vector<int> finest_tiles() const {
    std::vector<int> out;
    for (std::size_t t = 0; t < tileset_.tiles.size(); ++t)
      if (tileset_.tiles[t].children.empty()) out.push_back(static_cast<int>(t));
    return out;
  }

  const Settings& s_;
  const Tileset& tileset_;
  PictureOptions picture_;
  std::vector<bool> is_loaded_;
  std::size_t loaded_bytes_ = 0;
  std::vector<int> shown_tiles_;
  std::optional<Scenery> shown_, finest_;
};

int drive(const Settings& s) {
  Tileset tileset = read_tileset(s.tileset);
  if (!s.before.empty()) apply_rule_before(tileset, s.before);
  if (!s.folder.empty()) fs::create_directories(s.folder);
  Json out = {{"rule", s.before.empty() ? "tileset" : "before"},
              {"lines", s.lines},
              {"fovy_deg", kFovy_deg},
              {"limit", tileset.limit},
              {"findings", tileset.findings},
              {"paths", Json::array()}};
  Drive model(s, tileset);
  const Json paths = read_json(s.paths);
  for (const Json& path : paths.at("paths")) out["paths"].push_back(model.path(path));
  write_json(s.out, out);
  return 0;
}

/// Tiles that only one of the two shows, of those that a client named and those of the model.
Json unlike(const Tileset& tileset, const std::vector<int>& client, const std::vector<int>& model) {
  std::vector<int> only;
  std::set_symmetric_difference(client.begin(), client.end(), model.begin(), model.end(),
                                std::back_inserter(only));
  Json out = Json::array();
  for (const int t : only) out.push_back(tileset.tiles[t].uri);
  return out;
}

/// Replaces what a client drew at a stop by what that means.
void judge_stop(const Tileset& tileset, const Settings& s, int lines, Json& row) {
  const Stop stop = read_stop(row, tileset.offset);
  const Camera camera = camera_at(stop, kFovy_deg, kAspect);
  std::vector<int> drawn;
  std::vector<Shown> shown;
  for (const Json& said : row.at("drawn")) {
    const auto tile = std::find_if(tileset.tiles.begin(), tileset.tiles.end(), [&](const Tile& t) {
      return t.uri == said.at("uri").get<std::string>();
    });
    if (tile == tileset.tiles.end())
      throw Error(Stage::kInput, said.at("uri"), "no tile of the tileset");
    std::vector<Part> parts;
    for (const Json& f : said.at("features"))
      parts.push_back(
          {f.at("name"), f.value("coarsest_layer", f.at("layer").get<int>()), f.at("layer")});
    drawn.push_back(static_cast<int>(tile - tileset.tiles.begin()));
    if (is_beside_view(tileset, *tile, camera)) continue;
    for (const Shown& b : shown_by(tileset, drawn.back(), parts, stop.eye)) shown.push_back(b);
  }
  std::sort(drawn.begin(), drawn.end());
  row.erase("drawn");
  row["tiles"] = drawn.size();
  row["unlike_model"] =
      unlike(tileset, drawn, select_tiles(tileset, camera, lines, tileset.limit).drawn);
  if (row.contains("picture"))
    row["difference"] = difference_json(compare_pictures(
        read_screenshot((fs::path(s.folder) / row["picture"].get<std::string>()).string()),
        read_screenshot((fs::path(s.folder) / row.at("finest").get<std::string>()).string())));
  add_buildings(row, tileset, shown);
}

int judge(const Settings& s) {
  const Tileset tileset = read_tileset(s.tileset);
  Json run = read_json(s.run);
  for (Json& path : run.at("paths"))
    for (Json& stop : path.at("stops")) judge_stop(tileset, s, run.at("lines"), stop);
  write_json(s.out, run);
  return 0;
}

template <typename Picture>
void check_sizes(const Settings& s, const Picture& a, const Picture& b) {
  if (a.width != b.width || a.height != b.height)
    throw Error(Stage::kInput, s.second, "not as large as " + s.first);
}

/// Means over the pixels that either picture covers.
int look(const Settings& s) {
  const ColorPicture a = read_colors(s.first), b = read_colors(s.second);
  check_sizes(s, a, b);
  const PictureErrors e = compare_colors(a, b);
  const double n = std::max<double>(1, static_cast<double>(e.pixels));
  const Json out = {{"pixels", e.pixels},
                    {"only_a", e.only_a},
                    {"only_b", e.only_b},
                    {"psnr", e.squares > 0 ? Json(-10 * std::log10(e.squares / n)) : Json()},
                    {"ssim", e.ssim / n},
                    {"flip", e.flip / n}};
  std::printf("%s\n", out.dump().c_str());
  return 0;
}

int compare(const Settings& s) {
  const GreyPicture a = read_screenshot(s.first), b = read_screenshot(s.second);
  check_sizes(s, a, b);
  std::printf("%s\n", difference_json(compare_pictures(a, b)).dump().c_str());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Settings s;
  CLI::App app("what is drawn and loaded on the way over a tileset");
  app.require_subcommand(1);
  const auto command = [&](const char* name, const char* help) {
    CLI::App* sub = app.add_subcommand(name, help);
    sub->add_option("--threads", s.threads);
    return sub;
  };
  const auto with_tileset = [&](CLI::App* sub) {
    sub->add_option("tileset", s.tileset, "tileset.json")->required()->check(CLI::ExistingFile);
    sub->add_option("-o,--out", s.out, "JSON to write")->required();
    return sub;
  };
  CLI::App* paths = with_tileset(command("paths", "where to look from"));
  CLI::App* model = with_tileset(command("drive", "the model of the rule, stop by stop"));
  model->add_option("--paths", s.paths)->required()->check(CLI::ExistingFile);
  model->add_option("--before", s.before, "report.json: by the errors of the rule before")
      ->check(CLI::ExistingFile);
  model->add_option("--lines", s.lines, "of the screen")->check(CLI::Range(64, 8192));
  model->add_option("--picture-every", s.every, "draw every so many stops; 0: none");
  model->add_option("--samples", s.samples, "rays along a pixel's side")->check(CLI::Range(1, 16));
  model->add_option("--pictures", s.folder, "keep the pictures here");
  CLI::App* client = with_tileset(command("judge", "what a client drew"));
  client->add_option("--run", s.run, "JSON of the client")->required()->check(CLI::ExistingFile);
  client->add_option("--pictures", s.folder, "where its screenshots are");
  const auto with_pair = [&](CLI::App* sub) {
    sub->add_option("a", s.first)->required()->check(CLI::ExistingFile);
    sub->add_option("b", s.second)->required()->check(CLI::ExistingFile);
    return sub;
  };
  with_pair(command("compare", "two screenshots of clients"));
  CLI::App* colors = with_pair(command("look", "two in colours: PSNR, SSIM, FLIP"));
  CLI11_PARSE(app, argc, argv);
  limit_threads(s.threads);
  try {
    return *paths    ? write_paths(s)
           : *model  ? drive(s)
           : *client ? judge(s)
           : *colors ? look(s)
                     : compare(s);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "bench_streaming: %s\n", e.what());
    return 1;
  }
}
