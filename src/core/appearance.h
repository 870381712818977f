// How a surface looks: plain arrays beside a mesh's faces. No pixels here: images stay in their
// files until room `image` decodes them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace colod {

using Rgb = std::array<std::uint8_t, 3>;  ///< sRGB
using Vec2f = Eigen::Vector2f;

/// Where an encoded image lies.
struct ImagePlace {
  std::string path;                    ///< of the file that holds it
  std::size_t offset = 0, length = 0;  ///< bytes of that file; length 0: all of it
  bool is_base64 = false;              ///< these bytes are base64 …
  std::size_t skip = 0, take = 0;      ///< … of which these are the image; take 0: all

  bool operator==(const ImagePlace&) const = default;
};

/// What an image shows beyond its border.
enum class Wrap { kRepeat, kMirror, kClamp };

struct Material {
  std::string name;                        ///< for messages
  std::array<float, 3> color = {1, 1, 1};  ///< linear light; what the image shows is multiplied
  int image = -1;                          ///< index into the images; −1: one colour
  Wrap wrap_u = Wrap::kRepeat, wrap_v = Wrap::kRepeat;
  float cutoff = 0;  ///< alpha of the image below which it is seen through; 0: nowhere
};

/// The arrays per face are as long as the mesh's faces, or empty.
struct Appearance {
  std::vector<ImagePlace> images;
  std::vector<Material> materials;
  std::vector<int> face_material;          ///< index into `materials`; −1: none
  std::vector<std::array<Vec2f, 3>> uvs;   ///< per corner; 0,0 is the image's upper left corner
  std::vector<std::array<Rgb, 3>> colors;  ///< per corner, multiplied with the material's; of a
                                           ///< cloud per point, three times the same

  bool is_empty() const { return face_material.empty() && colors.empty(); }
  /// Whether a place of a face may look unlike another place of it.
  bool has_detail() const { return !images.empty() || !colors.empty(); }
  /// These faces stay, in this order; some may come several times.
  void pick(std::span<const int> faces);
};

/// What one component of an sRGB colour is in linear light, 0..1, and back.
float to_linear(std::uint8_t srgb);
std::uint8_t to_srgb(float linear);

}  // namespace colod
