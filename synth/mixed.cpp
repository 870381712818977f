// *Based on:* nothing published; sizes are drawn evenly in their logarithm, for every kind in three
// makes whose longest sides, and the areas of whose surfaces, span about the same as all other
// kinds': a balcony has 3 to 17 m² of surface, a window with its reveals 1 to 10, a chimney 2
// to 17.
//
// *Differs:* no --rules here.
//
// *Notation:* u, v: a facet's coordinates, right and up.
#include "mixed.h"

#include <algorithm>
#include <cmath>

namespace colod::synth {
namespace {

constexpr int kHallEvery = 8;        // buildings a hall
constexpr double kBelowEaves = 0.7;  // metres: the roof's edge hangs lower than the wall ends
constexpr int kSizes = 3;            // of each kind in a street: small, middle, large
const char* const kSizeNames[kSizes] = {"_small", "_middle", "_large"};

/// What the street's builders had in store, three sizes of everything.
struct SizedPool {
  std::vector<WindowModel> windows, arched;
  std::vector<DoorModel> doors, french;
  std::vector<BalconyModel> balconies;
  std::vector<DormerModel> dormers;
  std::vector<ChimneyModel> chimneys;
  std::vector<BayModel> bays;
  std::vector<LoggiaModel> loggias;
  std::vector<OrnamentModel> ornaments;

  explicit SizedPool(std::uint64_t street);
};

/// The part of [low, high] that belongs to size number `size`, evenly in the logarithm.
double sized(Random& r, double low, double high, int size) {
  const double share = (size + r.uniform(0.1, 0.9)) / kSizes;
  return std::round(100 * low * std::pow(high / low, share)) / 100;
}

SizedPool::SizedPool(std::uint64_t street) {
  Random r(street * 6271 + 29);
  for (int i = 0; i < kSizes; ++i) {
    const std::string size = kSizeNames[i];
    const int other = (i + 1) % kSizes, last = (i + 2) % kSizes;  // deep ones are not the wide ones
    windows.push_back({"window" + size, sized(r, 1.1, 3.2, i), sized(r, 1.15, 2.3, i),
                       sized(r, 0.12, 0.45, i), i, r.chance(0.5), false});
    arched.push_back({"window_arched" + size, sized(r, 0.6, 1.8, i), sized(r, 1.2, 3.0, i),
                      sized(r, 0.12, 0.45, other), 0, false, true});
    doors.push_back(
        {"door" + size, sized(r, 0.8, 3.0, i), sized(r, 1.9, 2.9, i), sized(r, 0.12, 0.45, last)});
    french.push_back({"door_french" + size, sized(r, 0.6, 2.8, i), sized(r, 1.55, 2.35, i),
                      sized(r, 0.12, 0.45, i)});
    balconies.push_back(
        {"balcony" + size, sized(r, 1.1, 3.2, i), sized(r, 0.5, 1.2, i), sized(r, 0.42, 1.1, i)});
    for (bool is_shed : {false, true})
      dormers.push_back({(is_shed ? "dormer_shed" : "dormer_gabled") + size, is_shed,
                         sized(r, 0.9, 3.0, i), sized(r, 0.8, 1.6, i)});
    chimneys.push_back(
        {"chimney" + size, sized(r, 0.4, 2.2, i), sized(r, 0.4, 1.1, i), sized(r, 0.5, 2.8, i)});
    const double bay = sized(r, 1.0, 3.0, i);
    bays.push_back({"bay" + size, bay, sized(r, 0.4, 1.0, i), r.chance(0.5) ? 0 : 0.15 * bay});
    loggias.push_back(
        {"loggia" + size, sized(r, 1.1, 3.2, i), sized(r, 1.9, 2.5, i), sized(r, 0.55, 1.3, i)});
    ornaments.push_back(
        {"ornament" + size, sized(r, 1.0, 3.2, i), sized(r, 0.9, 3.0, i), sized(r, 0.1, 0.6, i)});
  }
}

template <typename Model>
const Model& draw(Random& r, const std::vector<Model>& models) {
  return models[r.pick(static_cast<int>(models.size()))];
}

template <typename Model>
std::vector<Model> draw(Random& r, const std::vector<Model>& models, int n) {
  std::vector<Model> drawn;
  for (int i = 0; i < n; ++i) drawn.push_back(draw(r, models));
  return drawn;
}

/// So deep that two beside a corner do not meet inside of it, as close as the styles set them.
template <typename Model>
std::vector<Model> shallow(std::vector<Model> models) {
  constexpr double kDeepest = 0.3;
  for (Model& m : models)
    if (m.reveal > kDeepest) m.reveal = kDeepest, m.name += "_shallow";
  return models;
}

/// What one house takes from the pool, in the places where its style looks for it.
Catalogue draw_catalogue(const SizedPool& pool, std::uint64_t seed) {
  Random r(seed ^ 0x5bd1e995ull);
  Catalogue catalogue(seed);
  catalogue.windows = shallow(draw(r, pool.windows, 3));
  catalogue.tall_windows = shallow(draw(r, pool.windows, 2));
  catalogue.arched_windows = draw(r, pool.arched, 2);
  catalogue.doors = shallow(draw(r, pool.doors, 2));
  catalogue.french_doors = draw(r, pool.french, 2);
  catalogue.balconies = draw(r, pool.balconies, 2);
  catalogue.dormers = draw(r, pool.dormers, 2);
  catalogue.chimneys = draw(r, pool.chimneys, 2);
  catalogue.bays = draw(r, pool.bays, 2);
  catalogue.loggias = draw(r, pool.loggias, 1);
  return catalogue;
}

/// Of a list with equally many makes of each size, small ones first.
template <typename Model>
const Model& draw_sized(Random& r, const std::vector<Model>& models, int size) {
  const int makes = static_cast<int>(models.size()) / kSizes;
  return models[size * makes + r.pick(makes)];
}

/// Of the makes that leave a quarter of a metre on both sides, half of the time the widest.
template <typename Model>
const Model& draw_fitting(Random& r, const std::vector<Model>& models, double width,
                          double height) {
  constexpr double kBeside = 0.25, kAbove = 0.1;
  std::vector<const Model*> fitting;
  for (const Model& m : models)
    if (m.width + 2 * kBeside <= width && m.height + kAbove <= height) fitting.push_back(&m);
  if (fitting.empty()) return models.front();
  return r.chance(0.5) ? *fitting.back() : *fitting[r.pick(static_cast<int>(fitting.size()))];
}

/// Large parts come first, while there is room for them.
int size_of_attempt(int attempt, int attempts) { return kSizes - 1 - kSizes * attempt / attempts; }

/// Parts of any size wherever they fit on roofs.
void scatter_on_roof(House& house, int facet, const SizedPool& pool) {
  Random& r = house.random;
  const double width = house.solid.facet(facet).width(), height = house.solid.facet(facet).height();
  const int attempts = std::min(14, 2 + static_cast<int>(width * height / 9));
  for (int i = 0; i < attempts; ++i) {
    const double u = r.uniform(0, width), v = r.uniform(0, 0.8 * height);
    const int size = size_of_attempt(i, attempts);
    if (r.chance(0.4))
      add_chimney(house, facet, u, v, draw_sized(r, pool.chimneys, size));
    else
      add_dormer(house, facet, u, v, draw_sized(r, pool.dormers, size));
  }
}

void scatter_bay(House& house, int facet, double u, const SizedPool& pool, const BayModel& bay) {
  constexpr double kLeastHeight = 0.9, kSill = 0.6;
  Random& r = house.random;
  const double most = 0.5 * house.solid.facet(facet).height();
  const double v = r.uniform(0.3, most - kBelowEaves), height = r.uniform(kLeastHeight, most);
  const WindowModel& window =
      draw_fitting(r, pool.windows, bay.width - 2 * bay.splay, height - kSill);
  add_bay(house, facet, u, v, height, 3, bay, window);
}

/// Whatever sticks out or goes in keeps so far from a wall's ends that what two walls have does not
/// meet in a corner.
void scatter_on_wall(House& house, int facet, const SizedPool& pool, bool has_corners) {
  constexpr double kFromEnd = 1.75, kOrnamentFromEnd = 1.4, kDoorHeight = 2.4;
  Random& r = house.random;
  const double width = house.solid.facet(facet).width(), height = house.solid.facet(facet).height();
  const int attempts = std::min(24, 3 + static_cast<int>(width * height / 7));
  for (int i = 0; i < attempts; ++i) {
    const double kind = r.uniform(0, has_corners ? 0.2 : 1);
    const int size = size_of_attempt(i, attempts);
    if (kind < 0.2) {
      const OrnamentModel& ornament = draw_sized(r, pool.ornaments, size);
      const double least = kOrnamentFromEnd + ornament.width / 2;
      const double u = r.uniform(least, width - least), v = r.uniform(0.5, height);
      if (v + ornament.height / 2 > height - kBelowEaves) continue;
      if (u >= least && u <= width - least) add_ornament(house, facet, u, v, ornament);
    } else if (kind < 0.6) {
      const double v = r.uniform(0.6, std::max(0.7, height - kDoorHeight));
      const BalconyModel& balcony = draw_sized(r, pool.balconies, size);
      add_balcony(house, facet, r.uniform(0, width), v, balcony,
                  draw_fitting(r, pool.french, balcony.width, height - v));
    } else {
      const LoggiaModel& loggia = draw_sized(r, pool.loggias, size);
      const BayModel& bay = draw_sized(r, pool.bays, size);
      const DoorModel& door = draw_fitting(r, pool.french, loggia.width, loggia.height);
      const double least = kFromEnd + std::max(loggia.width, bay.width) / 2;
      const double u = r.uniform(least, width - least);
      if (u < least || u > width - least) continue;
      if (kind < 0.8)
        add_loggia(house, facet, u, r.uniform(0.4, std::max(0.5, height - kDoorHeight - 0.2)),
                   loggia, door);
      else
        scatter_bay(house, facet, u, pool, bay);
    }
  }
}

/// Walls and roofs as the style left them; what is added carries other numbers.
void scatter_parts(House& house, const SizedPool& pool) {
  const bool has_corners = house.style == "winged_house" || house.style == "church";
  const int facets = house.solid.facet_count();
  for (int f = 0; f < facets; ++f) {
    const double up = house.solid.facet(f).normal.z();
    const int object = house.solid.facet(f).object;
    if (object == kRoof && up > 0.25 && up < 0.98) scatter_on_roof(house, f, pool);
    if (object == kBody && std::abs(up) < 1e-6) scatter_on_wall(house, f, pool, has_corners);
  }
}

/// A house under one gabled roof.
struct Frame {
  const char* style;
  double width[2], depth[2], eaves[2], slope[2];
  double spacing, sill;
};
constexpr Frame kCottage = {"cottage", {5.5, 7.5}, {4.8, 6.2}, {2.9, 3.4}, {0.8, 1.2}, 3.0, 0.4};
constexpr Frame kTall = {"tall_house", {9, 15}, {8, 11}, {6, 9}, {0.8, 1.3}, 4.4, 0.5};
constexpr Frame kHall = {"hall", {34, 52}, {16, 24}, {7, 10}, {0.35, 0.6}, 6, 3.0};

House make_plain(const Frame& frame, const SizedPool& pool, std::uint64_t seed) {
  House house(frame.style, seed);
  Random& r = house.random;
  const auto within = [&](const double(&range)[2]) { return r.size(range[0], range[1]); };
  house.width = within(frame.width), house.depth = within(frame.depth);
  const Body body = add_gable_body(house, {.eaves = within(frame.eaves),
                                           .slope = within(frame.slope),
                                           .overhang = 0.3,
                                           .verge = 0.2,
                                           .thickness = 0.16});
  add_door(house, body.front, house.width / 2, 0.12, draw(r, pool.doors));
  const Facade facade = {.floors = {0.1}, .spacing = frame.spacing, .sill = frame.sill};
  for (int wall : {body.front, body.right, body.back, body.left})
    add_windows(house, wall, facade, draw(r, pool.windows));
  scatter_parts(house, pool);
  return house;
}

}  // namespace

House make_mixed_house(int index, int style, std::uint64_t street, std::uint64_t seed) {
  const SizedPool pool(street);
  if (index % kHallEvery == kHallEvery / 2) return make_plain(kHall, pool, seed);
  if (index % 8 != 0) return make_plain(index % 2 == 1 ? kCottage : kTall, pool, seed);
  House house = make_house(style, seed, draw_catalogue(pool, seed));
  scatter_parts(house, pool);
  return house;
}

bool is_large_kind(ElementKind kind) {
  return kind != ElementKind::kWindow && kind != ElementKind::kDoor &&
         kind != ElementKind::kOrnament;
}

}  // namespace colod::synth
