// Planes and segments made from meshes, without the rooms that find them: a plane a face.
#pragma once

#include "meshes.h"
#include "segments/segments.h"

namespace colod::test {

/// A plane with a triangulated outline from the faces [first, last) of a mesh; normal of the first.
inline Plane plane_of_faces(const Mesh& m, std::size_t first, std::size_t last) {
  Plane plane;
  for (std::size_t i = first; i < last; ++i) {
    const int base = static_cast<int>(plane.outline.vertices.size());
    for (const int v : m.faces[i]) plane.outline.vertices.push_back(m.vertices[v]);
    plane.outline.triangles.push_back({base, base + 1, base + 2});
    plane.outline.rings.push_back({base, base + 1, base + 2});
    plane.area += face_area(m, m.faces[i]);
  }
  const Vec3 cross = face_cross(m, m.faces[first]);
  if (cross.norm() > 0) plane.normal = cross.normalized();
  plane.centroid = plane.outline.vertices.front();
  plane.offset = plane.normal.dot(plane.centroid);
  return plane;
}

/// One segment of all faces, `per_plane` faces a plane, appended to both.
inline void add_segment(const Mesh& m, Planes& planes, Segments& segments, double volume = 1,
                        std::size_t per_plane = 1) {
  Segment s;
  for (std::size_t i = 0; i < m.faces.size(); i += per_plane) {
    s.planes.push_back(static_cast<int>(planes.planes.size()));
    planes.planes.push_back(plane_of_faces(m, i, std::min(i + per_plane, m.faces.size())));
    segments.segment_of_plane.push_back(static_cast<int>(segments.segments.size()));
    s.area += planes.planes.back().area;
  }
  s.volume = volume;
  segments.segments.push_back(s);
}

template <class Map>
Mesh mapped(Mesh m, const Map& map) {
  for (Vec3& v : m.vertices) v = map(v);
  return m;
}

}  // namespace colod::test
