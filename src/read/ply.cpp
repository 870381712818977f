// Based on: Greg Turk, The PLY Polygon File Format, 1994.
// Differs: no library, so that vertices stay doubles, the face property `object` is read, and a
// truncated file names the vertex or face where it ends. Other elements and properties are skipped.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "files.h"
#include "formats.h"

namespace colod::mesh_io {

namespace {

enum class Type { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };
constexpr int kSize[] = {1, 1, 2, 2, 4, 4, 4, 8};

struct Property {
  std::string name;
  bool is_list = false;
  Type count = Type::kUint8, type = Type::kFloat;
};

struct Element {
  std::string name;
  long long count = 0;
  std::vector<Property> properties;

  int find(std::string_view property) const {
    for (std::size_t i = 0; i < properties.size(); ++i)
      if (properties[i].name == property) return static_cast<int>(i);
    return -1;
  }
};

struct Header {
  bool is_text = false, is_big_endian = false;
  std::vector<Element> elements;
  std::size_t body = 0;  // where the data start
  int lines = 0;
  std::string remarks;  // its comments
};

bool parse_type(std::string_view name, Type& type) {
  static constexpr std::pair<std::string_view, Type> kNames[] = {
      {"char", Type::kInt8},     {"int8", Type::kInt8},     {"uchar", Type::kUint8},
      {"uint8", Type::kUint8},   {"short", Type::kInt16},   {"int16", Type::kInt16},
      {"ushort", Type::kUint16}, {"uint16", Type::kUint16}, {"int", Type::kInt32},
      {"int32", Type::kInt32},   {"uint", Type::kUint32},   {"uint32", Type::kUint32},
      {"float", Type::kFloat},   {"float32", Type::kFloat}, {"double", Type::kDouble},
      {"float64", Type::kDouble}};
  for (const auto& [spelling, value] : kNames)
    if (spelling == name) return type = value, true;
  return false;
}

Property read_property(Lines& lines) {
  Property p;
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

void read_format(Lines& lines, Header& header) {
  const std::string format = lower(std::string(lines.token()));
  header.is_text = format == "ascii";
  header.is_big_endian = format == "binary_big_endian";
  if (!header.is_text && !header.is_big_endian && format != "binary_little_endian")
    lines.fail("unknown format '" + format.substr(0, 40) + "'");
}

Header read_header(const std::string& path, const std::string& bytes) {
  Header header;
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
      header.remarks += std::string(lines.rest().substr(0, 200)) + "\n";
    } else {
      lines.fail("unknown word '" + key.substr(0, 40) + "' in the header");
    }
  }
  lines.fail("truncated: `end_header` is missing");
}

/// Numbers of the body one after the other, whatever the encoding.
class Body {
 public:
  Body(const std::string& path, const std::string& bytes, const Header& header)
      : path_(path),
        data_(std::string_view(bytes).substr(header.body)),
        lines_(path, data_, header.lines),
        is_text_(header.is_text),
        is_swapped_(header.is_big_endian != (std::endian::native == std::endian::big)) {}

  /// Names the place in messages: "vertex 12 of 100".
  void set_place(const Element& element, long long i) { element_ = &element, index_ = i; }

  double next(Type type) {
    if (is_text_) {
      while (!lines_.has_token())
        if (!lines_.next()) truncated();
      return lines_.number();
    }
    const std::size_t size = kSize[static_cast<int>(type)];
    if (data_.size() < size) truncated();
    char b[8];
    std::memcpy(b, data_.data(), size);
    data_.remove_prefix(size);
    if (is_swapped_) std::reverse(b, b + size);
    switch (type) {
      case Type::kInt8:
        return as<std::int8_t>(b);
      case Type::kUint8:
        return as<std::uint8_t>(b);
      case Type::kInt16:
        return as<std::int16_t>(b);
      case Type::kUint16:
        return as<std::uint16_t>(b);
      case Type::kInt32:
        return as<std::int32_t>(b);
      case Type::kUint32:
        return as<std::uint32_t>(b);
      case Type::kFloat:
        return as<float>(b);
      case Type::kDouble:
        return as<double>(b);
    }
    return 0;
  }

  /// A whole number; anything else is a failure that names the place.
  int next_integer(Type type) {
    const double value = next(type);
    if (!(std::abs(value) <= 2147483647.0) || value != std::floor(value))
      fail_here("a whole number is expected");
    return static_cast<int>(value);
  }

  [[noreturn]] void fail_here(const std::string& cause) const {
    fail(path_, element_->name + " " + std::to_string(index_) + " of " +
                    std::to_string(element_->count) + ": " + cause);
  }

 private:
  template <typename T>
  static double as(const char* b) {
    T value;
    std::memcpy(&value, b, sizeof value);
    return static_cast<double>(value);
  }
  [[noreturn]] void truncated() const { fail_here("the file ends here (truncated)"); }

  const std::string& path_;
  std::string_view data_;
  Lines lines_;
  bool is_text_, is_swapped_;
  const Element* element_ = nullptr;
  long long index_ = 0;
};

void skip(Body& body, const Property& p) {
  const int n = p.is_list ? body.next_integer(p.count) : 1;
  for (int i = 0; i < n; ++i) body.next(p.type);
}

void read_vertices(Body& body, const Element& element, RawFile& raw) {
  static constexpr const char* kNames[] = {"x", "y", "z", "nx", "ny", "nz"};
  std::vector<int> slot(element.properties.size(), -1);
  int found = 0;
  for (int k = 0; k < 6; ++k) {
    const int i = element.find(kNames[k]);
    if (i < 0 || element.properties[i].is_list) continue;
    slot[i] = k, ++found;
  }
  body.set_place(element, 0);
  for (int k = 0; k < 3; ++k)
    if (element.find(kNames[k]) < 0)
      body.fail_here("there is no property " + std::string(kNames[k]));
  const bool has_normals = found == 6;
  for (long long v = 0; v < element.count; ++v) {
    body.set_place(element, v);
    double values[6] = {};
    for (std::size_t i = 0; i < slot.size(); ++i)
      if (slot[i] >= 0)
        values[slot[i]] = body.next(element.properties[i].type);
      else
        skip(body, element.properties[i]);
    raw.points.emplace_back(values[0], values[1], values[2]);
    if (has_normals) raw.normals.emplace_back(values[3], values[4], values[5]);
  }
}

void read_faces(Body& body, const Element& element, RawFile& raw) {
  int list = element.find("vertex_indices");
  if (list < 0) list = element.find("vertex_index");
  const int object = element.find("object");
  body.set_place(element, 0);
  if (list < 0 || !element.properties[list].is_list) {
    if (element.count == 0) return;
    body.fail_here("there is no list `vertex_indices`");
  }
  ShortFaces short_faces;
  for (long long f = 0; f < element.count; ++f) {
    body.set_place(element, f);
    const int begin = static_cast<int>(raw.corners.size());
    int number = -1;
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const Property& p = element.properties[i];
      if (static_cast<int>(i) == list) {
        const int n = body.next_integer(p.count);
        for (int c = 0; c < n; ++c) raw.corners.push_back(body.next_integer(p.type));
      } else if (static_cast<int>(i) == object && !p.is_list) {
        number = body.next_integer(p.type);
      } else {
        skip(body, p);
      }
    }
    if (raw.corners.size() - begin < 3) {
      raw.corners.resize(begin);
      short_faces.add("face " + std::to_string(f));
      continue;
    }
    raw.face_begin.push_back(begin);
    if (object >= 0) raw.face_group.push_back(number);
  }
  short_faces.report(raw);
}

}  // namespace

RawFile read_ply(const std::string& path, const std::string& bytes) {
  const Header header = read_header(path, bytes);
  Body body(path, bytes, header);
  RawFile raw;
  raw.remarks = header.remarks;
  bool has_vertices = false;
  for (const Element& element : header.elements) {
    if (element.name == "vertex") {
      read_vertices(body, element, raw);
      has_vertices = true;
    } else if (element.name == "face") {
      read_faces(body, element, raw);
    } else if (element.name == "tristrips") {
      fail(path, "triangle strips are not read");
    } else {
      for (long long i = 0; i < element.count && !element.properties.empty(); ++i) {
        body.set_place(element, i);
        for (const Property& p : element.properties) skip(body, p);
      }
    }
  }
  if (!has_vertices) fail(path, "the header names no element `vertex`");
  return raw;
}

}  // namespace colod::mesh_io
