// Inside room 1 only: a glTF file from its bytes to numbers. The scene is mesh_io_gltf.cpp's.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "geometry.h"

namespace colod::mesh_io {

using Json = nlohmann::json;

/// What a file holds before anything is read from it.
struct GltfDocument {
  Json json;                         ///< an object
  std::vector<std::string> buffers;  ///< decoded; empty where the file says that it has no bytes
  std::vector<std::string> warnings;
};

/// Takes container, JSON and buffers apart. Buffers lie in the file, in `data:` URIs, or in files
/// at or below its folder. Throws Error{kInput}, also where the file needs an extension that is not
/// read.
GltfDocument open_gltf(const std::string& path, std::string_view bytes);

/// A primitive's own points and corners, before its node places them.
struct GltfPrimitive {
  std::vector<Vec3> points;
  std::vector<int> corners;  ///< three a triangle; empty: points or lines only
};

/// Everything that is checked when a document is read. All methods throw Error{kInput}.
class GltfReader {
 public:
  GltfReader(const std::string& path, const GltfDocument& document);

  [[noreturn]] void fail(const std::string& cause) const;
  const Json& json() const { return document_.json; }

  /// Entry i of a list of the document; `what` is one of them in words.
  const Json& at(const char* list, int i, const char* what) const;
  std::size_t count(const char* list) const;
  /// A member that is a whole number, or `none` where it is absent.
  int integer(const Json& object, const char* key, int none = -1) const;

  /// count × components numbers, as floats or normalized.
  std::vector<double> values(int accessor, int components) const;
  GltfPrimitive primitive(const Json& primitive) const;

  /// Counts what is placed. A file may hold few bytes and say that they stand in many places: it
  /// fails where that comes to more than 12 million corners beyond what its bytes could hold.
  void spend(std::size_t points_and_corners);

 private:
  struct View {
    std::string_view stored;
    std::string unpacked;    ///< instead, where the view was compressed
    std::size_t stride = 0;  ///< 0: packed
    std::string_view bytes() const { return unpacked.empty() ? stored : unpacked; }
  };
  View view(int index) const;
  View unpack(int index, const Json& extension) const;
  std::string_view slice(const Json& holder, const std::string& place) const;
  std::size_t size_of(const Json& object, const char* key, std::size_t none) const;
  void replace_sparse(const Json& sparse, int component_type, int components, bool is_normalized,
                      const std::string& place, std::vector<double>& values) const;
  GltfPrimitive draco(const Json& extension) const;

  const std::string& path_;
  const GltfDocument& document_;
  std::size_t budget_ = 0;
};

}  // namespace colod::mesh_io
