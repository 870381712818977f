// Houses as a scan shows them: with a balcony, a loggia or a chimney some of whose faces are
// missing.
#pragma once

#include "extraction/extraction_helpers.h"

namespace colod::test {

/// a, b, c, d counter-clockwise seen from outside.
inline void add_quad(Mesh& mesh, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const int first = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {a, b, c, d});
  mesh.faces.push_back({first, first + 1, first + 2});
  mesh.faces.push_back({first, first + 2, first + 3});
}

/// 10 × 8 × 7, its front at y = 0 looking to −y.
inline Mesh plain_house() { return box_mesh({0, 0, 0}, {10, 8, 7}); }

/// The outer faces and the floor of a balcony on that front: 3 × 1.2, rail at z = 4.
inline Mesh balcony_house() {
  Mesh m = plain_house();
  add_quad(m, {3, -1.2, 3}, {6, -1.2, 3}, {6, 0, 3}, {3, 0, 3});
  add_quad(m, {3, -1.2, 2.8}, {6, -1.2, 2.8}, {6, -1.2, 4}, {3, -1.2, 4});
  add_quad(m, {3, 0, 2.8}, {3, -1.2, 2.8}, {3, -1.2, 4}, {3, 0, 4});
  add_quad(m, {6, -1.2, 2.8}, {6, 0, 2.8}, {6, 0, 4}, {6, -1.2, 4});
  return m;
}

/// The same balcony from below: the outer faces and the underside. `top` is the rail's height.
inline Mesh balcony_from_below(double top = 4) {
  Mesh m = plain_house();
  add_quad(m, {3, 0, 2.8}, {6, 0, 2.8}, {6, -1.2, 2.8}, {3, -1.2, 2.8});
  add_quad(m, {3, -1.2, 2.8}, {6, -1.2, 2.8}, {6, -1.2, top}, {3, -1.2, top});
  add_quad(m, {3, 0, 2.8}, {3, -1.2, 2.8}, {3, -1.2, top}, {3, 0, top});
  add_quad(m, {6, -1.2, 2.8}, {6, 0, 2.8}, {6, 0, top}, {6, -1.2, top});
  return m;
}

/// A loggia in that front, 3 wide, 1.5 deep, from z = 3 to 5.3, its floor not seen.
inline Mesh loggia_house() {
  Mesh m = plain_house();
  std::erase_if(m.faces, [&](const Face& f) { return face_cross(m, f).normalized().y() < -0.9; });
  add_quad(m, {0, 0, 0}, {3, 0, 0}, {3, 0, 7}, {0, 0, 7});
  add_quad(m, {6, 0, 0}, {10, 0, 0}, {10, 0, 7}, {6, 0, 7});
  add_quad(m, {3, 0, 0}, {6, 0, 0}, {6, 0, 3}, {3, 0, 3});
  add_quad(m, {3, 0, 5.3}, {6, 0, 5.3}, {6, 0, 7}, {3, 0, 7});
  add_quad(m, {3, 0, 3}, {3, 1.5, 3}, {3, 1.5, 5.3}, {3, 0, 5.3});
  add_quad(m, {6, 1.5, 3}, {6, 0, 3}, {6, 0, 5.3}, {6, 1.5, 5.3});
  add_quad(m, {3, 1.5, 3}, {6, 1.5, 3}, {6, 1.5, 5.3}, {3, 1.5, 5.3});
  add_quad(m, {3, 0, 5.3}, {3, 1.5, 5.3}, {6, 1.5, 5.3}, {6, 0, 5.3});
  return m;
}

/// A window in that front, 1.2 × 1.4, its pane 0.2 behind the front.
inline Mesh window_house() {
  Mesh m = plain_house();
  std::erase_if(m.faces, [&](const Face& f) { return face_cross(m, f).normalized().y() < -0.9; });
  const double a = 3, b = 4.2, low = 1, high = 2.4, depth = 0.2;
  add_quad(m, {0, 0, 0}, {a, 0, 0}, {a, 0, 7}, {0, 0, 7});
  add_quad(m, {b, 0, 0}, {10, 0, 0}, {10, 0, 7}, {b, 0, 7});
  add_quad(m, {a, 0, 0}, {b, 0, 0}, {b, 0, low}, {a, 0, low});
  add_quad(m, {a, 0, high}, {b, 0, high}, {b, 0, 7}, {a, 0, 7});
  add_quad(m, {a, 0, low}, {a, depth, low}, {a, depth, high}, {a, 0, high});
  add_quad(m, {b, depth, low}, {b, 0, low}, {b, 0, high}, {b, depth, high});
  add_quad(m, {a, 0, low}, {b, 0, low}, {b, depth, low}, {a, depth, low});
  add_quad(m, {a, 0, high}, {a, depth, high}, {b, depth, high}, {b, 0, high});
  add_quad(m, {a, depth, low}, {b, depth, low}, {b, depth, high}, {a, depth, high});
  return m;
}

/// A chimney of 1 × 0.6 × 1.5 on the flat roof, without its top; with another part that is higher.
inline Mesh chimney_house() {
  Mesh m = join(plain_house(), box_mesh({7, 5, 7}, {10, 8, 10}));
  add_quad(m, {2, 2, 7}, {3, 2, 7}, {3, 2, 8.5}, {2, 2, 8.5});
  add_quad(m, {3, 2.6, 7}, {2, 2.6, 7}, {2, 2.6, 8.5}, {3, 2.6, 8.5});
  add_quad(m, {2, 2.6, 7}, {2, 2, 7}, {2, 2, 8.5}, {2, 2.6, 8.5});
  add_quad(m, {3, 2, 7}, {3, 2.6, 7}, {3, 2.6, 8.5}, {3, 2, 8.5});
  return m;
}

/// A shed dormer 2 wide on a slope of 60°, its cheeks not seen.
inline Mesh dormer_house() {
  Mesh m = box_mesh({0, 0, 0}, {10, 8, 4});
  const double rise = std::sqrt(3.0);  // a metre inward
  add_quad(m, {0, 0, 4}, {10, 0, 4}, {10, 3, 4 + 3 * rise}, {0, 3, 4 + 3 * rise});
  const double y = 0.3, top = 4 + rise * 1.1;
  add_quad(m, {4, y, 4 + rise * y}, {6, y, 4 + rise * y}, {6, y, top}, {4, y, top});
  add_quad(m, {4, y, top}, {6, y, top}, {6, 1.1, top}, {4, 1.1, top});
  return m;
}

/// That dormer with a window of 1.7 × 1.1 in its front, larger than what is left around it.
inline Mesh dormer_window_house() {
  Mesh m = dormer_house();
  const double front = 0.3, pane = 0.45, foot = 4 + std::sqrt(3.0) * front;
  const double top = 4 + std::sqrt(3.0) * 1.1, a = 4.15, b = 5.85, low = 4.65, high = 5.75;
  std::erase_if(m.faces, [&](const Face& f) {
    return (m.vertices[f[0]] + m.vertices[f[1]] + m.vertices[f[2]]).y() == 3 * front;
  });
  add_quad(m, {4, front, foot}, {a, front, foot}, {a, front, top}, {4, front, top});
  add_quad(m, {b, front, foot}, {6, front, foot}, {6, front, top}, {b, front, top});
  add_quad(m, {a, front, foot}, {b, front, foot}, {b, front, low}, {a, front, low});
  add_quad(m, {a, front, high}, {b, front, high}, {b, front, top}, {a, front, top});
  add_quad(m, {a, front, low}, {a, pane, low}, {a, pane, high}, {a, front, high});
  add_quad(m, {b, pane, low}, {b, front, low}, {b, front, high}, {b, pane, high});
  add_quad(m, {a, front, low}, {b, front, low}, {b, pane, low}, {a, pane, low});
  add_quad(m, {a, front, high}, {a, pane, high}, {b, pane, high}, {b, front, high});
  add_quad(m, {a, pane, low}, {b, pane, low}, {b, pane, high}, {a, pane, high});
  return m;
}

/// A bay 2.5 wide and 0.9 deep before the front, from z = 1 to 4.5; `splay` narrows its front.
inline Mesh bay_house(double splay = 0) {
  Mesh m = plain_house();
  const double a = 3 + splay, b = 5.5 - splay;
  add_quad(m, {a, -0.9, 1}, {b, -0.9, 1}, {b, -0.9, 4.5}, {a, -0.9, 4.5});
  add_quad(m, {3, 0, 1}, {a, -0.9, 1}, {a, -0.9, 4.5}, {3, 0, 4.5});
  add_quad(m, {b, -0.9, 1}, {5.5, 0, 1}, {5.5, 0, 4.5}, {b, -0.9, 4.5});
  add_quad(m, {a, -0.9, 4.5}, {b, -0.9, 4.5}, {5.5, 0, 4.5}, {3, 0, 4.5});
  return m;
}

}  // namespace colod::test
