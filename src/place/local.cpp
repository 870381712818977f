// Based on: WGS 84; Bowring's start and fixed-point steps for latitudes from ECEF.
#include "local.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/error.h"
#include "read/archive.h"

namespace colod {

namespace fs = std::filesystem;
using Json = nlohmann::json;

namespace {

constexpr double kMajor = 6378137, kFlattening = 1 / 298.257223563;
constexpr double kSquared = kFlattening * (2 - kFlattening);
constexpr double kLowest = 6.3e6, kHighest = 6.5e6;  // metres from the Earth's middle

/// The numbers of a member that is a list of `count`.
std::optional<std::vector<double>> list(const Json& json, const char* key, std::size_t count) {
  const auto found = json.find(key);
  if (found == json.end() || !found->is_array() || found->size() < count) return {};
  std::vector<double> out;
  for (const Json& value : *found) {
    if (!value.is_number()) return {};
    out.push_back(value.get<double>());
  }
  return out;
}

/// The middle of a tile's bounding volume with its transform.
std::optional<Vec3> middle_of(const Json& tile) {
  const auto volume = tile.find("boundingVolume");
  if (volume == tile.end() || !volume->is_object()) return {};
  if (const auto region = list(*volume, "region", 6)) {
    const std::vector<double>& r = *region;
    return geodetic_to_ecef((r[1] + r[3]) / 2, (r[0] + r[2]) / 2, (r[4] + r[5]) / 2);
  }
  auto at = list(*volume, "box", 12);
  if (!at) at = list(*volume, "sphere", 4);
  if (!at) return {};
  const Vec3 middle((*at)[0], (*at)[1], (*at)[2]);
  const auto transform = list(tile, "transform", 16);
  if (!transform) return middle;
  return (Eigen::Map<const Eigen::Matrix4d>(transform->data()) * middle.homogeneous()).head<3>();
}

/// Of what is in a tileset.json that `path` holds.
std::optional<Georeference> place_of_tileset(std::istream& in, const std::string& path) {
  // The tiles below the root are not needed: a tileset may list hundreds of thousands.
  const Json json = Json::parse(
      in,
      [](int depth, Json::parse_event_t event, Json& key) {
        return !(depth == 2 && event == Json::parse_event_t::key && key == "children");
      },
      false);
  if (!json.is_object() || !json.contains("root") || !json["root"].is_object()) return {};
  const std::optional<Vec3> middle = middle_of(json["root"]);
  if (!middle || !(middle->norm() > kLowest && middle->norm() < kHighest)) return {};
  const Vec3 place = ecef_to_geodetic(*middle);
  std::ostringstream crs;
  crs << std::setprecision(12) << "ENU:" << place.x() / kDegree << ',' << place.y() / kDegree << ','
      << std::setprecision(8) << place.z();
  return Georeference{crs.str(), Vec3::Zero(), path};
}

}  // namespace

Vec3 geodetic_to_ecef(double phi, double lambda, double height) {
  const double n = kMajor / std::sqrt(1 - kSquared * std::sin(phi) * std::sin(phi));
  return {(n + height) * std::cos(phi) * std::cos(lambda),
          (n + height) * std::cos(phi) * std::sin(lambda),
          (n * (1 - kSquared) + height) * std::sin(phi)};
}

Vec3 ecef_to_geodetic(const Vec3& p) {
  constexpr int kSteps = 20;  // each leaves a two-hundredth of the error
  const double lambda = std::atan2(p.y(), p.x()), r = std::hypot(p.x(), p.y());
  double phi = std::atan2(p.z(), r * (1 - kSquared));
  for (int i = 0; i < kSteps; ++i) {
    const double n = kMajor / std::sqrt(1 - kSquared * std::sin(phi) * std::sin(phi));
    phi = std::atan2(p.z() + kSquared * n * std::sin(phi), r);
  }
  const double n = kMajor / std::sqrt(1 - kSquared * std::sin(phi) * std::sin(phi));
  const double height = r * std::cos(phi) + p.z() * std::sin(phi) -
                        n * (1 - kSquared * std::sin(phi) * std::sin(phi));
  return {phi, lambda, height};
}

LocalPlace local_place(const Georeference& g) {
  const auto place = numbers(g.crs.substr(std::string("ENU:").size()));
  const bool is_high = place && place->size() > 2 && std::abs((*place)[2]) > kFarthest;
  if (!place || is_high || std::abs((*place)[0]) > 90 || std::abs((*place)[1]) > 360)
    throw Error(Stage::kUsage, g.source,
                "not a latitude, a longitude and a height: " + shortened(g.crs));
  const double phi = (*place)[0] * kDegree, lambda = (*place)[1] * kDegree;
  const double height = place->size() > 2 ? (*place)[2] : 0;
  const Vec3 east(-std::sin(lambda), std::cos(lambda), 0);
  const Vec3 up(std::cos(phi) * std::cos(lambda), std::cos(phi) * std::sin(lambda), std::sin(phi));
  LocalPlace out{geodetic_to_ecef(phi, lambda, height), {}};
  out.axes << east, up.cross(east), up;
  return out;
}

Eigen::Matrix4d local_from_ecef(const Georeference& g) {
  const LocalPlace place = local_place(g);
  Eigen::Matrix4d out = Eigen::Matrix4d::Identity();
  out.topLeftCorner<3, 3>() = place.axes.transpose();
  out.topRightCorner<3, 1>() = -(place.axes.transpose() * place.centre) - g.offset;
  return out;
}

std::optional<Georeference> georeference_of_tileset(const std::string& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return {};
  if (is_archive(path)) {
    std::istringstream in(read_archived(path, "tileset.json").value_or(""));
    return place_of_tileset(in, path);
  }
  if (fs::path(path).extension() != ".json") return {};
  std::ifstream in(path, std::ios::binary);
  return place_of_tileset(in, path);
}

}  // namespace colod
