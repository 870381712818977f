// Inside the synth room: the makes that a varied street's builders had in store.
#pragma once

#include "makes.h"

namespace colod::synth {

/// What one house is made with.
struct Makes {
  WindowModel window, ground_window, side_window, ribbon, arched;
  DoorModel door, french, gate;
  BalconyModel balcony;
  ShapedDormer dormer;
  ChimneyModel chimney;
  BayModel bay;
  LoggiaModel loggia;
  ShopFront shop;
  ArcadeModel arcade;
  CorniceModel cornice;
};

/// All sizes are drawn from wide ranges by the street's seed; a few makes of each kind, so that
/// neighbours share some.
class Pool {
 public:
  explicit Pool(std::uint64_t street);
  Makes draw(Random& random) const;

 private:
  std::vector<WindowModel> windows_, ribbons_, arched_;
  std::vector<DoorModel> doors_, french_, gates_;
  std::vector<BalconyModel> balconies_;
  std::vector<ShapedDormer> dormers_;
  std::vector<ChimneyModel> chimneys_;
  std::vector<BayModel> bays_;
  std::vector<LoggiaModel> loggias_;
  std::vector<ShopFront> shops_;
  std::vector<ArcadeModel> arcades_;
  std::vector<CorniceModel> cornices_;
};

}  // namespace colod::synth
