// LAS clouds: versions, point formats, classes, colours, and what is wrong with files.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "las_files.h"
#include "read/airborne.h"
#include "read_helpers.h"
#include "temporary_folder.h"

using namespace colod;
using namespace colod::test;
using Catch::Contains;

namespace {

/// Walls and a roof, some points apart from each other.
std::vector<LasPoint> house_points(int kind = 6) {
  std::vector<LasPoint> out;
  for (double x = 0; x <= 12; x += 0.5)
    for (double y = 0; y <= 8; y += 0.5) {
      const bool is_wall = x == 0 || x == 12 || y == 0 || y == 8;
      out.push_back({{x, y, 6}, kind});
      if (is_wall)
        for (double z = 0; z < 6; z += 0.5) out.push_back({{x, y, z}, kind});
    }
  return out;
}

Source only(const std::string& name, const std::string& bytes) {
  const ReadResult r = read_bytes(name, bytes);
  for (const ReadFailure& f : r.failures) UNSCOPED_INFO(f.message);
  REQUIRE(r.sources.size() == 1);
  return r.sources[0];
}

std::string joined(const std::vector<std::string>& lines) {
  std::string all;
  for (const std::string& l : lines) all += l + "\n";
  return all;
}

}  // namespace

TEST_CASE("LAS of all versions and point formats gives the same points") {
  const auto points = house_points();
  for (int minor = 0; minor <= 4; ++minor)
    for (int format = 0; format <= (minor == 4   ? 10
                                    : minor == 3 ? 5
                                    : minor >= 2 ? 3
                                                 : 1);
         ++format)
      for (const std::size_t extra : {0, 7}) {
        INFO("1." << minor << " format " << format << " extra " << extra);
        const Source s = only("a.las", las(points, minor, format, extra));
        REQUIRE(s.cloud.points.size() == points.size());
        CHECK((s.cloud.points[5] - points[5].at - kLasOffset).norm() < 1e-6);
        CHECK(s.look.colors.empty() == (kColorAt[format] == 0));
        if (!s.look.colors.empty()) CHECK(s.look.colors[5][0] == Rgb{5, 6, 7});
      }
}

TEST_CASE("LAS classes decide: buildings alone where there are any, else what may be one") {
  for (const int format : {0, 6}) {
    auto points = house_points();
    const std::size_t house = points.size();
    for (int i = 0; i < 40; ++i) points.push_back({{20.0 + i, 3, 0}, 2});
    for (int i = 0; i < 30; ++i) points.push_back({{3, 20.0 + i, 4}, 5});
    points.push_back({{1, 1, 7}, 6, true});
    const Source s = only("a.las", las(points, format == 6 ? 4 : 2, format));
    CHECK(s.cloud.points.size() == house);
    CHECK_THAT(joined(s.warnings), Contains("70 points left out: not of class 6") &&
                                       Contains("1 points left out: marked as withheld"));
    for (LasPoint& p : points)
      if (p.kind == 6) p.kind = 1;
    const Source unclassified = only("a.las", las(points, format == 6 ? 4 : 2, format));
    CHECK(unclassified.cloud.points.size() == house);
    CHECK_THAT(joined(unclassified.warnings), Contains("70 points left out: ground"));
  }
  CHECK_THAT(failure("a.las", las(house_points(2), 2, 0)), Contains("by its classes"));
}

TEST_CASE("a cloud is visited point by point, noise and what was withheld apart, block by block") {
  const std::size_t count = GENERATE(3, 32768, 40000);
  const int format = GENERATE(0, 7);
  std::vector<LasPoint> points;
  for (std::size_t i = 0; i < count; ++i)
    points.push_back({{0.5 * static_cast<double>(i), 1, 2}, i % 2 ? 2 : 6});
  points.push_back({{0, 0, 500}, 7}), points.push_back({{0, 0, 500}, 18});
  points.push_back({{0, 0, 9}, 6, true});
  const test::TemporaryFolder folder;
  const std::string path = (folder / "a.las").string();
  std::ofstream(path, std::ios::binary) << las(points, format > 5 ? 4 : 2, format);
  const AirborneCloud cloud(path, {});
  CHECK(cloud.has_color() == (format == 7));
  std::size_t seen = 0, ground = 0;
  bool is_right = true;
  cloud.visit([&](const AirbornePoint& p) {
    is_right &= (p.at - points[seen].at - kLasOffset).norm() < 1e-6;
    ground += p.kind == 2, ++seen;
  });
  CHECK(is_right);
  CHECK(seen == count);
  CHECK(ground == count / 2);
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 1);
  CHECK_THROWS_WITH(AirborneCloud(path, {}), Contains("truncated"));
}

TEST_CASE("what is wrong with LAS is named") {
  const std::string good = las(house_points(), 2, 2);
  const auto changed = [&](std::size_t at, auto value) {
    std::string bytes = good;
    set_at(bytes, at, value);
    return bytes;
  };
  CHECK_THAT(failure("a.las", good.substr(0, 200)), Contains("truncated within its header"));
  CHECK_THAT(failure("a.las", "LASX" + good.substr(4)), Contains("another format"));
  CHECK_THAT(failure("a.las", good.substr(0, good.size() - 30)),
             Contains("truncated: its header says"));
  CHECK_THAT(failure("a.las", changed(25, std::uint8_t{7})), Contains("version 1.7"));
  CHECK_THAT(failure("a.las", changed(104, std::uint8_t{11})), Contains("point format 11"));
  CHECK_THAT(failure("a.las", changed(105, std::uint16_t{19})), Contains("19 bytes a point"));
  CHECK_THAT(failure("a.las", changed(131, 0.0)), Contains("scale"));
  CHECK_THAT(failure("a.las", changed(155, std::nan(""))), Contains("scale or offset"));
  CHECK_THAT(failure("a.las", changed(107, std::uint32_t{4000000000u})),
             Contains("4000000000 points"));
  CHECK_THAT(failure("a.las", changed(96, std::uint32_t{3})), Contains("from byte 3 on"));
  CHECK_THAT(failure("a.las", changed(104, std::uint8_t{2 | 128})), Contains("name it .laz"));
}

TEST_CASE(
    "LAZ is unpacked by a program on the PATH, and named with a command where there is none") {
  const TempFolder folder;
  const std::string packed = [&] {
    std::string bytes = las(house_points(), 2, 0);
    set_at<std::uint8_t>(bytes, 104, 128);
    return bytes;
  }();
  const std::string laz = folder.write("a.laz", packed);
  const std::string before = std::getenv("PATH");
  setenv("PATH", folder.path.c_str(), 1);
  const ReadResult without = read_sources({laz});
  // A program of that name which gives back what was packed.
  const std::string plain = folder.write("plain.las", las(house_points(), 2, 0));
  const std::string program = folder.write(
      "las2las", "#!/bin/sh\n[ \"$1\" = -i ] && exec /bin/cp '" + plain + "' \"$4\"\n");
  std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  const ReadResult with = read_sources({laz});
  folder.write("las2las", "#!/bin/sh\nexit 3\n");
  const ReadResult broken = read_sources({laz});
  const ReadResult large = read_sources({laz}, {.input_memory = 0.001});
  setenv("PATH", before.c_str(), 1);
  REQUIRE(without.failures.size() == 1);
  CHECK_THAT(without.failures[0].message, Contains("pdal translate"));
  REQUIRE(with.sources.size() == 1);
  CHECK(with.sources[0].cloud.points.size() == house_points().size());
  REQUIRE(broken.failures.size() == 1);
  CHECK_THAT(broken.failures[0].message, Contains("exit code 3"));
  REQUIRE(large.failures.size() == 1);
  CHECK_THAT(large.failures[0].message, Contains("--input-memory"));
}
