// Based on: Greg Turk, The PLY Polygon File Format, 1994.
// Differs: the face property `object` is read.
#include <algorithm>

#include "files.h"
#include "look.h"
#include "ply_file.h"

namespace colod::mesh_io {

namespace {

void read_vertices(PlyBody& body, const PlyElement& element, RawFile& raw) {
  const PlyVertexSlots slots = find_ply_slots(body, element);
  visit_ply_vertices(body, element, slots, [&](const PlyVertex& v) {
    raw.points.push_back(v.at);
    if (slots.has_normals) raw.normals.push_back(v.normal);
    if (slots.has_colors) raw.point_colors.push_back(rgb_of(v.rgb[0], v.rgb[1], v.rgb[2]));
  });
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
  FaceReader(PlyBody& body, const PlyElement& element, RawFile& raw)
      : body_(body), element_(element), raw_(raw) {
    list_ = element.find("vertex_indices");
    if (list_ < 0) list_ = element.find("vertex_index");
    object_ = element.find("object");
    uvs_ = element.find("texcoord");
    if (uvs_ >= 0 && !element.properties[uvs_].is_list) uvs_ = -1;
    texture_ = element.find("texnumber");
    colors_ = find_ply_colors(element);
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
      const PlyProperty& p = element_.properties[i];
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
        look.rgb[color - colors_.begin()] = ply_shade(body_.next(p.type), p.type);
      } else {
        body_.skip(p);
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
  const PlyElement& element_;
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
  const PlyHeader header = read_ply_header(path, bytes);
  PlyBody body(path, std::string_view(bytes).substr(header.body), header);
  RawFile raw;
  raw.remarks = header.remarks;
  bool has_vertices = false;
  for (const PlyElement& element : header.elements) {
    if (element.name == "vertex") {
      read_vertices(body, element, raw);
      has_vertices = true;
    } else if (element.name == "face") {
      FaceReader(body, element, raw).read_all();
    } else if (element.name == "tristrips") {
      fail(path, "triangle strips are not read");
    } else {
      skip_ply_element(body, element);
    }
  }
  add_textures(path, header.textures, raw);
  if (!has_vertices) fail(path, "the header names no element `vertex`");
  return raw;
}

}  // namespace colod::mesh_io
