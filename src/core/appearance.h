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

/// Both ways between a component of an sRGB colour and linear light, 0..1 (IEC 61966-2-1), for many
/// texels.
class SrgbTable {
 public:
  SrgbTable();
  float to_linear(std::uint8_t srgb) const { return linear_[srgb]; }
  std::uint8_t to_srgb(float linear) const {
    if (!(linear > 0)) return 0;
    if (!(linear < 1)) return 255;
    std::size_t code = starts_[static_cast<std::size_t>(linear * kSteps)];
    code += code < 255 && borders_[code + 1] <= linear;
    return static_cast<std::uint8_t>(code);
  }

 private:
  static constexpr std::size_t kSteps = 4096;
  std::array<float, 256> linear_;
  std::array<float, 256> borders_;  // from which linear value on a component is i, not i − 1
  std::array<std::uint8_t, kSteps> starts_;  // of the linear value i / kSteps the component; up
                                             // to the next one it grows by one at most
};
extern const SrgbTable kSrgb;

/// What one component of an sRGB colour is in linear light, 0..1, and back.
inline float to_linear(std::uint8_t srgb) { return kSrgb.to_linear(srgb); }
inline std::uint8_t to_srgb(float linear) { return kSrgb.to_srgb(linear); }

}  // namespace colod
