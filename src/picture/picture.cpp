// Pictures by ray casting.
//
// Based on: Decaudin: Cartoon-looking rendering of 3D-scenes, INRIA report 2919, 1996 (lines where
//   neighbouring samples differ in surface or depth).
// Differs: the same under both rules.
// Notation: a sample is one ray's part of a pixel; right, up, forward are the camera's axes.
#include "picture.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <string_view>

#include "core/parallel.h"
#include "core/rays.h"
#include "image/look_sampler.h"

namespace colod {
namespace {

constexpr double kMargin = 1.06;  ///< the frame is this much larger than the box
constexpr Color kLightGrey{205, 205, 200}, kBackFace{150, 25, 25}, kRing{220, 0, 60};
constexpr double kInk = 0.25;        ///< how bright a line is
constexpr double kCrease_deg = 25;   ///< two faces without facets are told apart from here on
constexpr double kGrazing = 0.1;     ///< cosine: what is seen flatter is as sharp as this
constexpr double kDepthStep = 0.01;  ///< of the box's diagonal: a line between surfaces

/// Orthographic; the same box and options give the same camera.
struct Camera {
  Vec3 center, right, up, forward;
  Vec3 light;       ///< unit, to the light: over the viewer's left shoulder
  double step = 1;  ///< metres a sample
  double diagonal = 1;
  int width = 0, height = 0;  ///< in samples
  int samples = 1;            ///< a pixel's side

  Vec3 at(int x, int y) const {
    return center + step * ((x + 0.5 - 0.5 * width) * right + (0.5 * height - y - 0.5) * up);
  }
};

Camera make_camera(const PreviewOptions& o, const Box& box) {
  const double az = o.azimuth_deg * std::numbers::pi / 180;
  const double el = o.elevation_deg * std::numbers::pi / 180;
  Camera c;
  c.right = {std::cos(az), std::sin(az), 0};
  c.forward = {-std::cos(el) * std::sin(az), std::cos(el) * std::cos(az), -std::sin(el)};
  c.up = c.right.cross(c.forward);
  c.light = (-c.forward * 0.55 - c.right * 0.45 + Vec3::UnitZ() * 0.7).normalized();
  c.samples = o.samples;
  c.width = o.samples * o.width;
  c.height = o.samples * o.height;
  if (box.is_empty()) {
    c.center = Vec3::Zero();
    return c;
  }
  c.center = box.center();
  const Vec3 half = 0.5 * box.size();
  c.diagonal = std::max(box.diagonal(), 1e-9);
  const double across = 2 * half.dot(c.right.cwiseAbs()), tall = 2 * half.dot(c.up.cwiseAbs());
  c.step = kMargin * std::max({across / c.width, tall / c.height, 1e-9 * c.diagonal});
  return c;
}

/// Brightness of a surface: the light, and some from everywhere.
double shade(const Vec3& normal, const Camera& c) {
  return 0.5 + 0.5 * std::max(0.0, normal.dot(c.light));
}

/// What one sample sees.
struct Sample {
  int face = -1;
  bool is_back = false;
  double depth = 0;  ///< along `forward`, from the plane through the box's centre
};

struct Surface {
  Vec3 normal = Vec3::Zero();  ///< zero: degenerate
  int facet = 0;
};

std::vector<Surface> make_surfaces(const Mesh& mesh, const std::vector<int>& facet_of_face) {
  std::vector<Surface> surfaces(mesh.faces.size());
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const Vec3 cross = face_cross(mesh, mesh.faces[i]);
    if (cross.allFinite() && cross.norm() > 0) surfaces[i].normal = cross.normalized();
    surfaces[i].facet = facet_of_face.empty() ? -1 : facet_of_face[i];
  }
  return surfaces;
}

/// Metres of depth per metre across, along one of the camera's axes.
double depth_slope(const Vec3& normal, const Vec3& axis, const Vec3& forward) {
  const double facing = normal.dot(forward);
  return std::abs(facing) < 0.02 ? 0 : -normal.dot(axis) / facing;
}

/// Whether a line runs between sample a and its neighbour b, one step along `axis`.
bool is_edge(const Sample& a, const Sample& b, const Vec3& axis, const Camera& c,
             const std::vector<Surface>& surfaces) {
  if (a.face < 0 && b.face < 0) return false;
  if (a.face < 0 || b.face < 0 || a.is_back != b.is_back) return true;
  const Surface &sa = surfaces[a.face], &sb = surfaces[b.face];
  if (sa.facet != sb.facet) return true;
  static const double crease = std::cos(kCrease_deg * std::numbers::pi / 180);
  if (sa.facet < 0 && sa.normal.dot(sb.normal) < crease) return true;
  // A step in depth that neither surface's own slope explains.
  const double by_a = a.depth + c.step * depth_slope(sa.normal, axis, c.forward);
  const double by_b = b.depth - c.step * depth_slope(sb.normal, axis, c.forward);
  const double limit = kDepthStep * c.diagonal;
  return std::abs(b.depth - by_a) > limit && std::abs(a.depth - by_b) > limit;
}

/// Samples from (x0, y0) to (x1, y1), both ends included; empty when x0 > x1.
struct Window {
  int x0 = 0, y0 = 0, x1 = -1, y1 = -1;
};

struct Samples {
  std::vector<Sample> all;  ///< width × height, top row first
  Window window;            ///< nothing is seen outside
};

/// Faces whose rectangle in the picture holds the middle of a sample, within a hundredth: of a fine
/// scan that is less than half, and the others would cost as much to sort.
std::vector<int> sampled_faces(const Mesh& mesh, const Camera& c, Window& window) {
  std::vector<Vec2> at(mesh.vertices.size());  // in samples; whole numbers are their middles
  for (std::size_t i = 0; i < at.size(); ++i) {
    const Vec3 p = (mesh.vertices[i] - c.center) / c.step;
    at[i] = {p.dot(c.right) + 0.5 * c.width - 0.5, 0.5 * c.height - p.dot(c.up) - 0.5};
  }
  const Vec2 margin = Vec2::Constant(0.01), last(c.width - 1, c.height - 1);
  window = {c.width, c.height, -1, -1};
  std::vector<int> faces;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto& [i, j, k] = mesh.faces[f];
    const Vec2 low = (at[i].cwiseMin(at[j]).cwiseMin(at[k]) - margin).cwiseMax(0.0);
    const Vec2 high = (at[i].cwiseMax(at[j]).cwiseMax(at[k]) + margin).cwiseMin(last);
    const double x0 = std::ceil(low.x()), y0 = std::ceil(low.y());
    const double x1 = std::floor(high.x()), y1 = std::floor(high.y());
    if (!(x0 <= x1 && y0 <= y1)) continue;  // or not a number
    faces.push_back(static_cast<int>(f));
    window.x0 = std::min(window.x0, static_cast<int>(x0));
    window.y0 = std::min(window.y0, static_cast<int>(y0));
    window.x1 = std::max(window.x1, static_cast<int>(x1));
    window.y1 = std::max(window.y1, static_cast<int>(y1));
  }
  return faces;
}

Samples cast_samples(const Mesh& mesh, const Camera& c) {
  Samples samples{std::vector<Sample>(static_cast<std::size_t>(c.width) * c.height), {}};
  const std::vector<int> sampled = sampled_faces(mesh, c, samples.window);
  std::vector<Face> faces;
  for (const int f : sampled) faces.push_back(mesh.faces[f]);
  const RayScene scene(mesh.vertices, faces);
  const Box box = bounding_box(mesh.vertices);
  // Before everything, even where the frame's box is smaller than the mesh.
  double before = c.diagonal;
  if (!box.is_empty()) before += (box.center() - c.center).norm() + box.diagonal();
  const Window& w = samples.window;
  parallel_for(static_cast<std::size_t>(std::max(0, w.y1 - w.y0 + 1)), [&](std::size_t row) {
    const std::size_t y = w.y0 + row;
    for (int x = w.x0; x <= w.x1; ++x) {
      const Vec3 origin = c.at(x, static_cast<int>(y)) - before * c.forward;
      const RayHit hit = scene.first_hit(origin, c.forward);
      if (hit)
        samples.all[y * c.width + x] = {sampled[hit.triangle], hit.is_inside,
                                        hit.distance - before};
    }
  });
  return samples;
}

/// Brightness and colour of samples, averaged over each pixel.
template <typename ColorOf>
Image average(const Camera& c, const Window& window, const ColorOf& color_of) {
  const int side = c.samples;
  Image image{c.width / side, c.height / side, {}};
  image.rgb.resize(static_cast<std::size_t>(image.width) * image.height * 3);
  parallel_for(static_cast<std::size_t>(image.height), [&](std::size_t row) {
    for (int column = 0; column < image.width; ++column) {
      // A line may run between the window's first samples and those before.
      const int x = column * side, y = static_cast<int>(row) * side;
      if (x + side < window.x0 || x > window.x1 || y + side < window.y0 || y > window.y1) {
        std::copy(kBackground.begin(), kBackground.end(),
                  &image.rgb[3 * (row * image.width + column)]);
        continue;
      }
      Vec3 sum = Vec3::Zero();
      for (int dy = 0; dy < side; ++dy)
        for (int dx = 0; dx < side; ++dx) sum += color_of(x + dx, y + dy);
      sum /= side * side;
      for (int k = 0; k < 3; ++k)
        image.rgb[3 * (row * image.width + column) + k] =
            static_cast<std::uint8_t>(std::lround(std::clamp(sum[k], 0.0, 255.0)));
    }
  });
  return image;
}

Vec3 as_vector(const Color& c) {
  return {static_cast<double>(c[0]), static_cast<double>(c[1]), static_cast<double>(c[2])};
}

Box finite_box(const std::vector<Vec3>& points) {
  Box box;
  for (const Vec3& p : points)
    if (p.allFinite()) box.extend(p);
  return box;
}

/// Half the usual distance between neighbouring points, as if they covered two sides of their box.
double splat_radius(const PointCloud& cloud, const Box& box) {
  if (cloud.points.empty()) return 0;
  const Vec3 s = box.size();
  const double surface = 2 * (s.x() * s.y() + s.y() * s.z() + s.z() * s.x());
  return 0.9 * std::sqrt(surface / static_cast<double>(cloud.points.size()));
}

/// The nearest point over each sample; equal depth goes to the first point.
Samples splat(const PointCloud& cloud, const Camera& c, double radius) {
  Samples samples{std::vector<Sample>(static_cast<std::size_t>(c.width) * c.height),
                  {0, 0, c.width - 1, c.height - 1}};
  const double r = std::clamp(radius / c.step, 0.75, 8.0);
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    if (!cloud.points[i].allFinite()) continue;
    const Vec3 p = cloud.points[i] - c.center;
    const double x = p.dot(c.right) / c.step + 0.5 * c.width;
    const double y = 0.5 * c.height - p.dot(c.up) / c.step;
    if (!(x > -r && y > -r && x < c.width + r && y < c.height + r)) continue;
    const double depth = p.dot(c.forward);
    const int y0 = std::max(0, static_cast<int>(y - r)),
              y1 = std::min(c.height - 1, static_cast<int>(y + r));
    const int x0 = std::max(0, static_cast<int>(x - r)),
              x1 = std::min(c.width - 1, static_cast<int>(x + r));
    for (int sy = y0; sy <= y1; ++sy)
      for (int sx = x0; sx <= x1; ++sx) {
        if (std::hypot(sx + 0.5 - x, sy + 0.5 - y) > r) continue;
        Sample& s = samples.all[static_cast<std::size_t>(sy) * c.width + sx];
        if (s.face < 0 || depth < s.depth) s = {static_cast<int>(i), false, depth};
      }
  }
  return samples;
}

/// Printable ASCII, 5 × 7 dots: seven rows a character, each a digit to base 32 (0–9, a–v), its
/// highest bit the leftmost dot.
constexpr std::string_view kFont =
    "00000004444404aa00000aavavaa4fke5u4op248j3cik8lid4400000"  // space ! " # $ % & '
    "2488842842224804lel40044v4400000c48000v00000000cc01248g0"  // ( ) * + , - . /
    "ehjlphe4c4444eeh1248vv2421he26aiv22vgu11he68guhhe"         // 0 1 2 3 4 5 6
    "v124888ehhehheehhf12c0cc0cc00cc0c48248g84200v0v008421248"  // 7 8 9 : ; < = >
    "eh12404eh1dlle"                                            // ? @
    "ehhvhhhuhhuhhufgggggfuhhhhhuvgguggvvgguggg"                // A – F
    "fggjhhfhhhvhhhe44444e72222ichikokihggggggvhrllhhh"         // G – M
    "hhpljhhehhhhheuhhugggehhhliduhhukihfgge11uv444444"         // N – T
    "hhhhhhehhhhha4hhhlllahha4ahhhha4444v1248gv"                // U – Z
    "e88888e0g84210e22222e4ah0000000000v8400000"                // [ \ ] ^ _ `
    "00e1fhfggmphhu00fgggf11djhhf00ehvge698s888"                // a – f
    "0fhhf1eggmphhh40c444e20622icggikokic44444e00qlllh"         // g – m
    "00mphhh00ehhhe00uhugg00fhf1100mpggg00fge1u88s8896"         // n – t
    "00hhhjd00hhha400hhlla00ha4ah0hhhf1e00v248v"                // u – z
    "2448442444444484424480"
    "08l200";  // { | } ~
constexpr int kRows = 7, kColumns = 5, kAdvance = 6;
static_assert(kFont.size() == kRows * ('~' - ' ' + 1));

bool is_dot(char c, int column, int row) {
  const char digit = kFont[static_cast<std::size_t>(kRows * (c - ' ') + row)];
  const int bits = digit <= '9' ? digit - '0' : digit - 'a' + 10;
  return bits >> (kColumns - 1 - column) & 1;
}

/// Draws printable ASCII with its upper left corner at (x, y), inside the picture.
void draw_text(Image& image, int x, int y, const std::string& text, int scale) {
  for (std::size_t i = 0; i < text.size(); ++i)
    for (int dy = 0; dy < kRows * scale; ++dy)
      for (int dx = 0; dx < kColumns * scale; ++dx) {
        const int px = x + static_cast<int>(i) * kAdvance * scale + dx, py = y + dy;
        if (px < image.width && py < image.height && is_dot(text[i], dx / scale, dy / scale))
          std::fill_n(&image.rgb[3 * (static_cast<std::size_t>(py) * image.width + px)], 3, 20);
      }
}

/// What fits into `width` pixels at scale 1, with two dots for the rest; '?' for what is not ASCII.
std::string fit_text(std::string text, int width) {
  for (char& c : text)
    if (c < ' ' || c > '~') c = '?';
  const auto most = static_cast<std::size_t>(width / kAdvance);
  return text.size() <= most ? text : text.substr(0, most - std::min<std::size_t>(most, 2)) + "..";
}

/// A ring about a place, a twelfth of the picture across and a hundredth thick.
void draw_ring(const Vec3& place, const Camera& c, Image& image) {
  const Vec3 p = (place - c.center) / (c.step * c.samples);
  const Vec2 middle(p.dot(c.right) + 0.5 * image.width, 0.5 * image.height - p.dot(c.up));
  const double radius = 0.04 * image.width, thick = std::max(1.0, 0.01 * image.width);
  if (!middle.allFinite()) return;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (std::abs((Vec2(x + 0.5, y + 0.5) - middle).norm() - radius) < 0.5 * thick)
        std::copy(kRing.begin(), kRing.end(),
                  image.rgb.begin() + 3 * (static_cast<std::ptrdiff_t>(y) * image.width + x));
}

}  // namespace

Image render_preview(const Mesh& mesh, const PreviewOptions& options,
                     const std::vector<int>& facet_of_face,
                     const std::vector<Color>& color_of_face) {
  assert(options.width > 0 && options.height > 0 && options.samples > 0);
  assert(facet_of_face.empty() || facet_of_face.size() == mesh.faces.size());
  assert(color_of_face.empty() || color_of_face.size() == mesh.faces.size());
  const Camera c =
      make_camera(options, options.box.is_empty() ? finite_box(mesh.vertices) : options.box);
  const std::vector<Surface> surfaces = make_surfaces(mesh, facet_of_face);
  const Samples samples = cast_samples(mesh, c);
  const auto at = [&](int x, int y) -> const Sample& {
    return samples.all[static_cast<std::size_t>(y) * c.width + x];
  };
  Image image = average(c, samples.window, [&](int x, int y) -> Vec3 {
    const Sample& s = at(x, y);
    Vec3 color = as_vector(kBackground);
    if (s.face >= 0) {
      const Vec3 normal = s.is_back ? Vec3(-surfaces[s.face].normal) : surfaces[s.face].normal;
      const Color own = color_of_face.empty() ? kLightGrey : color_of_face[s.face];
      color = shade(normal, c) * as_vector(s.is_back ? kBackFace : own);
    }
    const bool is_line =
        options.has_edges && ((x + 1 < c.width && is_edge(s, at(x + 1, y), c.right, c, surfaces)) ||
                              (y + 1 < c.height && is_edge(s, at(x, y + 1), -c.up, c, surfaces)));
    return is_line ? Vec3(kInk * color) : color;
  });
  for (const Vec3& place : options.marks) draw_ring(place, c, image);
  return image;
}

Image render_preview(const Mesh& mesh, const LookSampler& look, const PreviewOptions& options) {
  assert(options.width > 0 && options.height > 0 && options.samples > 0);
  const Camera c =
      make_camera(options, options.box.is_empty() ? finite_box(mesh.vertices) : options.box);
  const std::vector<Surface> surfaces = make_surfaces(mesh, {});
  const Samples samples = cast_samples(mesh, c);
  std::vector<Color> colors(samples.all.size(), kBackground);
  parallel_for(static_cast<std::size_t>(c.height), [&](std::size_t y) {
    Lens lens(look.cache());
    for (int x = 0; x < c.width; ++x) {
      const Sample& s = samples.all[y * c.width + x];
      if (s.face < 0) continue;
      Color& color = colors[y * c.width + x] = kBackFace;
      if (s.is_back) continue;
      const double facing = std::max(kGrazing, -surfaces[s.face].normal.dot(c.forward));
      const Vec3 place = c.at(x, static_cast<int>(y)) + s.depth * c.forward;
      const Light light = look.sample(s.face, place, c.step / std::sqrt(facing), lens);
      for (int k = 0; k < 3; ++k) color[k] = to_srgb(light[k]);
    }
  });
  return average(c, samples.window, [&](int x, int y) {
    return as_vector(colors[static_cast<std::size_t>(y) * c.width + x]);
  });
}

Image render_preview(const PointCloud& cloud, const PreviewOptions& options) {
  assert(options.width > 0 && options.height > 0 && options.samples > 0);
  assert(cloud.normals.empty() || cloud.normals.size() == cloud.points.size());
  const Box own = finite_box(cloud.points);
  const Camera c = make_camera(options, options.box.is_empty() ? own : options.box);
  const Samples samples = splat(cloud, c, splat_radius(cloud, own));
  return average(c, samples.window, [&](int x, int y) -> Vec3 {
    const Sample& s = samples.all[static_cast<std::size_t>(y) * c.width + x];
    if (s.face < 0) return as_vector(kBackground);
    if (cloud.normals.empty())  // the nearer the brighter
      return std::clamp(0.65 - 0.6 * s.depth / c.diagonal, 0.2, 1.0) * as_vector(kLightGrey);
    const Vec3& n = cloud.normals[s.face];
    if (n.dot(c.forward) > 0) return shade(-n, c) * as_vector(kBackFace);
    return shade(n, c) * as_vector(kLightGrey);
  });
}

Image contact_sheet(const std::vector<Image>& images, const std::vector<std::string>& captions,
                    int columns) {
  assert(columns > 0 && (captions.empty() || captions.size() == images.size()));
  constexpr int kGap = 8, kLine = 12;  // kLine: a line of text with air
  int width = 1, height = 1;
  for (const Image& i : images)
    width = std::max(width, i.width), height = std::max(height, i.height);
  const int scale = width >= 320 ? 2 : 1;
  const int text = captions.empty() ? 0 : scale * kLine;
  const int count = static_cast<int>(images.size());
  const int across = std::max(1, std::min(columns, count)), rows = (count + columns - 1) / columns;
  Image sheet{across * (width + kGap) + kGap, rows * (height + text + kGap) + kGap, {}};
  sheet.rgb.assign(static_cast<std::size_t>(sheet.width) * sheet.height * 3, 255);
  for (int i = 0; i < count; ++i) {
    const int x = kGap + i % columns * (width + kGap);
    const int y = kGap + i / columns * (height + text + kGap);
    const Image& image = images[i];
    for (int row = 0; row < image.height; ++row)
      std::copy_n(&image.rgb[3 * static_cast<std::size_t>(row) * image.width], 3 * image.width,
                  &sheet.rgb[3 * (static_cast<std::size_t>(y + row) * sheet.width + x)]);
    if (captions.empty()) continue;
    // A long caption is set small before it is cut.
    const std::string caption = fit_text(captions[i], width);
    const int own = static_cast<int>(caption.size()) * kAdvance * scale <= width ? scale : 1;
    draw_text(sheet, x, y + height + 3, caption, own);
  }
  return sheet;
}

Color palette(int id) {
  if (id < 0) return {150, 150, 150};
  // Golden steps round the hues; brightness and strength change every few colours.
  const double hue = std::fmod(0.08 + id * (std::numbers::phi - 1), 1.0) * 6;
  const double strength = 0.45 + 0.2 * (id / 3 % 2), value = 0.95 - 0.14 * (id / 5 % 3);
  Color color;
  for (int k = 0; k < 3; ++k) {
    const double h = std::fmod(hue + std::array{0.0, 4.0, 2.0}[k], 6.0);
    const double part = std::clamp(std::abs(h - 3) - 1, 0.0, 1.0);
    color[k] = static_cast<std::uint8_t>(std::lround(255 * value * (1 - strength * (1 - part))));
  }
  return color;
}

}  // namespace colod
