// Based on: relief/relief.h. Differs: --rules robust only. Notation: –
#include "relief_planes.h"

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <tuple>

#include "arrangement.h"
#include "core/error.h"
#include "outline.h"
#include "parameters.h"
#include "planes.h"

namespace colod {
namespace regions {
namespace {

/// What the rings wind around; from above for a roof, from its front for a wall.
Outline outline_of(const Relief::Part& part) {
  const auto [u, v] = plane_basis(part.normal);
  std::vector<Edge2> edges;
  for (const std::vector<Vec3>& ring : part.rings)
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const Vec3 &a = ring[k], &b = ring[(k + 1) % ring.size()];
      if (ring.size() == 2 && k == 1) break;  // a loose edge
      edges.push_back({{u.dot(a), v.dot(a)}, {u.dot(b), v.dot(b)}});
    }
  const Arrangement flat = arrange(edges);
  Outline outline;
  for (const Vec2& q : flat.vertices)
    outline.vertices.push_back(q.x() * u + q.y() * v + part.offset * part.normal);
  outline.rings = flat.rings;
  outline.triangles = flat.triangles;
  return outline;
}

Vec3 centroid_of(const Outline& outline) {
  Vec3 sum = Vec3::Zero();
  double area = 0;
  for (const Face& t : outline.triangles) {
    const Vec3 &a = outline.vertices[t[0]], &b = outline.vertices[t[1]],
               &c = outline.vertices[t[2]];
    const double own = (b - a).cross(c - a).norm();
    sum += own * (a + b + c) / 3, area += own;
  }
  return area > 0 ? Vec3(sum / area) : sum;
}

std::vector<Plane> planes_of(Relief& relief) {
  std::vector<Plane> planes;
  for (Relief::Part& part : relief.parts) {
    Plane p;
    p.outline = outline_of(part);
    if (p.outline.triangles.empty()) continue;
    p.normal = part.normal;
    p.offset = part.offset;
    p.area = outline_area(p.outline);
    p.centroid = centroid_of(p.outline);
    p.items = std::move(part.faces);
    planes.push_back(std::move(p));
  }
  sort_planes(planes);
  return planes;
}

}  // namespace

void sort_planes(std::vector<Plane>& planes) {
  const auto key = [](const Plane& p) {
    return std::make_tuple(-p.area, p.centroid.x(), p.centroid.y(), p.centroid.z(),
                           p.items.empty() ? -1 : p.items.front());
  };
  std::sort(planes.begin(), planes.end(),
            [&](const Plane& a, const Plane& b) { return key(a) < key(b); });
}

}  // namespace regions

Planes relief_planes(const Source& source, Relief relief) {
  Planes result;
  result.planes = regions::planes_of(relief);
  if (result.planes.empty()) throw Error(Stage::kProcess, source.name, regions::kNoPlane);
  result.distance = std::max(parameters::planes::kReliefDistance, 2 * relief.noise);
  result.surface = surface_at(result.distance);
  result.plane_of_item.assign(source.mesh.faces.size(), -1);
  for (std::size_t f = 0; f < source.mesh.faces.size(); ++f)
    if (relief.is_left_out[f])
      result.plane_of_item[f] = kAround;
    else
      result.total_area += face_area(source.mesh, source.mesh.faces[f]);
  for (std::size_t p = 0; p < result.planes.size(); ++p) {
    for (const int f : result.planes[p].items) result.plane_of_item[f] = static_cast<int>(p);
    result.box.extend(bounding_box(result.planes[p].outline.vertices));
  }
  result.box.min.z() = relief.foot;
  char text[160];
  std::snprintf(
      text, sizeof text,
      "its mesh is melted (bumps of %.2f m) and read as roofs and upright walls; --without "
      "relief.melted keeps whatever planes it has",
      relief.noise);
  result.warnings.emplace_back(text);
  return result;
}

}  // namespace colod
