// What the geometric errors promise, drawn: at the distance where a client refines a tile, its
// silhouette and that of its children differ by no more than the wanted pixels.
#include <catch2/catch.hpp>
#include <numbers>

#include "../exporters/deviation.h"
#include "../exporters/tiles3d.h"
#include "../src/pipeline.h"
#include "exporters_helpers.h"

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

}  // namespace

TEST_CASE("at each switch silhouettes of simple houses move by at most the wanted pixels") {
  for (const int n : {1, 2, 5, 16}) {
    std::vector<ExportBuilding> buildings = street(n);
    for (ExportBuilding& b : buildings) measure_visible_errors(b);
    CHECK(check_all(buildings) > n / 2 + 1);
  }
}

TEST_CASE("at each switch silhouettes of scanned houses move by at most the wanted pixels") {
  Options options;
  options.ns = 40;
  options.nr = 40;
  const std::string folder = std::string(COLOD_SOURCE_DIR) + "/assets/neighbourhood/";
  const Scene scene =
      build_scene(read_sources({folder + "house_02.ply", folder + "house_03.ply"}, {}), options);
  std::vector<ExportBuilding> buildings;
  for (const Building& b : scene.buildings) {
    ExportBuilding out{b.source.name, b.source.path, b.frame.origin, {}};
    for (const Layer& layer : b.layers)
      if (layer.failure.empty())
        out.layers.push_back({layer.layer, layer.mesh, layer.geometric_error});
    measure_visible_errors(out);
    buildings.push_back(std::move(out));
  }
  REQUIRE(buildings.size() == 2);
  CHECK(check_all(buildings) >= 4);
}
