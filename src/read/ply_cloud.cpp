// Based on: Greg Turk, The PLY Polygon File Format, 1994.
#include <algorithm>
#include <cmath>

#include "blocks.h"
#include "files.h"
#include "ply_file.h"
#include "streams.h"

namespace colod::mesh_io {

namespace {

constexpr std::size_t kPlyHead = std::size_t{1} << 16;  // bytes: headers have some hundreds
constexpr double kFullByte = 255;

/// The vertices of a file, whatever stands before them passed over.
void visit_ply(const std::string& path, const PlyHeader& header,
               const std::function<void(const PlyVertex&)>& take) {
  Blocks blocks(path, header.body, header.is_text);
  PlyBody body(path, {}, header, [&](std::string_view& data) { return blocks.next(data); });
  for (const PlyElement& element : header.elements) {
    if (element.name != "vertex") {
      skip_ply_element(body, element);
      continue;
    }
    visit_ply_vertices(body, element, find_ply_slots(body, element), take);
    return;
  }
}

std::array<std::uint16_t, 3> byte_color(const std::array<double, 3>& rgb) {
  std::array<std::uint16_t, 3> out;
  for (std::size_t k = 0; k < 3; ++k)
    out[k] = static_cast<std::uint16_t>(
        std::lround(kFullByte * std::clamp(std::isfinite(rgb[k]) ? rgb[k] : 0, 0.0, 1.0)));
  return out;
}

const PlyElement* vertices_of(const PlyHeader& header) {
  for (const PlyElement& element : header.elements)
    if (element.name == "vertex") return &element;
  return nullptr;
}

}  // namespace

bool is_ply_cloud(const std::string& path) {
  try {
    const PlyHeader header = read_ply_header(path, file_head(path, kPlyHead));
    for (const PlyElement& element : header.elements)
      if ((element.name == "face" || element.name == "tristrips") && element.count > 0)
        return false;
    return vertices_of(header) != nullptr;
  } catch (const Error&) {
    return false;  // whoever reads it for the work tells of it
  }
}

PointStream stream_ply(const std::string& path, const ReadOptions& options) {
  const PlyHeader header = read_ply_header(path, file_head(path, kPlyHead));
  const PlyElement* vertices = vertices_of(header);
  if (!vertices) fail(path, "the header names no element `vertex`");
  PointStream out;
  out.unit = Vec3::Constant(options.unit.value_or(1));
  PlyBody nothing(path, {}, header);
  const PlyVertexSlots slots = find_ply_slots(nothing, *vertices);
  out.has_color = slots.has_colors;
  out.is_single = slots.is_single;
  out.visit = [path, header](const TakePoint& take) {
    visit_ply(path, header, [&](const PlyVertex& v) { take({v.at, v.kind, byte_color(v.rgb)}); });
  };
  return out;
}

}  // namespace colod::mesh_io
