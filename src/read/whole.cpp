// Based on: nothing published; what the formats' writers get wrong decides what is checked.
#include "whole.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "files.h"
#include "look.h"

namespace colod::mesh_io {

namespace fs = std::filesystem;

RawFile read_raw(const std::string& path, const ReadOptions& options) {
  const std::string e = lower(fs::path(path).extension().string());
  if (const std::string advice = foreign_advice(path); !advice.empty()) fail(path, advice);
  if (!is_supported(path)) fail(path, "unknown format '" + e + "'");
  std::string bytes = read_bytes(path, options.input_memory);
  if (e == ".stl") return read_stl(path, bytes);
  if (e == ".glb") return read_gltf(path, bytes, options);
  if (e == ".b3dm") return read_b3dm(path, bytes, options);
  if (e == ".las") return read_las(path, bytes, options);
  if (e == ".laz") return read_laz(path, bytes, options);
  bytes = as_text(std::move(bytes));
  if (e == ".obj") return read_obj(path, bytes);
  if (e == ".ply") return read_ply(path, bytes);
  if (e == ".off") return read_off(path, bytes);
  if (e == ".gltf") return read_gltf(path, bytes, options);
  return read_points(path, bytes, e == ".pwn");
}

namespace {

void check_indices(const std::string& path, const RawFile& raw) {
  const int n = static_cast<int>(raw.points.size());
  for (int f = 0; f < raw.face_count(); ++f)
    for (int c = raw.face_begin[f]; c < raw.face_end(f); ++c)
      if (raw.corners[c] < 0 || raw.corners[c] >= n)
        fail(path, "face " + std::to_string(f) + " of " + std::to_string(raw.face_count()) +
                       " names vertex " + std::to_string(raw.corners[c]) + " of " +
                       std::to_string(n) + " (both counted from 0)");
}

/// Ear clipping takes up to the cube of a polygon's corners: half a second for the most that is
/// read.
void check_polygons(const std::string& path, const RawFile& raw) {
  constexpr int kMostCorners = 5000;
  for (int f = 0; f < raw.face_count(); ++f)
    if (const int corners = raw.face_end(f) - raw.face_begin[f]; corners > kMostCorners)
      fail(path, "face " + std::to_string(f) + " has " + std::to_string(corners) +
                     " corners, more than the " + std::to_string(kMostCorners) +
                     " that are read: triangulate it first");
}

}  // namespace

void check_faces(const std::string& path, const RawFile& raw) {
  check_indices(path, raw);
  check_polygons(path, raw);
}

Triangles triangulate(const RawFile& raw, int& dropped) {
  Triangles out;
  std::vector<Vec3> ring;
  for (int f = 0; f < raw.face_count(); ++f) {
    ring.clear();
    for (int c = raw.face_begin[f]; c < raw.face_end(f); ++c)
      ring.push_back(raw.points[raw.corners[c]]);
    if (!std::all_of(ring.begin(), ring.end(), is_usable)) {
      ++dropped;
      continue;
    }
    const int* corner = &raw.corners[raw.face_begin[f]];
    for (const Face& t : triangulate_ring(ring)) {
      const int first = raw.face_begin[f];
      out.faces.push_back({corner[t[0]], corner[t[1]], corner[t[2]]});
      out.corners.push_back({first + t[0], first + t[1], first + t[2]});
      out.polygon.push_back(f);
    }
  }
  return out;
}

Source take(const RawFile& raw, const Triangles& all, const std::vector<int>& chosen) {
  Source s;
  std::vector<int> number(raw.points.size(), -1);
  for (const int t : chosen)
    for (const int v : all.faces[t]) number[v] = 0;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] < 0) continue;
    number[v] = static_cast<int>(s.mesh.vertices.size());
    s.mesh.vertices.push_back(raw.points[v]);
  }
  for (const int t : chosen) {
    const Face& f = all.faces[t];
    s.mesh.faces.push_back({number[f[0]], number[f[1]], number[f[2]]});
    if (!raw.face_group.empty()) s.face_object.push_back(raw.face_group[all.polygon[t]]);
  }
  s.look = look_of(raw, all.corners, all.polygon, chosen);
  return s;
}

bool has_area(const Mesh& m) {
  return std::any_of(m.faces.begin(), m.faces.end(),
                     [&](const Face& f) { return face_area(m, f) > 0; });
}

}  // namespace colod::mesh_io
