// Inside room `read` only: what files say of how faces look.
#pragma once

#include <string>
#include <vector>

#include "formats.h"

namespace colod::mesh_io {

/// Materials by name, as an MTL file defines them, and how their images lie on a surface.
struct MtlMaterial {
  Material material;
  Vec2 scale = Vec2(1, 1), shift = Vec2(0, 0);  ///< of texture coordinates: scale · uv + shift
  bool is_defined = false;                      ///< by a file that is there
};

/// What the MTL files of an OBJ say. Images are looked for where the file says and, by their bare
/// name, beside it; none outside of the folder of `path` is taken.
class MtlLibrary {
 public:
  explicit MtlLibrary(std::string path) : path_(std::move(path)) {}

  /// The rest of a `mtllib` line: one name with blanks, or several.
  void load(const std::string& names);
  /// Index into materials(); one that no file defines is grey, with a warning.
  int number(const std::string& name);

  const std::vector<MtlMaterial>& materials() const { return materials_; }
  const std::vector<ImagePlace>& images() const { return images_; }
  /// Number of the image that stands for those of a file which is not there; −1: all are.
  int lost_image();
  /// One line for each file that is missing.
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  bool load_file(const std::string& name);
  void parse(const std::string& file, const std::string& text);
  void set_image(Lines& lines, MtlMaterial& m);
  int find(const std::string& name) const;

  std::string path_;     // of the OBJ
  std::string missing_;  // a file that cannot be read; empty: none
  std::vector<MtlMaterial> materials_;
  std::vector<ImagePlace> images_;
  std::vector<std::string> warnings_;
};

/// The file that `name` stands for in the folder of `path`, or below: as it is written, or its last
/// part beside `path`. Empty: there is none.
std::string find_beside(const std::string& path, const std::string& name);

/// Alpha below which an image is seen through where a format does not say: OBJ and PLY.
constexpr float kCutoff = 0.5f;

/// The image in that file, or one that is missing.
ImagePlace image_beside(const std::string& path, const std::string& name);

/// Of a URI.
std::string percent_decoded(const std::string& uri);

/// Index in `images` of a place, which joins them where it is new.
int image_number(std::vector<ImagePlace>& images, const ImagePlace& place);

/// Of a colour as most formats write it, sRGB 0..1.
Rgb rgb_of(double r, double g, double b);

/// Adds a warning where there are images and no face wears one.
void warn_of_unworn(RawFile& raw);

/// Gives corners the colours of their points, before points become one. One colour for all is none.
void color_corners(RawFile& raw);

/// Corners' coordinates and colours for one source: of triangles, given by their corners in `raw`.
Appearance look_of(const RawFile& raw, const std::vector<Face>& corners,
                   const std::vector<int>& polygon, const std::vector<int>& chosen);

}  // namespace colod::mesh_io
