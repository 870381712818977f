// Based on: nothing published; how modellers, game engines and BIM converters name and nest what
// they write.
// Differs: --rules does not matter here.
#include "split.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

#include "alternatives.h"
#include "bodies.h"
#include "core/union_find.h"
#include "files.h"
#include "join.h"

namespace colod::mesh_io {

namespace {

constexpr std::size_t kMostCells = 20'000'000;  // 5 km² of plan; what comes later stands by itself
constexpr double kTurnsBack =
    -0.9;                       // cosine of two faces at an edge: walls that lie on one another
constexpr double kSlope = 0.3;  // of the distance that feet of bodies that stand apart may differ

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_between(char c) { return c == ' ' || c == '_' || c == '-' || c == '.'; }

/// Whether the last word of a name, or an IFC class, says that this is no whole building.
bool is_element(const std::string& name) {
  static const std::vector<std::string> elements = {
      "wall", "roof",   "window",  "door",   "floor",   "slab",     "stair",
      "beam", "column", "ceiling", "storey", "railing", "covering", "furniture"};
  const std::string low = lower(name);
  if (low.starts_with("ifc"))
    return !low.starts_with("ifcbuilding") && !low.starts_with("ifcsite") &&
           !low.starts_with("ifcproject");
  std::size_t end = low.size();
  while (end > 0 && !is_letter(low[end - 1])) --end;
  std::size_t begin = end;
  while (begin > 0 && is_letter(low[begin - 1])) --begin;
  std::string word = low.substr(begin, end - begin);
  if (word.size() > 4 && word.back() == 's') word.pop_back();
  return std::find(elements.begin(), elements.end(), word) != elements.end();
}

/// Objects, nodes or groups: what the file says of each triangle.
struct Labels {
  std::vector<int> of_triangle;  // −1: left out
  std::vector<std::string> names;
};

Labels object_labels(const RawFile& raw, const Triangles& all) {
  Labels labels{{}, raw.parts};
  const auto rest = static_cast<int>(raw.parts.size());
  for (const int polygon : all.polygon) {
    const int p = raw.face_part[polygon];
    labels.of_triangle.push_back(p >= 0 ? p : rest);
  }
  if (std::find(labels.of_triangle.begin(), labels.of_triangle.end(), rest) !=
      labels.of_triangle.end())
    labels.names.emplace_back();
  return labels;
}

Labels group_labels(const RawFile& raw, const Triangles& all) {
  Labels labels;
  std::map<int, int> number_of;
  for (const int polygon : all.polygon) {
    const int g = raw.face_group[polygon];
    const auto [it, is_new] = number_of.emplace(g, static_cast<int>(labels.names.size()));
    if (is_new) {
      const bool is_named = g >= 0 && g < static_cast<int>(raw.groups.size());
      labels.names.push_back(is_named ? raw.groups[g] : g < 0 ? "" : std::to_string(g));
    }
    labels.of_triangle.push_back(it->second);
  }
  return labels;
}

/// Levels of detail hang below their building's node: label → the node that is shown.
void fold(const RawFile& raw, Labels& labels) {
  for (int& label : labels.of_triangle)
    while (label >= 0 && label < static_cast<int>(raw.part_parent.size()) &&
           raw.part_parent[label] >= 0)
      label = raw.part_parent[label];
}

std::vector<std::vector<int>> triangles_of(const std::vector<int>& of_triangle, std::size_t n) {
  std::vector<std::vector<int>> lists(n);
  for (std::size_t t = 0; t < of_triangle.size(); ++t)
    if (of_triangle[t] >= 0) lists[of_triangle[t]].push_back(static_cast<int>(t));
  return lists;
}

/// One part a label that has triangles, in the labels' order.
Parting part_by(const Labels& labels) {
  Parting parting;
  std::vector<int> number(labels.names.size(), -1);
  for (const int label : labels.of_triangle)
    if (label >= 0) number[label] = 0;
  int count = 0;
  for (std::size_t i = 0; i < number.size(); ++i) {
    if (number[i] < 0) continue;
    number[i] = count++;
    const std::string& name = labels.names[i];
    parting.parts.push_back({name.empty() ? "rest" : name, name});
  }
  for (const int label : labels.of_triangle)
    parting.part_of.push_back(label < 0 ? -1 : number[label]);
  if (parting.parts.size() == 1) parting.parts[0] = {};
  return parting;
}

Parting one_part(const Triangles& all) {
  return {std::vector<int>(all.faces.size(), 0), {{"", ""}}, ""};
}

/// Connected components over shared (or equal) points: triangle → component, numbered by first
/// triangle.
std::vector<int> components(const std::vector<int>& welded, const std::vector<Face>& faces,
                            int& count) {
  UnionFind sets(welded.size());
  for (const Face& f : faces)
    for (int i = 1; i < 3; ++i) sets.unite(welded[f[0]], welded[f[i]]);
  std::vector<int> number(welded.size(), -1), result;
  count = 0;
  for (const Face& f : faces) {
    int& c = number[sets.find(welded[f[0]])];
    if (c < 0) c = count++;
    result.push_back(c);
  }
  return result;
}

Parting part_components(const RawFile& raw, const Triangles& all) {
  Labels labels;
  int count = 0;
  labels.of_triangle = components(weld(raw.points), all.faces, count);
  for (int c = 0; c < count; ++c) labels.names.push_back(std::to_string(c + 1));
  Parting parting = part_by(labels);
  for (Part& part : parting.parts) part.given.clear();
  return parting;
}

/// What `auto` looks at.
class Splitter {
 public:
  Splitter(const RawFile& raw, const Triangles& all)
      : raw_(raw), all_(all), welded_(weld(raw.points)) {}

  Parting split();

 private:
  std::vector<Body> describe(const std::vector<std::vector<int>>& lists) const;
  void drop_coarser_levels(Labels& labels);
  void drop_alternatives(Labels& labels);
  Labels join(const Labels& labels, std::vector<char>& has_building) const;
  void join_open_ones(Labels& labels, std::vector<char>& has_building) const;
  Parting by_objects();
  Parting by_groups();
  void part_bodies(Parting& parting);
  std::vector<std::vector<int>> apart(const std::vector<int>& triangles) const;
  int detach(const std::vector<int>& triangles, Parting& parting, int part) const;
  void say(const std::string& what) { said_ += (said_.empty() ? "" : "; ") + what; }

  const RawFile& raw_;
  const Triangles& all_;
  const std::vector<int> welded_;
  std::string said_;
};

std::vector<Body> Splitter::describe(const std::vector<std::vector<int>>& lists) const {
  std::vector<Body> bodies;
  std::size_t cells = 0;
  for (const std::vector<int>& list : lists) {
    bodies.push_back(describe_body(raw_.points, welded_, all_.faces, list));
    cells += bodies.back().cells.size();
    if (cells > kMostCells) bodies.back().cells.clear(), bodies.back().is_wide = true;
  }
  return bodies;
}

/// Of labels whose names differ by a level of detail alone and that are on one place, the one with
/// the most triangles stays.
void Splitter::drop_coarser_levels(Labels& labels) {
  std::map<std::pair<int, std::string>, std::vector<int>> levels;
  for (std::size_t i = 0; i < labels.names.size(); ++i)
    if (const auto base = name_without_level(labels.names[i]))
      levels[{i < raw_.part_parent.size() ? raw_.part_parent[i] : -1, *base}].push_back(
          static_cast<int>(i));
  std::erase_if(levels, [](const auto& entry) { return entry.second.size() < 2; });
  if (levels.empty()) return;
  const auto lists = triangles_of(labels.of_triangle, labels.names.size());
  const std::vector<Body> bodies = describe(lists);
  std::vector<std::vector<int>> above(bodies.size());
  for (const Contact& c : find_contacts(bodies))
    if (covers(bodies, c)) above[c.a].push_back(c.b), above[c.b].push_back(c.a);
  std::vector<char> is_dropped(bodies.size(), 0);
  std::string kept;
  int dropped = 0;
  for (auto& [key, members] : levels) {
    std::stable_sort(members.begin(), members.end(),
                     [&](int a, int b) { return lists[a].size() > lists[b].size(); });
    const int finest = members.front();
    int own = 0;
    for (const int m : members)
      if (m != finest && std::count(above[finest].begin(), above[finest].end(), m) > 0)
        is_dropped[m] = 1, ++own;
    if (own > 0 && kept.empty()) kept = labels.names[finest];
    if (own > 0 && !key.second.empty()) labels.names[finest] = key.second;
    dropped += own;
  }
  if (dropped == 0) return;
  for (int& label : labels.of_triangle)
    if (label >= 0 && is_dropped[label]) label = -1;
  say(std::to_string(dropped) + " coarser levels of detail are left out, '" + kept +
      "' is the finest (--split object or none takes them all)");
}

/// Of labels on one place that show the same thing, whatever their names, the one with the most
/// triangles stays.
void Splitter::drop_alternatives(Labels& labels) {
  const auto lists = triangles_of(labels.of_triangle, labels.names.size());
  const std::vector<Body> bodies = describe(lists);
  std::vector<char> is_dropped(bodies.size(), 0);
  std::string kept;
  for (const Contact& c : find_contacts(bodies)) {
    const auto [coarse, fine] =
        lists[c.a].size() < lists[c.b].size() ? std::pair(c.a, c.b) : std::pair(c.b, c.a);
    if (is_dropped[coarse] || !covers(bodies, c) ||
        !is_coarser_alternative(raw_.points, all_.faces, lists[coarse], lists[fine]))
      continue;
    is_dropped[coarse] = 1;
    if (kept.empty()) kept = labels.names[fine];
  }
  const auto dropped = std::count(is_dropped.begin(), is_dropped.end(), 1);
  if (dropped == 0) return;
  for (int& label : labels.of_triangle)
    if (label >= 0 && is_dropped[label]) label = -1;
  say(std::to_string(dropped) + " parts show what finer ones on their place show, as '" + kept +
      "', and are left out (--split object or none takes them all)");
}

/// Labels that are one building become one, named after the one of the largest area.
Labels Splitter::join(const Labels& labels, std::vector<char>& has_building) const {
  const std::vector<Body> bodies = describe(triangles_of(labels.of_triangle, labels.names.size()));
  std::vector<char> elements;
  for (const std::string& name : labels.names) elements.push_back(is_element(name));
  Joiner joiner(bodies, elements);
  Labels joined;
  joined.names.resize(labels.names.size());
  has_building.assign(labels.names.size(), 0);
  std::vector<double> largest(labels.names.size(), -1);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const int set = joiner.set_of(static_cast<int>(b));
    has_building[set] |= joiner.is_building(static_cast<int>(b));
    if (bodies[b].area > largest[set]) {
      largest[set] = bodies[b].area;
      joined.names[set] = labels.names[b];
    }
  }
  for (const int label : labels.of_triangle)
    joined.of_triangle.push_back(label < 0 ? -1 : joiner.set_of(label));
  return joined;
}

Parting Splitter::by_objects() {
  Labels labels = object_labels(raw_, all_);
  drop_coarser_levels(labels);
  drop_alternatives(labels);
  fold(raw_, labels);
  const Parting apart = part_by(labels);
  if (apart.parts.size() < 2) return apart;
  std::vector<char> has_building;
  Parting joined = part_by(join(labels, has_building));
  if (joined.parts.size() < apart.parts.size())
    say(std::to_string(apart.parts.size()) +
        " parts touch or stand in one another and are taken for " +
        std::to_string(joined.parts.size()) + " building" + (joined.parts.size() > 1 ? "s" : "") +
        " (--split object: one each, --split none: all one)");
  return joined;
}

/// Labels between which the surface goes on, without a wall, are one building, named after the one
/// with the most triangles: each alone would be open there. Where the walls of neighbours lie on
/// one another it turns back.
void Splitter::join_open_ones(Labels& labels, std::vector<char>& has_building) const {
  std::vector<std::array<int, 3>> edges;  // both ends, triangle
  for (std::size_t t = 0; t < all_.faces.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] =
          std::minmax(welded_[all_.faces[t][k]], welded_[all_.faces[t][(k + 1) % 3]]);
      if (a != b) edges.push_back({a, b, static_cast<int>(t)});
    }
  std::sort(edges.begin(), edges.end());
  const auto normal = [&](int t) {
    const Face& f = all_.faces[t];
    const Vec3 &a = raw_.points[f[0]], &b = raw_.points[f[1]], &c = raw_.points[f[2]];
    return Vec3((b - a).cross(c - a).normalized());
  };
  UnionFind sets(labels.names.size());
  for (std::size_t i = 0, end; i < edges.size(); i = end) {
    for (end = i; end < edges.size() &&
                  std::equal(edges[i].begin(), edges[i].begin() + 2, edges[end].begin());)
      ++end;
    if (end - i != 2) continue;
    const int s = edges[i][2], t = edges[i + 1][2];
    const int a = labels.of_triangle[s], b = labels.of_triangle[t];
    if (a >= 0 && b >= 0 && a != b && normal(s).dot(normal(t)) > kTurnsBack) sets.unite(a, b);
  }
  const auto lists = triangles_of(labels.of_triangle, labels.names.size());
  std::vector<int> largest(labels.names.size(), -1);
  for (std::size_t i = 0; i < lists.size(); ++i) {
    int& best = largest[sets.find(static_cast<int>(i))];
    if (best < 0 || lists[i].size() > lists[best].size()) best = static_cast<int>(i);
  }
  for (std::size_t i = 0; i < lists.size(); ++i)
    has_building[largest[sets.find(static_cast<int>(i))]] |= has_building[i];
  for (int& label : labels.of_triangle)
    if (label >= 0) label = largest[sets.find(label)];
}

/// Groups are mostly walls and roofs, or materials: they are buildings only where all that remains
/// after joining looks like one.
Parting Splitter::by_groups() {
  const Labels labels = group_labels(raw_, all_);
  std::vector<char> has_building;
  Labels joined = join(labels, has_building);
  join_open_ones(joined, has_building);
  const bool is_apart = std::all_of(joined.of_triangle.begin(), joined.of_triangle.end(),
                                    [&](int set) { return has_building[set]; });
  Parting parting = part_by(joined);
  const std::size_t n = parting.parts.size();
  if (is_apart && n > 1) {
    say("its groups stand apart and are taken for " + std::to_string(n) +
        " buildings (--split none: all one)");
    return parting;
  }
  if (n > 1 && std::count(has_building.begin(), has_building.end(), 1) > 1)
    say("its " + std::to_string(labels.names.size()) +
        " groups are taken for one building, since some look like none (--split group: one each)");
  return one_part(all_);
}

/// Metres in plan between two boxes.
double distance(const Box& a, const Box& b) {
  const Vec3 gap = (a.min - b.max).cwiseMax(b.min - a.max).cwiseMax(Vec3::Zero());
  return gap.head<2>().norm();
}

/// Triangles in sets that stand apart; none where one is too wide to tell.
std::vector<std::vector<int>> Splitter::apart(const std::vector<int>& triangles) const {
  std::vector<Face> faces;
  for (const int t : triangles) faces.push_back(all_.faces[t]);
  int count = 0;
  const std::vector<int> component = components(welded_, faces, count);
  if (count < 2) return {};
  std::vector<std::vector<int>> lists(count), joined(count);
  for (std::size_t i = 0; i < triangles.size(); ++i) lists[component[i]].push_back(triangles[i]);
  const std::vector<Body> pieces = describe(lists);
  if (std::any_of(pieces.begin(), pieces.end(), [](const Body& b) { return b.is_wide; })) return {};
  UnionFind sets(pieces.size());
  for (const Contact& c : find_contacts(pieces)) sets.unite(c.a, c.b);
  for (std::size_t i = 0; i < triangles.size(); ++i)
    joined[sets.find(component[i])].push_back(triangles[i]);
  std::erase_if(joined, [](const std::vector<int>& list) { return list.empty(); });
  return joined;
}

/// The largest body first, then those that look like buildings and stand about as deep.
std::vector<int> buildings_among(const std::vector<Body>& bodies) {
  const auto largest = std::max_element(
      bodies.begin(), bodies.end(), [](const Body& a, const Body& b) { return a.area < b.area; });
  std::vector<int> buildings = {static_cast<int>(largest - bodies.begin())};
  for (auto b = bodies.begin(); b != bodies.end(); ++b) {
    const double rise = b->box.min.z() - largest->box.min.z();
    if (b != largest && b->has_building_shape &&
        rise <= kStep + kSlope * distance(b->box, largest->box))
      buildings.push_back(static_cast<int>(b - bodies.begin()));
  }
  return buildings;
}

/// Parts what stands apart from the largest body of a part and looks like a building. What looks
/// like none stays with the nearest. How many were parted.
int Splitter::detach(const std::vector<int>& triangles, Parting& parting, int part) const {
  const std::vector<std::vector<int>> lists = apart(triangles);
  if (lists.size() < 2) return 0;
  const std::vector<Body> bodies = describe(lists);
  const std::vector<int> buildings = buildings_among(bodies);
  const Part named = parting.parts[part];
  const int before = static_cast<int>(parting.parts.size()) - 1;
  for (std::size_t k = 1; k < buildings.size(); ++k) {
    const std::string number = std::to_string(k + 1);
    parting.parts.push_back({named.name.empty() ? number : named.name + "_" + number, named.given});
  }
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const auto rank = [&](int building) {
      return std::make_pair(building != static_cast<int>(b),
                            distance(bodies[building].box, bodies[b].box));
    };
    const auto nearest = std::min_element(buildings.begin(), buildings.end(),
                                          [&](int i, int j) { return rank(i) < rank(j); });
    if (const auto k = static_cast<int>(nearest - buildings.begin()); k > 0)
      for (const int t : lists[b]) parting.part_of[t] = before + k;
  }
  return static_cast<int>(buildings.size()) - 1;
}

void Splitter::part_bodies(Parting& parting) {
  const auto lists = triangles_of(parting.part_of, parting.parts.size());
  int parted = 0;
  for (std::size_t p = 0; p < lists.size(); ++p)
    parted += detach(lists[p], parting, static_cast<int>(p));
  if (parted > 0)
    say("bodies that look like buildings stand apart, " + std::to_string(parted) +
        " parted from the largest (--split none: all one)");
}

Parting Splitter::split() {
  Parting parting = raw_.parts.size() > 1    ? by_objects()
                    : raw_.groups.size() > 1 ? by_groups()
                                             : one_part(all_);
  part_bodies(parting);
  parting.message = said_;
  return parting;
}

}  // namespace

std::vector<int> weld(const std::vector<Vec3>& points) {
  std::vector<int> order(points.size()), first(points.size());
  std::iota(order.begin(), order.end(), 0);
  const auto is_finite = [&](int i) { return points[i].allFinite(); };
  const auto key = [&](int i) {
    const Vec3 p = is_finite(i) ? points[i] : Vec3(Vec3::Constant(INFINITY));
    return std::make_tuple(p.x(), p.y(), p.z(), i);
  };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return key(a) < key(b); });
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool is_equal = k > 0 && is_finite(order[k]) && points[order[k]] == points[order[k - 1]];
    first[order[k]] = is_equal ? first[order[k - 1]] : order[k];
  }
  return first;
}

std::optional<std::string> name_without_level(const std::string& name) {
  const std::size_t at = lower(name).rfind("lod");
  if (at == name.npos || (at > 0 && is_letter(name[at - 1]) && name[at] != 'L')) return {};
  std::size_t end = at + 3;
  while (end < name.size() && is_between(name[end])) ++end;
  const std::size_t digits = end;
  while (end < name.size() && (is_digit(name[end]) || (end > digits && name[end] == '.'))) ++end;
  if (end == digits) return {};
  std::string base = name.substr(0, at) + name.substr(end);
  while (!base.empty() && is_between(base.back())) base.pop_back();
  while (!base.empty() && is_between(base.front())) base.erase(0, 1);
  return base;
}

Parting part_buildings(const RawFile& raw, const Triangles& all, Split how) {
  const bool has_groups = !raw.face_group.empty();
  switch (how) {
    case Split::kNone:
      return one_part(all);
    case Split::kComponent:
      return part_components(raw, all);
    case Split::kGroup:
      return has_groups ? part_by(group_labels(raw, all)) : one_part(all);
    case Split::kObject: {
      const bool has_named_groups = raw.parts.empty() && raw.groups.size() > 1;
      if (raw.parts.size() < 2)
        return has_named_groups ? part_by(group_labels(raw, all)) : one_part(all);
      Labels labels = object_labels(raw, all);
      fold(raw, labels);
      return part_by(labels);
    }
    case Split::kAuto:
      break;
  }
  return Splitter(raw, all).split();
}

}  // namespace colod::mesh_io
