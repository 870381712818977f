// Based on: C. Ericson, Real-Time Collision Detection, 2005, section 5.1.5.
#pragma once

#include "geometry.h"

namespace colod {

/// The point of triangle abc nearest to p.
inline Vec3 nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const Vec3 bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
  const Vec3 cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  const double sum = va + vb + vc;
  return a + vb / sum * ab + vc / sum * ac;
}

/// Weights of a face's corners at its place nearest to p.
inline Vec3 nearest_weights(const Mesh& m, const Face& f, const Vec3& p) {
  const Vec3 near = nearest_on_triangle(p, m.vertices[static_cast<std::size_t>(f[0])],
                                        m.vertices[static_cast<std::size_t>(f[1])],
                                        m.vertices[static_cast<std::size_t>(f[2])]);
  return barycentric(m, f, near);
}

}  // namespace colod
