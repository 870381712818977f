// Inside consistency: how far the parts of a building stand out of it, or into it, measured against
// the building with the part closed.
#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "consistency.h"
#include "core/rays.h"

namespace colod {

/// A point on a part's own faces.
struct PartSample {
  Vec3 point, along;  ///< unit: the direction that this side of the part looks in, or its opposite
  double relief = std::numeric_limits<double>::infinity();  ///< metres along it, either way, to the
                                                            ///< closed building; ∞: it is not there
  double area = 0;  ///< m² that it stands for
};

struct PartRelief {
  std::vector<PartSample> samples;
  double depth =
      0;  ///< metres: the least, over its sides of at least a tenth of its area, of their
          ///< middle relief, where that is not next to nothing (2 cm); 0: none has any
};

/// A source and what is its body. Windows and doors are closed by all that is neither, since they
/// stand in bays and dormers, too; other parts by the body alone. What closes a part is the body's
/// own surface, where there is any along the line, and the plane that goes on from the body around
/// the part: what faces alike by 30° within half a metre of it, seen along the line, and a metre in
/// depth (three, where there is nothing). So the edge of the hole in which a pane stands is no
/// surface that is near.
class ClosedBuilding {
 public:
  /// \pre the source's faces carry object numbers. It outlives this.
  ClosedBuilding(const Source& source, const TruthBuilding& truth);
  ~ClosedBuilding();

  /// One for every 0.01 m² of the part, or 400 if that is more, and of these those that are seen
  /// from outside: the inner side of a frame is no part of what a layer has to show. Deterministic.
  PartRelief sample(const TruthPart& part) const;

 private:
  struct Body;
  bool is_seen(const Vec3& x) const;

  const Source& source_;
  RayScene rays_;  // of all of it
  std::unique_ptr<Body> for_openings_, for_others_;
};

}  // namespace colod
