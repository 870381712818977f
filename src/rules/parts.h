// Inside room `rules`: the table's parts, a room or two each.
#pragma once

#include <numbers>

#include "rules.h"

namespace colod::rules {

constexpr double kDegrees = 180 / std::numbers::pi;  // of a radian

std::vector<RuleInfo> source_rules();      ///< scene, planes' input
std::vector<RuleInfo> relief_rules();      ///< melted meshes
std::vector<RuleInfo> plane_rules();       ///< growing and regularity
std::vector<RuleInfo> outline_rules();     ///< outlines, orientation, visibility
std::vector<RuleInfo> segment_rules();     ///< segments
std::vector<RuleInfo> coanalysis_rules();  ///< selection, clustering, layers
std::vector<RuleInfo> element_rules();     ///< elements
std::vector<RuleInfo> extraction_rules();  ///< extraction
std::vector<RuleInfo> chain_rules();       ///< a layer's planes and tolerance, the chain of layers

}  // namespace colod::rules
