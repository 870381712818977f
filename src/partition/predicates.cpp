// Based on: the representation of BSP trees by planes instead of points (Sugihara and Iri 1989;
//   Bernstein and Fussell, "Fast, exact, linear Booleans", SGP 2009), here with canonical vertices.
// Differs: the paper says nothing of arithmetic. A vertex is not a triple of planes but the point
//   itself, (X, Y, Z, W) divided by its gcd with W > 0: however many planes pass through it, it has
//   one id, and tests of it are four products.
// Notation: n, d plane n·x + d = 0; h homogeneous point. Bounds, with |n| ≤ 2^23 + 1, |x| ≤ 2^24
// per
//   coordinate and planes that cross the box, so |d| ≤ |n| · |x| < 2^47.8: W = det(n, n, n) ≤ 2^69;
//   X = x · W ≤ 2^93, each of its three terms d · (n × n) < 2^94; value of a side test
//   W · (n · x + d) < 2^118.8. All fit in 127 bits with every intermediate sum.
#include "predicates.h"

#include <bit>
#include <boost/multiprecision/cpp_int.hpp>
#include <cassert>
#include <cmath>
#include <utility>

namespace colod {
namespace {

using Wide = boost::multiprecision::int512_t;
using Unsigned = unsigned __int128;
using Direction = std::array<__int128, 3>;

Unsigned magnitude(__int128 x) {
  return x < 0 ? -static_cast<Unsigned>(x) : static_cast<Unsigned>(x);
}

int trailing_zeros(Unsigned x) {
  const auto low = static_cast<std::uint64_t>(x);
  return low != 0 ? std::countr_zero(low)
                  : 64 + std::countr_zero(static_cast<std::uint64_t>(x >> 64));
}

Unsigned gcd(Unsigned a, Unsigned b) {
  if (a < b) std::swap(a, b);
  if (b == 0) return a;
  a %= b;  // evens out lengths that differ much, then Stein's algorithm
  if (a == 0) return b;
  const int shift = trailing_zeros(a | b);
  a >>= trailing_zeros(a);
  while (b != 0) {
    b >>= trailing_zeros(b);
    if (a > b) std::swap(a, b);
    b -= a;
  }
  return a << shift;
}

Direction cross(const Partition::IntPlane& a, const Partition::IntPlane& b) {
  const auto minor = [&](int i, int j) {
    return static_cast<__int128>(a.normal[i]) * b.normal[j] -
           static_cast<__int128>(a.normal[j]) * b.normal[i];
  };
  return {minor(1, 2), minor(2, 0), minor(0, 1)};
}

/// Divides by the common divisor; `is_negative` turns all signs.
template <std::size_t N>
void reduce(std::array<__int128, N>& h, bool is_negative) {
  Unsigned divisor = 0;
  for (std::size_t i = N; i-- > 0 && divisor != 1;) divisor = gcd(divisor, magnitude(h[i]));
  const __int128 by =
      is_negative ? -static_cast<__int128>(divisor) : static_cast<__int128>(divisor);
  if (by != 1)
    for (__int128& x : h) x /= by;
}

std::uint64_t mix(std::uint64_t hash, __int128 value) {
  for (const auto word : {static_cast<std::uint64_t>(value),
                          static_cast<std::uint64_t>(static_cast<Unsigned>(value) >> 64)}) {
    hash = (hash ^ word) * 0x9e3779b97f4a7c15u;
    hash ^= hash >> 29;
  }
  return hash;
}

template <std::size_t N>
std::uint64_t hash_of(const std::array<__int128, N>& h) {
  std::uint64_t hash = 0;
  for (const __int128 x : h) hash = mix(hash, x);
  return hash ^ (hash >> 32);
}

int dominant_axis(const Direction& direction) {
  int axis = 0;
  for (int k = 1; k < 3; ++k)
    if (magnitude(direction[k]) > magnitude(direction[axis])) axis = k;
  return axis;
}

/// A coordinate in grid units, wrong by less than 2^-28 (three roundings of at most 2^24).
double coordinate(const HomogeneousPoint& p, int axis) {
  return static_cast<double>(p[axis]) / static_cast<double>(p[3]);
}

int orientation_exact(const HomogeneousPoint& a, const HomogeneousPoint& b,
                      const HomogeneousPoint& c, int i, int j) {
  // at most 93 + 93 + 69 bits and a sum of six
  const Wide value = Wide(a[3]) * (Wide(b[i]) * c[j] - Wide(b[j]) * c[i]) +
                     Wide(b[3]) * (Wide(c[i]) * a[j] - Wide(c[j]) * a[i]) +
                     Wide(c[3]) * (Wide(a[i]) * b[j] - Wide(a[j]) * b[i]);
  return value.sign();
}

}  // namespace

HomogeneousPoint meet(const Partition::IntPlane& a, const Partition::IntPlane& b,
                      const Partition::IntPlane& c) {
  const Direction bc = cross(b, c), ca = cross(c, a), ab = cross(a, b);
  HomogeneousPoint h;
  for (int k = 0; k < 3; ++k) h[k] = -(a.d * bc[k] + b.d * ca[k] + c.d * ab[k]);
  h[3] = a.normal[0] * bc[0] + a.normal[1] * bc[1] + a.normal[2] * bc[2];
  assert(h[3] != 0);  // the caller's edge crosses a plane strictly
  reduce(h, h[3] < 0);
  return h;
}

VertexTable::VertexTable(std::vector<Partition::Vertex>& vertices)
    : vertices_(vertices), slots_(1024, -1) {}

int VertexTable::id(const HomogeneousPoint& point) {
  if (2 * (vertices_.size() + 1) > slots_.size()) grow();
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = hash_of(point) & mask;
  for (; slots_[slot] >= 0; slot = (slot + 1) & mask)
    if (vertices_[slots_[slot]].h == point) return slots_[slot];
  vertices_.push_back({point});
  return slots_[slot] = static_cast<int>(vertices_.size()) - 1;
}

void VertexTable::grow() {
  slots_.assign(2 * slots_.size(), -1);
  const std::size_t mask = slots_.size() - 1;
  for (std::size_t v = 0; v < vertices_.size(); ++v) {
    std::size_t slot = hash_of(vertices_[v].h) & mask;
    while (slots_[slot] >= 0) slot = (slot + 1) & mask;
    slots_[slot] = static_cast<int>(v);
  }
}

int side(const Partition& partition, int plane, int vertex) {
  return side_of(partition.planes[plane], partition.vertices[vertex].h);
}

int orientation(const Partition& partition, int plane, int a, int b, int c) {
  const auto& n = partition.planes[plane].normal;
  const int k = dominant_axis({n[0], n[1], n[2]}), i = (k + 1) % 3, j = (k + 2) % 3;
  const HomogeneousPoint &pa = partition.vertices[a].h, &pb = partition.vertices[b].h,
                         &pc = partition.vertices[c].h;
  const double abi = coordinate(pb, i) - coordinate(pa, i);
  const double abj = coordinate(pb, j) - coordinate(pa, j);
  const double aci = coordinate(pc, i) - coordinate(pa, i);
  const double acj = coordinate(pc, j) - coordinate(pa, j);
  const double det = abi * acj - abj * aci;
  // each difference is wrong by less than 2^-26, the products by that times the other factor
  const double doubt =
      0x1p-25 * (1 + std::abs(abi) + std::abs(abj) + std::abs(aci) + std::abs(acj));
  const int sign =
      std::abs(det) > doubt ? (det > 0) - (det < 0) : orientation_exact(pa, pb, pc, i, j);
  return n[k] > 0 ? sign : -sign;
}

bool along_line_less(const Partition& partition, int plane_a, int plane_b, int v, int w) {
  if (v == w) return false;
  const Direction direction = cross(partition.planes[plane_a], partition.planes[plane_b]);
  const int k = dominant_axis(direction);
  assert(direction[k] != 0);
  const HomogeneousPoint &pv = partition.vertices[v].h, &pw = partition.vertices[w].h;
  const double difference = coordinate(pw, k) - coordinate(pv, k);
  const int sign = std::abs(difference) > 0x1p-26
                       ? (difference > 0) - (difference < 0)
                       : Wide(Wide(pw[k]) * pv[3] - Wide(pv[k]) * pw[3]).sign();
  return direction[k] > 0 ? sign > 0 : sign < 0;
}

std::size_t LineIdHash::operator()(const LineId& line) const { return hash_of(line.h); }

LineId line_id(const Partition& partition, int plane_a, int plane_b) {
  const Partition::IntPlane &a = partition.planes[plane_a], &b = partition.planes[plane_b];
  const Direction direction = cross(a, b);
  LineId line;
  for (int k = 0; k < 3; ++k) {
    line.h[k] = direction[k];
    line.h[3 + k] =
        static_cast<__int128>(a.d) * b.normal[k] - static_cast<__int128>(b.d) * a.normal[k];
  }
  const int first = direction[0] != 0 ? 0 : direction[1] != 0 ? 1 : 2;
  assert(direction[first] != 0);
  reduce(line.h, direction[first] < 0);
  return line;
}

}  // namespace colod
