// Based on: nothing published.
// Differs: the same under both rules.
// Notation: none.
#include "element_kind.h"

#include <algorithm>
#include <array>
#include <utility>

namespace colod {
namespace {

constexpr std::array<std::pair<ElementKind, std::string_view>, 20> kNames = {
    {{ElementKind::kPlain, "body"},      {ElementKind::kBalcony, "balcony"},
     {ElementKind::kLoggia, "recess"},   {ElementKind::kDormer, "dormer"},
     {ElementKind::kBay, "bay"},         {ElementKind::kSpire, "tower"},
     {ElementKind::kWindow, "window"},   {ElementKind::kChimney, "chimney"},
     {ElementKind::kDoor, "door"},       {ElementKind::kStairhead, "stairhead"},
     {ElementKind::kSteps, "steps"},     {ElementKind::kThin, "thin"},
     {ElementKind::kRoof, "roof"},       {ElementKind::kOrnament, "ornament"},
     {ElementKind::kAnnex, "annex"},     {ElementKind::kParapet, "parapet"},
     {ElementKind::kCornice, "cornice"}, {ElementKind::kArcade, "arcade"},
     {ElementKind::kPassage, "passage"}, {ElementKind::kOther, "other"}}};

}  // namespace

std::string name_of(ElementKind kind) {
  const auto at = std::find_if(kNames.begin(), kNames.end(),
                               [&](const auto& entry) { return entry.first == kind; });
  return std::string(at->second);
}

ElementKind kind_named(std::string_view name) {
  const auto at = std::find_if(kNames.begin(), kNames.end(),
                               [&](const auto& entry) { return entry.second == name; });
  return at == kNames.end() ? ElementKind::kOther : at->first;
}

}  // namespace colod
