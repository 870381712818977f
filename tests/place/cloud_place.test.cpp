// What a LAS says itself of its place and its units, in all versions and both kinds of records.
#include "place/cloud_place.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>

#include "core/error.h"
#include "las_files.h"
#include "read/airborne.h"
#include "temporary_folder.h"

using namespace colod;
using namespace colod::test;
using Catch::Contains;

namespace {

constexpr double kSurveyFoot = 1200.0 / 3937;

const std::string kUtm =
    "PROJCS[\"WGS 84 / UTM zone 32N\",GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS "
    "84\",6378137,298.257223563]],PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]],"
    "PROJECTION[\"Transverse_Mercator\"],PARAMETER[\"latitude_of_origin\",0],PARAMETER[\"central_"
    "meridian\",9],PARAMETER[\"scale_factor\",0.9996],PARAMETER[\"false_easting\",500000],"
    "PARAMETER[\"false_northing\",0],UNIT[\"metre\",1]]";
const std::string kFeet =
    "COMPD_CS[\"NAD83 / New York Long Island (ftUS) + NAVD88 height (ftUS)\",PROJCS[\"NAD83 / New "
    "York Long Island (ftUS)\",GEOGCS[\"NAD83\",DATUM[\"North_American_Datum_1983\",SPHEROID[\"GRS "
    "1980\",6378137,298.257222101]],PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]],"
    "PROJECTION[\"Lambert_Conformal_Conic_2SP\"],PARAMETER[\"latitude_of_origin\",40.1666666666667]"
    ",PARAMETER[\"central_meridian\",-74],PARAMETER[\"standard_parallel_1\",41.0333333333333],"
    "PARAMETER[\"standard_parallel_2\",40.6666666666667],PARAMETER[\"false_easting\",984250],"
    "PARAMETER[\"false_northing\",0],UNIT[\"US survey foot\",0.304800609601219]],VERT_CS[\"NAVD88 "
    "height (ftUS)\",VERT_DATUM[\"North American Vertical Datum 1988\",2005],UNIT[\"US survey "
    "foot\",0.304800609601219]]]";

/// One file with records, for as long as the test lasts.
struct Cloud {
  TemporaryFolder folder;
  std::string path;

  explicit Cloud(const std::vector<LasRecord>& records, int minor = 2, bool has_wkt_bit = false) {
    path = write("a.las", records, minor, has_wkt_bit);
  }
  std::string write(const std::string& name, const std::vector<LasRecord>& records, int minor = 2,
                    bool has_wkt_bit = false) const {
    std::string bytes = with_records(
        las({{{0, 0, 0}}, {{9, 9, 9}}, {{5, 5, 5}}}, minor, minor == 4 ? 6 : 0), records);
    if (has_wkt_bit) set_at<std::uint16_t>(bytes, 6, 16);
    for (std::size_t k = 0; k < 3; ++k)
      for (const std::size_t side : {0, 8})
        set_at(bytes, 179 + 16 * k + side, kLasOffset[static_cast<long>(k)] + 5);
    write_text(name, bytes);
    return (folder / name).string();
  }
  void write_text(const std::string& name, const std::string& text) const {
    std::ofstream((folder / name).string(), std::ios::binary) << text;
  }
  CloudUnits units() const { return units_of_cloud(read_cloud_system(path)); }
};

Vec3 placed(const Georeference& g, const Vec3& p) { return place_on_earth(g, p).to_ecef(p); }

double off(const Georeference& g, const std::string& crs, const Vec3& at = kLasOffset) {
  return (placed(g, at) - placed({crs, Vec3::Zero(), "test"}, at)).norm();
}

}  // namespace

TEST_CASE("both kinds of records of a LAS place it, early and late, to a millimetre") {
  const LasRecord keys = geokeys({{1024, 1}, {3072, 32632}, {3076, 9001}});
  const LasRecord wkt = {2112, kUtm + '\0'}, late = {2112, kUtm + '\0', true};
  for (const auto& [minor, record, has_bit] : {std::tuple(2, keys, false),
                                               {2, wkt, false},
                                               {4, keys, false},
                                               {4, wkt, true},
                                               {4, late, true},
                                               {0, keys, false},
                                               {3, keys, false}}) {
    CAPTURE(minor, record.id, record.is_late);
    const Cloud cloud({{34000, "another"}, record}, minor, has_bit);
    const auto found = georeference_beside(cloud.path);
    REQUIRE(found);
    CHECK(found->source == cloud.path);
    CHECK(found->warnings.empty());
    CHECK(off(*found, "EPSG:32632") < 1e-3);
    CHECK(cloud.units().text.empty());
    CHECK(cloud.units().metres == Vec3::Ones());
  }
  CHECK_FALSE(georeference_beside(Cloud({}).path));
}

TEST_CASE("of two kinds of records the header's bit decides, and the other one stands in") {
  const LasRecord keys = geokeys({{1024, 1}, {3072, 32633}}), wkt = {2112, kUtm};
  CHECK(off(*georeference_of_cloud(Cloud({keys, wkt}, 4, false).path), "EPSG:32633") < 1e-3);
  CHECK(off(*georeference_of_cloud(Cloud({keys, wkt}, 4, true).path), "EPSG:32632") < 1e-3);
  const auto other = georeference_of_cloud(Cloud({keys, {2112, "PROJCS[\"cut"}}, 4, true).path);
  REQUIRE(other);
  CHECK(off(*other, "EPSG:32633") < 1e-3);
  REQUIRE(other->warnings.size() == 1);
  CHECK_THAT(other->warnings[0], Contains("PROJCS[\"cut"));
}

TEST_CASE("heights of a compound system go along, by their code, by the code of their datum") {
  for (const auto& [code, crs] : {std::pair(5773, "EPSG:32632+5773"),
                                  {5703, "EPSG:32632+5703"},
                                  {5103, "EPSG:32632+5703"},
                                  {5030, "EPSG:32632"}}) {
    CAPTURE(code);
    const auto found = georeference_of_cloud(Cloud({geokeys({{3072, 32632}, {4096, code}})}).path);
    REQUIRE(found);
    CHECK(found->crs == crs);
  }
  const auto odd = georeference_of_cloud(Cloud({geokeys({{3072, 32632}, {4096, 4979}})}).path);
  REQUIRE(odd);
  CHECK(odd->crs == "EPSG:32632");
  CHECK_THAT(odd->warnings.at(0), Contains("EPSG:4979") && Contains("no vertical system"));
}

TEST_CASE("feet are feet: by keys, by the system's own axes, across and up apart") {
  const Cloud wkt({{2112, kFeet}}, 4, true);
  CHECK((wkt.units().metres - Vec3::Constant(kSurveyFoot)).norm() < 1e-9);
  CHECK(wkt.units().text == "US survey foot");
  CHECK(wkt.units().doubt.empty());
  const CloudUnits by_code = Cloud({geokeys({{3072, 2263}, {4096, 5703}})}).units();
  CHECK((by_code.metres - Vec3(kSurveyFoot, kSurveyFoot, 1)).norm() < 1e-9);
  CHECK(by_code.text == "US survey foot, heights in metre");
  const CloudUnits by_key =
      Cloud({geokeys({{3072, 32632}, {3076, 9002}, {4096, 5703}, {4099, 9003}})}).units();
  CHECK((by_key.metres - Vec3(0.3048, 0.3048, kSurveyFoot)).norm() < 1e-9);
  const CloudUnits silent = Cloud({geokeys({{3072, 2263}})}).units();
  CHECK((silent.metres - Vec3::Constant(kSurveyFoot)).norm() < 1e-9);
  CHECK_THAT(silent.doubt, Contains("of heights it says nothing"));
}

TEST_CASE("points in feet come out in metres where their system puts them") {
  const Cloud cloud({geokeys({{3072, 2263}, {3076, 9003}, {4096, 6360}, {4099, 9003}})});
  const AirborneCloud read(cloud.path, {.cloud_units = units_of_cloud});
  CHECK_THAT(read.warnings().at(0), Contains("read in US survey foot") && Contains("--unit m"));
  std::vector<Vec3> points;
  read.visit([&](const AirbornePoint& p) { points.push_back(p.at); });
  CHECK((points.at(1) - kSurveyFoot * (kLasOffset + Vec3(9, 9, 9))).norm() < 1e-4);
  // The same point of the system in metres (EPSG:32118), which has another false easting of none.
  const auto found = georeference_of_cloud(cloud.path);
  REQUIRE(found);
  CHECK(found->crs == "EPSG:2263+6360");
  const Vec3 feet = placed({"EPSG:2263", Vec3::Zero(), "test"}, points[1]);
  const Vec3 metres = placed({"EPSG:32118", Vec3::Zero(), "test"}, points[1]);
  CHECK((feet - metres).norm() < 0.01);
  const AirborneCloud said(cloud.path, {.unit = 1, .cloud_units = units_of_cloud});
  CHECK_THAT(said.warnings().at(0), Contains("--unit says otherwise"));
  said.visit([&](const AirbornePoint& p) { points.push_back(p.at); });
  CHECK((points.at(4) - (kLasOffset + Vec3(9, 9, 9))).norm() < 1e-6);
}

TEST_CASE("a system bound to WGS 84 by its text is one") {
  std::string bound = kUtm;
  bound.insert(bound.find("],PRIMEM"), ",TOWGS84[0,0,0,0,0,0,0]");
  const auto found = georeference_of_cloud(Cloud({{2112, bound}}, 4, true).path);
  REQUIRE(found);
  CHECK(off(*found, "EPSG:32632") < 1e-3);
}

TEST_CASE("a projection that keys define by its parameters is one where GDAL is there") {
  LasRecord keys = geokeys({{1024, 1},
                            {2048, 4258},
                            {3072, 32767},
                            {3074, 32767},
                            {3075, 1},
                            {3076, 9001},
                            {3080, 0},
                            {3081, 1},
                            {3082, 2},
                            {3083, 3},
                            {3092, 4}});
  for (std::size_t i = 7; i <= 11; ++i) set_at<std::uint16_t>(keys.bytes, 8 * i - 6 + 8, 34736);
  const double values[] = {9, 0, 500000, 0, 0.9996};
  LasRecord numbers = {34736, std::string(sizeof values, '\0')};
  std::memcpy(numbers.bytes.data(), values, sizeof values);
  const Cloud cloud({keys, numbers, {34737, std::string("mine|\0", 6)}});
  try {
    const auto found = georeference_of_cloud(cloud.path);
    REQUIRE(found);
    CHECK(off(*found, "EPSG:25832") < 1e-3);
  } catch (const Error& error) {
    CHECK_THAT(error.what(), Contains("built with GDAL"));
  }
}

TEST_CASE("what a LAS says wrongly of its place is named in one short line") {
  const auto message = [](const std::vector<LasRecord>& records, bool has_bit = false) {
    const Cloud cloud(records, 4, has_bit);
    CHECK(cloud.units().metres == Vec3::Ones());
    try {
      georeference_of_cloud(cloud.path);
    } catch (const Error& error) {
      CHECK(std::string(error.what()).size() < 400);
      CHECK(std::string(error.what()).find('\n') == std::string::npos);
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  CHECK_THAT(message({geokeys({{3072, 29999}})}), Contains("EPSG:29999, which PROJ does not know"));
  CHECK_THAT(message({geokeys({{1024, 2}, {2048, 4326}})}), Contains("WGS 84, is in degrees"));
  CHECK_THAT(message({{2112, std::string(60000, 'A')}}), Contains("no reference system"));
  CHECK_THAT(message({{2112, ""}}), Contains("is empty"));
  CHECK_THAT(message({geokeys({{1024, 1}})}), Contains("name no reference system"));
  LasRecord cut = geokeys({{1024, 1}, {3072, 32632}});
  cut.bytes.resize(12);
  CHECK_THAT(message({cut}), Contains("are cut or empty"));
  std::string random(400, '\0');
  for (std::size_t i = 0; i < random.size(); ++i) random[i] = static_cast<char>(i * 97 + i / 3);
  CHECK_THAT(message({{2112, random}}), !Contains("accepted"));
  CHECK_THAT(message({{34735, random}}), !Contains("accepted"));
}

TEST_CASE("records beyond the file's end, and counts of thousands of millions, end the search") {
  const Cloud cloud({geokeys({{3072, 32632}})});
  std::string bytes = slurp(cloud.path);
  std::string many = bytes;
  set_at<std::uint32_t>(many, 100, 4000000000u);
  cloud.write_text("many.las", many);
  const auto found = georeference_of_cloud((cloud.folder / "many.las").string());
  REQUIRE(found);  // the record that is there is believed
  CHECK_THAT(found->warnings.at(0), Contains("records end before the 4000000000"));
  std::string far = bytes;
  set_at<std::uint16_t>(far, 227 + 20, 60000);
  cloud.write_text("far.las", far);
  CHECK_THROWS_WITH(georeference_of_cloud((cloud.folder / "far.las").string()),
                    Contains("LASF_Projection 34735 is cut"));
  cloud.write_text("short.las", bytes.substr(0, 240));
  CHECK_THROWS_AS(georeference_of_cloud((cloud.folder / "short.las").string()), Error);
  cloud.write_text("none.las", "LASF");
  CHECK_FALSE(georeference_of_cloud((cloud.folder / "none.las").string()));
}

TEST_CASE("a file beside a cloud stands in where its own word is of no use, else it is told of") {
  const std::string beside = "<M><SRS>EPSG:25833</SRS><SRSOrigin>0,0,0</SRSOrigin></M>";
  const Cloud good({geokeys({{3072, 32632}})}), bad({geokeys({{3072, 29999}})});
  good.write_text("metadata.xml", beside), bad.write_text("metadata.xml", beside);
  const auto own = georeference_beside(good.path), other = georeference_beside(bad.path);
  REQUIRE((own && other));
  CHECK(own->crs == "EPSG:32632");
  CHECK_THAT(own->warnings.at(0), Contains("metadata.xml says EPSG:25833"));
  CHECK(other->crs == "EPSG:25833");
  CHECK_THAT(other->warnings.at(0), Contains("EPSG:29999"));
}

TEST_CASE("a folder of clouds alone lies where they say, unless they contradict each other") {
  const Cloud cloud({geokeys({{3072, 32632}})});
  cloud.write("b.las", {{2112, kUtm}});
  cloud.write("c.las", {});
  cloud.write_text("readme.txt", "flown in November");
  const std::string folder = cloud.folder.path().string();
  const auto found = georeference_beside(folder);
  REQUIRE(found);
  CHECK(found->crs == "EPSG:32632");
  cloud.write("d.las", {geokeys({{3072, 32633}})});
  CHECK_THROWS_WITH(georeference_of_cloud(folder), Contains("elsewhere on Earth"));
  cloud.write_text("house.obj", "");
  CHECK_FALSE(georeference_of_cloud(folder));
}
