// What an element of a building is: one word for it from the planes to the ground truth.
#pragma once

#include <string>
#include <string_view>

namespace colod {

/// A scene file holds the numbers of the first eight. What makes the building much taller is a
/// spire; what no detector tells (elements/elements.h) only a ground truth names.
enum class ElementKind {
  kPlain = 0,    ///< none: of the body
  kBalcony = 1,  ///< a floor with thin walls around it and nothing above
  kLoggia = 2,   ///< between two walls that face each other, behind the facade; a shop front, too
  kDormer = 3,   ///< on a roof that it stands out of
  kBay = 4,      ///< before a facade; closed
  kSpire = 5,
  kWindow = 6,  ///< a pane behind the facade, and its reveals; detectors take doors for windows
  kChimney,     ///< between two walls that look away from each other; solid
  kDoor,
  kStairhead,
  kSteps,
  kThin,  ///< what has hardly a thickness: a railing, a wire
  kRoof,  ///< of the body
  // Known to ground truths only:
  kOrnament,
  kAnnex,
  kParapet,
  kCornice,
  kArcade,
  kPassage,
  kOther
};

/// As ground truths, reports and groups of OBJ files write it: "body", "balcony", "recess"
/// (loggia), "dormer", "bay", "tower" (spire), "window", "chimney", "door", "stairhead", "steps",
/// "thin", "roof", "ornament", "annex", "parapet", "cornice", "arcade", "passage", "other".
std::string name_of(ElementKind kind);
/// kOther for any other word.
ElementKind kind_named(std::string_view name);

}  // namespace colod
