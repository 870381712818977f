// Scenes made up for tests: meshes as tiles, and tilesets over them.
#pragma once

#include <string>
#include <vector>

#include "read/read_helpers.h"

namespace colod::test {

/// z up → the axes of a glTF file.
inline Mesh y_up(Mesh m) {
  for (Vec3& p : m.vertices) p = Vec3(p.x(), p.z(), -p.y());
  return m;
}

inline Mesh moved(Mesh m, const Vec3& by) {
  for (Vec3& p : m.vertices) p += by;
  return m;
}

inline std::string glb_of(const Mesh& m) { return glb_bytes(m, R"([{"mesh":0}])", "[0]"); }

/// A batched model about `feature_table`'s RTC_CENTER, if it says one.
inline std::string b3dm_of(const std::string& glb, std::string feature_table = "{}") {
  while ((28 + feature_table.size()) % 8 != 0) feature_table += ' ';
  std::string out = "b3dm";
  put(out, std::uint32_t{1}, false);
  put(out, static_cast<std::uint32_t>(28 + feature_table.size() + glb.size()), false);
  put(out, static_cast<std::uint32_t>(feature_table.size()), false);
  for (int i = 0; i < 3; ++i) put(out, std::uint32_t{0}, false);
  return out + feature_table + glb;
}

/// A tileset with this root tile; `asset` may hold more members, begun with a comma.
inline std::string tileset_of(const std::string& root, const std::string& asset = "") {
  return R"({"asset":{"version":"1.0")" + asset + R"(},"geometricError":100,"root":)" + root + "}";
}

/// A tile; `rest` are further members, begun with a comma.
inline std::string tile_of(const std::string& uri, const std::string& rest = "", double error = 0) {
  return R"({"boundingVolume":{"sphere":[0,0,0,100]},"geometricError":)" + std::to_string(error) +
         (uri.empty() ? "" : R"(,"content":{"uri":")" + uri + R"("})") + rest + "}";
}

/// A level square of cells `step` wide, and boxes that stand in it: a surface seen from above, with
/// upright walls, as photogrammetry gives.
inline Mesh terrain_with_boxes(double side, double step, const std::vector<Box>& boxes) {
  Mesh m;
  const int n = static_cast<int>(std::lround(side / step));
  const auto height = [&](double x, double y) {
    for (const Box& b : boxes)
      if (x > b.min.x() && x < b.max.x() && y > b.min.y() && y < b.max.y()) return b.max.z();
    return 0.0;
  };
  const auto quad = [&](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const int v = static_cast<int>(m.vertices.size());
    for (const Vec3& p : {a, b, c, d}) m.vertices.push_back(p);
    m.faces.push_back({v, v + 1, v + 2}), m.faces.push_back({v, v + 2, v + 3});
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double x = i * step, y = j * step, u = x + step, v = y + step;
      const double h = height(x + step / 2, y + step / 2);
      quad({x, y, h}, {u, y, h}, {u, v, h}, {x, v, h});
      const double e = i + 1 < n ? height(u + step / 2, y + step / 2) : h;
      const double f = j + 1 < n ? height(x + step / 2, v + step / 2) : h;
      if (e != h) quad({u, y, h}, {u, y, e}, {u, v, e}, {u, v, h});
      if (f != h) quad({x, v, f}, {x, v, h}, {u, v, h}, {u, v, f});
    }
  return m;
}

}  // namespace colod::test
