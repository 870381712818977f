// A place of four tiles with two houses of a row, and their plans.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "program.h"
#include "scenes.h"

namespace colod::test {

/// Two houses of a row, 8 by 10 m, 6 and 9 m high, that share the wall at x = 20, on level ground
/// in four tiles.
inline const std::vector<Box> kRow = {Box{{12, 14, 0}, {20, 24, 6}}, Box{{20, 14, 0}, {28, 24, 9}}};

/// The finest tiles stand below `coarse`, one below another; `beside` them others.
inline std::string write_row(const TempFolder& folder, const std::string& root_members = "",
                             const std::vector<std::string>& coarse = {},
                             const std::string& beside = "") {
  const Mesh whole = terrain_with_boxes(40, 1, kRow);
  std::string children;
  for (int t = 0; t < 4; ++t) {
    Mesh part;
    part.vertices = whole.vertices;
    for (const Face& f : whole.faces) {
      const Vec3 middle = (whole.vertices[static_cast<std::size_t>(f[0])] +
                           whole.vertices[static_cast<std::size_t>(f[1])] +
                           whole.vertices[static_cast<std::size_t>(f[2])]) /
                          3;
      if ((middle.x() > 17.5 ? 1 : 0) + (middle.y() > 17.5 ? 2 : 0) == t) part.faces.push_back(f);
    }
    const std::string name = "tile" + std::to_string(t) + ".b3dm";
    folder.write(name, b3dm_of(glb_of(y_up(part))));
    children += (t ? "," : "") + tile_of(name);
  }
  children += beside;
  for (const std::string& name : coarse)
    children = tile_of(name, R"(,"refine":"REPLACE","children":[)" + children + "]", 1);
  return folder.write("tileset.json",
                      tileset_of(tile_of("", root_members + R"(,"children":[)" + children + "]")));
}

inline std::string square(double x, double y, double w, double h) {
  const auto point = [](double a, double b) {
    return "[" + std::to_string(a) + "," + std::to_string(b) + "]";
  };
  return point(x, y) + "," + point(x + w, y) + "," + point(x + w, y + h) + "," + point(x, y + h) +
         "," + point(x, y);
}

inline std::string plan(const std::vector<std::pair<std::string, std::string>>& rings) {
  std::string out = R"({"type":"FeatureCollection","features":[)";
  for (std::size_t i = 0; i < rings.size(); ++i)
    out += (i ? "," : "") + std::string(R"({"type":"Feature","properties":{"id":")") +
           rings[i].first + R"(","use":"flats"},"geometry":{"type":"Polygon","coordinates":[[)" +
           rings[i].second + "]]}}";
  return out + "]}";
}

inline const std::string kPlan =
    plan({{"left", square(12, 14, 8, 10)}, {"right", square(20, 14, 8, 10)}});

}  // namespace colod::test
