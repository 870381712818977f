// Based on: nothing published; how modellers and BIM converters nest what they write.
// Differs: --rules does not matter here.
#include "join.h"

#include <algorithm>

namespace colod::mesh_io {

namespace {

constexpr double kCovered = 0.5;   // of a body's cells: it stands on or in the other one
constexpr double kLow = 0.25;      // of its width: a body so low that carries others is ground
constexpr std::size_t kRoomy = 2;  // times the cells of what is in a building; a roof has fewer

}  // namespace

bool covers(const std::vector<Body>& bodies, const Contact& c) {
  const std::size_t least = std::min(bodies[c.a].cells.size(), bodies[c.b].cells.size());
  return c.cells >= kCovered * static_cast<double>(least);
}

Joiner::Joiner(const std::vector<Body>& bodies, const std::vector<char>& is_element)
    : bodies_(bodies),
      is_element_(is_element),
      contacts_(find_contacts(bodies)),
      of_body_(bodies.size()),
      sets_(bodies.size()) {
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    of_body_[contacts_[c].a].push_back(static_cast<int>(c));
    of_body_[contacts_[c].b].push_back(static_cast<int>(c));
  }
  find_carriers();
  find_buildings();
  for (const Contact& c : contacts_)
    if (is_building_[c.a] && is_building_[c.b] && covers(bodies_, c)) sets_.unite(c.a, c.b);
  for (std::size_t b = 0; b < bodies_.size(); ++b) attach(static_cast<int>(b));
}

/// Whether two bodies in the shape of buildings stand on this one and apart from one another.
bool Joiner::carries_two(int body) const {
  std::vector<int> carried;
  for (const int c : of_body_[body]) {
    const int o = other(c, body);
    if (bodies_[o].has_building_shape && !is_element_[o] && covers(bodies_, contacts_[c]) &&
        bodies_[o].cells.size() < bodies_[body].cells.size())
      carried.push_back(o);
  }
  for (std::size_t i = 1; i < carried.size(); ++i) {
    const auto& near = of_body_[carried[0]];
    if (std::none_of(near.begin(), near.end(),
                     [&](int c) { return other(c, carried[0]) == carried[i]; }))
      return true;
  }
  return false;
}

/// Ground and plates: low, with nothing below them, and two buildings on them that stand apart.
void Joiner::find_carriers() {
  is_carrier_.assign(bodies_.size(), 0);
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const Body& body = bodies_[b];
    const Vec3 size = body.box.size();
    const bool is_low = size.z() <= kLow * std::min(size.x(), size.y());
    if (is_element_[b] || (body.has_building_shape && !is_low)) continue;
    const bool is_lowest = std::none_of(of_body_[b].begin(), of_body_[b].end(), [&](int c) {
      return bodies_[other(c, static_cast<int>(b))].box.min.z() < body.box.min.z() - kStep;
    });
    is_carrier_[b] = is_lowest && carries_two(static_cast<int>(b));
  }
}

void Joiner::find_buildings() {
  is_building_.assign(bodies_.size(), 0);
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const Body& body = bodies_[b];
    if (!body.has_building_shape || is_element_[b] || is_carrier_[b]) continue;
    is_building_[b] = std::none_of(of_body_[b].begin(), of_body_[b].end(), [&](int c) {
      const Body& o = bodies_[other(c, static_cast<int>(b))];
      if (is_carrier_[other(c, static_cast<int>(b))]) return false;
      const bool is_on_it = o.has_building_shape && o.box.min.z() < body.box.min.z() - kStep;
      const bool is_in_it = covers(bodies_, contacts_[c]) && o.box.max.z() > body.box.max.z() &&
                            o.cells.size() > kRoomy * body.cells.size();
      return is_on_it || is_in_it;
    });
  }
}

/// The neighbour with the most cells in common; −1: none.
int Joiner::strongest(int body, bool among_buildings) const {
  int best = -1, most = 0;
  for (const int c : of_body_[body]) {
    const int o = other(c, body);
    if (is_carrier_[o] || is_building_[o] != among_buildings || contacts_[c].cells <= most)
      continue;
    best = o, most = contacts_[c].cells;
  }
  return best;
}

/// What is no building joins the building that it shares most with; where it touches none, the
/// other parts that touch it.
void Joiner::attach(int body) {
  if (is_building_[body] || is_carrier_[body]) return;
  if (const int building = strongest(body, true); building >= 0) {
    sets_.unite(body, building);
    return;
  }
  bool has_free = false;
  for (const int c : of_body_[body]) {
    const int o = other(c, body);
    if (is_carrier_[o] || strongest(o, true) >= 0) continue;
    sets_.unite(body, o), has_free = true;
  }
  if (const int part = strongest(body, false); !has_free && part >= 0) sets_.unite(body, part);
}

}  // namespace colod::mesh_io
