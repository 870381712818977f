// Based on: own work.
// Differs: compares files with each other, which no validator does.
#include "switching.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "files.h"

namespace colod {

using Json = nlohmann::json;

namespace {

constexpr double kMostLayers = 1e6;  // any number may stand in a file
constexpr double kSame = 1e-5;       // relative: tables hold floats

bool is_same(double a, double b) { return std::abs(a - b) <= kSame * std::max(a, b); }

}  // namespace

void ScopeCheck::expect(const Json& switching) {
  if (!switching.is_object() || switching.value("scope", "") != "scene") return;
  is_scene_ = true;
  for (const Json& layer : switching.value("layers", Json::array()))
    if (const double gsd = layer.value("gsd", 0.0); gsd > 0)
      said_[static_cast<int>(std::clamp(layer.value("layer", -1.0), -1.0, kMostLayers))].push_back(
          {gsd, "asset.extras"});
}

void ScopeCheck::add(const std::vector<GlbContent::Row>& rows, const std::string& where) {
  for (const GlbContent::Row& row : rows)
    if (row.layer >= 0 && row.gsd > 0)
      said_[row.layer].push_back({row.gsd, where + " " + row.name});
}

void ScopeCheck::report(std::vector<Finding>& findings) const {
  if (!is_scene_) return;
  for (const auto& [layer, said] : said_)
    for (const Said& s : said)
      if (!is_same(s.gsd, said.front().gsd)) {
        findings.push_back({"gsd-differs", s.where,
                            "layer " + std::to_string(layer) + " switches elsewhere than in " +
                                said.front().where + ", though the scope is the scene"});
        break;
      }
}

void check_lods(const std::string& text, const std::string& where, ScopeCheck& scope,
                std::vector<Finding>& findings) {
  const Json lods = parse_json(text);
  if (!lods.is_object() || !lods.contains("buildings")) {
    findings.push_back({"json", where, "not a list of levels"});
    return;
  }
  try {
    scope.expect(lods.at("switching"));
    const double height = lods.at("viewport_height"), fov = lods.at("fov_y_deg");
    const double view = 2 * std::tan(fov * std::numbers::pi / 360);
    for (const Json& building : lods.at("buildings")) {
      const std::string place = where + " " + building.at("name").get<std::string>();
      double finer = -1;
      std::vector<GlbContent::Row> rows;
      for (const Json& level : building.at("levels")) {
        const double gsd = level.at("gsd");
        if (!(gsd > finer) || (finer < 0 && gsd != 0))
          findings.push_back({"lod-gsd", place, "gsds do not rise strictly from 0"});
        if (!is_same(level.at("switch_distance"), gsd * height / view))
          findings.push_back(
              {"lod-distance", place, "a switch distance is not what its gsd makes"});
        rows.push_back({"", level.at("layer"), level.at("layers").at(0), gsd, 0});
        finer = gsd;
      }
      scope.add(rows, place);
    }
  } catch (const Json::exception& problem) {
    findings.push_back({"json", where, problem.what()});
  }
}

}  // namespace colod
