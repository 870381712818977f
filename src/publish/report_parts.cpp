// Based on: the paper's section 3.2 (similarity, clusters).
// Differs: the same under both rules.
// Notation: a part is one segment of one building.
#include "report_parts.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <tuple>

#include "exporters/html_report/html_report.h"

namespace colod {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr std::size_t kMostParts = 320;

struct Part {
  PartFacts facts;
  std::size_t building = 0, segment = 0;
};

/// By layer, there by falling extent.
std::vector<Part> sorted_parts(const std::vector<std::vector<PartFacts>>& buildings, int layers) {
  std::vector<Part> parts;
  for (std::size_t i = 0; i < buildings.size(); ++i)
    for (std::size_t s = 0; s < buildings[i].size(); ++s)
      if (buildings[i][s].layer >= 0 && buildings[i][s].layer < layers)
        parts.push_back({buildings[i][s], i, s});
  std::sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) {
    return std::tuple(a.facts.layer, -a.facts.extent, a.building, a.segment) <
           std::tuple(b.facts.layer, -b.facts.extent, b.building, b.segment);
  });
  return parts;
}

/// `parts` are those of one layer, by falling extent.
OrderedJson cluster_json(const std::vector<Part>& parts, int layer) {
  std::vector<std::size_t> buildings;
  double area = 0;
  std::size_t flat = 0;
  for (const Part& p : parts) {
    buildings.push_back(p.building);
    area += p.facts.area;
    flat += p.facts.is_flat;
  }
  std::sort(buildings.begin(), buildings.end());
  const auto end = std::unique(buildings.begin(), buildings.end());
  return {{"layer", layer},
          {"segments", parts.size()},
          {"buildings", end - buildings.begin()},
          {"flat", flat},
          {"extent", parts.empty() ? 0.0 : parts[parts.size() / 2].facts.extent},
          {"area", area}};
}

OrderedJson members_json(const std::vector<PartFacts>& parts, int layers) {
  std::vector<int> count(static_cast<std::size_t>(layers), 0);
  for (const PartFacts& p : parts)
    if (p.layer >= 0 && p.layer < layers) ++count[p.layer];
  return count;
}

std::vector<Part> pick(const std::vector<Part>& parts) {
  const std::size_t n = std::min(parts.size(), kMostParts);
  std::vector<Part> picked;
  for (std::size_t i = 0; i < n; ++i) picked.push_back(parts[i * parts.size() / n]);
  return picked;
}

/// Sums over pairs of layers.
class Between {
 public:
  explicit Between(int layers)
      : layers_(static_cast<std::size_t>(layers)),
        sums_(layers_ * layers_),
        counts_(sums_.size()) {}
  void add(int a, int b, double similarity) {
    for (const std::size_t at : {a * layers_ + b, b * layers_ + a})
      sums_[at] += similarity, counts_[at] += 1;
  }
  OrderedJson json() const {
    OrderedJson rows = OrderedJson::array();
    for (std::size_t a = 0; a < layers_; ++a) {
      rows.push_back(OrderedJson::array());
      for (std::size_t at = a * layers_; at < (a + 1) * layers_; ++at)
        rows.back().push_back(counts_[at] > 0 ? OrderedJson(sums_[at] / counts_[at])
                                              : OrderedJson());
    }
    return rows;
  }

 private:
  std::size_t layers_;
  std::vector<double> sums_, counts_;
};

void add_similarity(OrderedJson& json, const std::vector<Part>& parts,
                    const DescriptorOf& descriptor_of, const Options& options) {
  std::vector<Descriptor> descriptors;
  for (const Part& p : parts) descriptors.push_back(descriptor_of(p.building, p.segment));
  std::string values;
  Between between(options.layers);
  OrderedJson layer = OrderedJson::array(), building = OrderedJson::array(),
              segment = OrderedJson::array(), extent = OrderedJson::array();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    layer.push_back(parts[i].facts.layer);
    building.push_back(parts[i].building);
    segment.push_back(parts[i].segment);
    extent.push_back(parts[i].facts.extent);
    for (std::size_t j = i; j < parts.size(); ++j) {
      const double s = segment_similarity(descriptors[i], descriptors[j], options.eta);
      values += static_cast<char>(std::lround(255 * std::clamp(s, 0.0, 1.0)));
      if (i != j) between.add(parts[i].facts.layer, parts[j].facts.layer, s);
    }
  }
  json["similarity"] = {{"layer", layer},
                        {"building", building},
                        {"segment", segment},
                        {"extent", extent},
                        {"values", base64(values)}};
  json["between"] = between.json();
}

}  // namespace

std::vector<PartFacts> parts_of(const Building& b) {
  std::vector<PartFacts> parts;
  for (std::size_t s = 0; s < std::min(b.descriptors.size(), b.layer_of_segment.size()); ++s)
    parts.push_back({b.layer_of_segment[s], b.descriptors[s].extent, b.descriptors[s].area,
                     b.descriptors[s].is_flat});
  return parts;
}

std::string parts_json(const std::vector<std::vector<PartFacts>>& buildings,
                       const DescriptorOf& descriptor_of, const Options& options) {
  const std::vector<Part> parts = sorted_parts(buildings, options.layers);
  OrderedJson json;
  json["clusters"] = OrderedJson::array();
  for (int layer = 0; layer < options.layers; ++layer) {
    std::vector<Part> own;
    std::copy_if(parts.begin(), parts.end(), std::back_inserter(own),
                 [layer](const Part& p) { return p.facts.layer == layer; });
    json["clusters"].push_back(cluster_json(own, layer));
  }
  json["members"] = OrderedJson::array();
  for (const std::vector<PartFacts>& b : buildings)
    json["members"].push_back(members_json(b, options.layers));
  if (!parts.empty()) add_similarity(json, pick(parts), descriptor_of, options);
  return json.dump();
}

std::string parts_json(const Scene& scene, const Options& options) {
  std::vector<std::vector<PartFacts>> parts;
  for (const Building& b : scene.buildings) parts.push_back(parts_of(b));
  return parts_json(
      parts,
      [&](std::size_t building, std::size_t segment) {
        return scene.buildings[building].descriptors[segment];
      },
      options);
}

}  // namespace colod
