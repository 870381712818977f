// Inside the synth room: the catalogue of repeated parts and how they are put on a house.
//
// A house is built in its own frame: the street lies towards −y, z = 0 is the ground.
#pragma once

#include <random>
#include <string>
#include <vector>

#include "outlines.h"
#include "synth.h"

namespace colod::synth {

/// Own mapping of the generator's bits, so that numbers are the same with every standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : bits_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(bits_() >> 11) * 0x1p-53);
  }
  int pick(int n) { return static_cast<int>(uniform(0, n)); }
  bool chance(double probability) { return uniform(0, 1) < probability; }
  /// To whole centimetres, as a builder would.
  double size(double low, double high) { return std::round(100 * uniform(low, high)) / 100; }

 private:
  std::mt19937_64 bits_;
};

struct WindowModel {
  std::string name;
  double width, height, reveal;
  int panes;  ///< behind a frame; 0: no frame
  bool has_sill, is_arched;
  int rows = 1;         ///< of panes
  double surround = 0;  ///< metres that a frame of stone stands out; not around arches
};
struct DoorModel {
  std::string name;
  double width, height, reveal;
};
struct BalconyModel {
  std::string name;
  double width, depth, parapet;
  double slab = 0.18, wall = 0.1;  ///< metres of thickness
  int pillars = 0;                 ///< below its front, down to the ground
  double pillar = 0.25;            ///< metres of thickness
};
struct DormerModel {
  std::string name;
  bool is_shed;
  double width, height;
};
struct ChimneyModel {
  std::string name;
  double width, depth, height;  ///< above where it leaves the roof, uphill
};
struct BayModel {
  std::string name;
  double width, depth, splay;  ///< the front is narrower by `splay` on each side
};
struct LoggiaModel {
  std::string name;
  double width, height, depth;
};

struct OrnamentModel {
  std::string name;
  double width, height, depth;
};

/// What a neighbourhood's builders had in store. Every house chooses from it.
struct Catalogue {
  explicit Catalogue(std::uint64_t seed);
  std::vector<WindowModel> windows, tall_windows, arched_windows;
  std::vector<DoorModel> doors, french_doors;
  std::vector<BalconyModel> balconies;
  std::vector<DormerModel> dormers;
  std::vector<ChimneyModel> chimneys;
  std::vector<BayModel> bays;
  std::vector<LoggiaModel> loggias;
};

constexpr int kBody = 0, kRoof = 1;  ///< instances that every house has

struct House {
  House(std::string style_name, std::uint64_t seed);

  std::string style;
  Random random;
  Solid solid;
  std::vector<SynthPart> parts;
  double width = 0, depth = 0;  ///< footprint in its frame: x in [0, width], y in [0, depth] or so
  double before = 0, beside = 0;  ///< metres that it reaches beyond, to the street and to the sides
  Ground ground;

  int new_part(ElementKind kind, const std::string& model, double relief);
  template <typename Model>
  const Model& choose(const std::vector<Model>& models) {
    return models[random.pick(static_cast<int>(models.size()))];
  }
};

// Each puts one part on the facet, u its middle and v its foot in the facet's coordinates, or
// returns false (loggia, bay: −1) and does nothing where it does not fit.
bool add_window(House& house, int facet, double u, double v, const WindowModel& model);
bool add_door(House& house, int facet, double u, double v, const DoorModel& model);
/// With its French door; v is the floor's level.
bool add_balcony(House& house, int facet, double u, double v, const BalconyModel& model,
                 const DoorModel& door);
/// With a French door at the back.
bool add_loggia(House& house, int facet, double u, double v, const LoggiaModel& model,
                const DoorModel& door);
/// `height` from foot to top; a window for each floor.
bool add_bay(House& house, int facet, double u, double v, double height, double floor_height,
             const BayModel& model, const WindowModel& window);
/// On a sloped facet; v along the slope.
bool add_dormer(House& house, int facet, double u, double v, const DormerModel& model);
bool add_chimney(House& house, int facet, double u, double v, const ChimneyModel& model);
/// A relief on a wall, u and v its middle.
bool add_ornament(House& house, int facet, double u, double v, const OrnamentModel& model);
bool add_roof_window(House& house, int facet, double u, double v);
/// A room for the stairs on a flat roof.
bool add_stairhead(House& house, int facet, double u, double v);

/// Windows in columns over the floors of a wall, with what stands there already left alone.
struct Facade {
  std::vector<double> floors;  ///< heights of the floors above the wall's foot
  double spacing = 2.6;        ///< between columns
  double sill = 0.9;
};
std::vector<double> facade_columns(const House& house, int facet, double spacing);
void add_windows(House& house, int facet, const Facade& facade, const WindowModel& model);

}  // namespace colod::synth
