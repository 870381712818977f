// Inside room `read` only: a glTF file from its bytes to numbers. The scene is gltf.cpp's.
#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry.h"

namespace colod::mesh_io {

/// A material, and how its image lies on a surface.
struct GltfMaterial {
  Material material;
  int uv_set = 0;  ///< of TEXCOORD_<n>
  Eigen::Matrix<double, 2, 3> place =
      Eigen::Matrix<double, 2, 3>::Identity();  ///< KHR_texture_transform
};

/// What a file says of how its primitives look.
struct GltfLook {
  std::vector<GltfMaterial> materials;  ///< by the file's numbers
  std::vector<ImagePlace> images;
};

/// Faults cost an image, which is a missing one then, and nothing else. `binary`: where the GLB's
/// own buffer begins in the file.
GltfLook read_gltf_look(const std::string& path, std::string_view bytes, std::size_t binary,
                        const nlohmann::json& json);

/// A file as tinygltf took it apart, without what shapes do not need.
struct GltfDocument {
  tinygltf::Model model;
  GltfLook look;
  std::vector<std::string> warnings;
};

/// Buffers lie in the file, in `data:` URIs, or in files at or below its folder, which take at most
/// `input_memory` MiB with it. `begin`: where in the file `bytes` begin. Throws Error{kInput}, also
/// where the file needs an extension that is not read.
GltfDocument open_gltf(const std::string& path, std::string_view bytes, std::size_t begin,
                       double input_memory);

/// A document of glTF 1.0 as one of 2.0; `binary` bytes stand behind its JSON. Throws
/// Error{kInput}.
nlohmann::json upgrade_gltf1(const std::string& path, const nlohmann::json& old,
                             std::size_t binary);

/// nullptr: there is none of that name.
const tinygltf::Value* extension_of(const tinygltf::ExtensionMap& extensions, const char* name);

/// A primitive's own points and corners, before its node places them.
struct GltfPrimitive {
  std::vector<Vec3> points;
  std::vector<int> corners;  ///< three a triangle; empty: points or lines only
  std::vector<Vec2f> uvs;    ///< per point, 0,0 the upper left; or empty
  std::vector<Rgb> colors;   ///< per point, or empty
};

/// Everything that is checked when a document is read: tinygltf hands out indices, offsets and
/// counts as they are written. All methods throw Error{kInput}.
class GltfReader {
 public:
  GltfReader(const std::string& path, const tinygltf::Model& model, double input_memory);

  [[noreturn]] void fail(const std::string& cause) const;
  const tinygltf::Model& model() const { return model_; }

  /// Entry i of a list of the model; `what` is one of them in words.
  template <typename T>
  const T& at(const std::vector<T>& list, int i, const char* what) const {
    if (i < 0 || static_cast<std::size_t>(i) >= list.size())
      fail(std::string(what) + " " + std::to_string(i) + " of " + std::to_string(list.size()) +
           " is named but missing");
    return list[static_cast<std::size_t>(i)];
  }
  /// A member that is a whole number, or `none` where it is absent.
  int integer(const tinygltf::Value& object, const char* key, int none = -1) const;
  /// A member that lists numbers; empty where it is absent.
  std::vector<double> numbers(const tinygltf::Value& object, const char* key) const;

  /// count × components numbers, as floats or normalized.
  std::vector<double> values(int accessor, int components) const;
  /// With the texture coordinates of this set, where it has them.
  GltfPrimitive primitive(const tinygltf::Primitive& primitive, int uv_set) const;

  /// Counts what is placed. A file may hold few bytes and say that they stand in many places: it
  /// fails where that comes to more corners than `input_memory` has room for, beyond what its bytes
  /// could hold.
  void spend(std::size_t points_and_corners);

 private:
  struct View {
    std::string_view stored;
    std::string unpacked;    ///< instead, where the view was compressed
    std::size_t stride = 0;  ///< 0: packed
    std::string_view bytes() const { return unpacked.empty() ? stored : unpacked; }
  };
  View view(int index) const;
  View unpack(int index, const tinygltf::Value& extension) const;
  std::string_view slice(int buffer, std::size_t offset, std::size_t length,
                         const std::string& place) const;
  void replace_sparse(const tinygltf::Accessor& accessor, int components, const std::string& place,
                      std::vector<double>& values) const;
  GltfPrimitive draco(const tinygltf::Value& extension, int uv_set) const;
  void add_look(const tinygltf::Primitive& primitive, int uv_set, GltfPrimitive& out) const;

  const std::string& path_;
  const tinygltf::Model& model_;
  std::size_t free_corners_, budget_;
};

}  // namespace colod::mesh_io
