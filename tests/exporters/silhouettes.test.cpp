// What --switch deviation promises, drawn: at the distance where a client refines a tile, its
// silhouette and that of its children differ by no more than the wanted pixels.
#include <catch2/catch.hpp>
#include <numbers>

#include "exporters/tiles3d/tiles3d.h"
#include "exporters_helpers.h"
#include "measure/picture_difference.h"
#include "pipeline/switches.h"
#include "publish/publish.h"

using namespace colod;
using namespace colod::test;

namespace {

constexpr double kTargetSse = 16, kPixels = 2, kFovY = 60 * std::numbers::pi / 180;
constexpr int kHeight = 540;  // of the viewport

/// The scene as bits, seen from outside.
struct Picture {
  int size = 0;
  std::vector<char> bits;
  bool at(int x, int y) const {
    return x >= 0 && y >= 0 && x < size && y < size && bits[y * size + x];
  }
};

struct Camera {
  Vec3 eye, forward, right, up;
};

Camera looking_at(const Vec3& target, double distance, double azimuth, double elevation) {
  const Vec3 back(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                  std::sin(elevation));
  const Vec3 right = Vec3::UnitZ().cross(back).normalized();
  return {target + distance * back, -back, right, back.cross(right)};
}

/// `size` pixels of the viewport's middle, both ways.
Picture draw(const RayScene& scene, const Camera& camera, int size) {
  Picture out{size, std::vector<char>(static_cast<std::size_t>(size) * size)};
  const double pixel = 2 * std::tan(kFovY / 2) / kHeight;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const Vec3 ray = camera.forward + pixel * (x + 0.5 - 0.5 * size) * camera.right +
                       pixel * (0.5 * size - y - 0.5) * camera.up;
      out.bits[y * size + x] = static_cast<bool>(scene.first_hit(camera.eye, ray.normalized()));
    }
  return out;
}

/// Pixels of `a` that have none of `b` within `reach`.
int missing(const Picture& a, const Picture& b, double reach) {
  int count = 0;
  const int r = static_cast<int>(reach);
  for (int y = 0; y < a.size; ++y)
    for (int x = 0; x < a.size; ++x) {
      bool is_near = !a.at(x, y);
      for (int dy = -r; dy <= r && !is_near; ++dy)
        for (int dx = -r; dx <= r && !is_near; ++dx)
          is_near = dx * dx + dy * dy <= reach * reach && b.at(x + dx, y + dy);
      count += !is_near;
    }
  return count;
}

Mesh content_of(const std::vector<Encoded>& files, const nlohmann::json& tile) {
  Mesh mesh = decode_mesh(parse_glb(find(files, tile["content"]["uri"]).bytes), 0).mesh;
  for (Vec3& p : mesh.vertices) p = Vec3(p.x(), -p.z(), p.y());
  return mesh;
}

/// Draws every switch below a tile; returns how many there were.
int check_switches(const std::vector<Encoded>& files, const nlohmann::json& tile) {
  if (!tile.contains("children")) return 0;
  Mesh finer;
  int switches = 1;
  for (const auto& child : tile["children"]) {
    finer = join(finer, content_of(files, child));
    switches += check_switches(files, child);
  }
  const RayScene before(content_of(files, tile)), after(finer);
  const Box box = box_of(tile);
  const double error = tile["geometricError"];
  const double away = error * kHeight / (kTargetSse * 2 * std::tan(kFovY / 2));
  const double distance = away + 0.5 * box.diagonal();  // clients measure to the box
  const double seen = box.diagonal() * kHeight / (2 * std::tan(kFovY / 2) * away);
  const int size = std::clamp(static_cast<int>(seen) + 16, 32, kHeight);
  for (const double azimuth : {0.3, 1.9, 3.6})
    for (const double elevation : {0.15, 0.7}) {
      const Camera camera = looking_at(box.center(), distance, azimuth, elevation);
      const Picture a = draw(before, camera, size), b = draw(after, camera, size);
      INFO(tile["content"]["uri"] << " from " << distance << " m, azimuth " << azimuth);
      CHECK(missing(a, b, kPixels + 1) == 0);
      CHECK(missing(b, a, kPixels + 1) == 0);
    }
  return switches;
}

int check_all(const std::vector<ExportBuilding>& buildings) {
  const auto files = encode_tileset(buildings);
  return check_switches(files, nlohmann::json::parse(files.front().bytes)["root"]);
}

/// Perspective, by rays, lit from over the viewer's left shoulder, 4 × 4 rays a pixel.
GreyPicture shade(const Mesh& mesh, const RayScene& scene, const Camera& camera, int size) {
  constexpr int kSide = 4;
  const Vec3 light =
      (-0.55 * camera.forward - 0.45 * camera.right + 0.7 * Vec3::UnitZ()).normalized();
  const double pixel = 2 * std::tan(kFovY / 2) / kHeight / kSide;
  GreyPicture out{size, size, std::vector<float>(size * size, 0),
                  std::vector<float>(size * size, 0)};
  for (int y = 0; y < size * kSide; ++y)
    for (int x = 0; x < size * kSide; ++x) {
      const Vec3 ray = camera.forward + pixel * (x + 0.5 - 0.5 * size * kSide) * camera.right +
                       pixel * (0.5 * size * kSide - y - 0.5) * camera.up;
      const RayHit hit = scene.first_hit(camera.eye, ray.normalized());
      const int at = y / kSide * size + x / kSide;
      const double lit =
          hit ? std::max(0.0, face_cross(mesh, mesh.faces[hit.triangle]).normalized().dot(light))
              : 0;
      out.luminance[at] += (hit ? 0.4 + 0.45 * lit : 0.9) / (kSide * kSide);
      out.coverage[at] += hit ? 1.0 / (kSide * kSide) : 0;
    }
  return out;
}

/// What differs where a pixel covers gsd, from 20 sides at three heights; rising.
std::vector<double> views_at_switch(const Mesh& coarse, const Mesh& finest, double gsd) {
  const RayScene before(coarse), after(finest);
  const Box box = bounding_box(finest.vertices);
  const double distance = gsd * kHeight / (2 * std::tan(kFovY / 2));
  const int size = static_cast<int>(1.5 * box.diagonal() / gsd) + 8;
  std::vector<double> pixels;
  for (int i = 0; i < 20; ++i) {
    const Camera camera = looking_at(box.center(), distance, 0.2 + 2 * std::numbers::pi * i / 20,
                                     std::array{0.1, 0.5, 1.0}[i % 3]);
    pixels.push_back(
        compare_pictures(shade(coarse, before, camera, size), shade(finest, after, camera, size))
            .pixels());
  }
  std::sort(pixels.begin(), pixels.end());
  return pixels;
}

Scene scanned_houses() {
  Options options;
  options.ns = 40;
  options.nr = 40;
  const std::string folder = std::string(COLOD_SOURCE_DIR) + "/assets/neighbourhood/";
  return build_scene(read_sources({folder + "house_02.ply", folder + "house_03.ply"}, {}), options);
}

}  // namespace

TEST_CASE("at each switch silhouettes of simple houses move by at most the wanted pixels") {
  for (const int n : {1, 2, 5, 16}) {
    std::vector<ExportBuilding> buildings = street(n);
    for (ExportBuilding& b : buildings)
      for (ExportLevel& level : b.levels) level.gsd = level.deviation / kPixels;
    CHECK(check_all(buildings) > n / 2 + 1);
  }
}

TEST_CASE("at each switch silhouettes of scanned houses move by at most the wanted pixels") {
  Scene scene = scanned_houses();
  decide_switches(scene, 3,
                  {.measure = SwitchMeasure::kDeviation, .scope = SwitchScope::kBuilding});
  std::vector<ExportBuilding> buildings;
  for (const Building& b : scene.buildings) buildings.push_back(export_building(b));
  REQUIRE(buildings.size() == 2);
  CHECK(check_all(buildings) >= 4);
}

TEST_CASE("at each visual switch a layer looks like the finest one, to the wanted pixels") {
  Scene scene = scanned_houses();
  for (const double wanted : {4.0, 8.0}) {
    decide_switches(scene, 3, {.scope = SwitchScope::kBuilding, .visual_error = wanted});
    for (const Building& b : scene.buildings) {
      const ExportBuilding out = export_building(b);
      for (std::size_t level = 0; level + 1 < out.levels.size(); ++level) {
        const std::vector<double> pixels = views_at_switch(
            out.levels[level].mesh.mesh(), out.levels.back().mesh.mesh(), out.levels[level].gsd);
        INFO(out.name << " level " << level << " at " << out.levels[level].gsd << " m a pixel");
        CHECK(pixels[pixels.size() * 9 / 10 - 1] <= wanted + 2);  // outlines go by whole pixels
        CHECK(pixels.back() <= 2 * wanted);
        CHECK(pixels.back() >= 0.25 * wanted);  // no farther than needed
      }
    }
  }
}
