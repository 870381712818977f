// Based on: Greg Turk, The PLY Polygon File Format, 1994.
// Differs: no library, so that vertices stay doubles, the face property `object` is read, and a
// truncated file names the vertex or face where it ends. Other elements and properties are skipped.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "files.h"
#include "formats.h"
#include "look.h"

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
  std::string remarks;                // its comments
  std::vector<std::string> textures;  // files that comments name
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

/// Numbers of the body one after the other, whatever the encoding.
class PlyBody {
 public:
  PlyBody(const std::string& path, const std::string& bytes, const Header& header)
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

void skip(PlyBody& body, const Property& p) {
  const int n = p.is_list ? body.next_integer(p.count) : 1;
  for (int i = 0; i < n; ++i) body.next(p.type);
}

/// The properties red, green and blue, under any of their names; −1: not all are there.
std::array<int, 3> find_colors(const Element& element) {
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

/// A component of a colour, 0..1: whole numbers count to 255, or 65535 where they take 16 bits.
double shade(double value, Type type) {
  if (type == Type::kFloat || type == Type::kDouble) return value > 1 ? value / 255 : value;
  return type == Type::kUint16 || type == Type::kInt16 ? value / 65535 : value / 255;
}

void read_vertices(PlyBody& body, const Element& element, RawFile& raw) {
  static constexpr const char* kNames[] = {"x", "y", "z", "nx", "ny", "nz"};
  std::vector<int> slot(element.properties.size(), -1);
  int found = 0;
  for (int k = 0; k < 6; ++k) {
    const int i = element.find(kNames[k]);
    if (i < 0 || element.properties[i].is_list) continue;
    slot[i] = k, ++found;
  }
  const std::array<int, 3> colors = find_colors(element);
  const bool has_colors = colors[0] >= 0;
  for (int k = 0; k < 3 && has_colors; ++k) slot[colors[k]] = 6 + k;
  body.set_place(element, 0);
  for (int k = 0; k < 3; ++k)
    if (element.find(kNames[k]) < 0)
      body.fail_here("there is no property " + std::string(kNames[k]));
  const bool has_normals = found == 6;
  for (long long v = 0; v < element.count; ++v) {
    body.set_place(element, v);
    double values[9] = {};
    for (std::size_t i = 0; i < slot.size(); ++i)
      if (slot[i] >= 0)
        values[slot[i]] = body.next(element.properties[i].type);
      else
        skip(body, element.properties[i]);
    raw.points.emplace_back(values[0], values[1], values[2]);
    if (has_normals) raw.normals.emplace_back(values[3], values[4], values[5]);
    if (!has_colors) continue;
    for (int k = 0; k < 3; ++k)
      values[6 + k] = shade(values[6 + k], element.properties[colors[k]].type);
    raw.point_colors.push_back(rgb_of(values[6], values[7], values[8]));
  }
}

/// What one face says besides its corners.
struct FaceLook {
  std::vector<double> uvs;  // two a corner, from the lower left
  int texture = 0;
  double rgb[3] = {1, 1, 1};
};

/// Faces one by one; which property is what is looked up once.
class FaceReader {
 public:
  FaceReader(PlyBody& body, const Element& element, RawFile& raw)
      : body_(body), element_(element), raw_(raw) {
    list_ = element.find("vertex_indices");
    if (list_ < 0) list_ = element.find("vertex_index");
    object_ = element.find("object");
    uvs_ = element.find("texcoord");
    if (uvs_ >= 0 && !element.properties[uvs_].is_list) uvs_ = -1;
    texture_ = element.find("texnumber");
    colors_ = find_colors(element);
  }

  void read_all() {
    body_.set_place(element_, 0);
    if (list_ < 0 || !element_.properties[list_].is_list) {
      if (element_.count == 0) return;
      body_.fail_here("there is no list `vertex_indices`");
    }
    for (long long f = 0; f < element_.count; ++f) {
      body_.set_place(element_, f);
      read(f);
    }
    short_faces_.report(raw_);
  }

 private:
  void read(long long f) {
    const int begin = static_cast<int>(raw_.corners.size());
    int number = -1;
    FaceLook look;
    for (std::size_t i = 0; i < element_.properties.size(); ++i) {
      const Property& p = element_.properties[i];
      const int property = static_cast<int>(i);
      const auto color = std::find(colors_.begin(), colors_.end(), property);
      if (property == list_) {
        const int n = body_.next_integer(p.count);
        for (int c = 0; c < n; ++c) raw_.corners.push_back(body_.next_integer(p.type));
      } else if (property == object_ && !p.is_list) {
        number = body_.next_integer(p.type);
      } else if (property == uvs_) {
        const int n = body_.next_integer(p.count);
        for (int c = 0; c < n; ++c) look.uvs.push_back(body_.next(p.type));
      } else if (property == texture_ && !p.is_list) {
        const double n = body_.next(p.type);
        look.texture = n >= 0 && n < 1e6 ? static_cast<int>(n) : -1;
      } else if (color != colors_.end()) {
        look.rgb[color - colors_.begin()] = shade(body_.next(p.type), p.type);
      } else {
        skip(body_, p);
      }
    }
    if (raw_.corners.size() - begin < 3) {
      raw_.corners.resize(begin);
      short_faces_.add("face " + std::to_string(f));
      return;
    }
    raw_.face_begin.push_back(begin);
    if (object_ >= 0) raw_.face_group.push_back(number);
    add_look(look, raw_.corners.size() - static_cast<std::size_t>(begin));
  }

  void add_look(const FaceLook& look, std::size_t corners) {
    if (uvs_ >= 0) {
      const bool is_whole = look.uvs.size() == 2 * corners;
      raw_.face_material.push_back(is_whole ? look.texture : -1);
      for (std::size_t c = 0; c < corners; ++c)
        raw_.corner_uvs.push_back(is_whole
                                      ? Vec2(look.uvs[2 * c], 1 - look.uvs[2 * c + 1]).cast<float>()
                                      : Vec2f(NAN, NAN));
    }
    if (colors_[0] >= 0 && raw_.point_colors.empty())
      raw_.corner_colors.insert(raw_.corner_colors.end(), corners,
                                rgb_of(look.rgb[0], look.rgb[1], look.rgb[2]));
  }

  PlyBody& body_;
  const Element& element_;
  RawFile& raw_;
  int list_, object_, uvs_, texture_;
  std::array<int, 3> colors_;
  ShortFaces short_faces_;
};

/// A material for each file that the header names.
void add_textures(const std::string& path, const std::vector<std::string>& files, RawFile& raw) {
  for (const std::string& name : files) {
    raw.materials.emplace_back();
    raw.materials.back().name = name;
    raw.materials.back().image = image_number(raw.images, image_beside(path, name));
    raw.materials.back().cutoff = kCutoff;
  }
  const int count = static_cast<int>(raw.materials.size());
  for (int& m : raw.face_material)
    if (m >= count) m = -1;
  if (raw.materials.empty()) raw.face_material.clear();
  if (raw.images.empty()) raw.corner_uvs.clear();
}

}  // namespace

RawFile read_ply(const std::string& path, const std::string& bytes) {
  const Header header = read_header(path, bytes);
  PlyBody body(path, bytes, header);
  RawFile raw;
  raw.remarks = header.remarks;
  bool has_vertices = false;
  for (const Element& element : header.elements) {
    if (element.name == "vertex") {
      read_vertices(body, element, raw);
      has_vertices = true;
    } else if (element.name == "face") {
      FaceReader(body, element, raw).read_all();
    } else if (element.name == "tristrips") {
      fail(path, "triangle strips are not read");
    } else {
      for (long long i = 0; i < element.count && !element.properties.empty(); ++i) {
        body.set_place(element, i);
        for (const Property& p : element.properties) skip(body, p);
      }
    }
  }
  add_textures(path, header.textures, raw);
  if (!has_vertices) fail(path, "the header names no element `vertex`");
  return raw;
}

}  // namespace colod::mesh_io
