#include "place/place.h"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <thread>

#include "core/error.h"

using namespace colod;
namespace fs = std::filesystem;

namespace {

constexpr double kDegree = std::numbers::pi / 180;

struct Ellipsoid {
  double a, f;
};
constexpr Ellipsoid kGrs80 = {6378137, 1 / 298.257222101}, kWgs84 = {6378137, 1 / 298.257223563};

struct Geodetic {
  double phi, lambda;  // degrees
};

/// Transverse Mercator to latitude and longitude by Krüger's series to n^3: good to a millimetre,
/// and written down without PROJ.
Geodetic inverse_mercator(const Ellipsoid& e, double x, double y, double scale, double lambda0) {
  const double n = e.f / (2 - e.f);
  const double radius = e.a / (1 + n) * (1 + n * n / 4 + n * n * n * n / 64);
  const double beta[] = {n / 2 - 2 * n * n / 3 + 37 * n * n * n / 96, n * n / 48 + n * n * n / 15,
                         17 * n * n * n / 480};
  const double delta[] = {2 * n - 2 * n * n / 3 - 2 * n * n * n, 7 * n * n / 3 - 8 * n * n * n / 5,
                          56 * n * n * n / 15};
  const double xi = y / (scale * radius), eta = x / (scale * radius);
  double xi1 = xi, eta1 = eta;
  for (int j = 1; j <= 3; ++j) {
    xi1 -= beta[j - 1] * std::sin(2 * j * xi) * std::cosh(2 * j * eta);
    eta1 -= beta[j - 1] * std::cos(2 * j * xi) * std::sinh(2 * j * eta);
  }
  const double chi = std::asin(std::sin(xi1) / std::cosh(eta1));
  double phi = chi;
  for (int j = 1; j <= 3; ++j) phi += delta[j - 1] * std::sin(2 * j * chi);
  return {phi / kDegree, lambda0 + std::atan2(std::sinh(eta1), std::cos(xi1)) / kDegree};
}

Vec3 ecef(const Ellipsoid& e, const Geodetic& g, double h) {
  const double phi = g.phi * kDegree, lambda = g.lambda * kDegree, e2 = e.f * (2 - e.f);
  const double n = e.a / std::sqrt(1 - e2 * std::sin(phi) * std::sin(phi));
  return {(n + h) * std::cos(phi) * std::cos(lambda), (n + h) * std::cos(phi) * std::sin(lambda),
          (n * (1 - e2) + h) * std::sin(phi)};
}

Vec3 placed(const std::string& crs, const Vec3& p) {
  return place_on_earth({crs, Vec3::Zero(), "test"}, p).to_ecef(p);
}

/// A folder that goes away with the test.
struct Folder {
  fs::path path = fs::temp_directory_path() / ("colod_georeference_" + std::to_string(getpid()));
  Folder() { fs::create_directories(path); }
  ~Folder() { fs::remove_all(path); }
  void write(const std::string& name, const std::string& text) const {
    fs::create_directories((path / name).parent_path());
    std::ofstream(path / name) << text;
  }
};

}  // namespace

TEST_CASE("UTM control points stand where Krüger's series puts them, to a centimetre") {
  for (const Vec3& p : {Vec3(691234.567, 5334567.891, 512.3), Vec3(500000, 5500000, 0),
                        Vec3(320000.25, 5900000.75, -4)}) {
    const Geodetic g = inverse_mercator(kGrs80, p.x() - 500000, p.y(), 0.9996, 9);
    CHECK((placed("EPSG:25832", p) - ecef(kGrs80, g, p.z())).norm() < 0.01);
  }
  const Geodetic south = inverse_mercator(kWgs84, 334000 - 500000, 6252000 - 1e7, 0.9996, 153);
  CHECK((placed("EPSG:32756", {334000, 6252000, 30}) - ecef(kWgs84, south, 30)).norm() < 0.01);
}

TEST_CASE("easting comes first, whatever order the system declares its axes in") {
  // DHDN zone 3 and ETRS89 (N-E) declare northing first.
  const Vec3 p(691234.5, 5334567.5, 500);
  const Vec3 expected =
      ecef(kGrs80, inverse_mercator(kGrs80, p.x() - 500000, p.y(), 0.9996, 9), 500);
  CHECK((placed("EPSG:3044", p) - expected).norm() < 0.01);
  // MGI Austria GK East declares northing first; Vienna's cathedral.
  const Vec3 vienna = placed("EPSG:31256", {2980, 341040, 170});
  CHECK((vienna - ecef(kWgs84, {48.2085, 16.3735}, 215)).norm() < 300);
}

TEST_CASE("a datum shift is made: the Dutch grid's centre to within its Helmert transformation") {
  const Vec3 amersfoort = placed("EPSG:28992", {155000, 463000, 0});
  const Geodetic known = {52.15517440, 5.38720621};  // of the published RD approximation
  const Vec3 there = ecef(kGrs80, known, 0);
  const Vec3 up = there.normalized();
  const Vec3 off = amersfoort - there;
  CHECK((off - off.dot(up) * up).norm() < 0.5);
}

TEST_CASE("heights of a compound system go through its geoid, or a warning says that they do not") {
  const Vec3 p(691234.5, 5334567.5, 500);
  const EarthMap egm = place_on_earth({"EPSG:32632+5773", Vec3::Zero(), "test"}, p);
  const Vec3 flat = placed("EPSG:32632", p);
  const double raised = (egm.to_ecef(p) - flat).norm();
  if (egm.warnings.empty())
    CHECK(raised == Approx(45.5).margin(3));  // EGM96's undulation near Munich
  else
    CHECK(raised < 1e-3);
  const EarthMap missing = place_on_earth({"EPSG:7415", Vec3::Zero(), "test"}, {155000, 463000, 3});
  REQUIRE(missing.warnings.size() <= 1);
  CHECK(missing.to_ecef({155000, 463000, 3}).allFinite());
}

TEST_CASE("an origin in degrees gives axes east, north and up there") {
  const auto g = georeference_from_options("", "52.5, 13.4,100");
  REQUIRE(g);
  const EarthMap map = place_on_earth(*g, Vec3::Zero());
  CHECK((map.to_ecef(Vec3::Zero()) - ecef(kWgs84, {52.5, 13.4}, 100)).norm() < 1e-6);
  CHECK((map.to_ecef({0, 0, 7}) - ecef(kWgs84, {52.5, 13.4}, 107)).norm() < 1e-6);
  const Vec3 north = ecef(kWgs84, {52.5 + 1e-5, 13.4}, 100) - map.to_ecef(Vec3::Zero());
  const Vec3 axis = map.to_ecef({0, 1, 0}) - map.to_ecef(Vec3::Zero());
  CHECK(axis.dot(north.normalized()) > 0.999999);
}

TEST_CASE("an origin in a system is added to the coordinates") {
  const auto g = georeference_from_options("EPSG:25832", "691000,5334000,500");
  REQUIRE(g);
  CHECK((place_on_earth(*g, {234.5, 567.5, 1}).to_ecef({234.5, 567.5, 1}) -
         placed("EPSG:25832", {691234.5, 5334567.5, 501}))
            .norm() < 1e-6);
}

TEST_CASE("what cannot be a place is refused, and nothing given is no place") {
  CHECK(!georeference_from_options("", ""));
  CHECK(!georeference_from_options("local", ""));
  CHECK_THROWS_AS(georeference_from_options("", "1;2"), Error);
  CHECK_THROWS_AS(georeference_from_options("", "nan,2"), Error);
  CHECK_THROWS_AS(georeference_from_options("", "48,11,1e300"), Error);
  CHECK_THROWS_AS(georeference_from_options("EPSG:25832", "1e300,5334000"), Error);
  CHECK_THROWS_AS(placed("ENU:48,11,1e300", Vec3::Zero()), Error);
  CHECK_THROWS_AS(georeference_from_options("", "691000,5334000"), Error);
  CHECK_THROWS_AS(georeference_from_options("local", "1,2"), Error);
  CHECK_THROWS_WITH(placed("EPSG:999999", Vec3::Zero()), Catch::Contains("unknown"));
  CHECK_THROWS_WITH(placed("EPSG:4326", Vec3::Zero()), Catch::Contains("--origin"));
  CHECK_THROWS_AS(placed("EPSG:25832", {1e12, 1e12, 0}), Error);
}

TEST_CASE("ContextCapture's metadata.xml is found beside the input and above its tiles") {
  const Folder folder;
  folder.write("metadata.xml",
               "<?xml version=\"1.0\"?><ModelMetadata version=\"1\"><SRS>EPSG:25832</SRS>\n"
               "<SRSOrigin>691000,5334000,500</SRSOrigin></ModelMetadata>");
  folder.write("Data/Tile_+001_+002/a.obj", "");
  folder.write("other/a.obj", "");
  for (const char* input : {"", "Data", "Data/Tile_+001_+002", "Data/Tile_+001_+002/a.obj"}) {
    const auto g = georeference_beside((folder.path / input).string());
    REQUIRE(g);
    CHECK(g->crs == "EPSG:25832");
    CHECK(g->offset == Vec3(691000, 5334000, 500));
  }
  CHECK(!georeference_beside((folder.path / "other/a.obj").string()));
  folder.write("metadata.xml", "<SRS>ENU:48.1,11.5</SRS><SRSOrigin>0,0,0</SRSOrigin>");
  const auto g = georeference_beside(folder.path.string());
  REQUIRE(g);
  CHECK((place_on_earth(*g, Vec3::Zero()).to_ecef(Vec3::Zero()) - ecef(kWgs84, {48.1, 11.5}, 0))
            .norm() < 1e-6);
  folder.write("metadata.xml", "<SRS>EPSG:25832</SRS><SRSOrigin>here</SRSOrigin>");
  CHECK_THROWS_AS(georeference_beside(folder.path.string()), Error);
}

TEST_CASE("a metadata.xml is read as XML, and what is none is refused in one short line") {
  const Folder folder;
  const auto beside = [&](const std::string& text) {
    folder.write("metadata.xml", text);
    return georeference_beside(folder.path.string());
  };
  const auto g = beside(
      "\xEF\xBB\xBF<?xml version='1.0'?>\r\n<!-- <SRS>EPSG:4326</SRS> -->"
      "<M><SRS a='1'><![CDATA[EPSG:25832]]></SRS>\n<SRSOrigin>\n 1, 2, 3\n</SRSOrigin></M>");
  REQUIRE(g);
  CHECK(g->crs == "EPSG:25832");
  CHECK(g->offset == Vec3(1, 2, 3));
  CHECK(!beside("<project><modelVersion>4</modelVersion></project>"));
  std::string deep;
  for (int i = 0; i < 200000; ++i) deep += "<a>";
  for (const std::string& text :
       {std::string("no XML at all"), std::string("\0\1\2", 3), deep.substr(0, 900000),
        "<SRS>" + std::string(60000, 'A') + "</SRS>", std::string(2000000, ' '),
        "<M><SRS>EPSG:25832</SRS><SRSOrigin>" + std::string(60000, '1') + "</SRSOrigin></M>"}) {
    try {
      beside(text);
      FAIL("accepted");
    } catch (const Error& e) {
      CHECK(std::string(e.what()).size() < 300);
    }
  }
}

TEST_CASE("an offset file of any length is refused, not searched for ever") {
  const Folder folder;
  for (const std::string& line : {std::string(100000, ' '), std::string(100000, '1'),
                                  "WGS84 UTM 32N" + std::string(100000, 'N')}) {
    folder.write("odm_georeferencing/odm_georeferencing_model_geo.txt", line + "\n1 2\n");
    folder.write("odm_texturing/model.obj", "");
    CHECK_THROWS_AS(georeference_beside((folder.path / "odm_texturing").string()), Error);
  }
}

TEST_CASE("OpenDroneMap's and Pix4D's offsets are read") {
  const Folder folder;
  folder.write("odm_georeferencing/odm_georeferencing_model_geo.txt",
               "WGS84 UTM 32N\n691000 5334000\n");
  folder.write("odm_texturing/model.obj", "");
  const auto odm = georeference_beside((folder.path / "odm_texturing/model.obj").string());
  REQUIRE(odm);
  CHECK(odm->crs == "EPSG:32632");
  CHECK(odm->offset == Vec3(691000, 5334000, 0));
  folder.write("pix/p_offset.xyz", "691000.0 5334000.0 500.0\n");
  CHECK(!georeference_beside((folder.path / "pix").string()));
  folder.write(
      "pix/p_wkt.prj",
      "PROJCS[\"WGS 84 / UTM zone 32N\",GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS "
      "84\",6378137,298.257223563]],PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0."
      "0174532925199433]],PROJECTION[\"Transverse_Mercator\"],PARAMETER[\"latitude_of_"
      "origin\",0],PARAMETER[\"central_meridian\",9],PARAMETER[\"scale_factor\",0.9996],"
      "PARAMETER[\"false_easting\",500000],PARAMETER[\"false_northing\",0],UNIT[\"metre\",1]]");
  const auto pix = georeference_beside((folder.path / "pix").string());
  REQUIRE(pix);
  CHECK((place_on_earth(*pix, {1, 2, 3}).to_ecef({1, 2, 3}) -
         placed("EPSG:32632", {691001, 5334002, 503}))
            .norm() < 0.01);
}

TEST_CASE("several threads may ask at once") {
  const EarthMap map = place_on_earth({"EPSG:25832", Vec3::Zero(), "test"}, {5e5, 5e6, 0});
  const Vec3 expected = map.to_ecef({6e5, 5.3e6, 10});
  std::vector<std::thread> threads;
  std::vector<int> wrong(4);
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&, t] {
      for (int i = 0; i < 200; ++i) wrong[t] += map.to_ecef({6e5, 5.3e6, 10}) != expected;
    });
  for (std::thread& t : threads) t.join();
  CHECK(wrong == std::vector<int>(4, 0));
}

TEST_CASE("a tileset on Earth says where it is, a local one does not") {
  const fs::path folder = fs::temp_directory_path() / ("colod-tileset-" + std::to_string(getpid()));
  fs::create_directories(folder);
  const std::string path = (folder / "tileset.json").string();
  const Georeference jakarta{"ENU:-6.4249,107.3768,40", Vec3::Zero(), "test"};
  const EarthMap map = place_on_earth(jakarta, Vec3::Zero());
  const Vec3 middle = map.to_ecef({100, 200, 0});
  char text[400];
  std::snprintf(text, sizeof text,
                R"({"root":{"boundingVolume":{"sphere":[%.6f,%.6f,%.6f,50]},"children":[{}]}})",
                middle.x(), middle.y(), middle.z());
  std::ofstream(path) << text;
  const auto found = georeference_beside(path);
  REQUIRE(found);
  CHECK((place_on_earth(*found, Vec3::Zero()).to_ecef(Vec3::Zero()) - middle).norm() < 1e-3);
  const Vec3 point = map.to_ecef({130, 180, 7});
  const Vec3 local = (local_from_ecef(*found) * point.homogeneous()).head<3>();
  CHECK((local - Vec3(30, -20, 7)).norm() < 0.02);  // axes turn by some 2e-5
  CHECK((place_on_earth(*found, Vec3::Zero()).to_ecef(local) - point).norm() < 1e-6);
  std::ofstream(path) << R"({"root":{"boundingVolume":{"sphere":[1,2,3,50]}}})";
  CHECK_FALSE(georeference_of_tileset(path));
  std::ofstream(path) << R"({"root":{"boundingVolume":{"region":[1.87,-0.11,1.88,-0.10,0,90]}}})";
  CHECK(georeference_of_tileset(path)->crs.starts_with("ENU:-6.01"));
  fs::remove_all(folder);
}
