// Clouds of places in all formats, visited point by point.
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>

#include "cloud_files.h"
#include "core/error.h"
#include "read/airborne.h"
#include "temporary_folder.h"

using namespace colod;
using namespace colod::test;
using Catch::Contains;

namespace {

/// More than a mebibyte in any coding.
std::vector<LasPoint> many_points() {
  std::vector<LasPoint> out;
  for (int i = 0; i < 70000; ++i)
    out.push_back({{0.37 * i, 0.011 * i, 5 + std::sin(i)}, 2 + i % 5});
  return out;
}

std::string write(const TemporaryFolder& folder, const std::string& name, const std::string& text) {
  std::ofstream(folder / name, std::ios::binary) << text;
  return (folder / name).string();
}

std::vector<AirbornePoint> visited(const std::string& path, const ReadOptions& options = {}) {
  std::vector<AirbornePoint> out;
  AirborneCloud(path, options).visit([&](const AirbornePoint& p) { out.push_back(p); });
  return out;
}

}  // namespace

TEST_CASE("a cloud is the same points and classes in every format, longer than a block") {
  const auto points = many_points();
  const bool has_kinds = GENERATE(true, false);
  const auto [name, text] = GENERATE_COPY(table<std::string, std::string>(
      {{"a.ply", ply_of(points, PlyCoding::kText, has_kinds)},
       {"b.ply", ply_of(points, PlyCoding::kLittle, has_kinds)},
       {"c.ply", ply_of(points, PlyCoding::kBig, has_kinds)},
       {"d.xyz", table_of(points, has_kinds, has_kinds ? "//X Y Z Classification" : "")},
       {"e.pts", std::to_string(points.size()) + "\n" + table_of(points, false)},
       {"f.csv", table_of(points, has_kinds, "\"X\",\"Y\",\"Z\",\"Classification\"", ",")},
       {"g.txt", table_of(points, has_kinds, "x;y;z;class", ";")},
       {"h.asc", table_of(points, has_kinds, has_kinds ? "x y z scalar_Classification" : "")}}));
  CAPTURE(name, has_kinds);
  const TemporaryFolder folder;
  const std::string path = write(folder, name, text);
  REQUIRE(is_cloud(path));
  const auto seen = visited(path);
  REQUIRE(seen.size() == points.size());
  double off = 0;
  std::size_t wrong = 0;
  const bool is_told = has_kinds && name != "e.pts";
  for (std::size_t i = 0; i < seen.size(); ++i) {
    off = std::max(off, (seen[i].at - las_place(points[i])).norm());
    wrong += seen[i].kind != (is_told ? points[i].kind : 0);
  }
  CHECK(off < 1e-6);
  CHECK(wrong == 0);
}

TEST_CASE("colours, units, axes, noise and points without a place, as in LAS") {
  const TemporaryFolder folder;
  std::string rows = "x y z r g b class\n";
  for (int i = 0; i < 30; ++i)
    rows += std::to_string(i) + " 2 3 " + std::to_string(100 + i) + " 50 60 6\n";
  rows += "1 1 900 1 1 1 7\nnan 1 1 1 1 1 2\n";
  const std::string path = write(folder, "a.xyz", rows);
  CHECK(AirborneCloud(path, {}).has_color());
  const auto seen = visited(path, {.up = Up::kY, .unit = 0.5});
  REQUIRE(seen.size() == 30);
  CHECK((seen[4].at - Vec3(2, -1.5, 1)).norm() < 1e-12);
  CHECK(seen[4].color == std::array<std::uint16_t, 3>{104, 50, 60});
  const std::string ply = write(folder, "b.ply",
                                "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\n"
                                "property float y\nproperty float z\nproperty uchar red\n"
                                "property uchar green\nproperty uchar blue\nend_header\n"
                                "1 2 3 9 8 7\n4\n5 6 1 2 3\n");
  CHECK(AirborneCloud(ply, {}).is_single());
  const auto two = visited(ply);
  REQUIRE(two.size() == 2);
  CHECK(two[1].at == Vec3(4, 5, 6));  // broken over lines
  CHECK(two[0].color == std::array<std::uint16_t, 3>{9, 8, 7});
}

TEST_CASE("a text in any spelling of a table is a cloud, what is none is not") {
  const TemporaryFolder folder;
  const std::string rows = table_of(many_points(), false).substr(0, 4000);
  std::string wide = "\xFF\xFE";
  for (const char c : rows) wide += c, wide += '\0';
  CHECK(visited(write(folder, "wide.xyz", wide)).size() ==
        visited(write(folder, "mark.xyz", "\xEF\xBB\xBF" + rows)).size());
  CHECK_FALSE(is_cloud(write(folder, "read.txt", "This is a text.\n")));
  CHECK_FALSE(is_cloud(write(folder, "mesh.ply",
                             "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                             "property float y\nproperty float z\nelement face 1\n"
                             "property list uchar int vertex_indices\nend_header\n"
                             "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")));
  CHECK_FALSE(is_cloud(write(folder, "none.ply", "nothing")));
  CHECK_FALSE(is_cloud((folder / "gone.ply").string()));
}

TEST_CASE("a cloud that is cut or broken is named with the place") {
  const TemporaryFolder folder;
  const std::string ply = ply_of(many_points(), PlyCoding::kLittle, true);
  CHECK_THROWS_WITH(visited(write(folder, "cut.ply", ply.substr(0, ply.size() - 5))),
                    Contains("vertex 69999 of 70000") && Contains("truncated"));
  const std::string text = ply_of(many_points(), PlyCoding::kText, true);
  CHECK_THROWS_WITH(visited(write(folder, "cut2.ply", text.substr(0, text.size() / 2))),
                    Contains("of 70000"));
  std::string rows = table_of(many_points(), false);
  CHECK_THROWS_WITH(visited(write(folder, "bad.xyz", rows + "1 2\n")), Contains("line 70001"));
  CHECK_THROWS_WITH(visited(write(folder, "empty.xyz", "\n")), Contains("no line holds"));
  CHECK_THROWS_WITH(visited(write(folder, "long.xyz", std::string(3 << 20, '1'))),
                    Contains("longer than a mebibyte"));
}
