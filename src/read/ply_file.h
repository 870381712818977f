// Inside room `read` only: the parts of a PLY, whether it is in memory or read block by block.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "formats.h"

namespace colod::mesh_io {

enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };

struct PlyProperty {
  std::string name;
  bool is_list = false;
  PlyType count = PlyType::kUint8, type = PlyType::kFloat;
};

struct PlyElement {
  std::string name;
  long long count = 0;
  std::vector<PlyProperty> properties;

  int find(std::string_view property) const {
    for (std::size_t i = 0; i < properties.size(); ++i)
      if (properties[i].name == property) return static_cast<int>(i);
    return -1;
  }
};

struct PlyHeader {
  bool is_text = false, is_big_endian = false;
  std::vector<PlyElement> elements;
  std::size_t body = 0;  // where the data start
  int lines = 0;
  std::string remarks;                // its comments
  std::vector<std::string> textures;  // files that comments name
};

/// Of the bytes of a file or of its head. Throws Error{kInput} naming the line.
PlyHeader read_ply_header(const std::string& path, const std::string& bytes);

/// Numbers of the body one after the other, whatever the encoding.
class PlyBody {
 public:
  /// What is left of the data → that, and more of the file; false: there is no more.
  using More = std::function<bool(std::string_view& data)>;

  /// `data`: what follows the header, up to the end unless there is `more`.
  PlyBody(const std::string& path, std::string_view data, const PlyHeader& header, More more = {});

  /// Names the place in messages: "vertex 12 of 100".
  void set_place(const PlyElement& element, long long i) { element_ = &element, index_ = i; }

  double next(PlyType type);
  /// A whole number; anything else is a failure that names the place.
  int next_integer(PlyType type);
  /// Passes over one property.
  void skip(const PlyProperty& p);
  [[noreturn]] void fail_here(const std::string& cause) const;

 private:
  double next_in_text();
  [[noreturn]] void truncated() const;

  const std::string& path_;
  std::string_view data_;
  Lines lines_;
  More more_;
  bool is_text_, is_swapped_;
  const PlyElement* element_ = nullptr;
  long long index_ = 0;
};

/// The properties red, green and blue, under any of their names; −1: not all are there.
std::array<int, 3> find_ply_colors(const PlyElement& element);

/// A component of a colour, 0..1: whole numbers count to 255, or 65535 where they take 16 bits.
double ply_shade(double value, PlyType type);

struct PlyVertex {
  Vec3 at, normal;
  std::array<double, 3> rgb{};  ///< 0..1
  int kind = 0;                 ///< class, as LAS numbers them
};

/// Which property of a vertex is what.
struct PlyVertexSlots {
  std::vector<int> of;  ///< per property: coordinate, normal, colour (0 to 8), class (9), or −1
  bool has_normals = false, has_colors = false, is_single = false;  ///< single precision
  std::array<PlyType, 3> shades{};
};

/// Throws Error{kInput} where x, y or z is missing.
PlyVertexSlots find_ply_slots(PlyBody& body, const PlyElement& element);

/// All vertices of the element that is next in the body.
void visit_ply_vertices(PlyBody& body, const PlyElement& element, const PlyVertexSlots& slots,
                        const std::function<void(const PlyVertex&)>& take);

/// An element of which nothing is wanted.
void skip_ply_element(PlyBody& body, const PlyElement& element);

}  // namespace colod::mesh_io
