// Which of the rules by which colod differs from the paper are on. A room asks the set that its
// options hold; what a rule sees and does, why, and its numbers stand in rules/rules.h.
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>

namespace colod {

/// In the order in which data flows. With a rule off its room does what the paper says, or, where
/// the paper says nothing, nothing.
enum class Rule : std::uint8_t {
  kGround,
  kHidden,
  kFloaters,
  kFaces,
  kRoundSides,
  kEllipses,
  kRelief,
  kNoise,
  kFewPlanes,
  kSmoothNormals,
  kGrowing,
  kRegionArea,
  kCoplanar,
  kSheetSides,
  kUpright,
  kFamilies,
  kTilts,
  kNarrowStrips,
  kOffsets,
  kAbsorb,
  kHoles,
  kBorders,
  kOrientation,
  kAirborne,
  kPartyWalls,
  kWideOutlines,
  kHistograms,
  kSpecks,
  kDetails,
  kBehind,
  kAlcoves,
  kAlcoveGuard,
  kBalconies,
  kLoggias,
  kChimneys,
  kBays,
  kDormers,
  kWindows,
  kElementSegments,
  kFidelity,
  kAreaShares,
  kStrictBound,
  kWholeKinds,
  kKinds,
  kSmallPlanes,
  kMissingPlanes,
  kRoundLayers,
  kTolerance,
  kSides,
  kExtractionFoot,
  kLeaders,
  kElementCuts,
  kWalls,
  kReach,
  kFineCuts,
  kRings,
  kMinCut,
  kBoxFallback,
  kComponents,
  kCavities,
  kShortEdges,
  kNarrowFacets,
  kPruning,
  kFacetPrice,
  kPriceCap,
  kSheets,
  kVolume,
  kScenePart,
};
constexpr std::size_t kRuleCount = static_cast<std::size_t>(Rule::kScenePart) + 1;
/// Up to this one rules decide on planes and segments, later ones on layers and meshes.
constexpr Rule kLastOfSegments = Rule::kFidelity;

/// A set of rules, passed by value.
class RuleSet {
 public:
  /// --rules robust.
  static RuleSet all() { return RuleSet{}.flipped(); }
  /// --rules paper.
  static RuleSet none() { return {}; }

  bool has(Rule rule) const { return on_[static_cast<std::size_t>(rule)]; }
  bool is_none() const { return on_.none(); }
  bool is_all() const { return on_.all(); }
  RuleSet with(Rule rule) const { return set(rule, true); }
  RuleSet without(Rule rule) const { return set(rule, false); }

  friend bool operator==(const RuleSet& a, const RuleSet& b) { return a.on_ == b.on_; }

 private:
  RuleSet flipped() const {
    RuleSet other = *this;
    other.on_.flip();
    return other;
  }
  RuleSet set(Rule rule, bool is_on) const {
    RuleSet other = *this;
    other.on_[static_cast<std::size_t>(rule)] = is_on;
    return other;
  }

  std::bitset<kRuleCount> on_;
};

}  // namespace colod
