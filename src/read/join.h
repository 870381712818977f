// Inside room `read` only: which parts of a file are one building, by how they stand.
#pragma once

#include <vector>

#include "bodies.h"
#include "core/union_find.h"

namespace colod::mesh_io {

/// Whether the smaller of two bodies lies mostly on, under or in the other one.
bool covers(const std::vector<Body>& bodies, const Contact& contact);

/// Joins bodies that are one building. Bodies in the shape of buildings that stand on the ground
/// stay apart unless one lies in or on the other; what is none joins the one that it shares most
/// with. Low ground that carries several joins nothing. `is_element`: no building, by its name.
/// Both arguments outlive it.
class Joiner {
 public:
  Joiner(const std::vector<Body>& bodies, const std::vector<char>& is_element);

  int set_of(int body) { return sets_.find(body); }
  bool is_building(int body) const { return is_building_[body]; }

 private:
  int other(int contact, int body) const {
    return contacts_[contact].a == body ? contacts_[contact].b : contacts_[contact].a;
  }
  void find_carriers();
  void find_buildings();
  void attach(int body);
  int strongest(int body, bool among_buildings) const;
  bool carries_two(int body) const;

  const std::vector<Body>& bodies_;
  const std::vector<char>& is_element_;
  const std::vector<Contact> contacts_;
  std::vector<std::vector<int>> of_body_;  // contacts of each body
  std::vector<char> is_carrier_, is_building_;
  UnionFind sets_;
};

}  // namespace colod::mesh_io
