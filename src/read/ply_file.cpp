// Based on: Greg Turk, The PLY Polygon File Format, 1994.
// Differs: no library, so that vertices stay doubles and a truncated file names the vertex or face
// where it ends. Other elements and properties are skipped.
#include "ply_file.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "files.h"

namespace colod::mesh_io {

namespace {

constexpr int kPlyBytes[] = {1, 1, 2, 2, 4, 4, 4, 8};  // of a number, by its type
constexpr int kKindSlot = 9;

bool parse_type(std::string_view name, PlyType& type) {
  static constexpr std::pair<std::string_view, PlyType> kNames[] = {
      {"char", PlyType::kInt8},     {"int8", PlyType::kInt8},     {"uchar", PlyType::kUint8},
      {"uint8", PlyType::kUint8},   {"short", PlyType::kInt16},   {"int16", PlyType::kInt16},
      {"ushort", PlyType::kUint16}, {"uint16", PlyType::kUint16}, {"int", PlyType::kInt32},
      {"int32", PlyType::kInt32},   {"uint", PlyType::kUint32},   {"uint32", PlyType::kUint32},
      {"float", PlyType::kFloat},   {"float32", PlyType::kFloat}, {"double", PlyType::kDouble},
      {"float64", PlyType::kDouble}};
  for (const auto& [spelling, value] : kNames)
    if (spelling == name) return type = value, true;
  return false;
}

PlyProperty read_property(Lines& lines) {
  PlyProperty p;
  std::string type = lower(std::string(lines.token()));
  if (type == "list") {
    p.is_list = true;
    if (!parse_type(lower(std::string(lines.token())), p.count))
      lines.fail("unknown type of a list's length");
    type = lower(std::string(lines.token()));
  }
  if (!parse_type(type, p.type)) lines.fail("unknown type '" + type.substr(0, 40) + "'");
  p.name = lower(std::string(lines.token()));
  if (p.name.empty()) lines.fail("a property without a name");
  return p;
}

void read_format(Lines& lines, PlyHeader& header) {
  const std::string format = lower(std::string(lines.token()));
  header.is_text = format == "ascii";
  header.is_big_endian = format == "binary_big_endian";
  if (!header.is_text && !header.is_big_endian && format != "binary_little_endian")
    lines.fail("unknown format '" + format.substr(0, 40) + "'");
}

}  // namespace

PlyHeader read_ply_header(const std::string& path, const std::string& bytes) {
  PlyHeader header;
  Lines lines(path, bytes);
  if (!lines.next() || lower(std::string(lines.token())) != "ply")
    fail(path, "line 1: this is no PLY header");
  bool has_format = false;
  while (lines.next()) {
    const std::string key = lower(std::string(lines.token()));
    if (key == "format") {
      read_format(lines, header);
      has_format = true;
    } else if (key == "element") {
      header.elements.push_back({lower(std::string(lines.token())), lines.integer(), {}});
      if (header.elements.back().count < 0) lines.fail("a count is negative");
    } else if (key == "property") {
      if (header.elements.empty()) lines.fail("a property before the first element");
      header.elements.back().properties.push_back(read_property(lines));
    } else if (key == "end_header") {
      if (!has_format) lines.fail("the header names no format");
      header.body = bytes.size() - lines.bytes_left();
      header.lines = lines.line_number();
      return header;
    } else if (key == "comment" || key == "obj_info") {
      const std::string rest(lines.rest());
      if (const std::size_t at = rest.find("TextureFile "); at != rest.npos)
        header.textures.push_back(rest.substr(at + 12));
      header.remarks += std::string(lines.rest().substr(0, 200)) + "\n";
    } else {
      lines.fail("unknown word '" + key.substr(0, 40) + "' in the header");
    }
  }
  lines.fail("truncated: `end_header` is missing");
}

PlyBody::PlyBody(const std::string& path, std::string_view data, const PlyHeader& header, More more)
    : path_(path),
      data_(data),
      lines_(path, data_, header.lines),
      more_(std::move(more)),
      is_text_(header.is_text),
      is_swapped_(header.is_big_endian != (std::endian::native == std::endian::big)) {}

double PlyBody::next_in_text() {
  while (!lines_.has_token()) {
    if (lines_.next()) continue;
    std::string_view data;
    if (!more_ || !more_(data)) truncated();
    lines_ = Lines(path_, data, lines_.line_number());
  }
  return lines_.number();
}

namespace {

template <typename T>
double number_of(const char* b) {
  T value;
  std::memcpy(&value, b, sizeof value);
  return static_cast<double>(value);
}

}  // namespace

double PlyBody::next(PlyType type) {
  if (is_text_) return next_in_text();
  const std::size_t size = kPlyBytes[static_cast<int>(type)];
  while (data_.size() < size)
    if (!more_ || !more_(data_)) truncated();
  char b[8];
  std::memcpy(b, data_.data(), size);
  data_.remove_prefix(size);
  if (is_swapped_) std::reverse(b, b + size);
  switch (type) {
    case PlyType::kInt8:
      return number_of<std::int8_t>(b);
    case PlyType::kUint8:
      return number_of<std::uint8_t>(b);
    case PlyType::kInt16:
      return number_of<std::int16_t>(b);
    case PlyType::kUint16:
      return number_of<std::uint16_t>(b);
    case PlyType::kInt32:
      return number_of<std::int32_t>(b);
    case PlyType::kUint32:
      return number_of<std::uint32_t>(b);
    case PlyType::kFloat:
      return number_of<float>(b);
    case PlyType::kDouble:
      return number_of<double>(b);
  }
  return 0;
}

int PlyBody::next_integer(PlyType type) {
  const double value = next(type);
  if (!(std::abs(value) <= 2147483647.0) || value != std::floor(value))
    fail_here("a whole number is expected");
  return static_cast<int>(value);
}

void PlyBody::skip(const PlyProperty& p) {
  const int n = p.is_list ? next_integer(p.count) : 1;
  for (int i = 0; i < n; ++i) next(p.type);
}

void PlyBody::fail_here(const std::string& cause) const {
  fail(path_, element_->name + " " + std::to_string(index_) + " of " +
                  std::to_string(element_->count) + ": " + cause);
}

void PlyBody::truncated() const { fail_here("the file ends here (truncated)"); }

std::array<int, 3> find_ply_colors(const PlyElement& element) {
  for (const char* prefix : {"", "diffuse_", "vertex_"}) {
    std::array<int, 3> found;
    int k = 0;
    for (const char* name : {"red", "green", "blue"}) {
      const int i = element.find(std::string(prefix) + name);
      found[k++] = i >= 0 && !element.properties[i].is_list ? i : -1;
    }
    if (*std::min_element(found.begin(), found.end()) >= 0) return found;
  }
  return {-1, -1, -1};
}

double ply_shade(double value, PlyType type) {
  if (type == PlyType::kFloat || type == PlyType::kDouble) return value > 1 ? value / 255 : value;
  return type == PlyType::kUint16 || type == PlyType::kInt16 ? value / 65535 : value / 255;
}

PlyVertexSlots find_ply_slots(PlyBody& body, const PlyElement& element) {
  static constexpr const char* kNames[] = {"x", "y", "z", "nx", "ny", "nz"};
  PlyVertexSlots slots;
  slots.of.assign(element.properties.size(), -1);
  int found = 0;
  for (int k = 0; k < 6; ++k) {
    const int i = element.find(kNames[k]);
    if (i < 0 || element.properties[i].is_list) continue;
    slots.of[i] = k, ++found;
    slots.is_single |= k < 3 && element.properties[i].type == PlyType::kFloat;
  }
  slots.has_normals = found == 6;
  const std::array<int, 3> colors = find_ply_colors(element);
  slots.has_colors = colors[0] >= 0;
  for (int k = 0; k < 3 && slots.has_colors; ++k) {
    slots.of[colors[k]] = 6 + k;
    slots.shades[k] = element.properties[colors[k]].type;
  }
  for (const char* name : {"classification", "class", "scalar_classification"})
    if (const int i = element.find(name); i >= 0 && !element.properties[i].is_list) {
      slots.of[i] = kKindSlot;
      break;
    }
  body.set_place(element, 0);
  for (int k = 0; k < 3; ++k)
    if (element.find(kNames[k]) < 0)
      body.fail_here("there is no property " + std::string(kNames[k]));
  return slots;
}

void visit_ply_vertices(PlyBody& body, const PlyElement& element, const PlyVertexSlots& slots,
                        const std::function<void(const PlyVertex&)>& take) {
  for (long long v = 0; v < element.count; ++v) {
    body.set_place(element, v);
    double values[kKindSlot + 1] = {};
    for (std::size_t i = 0; i < slots.of.size(); ++i)
      if (slots.of[i] >= 0)
        values[slots.of[i]] = body.next(element.properties[i].type);
      else
        body.skip(element.properties[i]);
    PlyVertex vertex{{values[0], values[1], values[2]}, {values[3], values[4], values[5]}};
    for (std::size_t k = 0; k < 3 && slots.has_colors; ++k)
      vertex.rgb[k] = ply_shade(values[6 + k], slots.shades[k]);
    vertex.kind = class_number(values[kKindSlot]);
    take(vertex);
  }
}

void skip_ply_element(PlyBody& body, const PlyElement& element) {
  for (long long i = 0; i < element.count && !element.properties.empty(); ++i) {
    body.set_place(element, i);
    for (const PlyProperty& p : element.properties) body.skip(p);
  }
}

}  // namespace colod::mesh_io
