// Based on: Wavefront MTL as its writers use it.
// Differs: Kd counts only where there is no image, since many programs write a grey one beside it.
#include "look.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

#include "files.h"
#include "image/cache.h"

namespace colod::mesh_io {

namespace fs = std::filesystem;

namespace {

constexpr double kLargestMtl = 64;  // MiB

std::string unquoted(std::string_view s) {
  while (!s.empty() && (s.front() == ' ' || s.front() == '\t')) s.remove_prefix(1);
  while (!s.empty() && (s.back() == ' ' || s.back() == '\t')) s.remove_suffix(1);
  if (s.size() > 1 && s.front() == '"' && s.back() == '"') s = s.substr(1, s.size() - 2);
  return std::string(s);
}

/// How many numbers an option of a map takes: fewest and most; {-1, -1}: no option.
std::pair<int, int> arguments_of(const std::string& option) {
  static constexpr std::pair<const char*, std::pair<int, int>> kOptions[] = {
      {"-blendu", {1, 1}}, {"-blendv", {1, 1}},    {"-cc", {1, 1}},    {"-clamp", {1, 1}},
      {"-mm", {2, 2}},     {"-o", {1, 3}},         {"-s", {1, 3}},     {"-t", {1, 3}},
      {"-texres", {1, 1}}, {"-bm", {1, 1}},        {"-boost", {1, 1}}, {"-imfchan", {1, 1}},
      {"-type", {1, 1}},   {"-colorspace", {1, 1}}};
  for (const auto& [name, count] : kOptions)
    if (option == name) return count;
  return {-1, -1};
}

/// The next token without taking it.
std::string peek(const Lines& lines) {
  const std::string rest = unquoted(lines.rest());
  return rest.substr(0, rest.find_first_of(" \t"));
}

bool is_within(const fs::path& folder, const fs::path& file) {
  const auto [end, at] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
  return end == folder.end();
}

}  // namespace

std::string find_beside(const std::string& path, const std::string& name) {
  std::string written = name;
  std::replace(written.begin(), written.end(), '\\', '/');
  std::error_code error;
  const fs::path folder = fs::canonical(fs::absolute(path).parent_path(), error);
  if (error || written.empty()) return {};
  for (const fs::path& candidate : {folder / written, folder / fs::path(written).filename()}) {
    const fs::path file = fs::canonical(candidate, error);
    if (!error && is_within(folder, file) && fs::is_regular_file(file, error)) return file.string();
  }
  return {};
}

ImagePlace image_beside(const std::string& path, const std::string& name) {
  const std::string file = find_beside(path, name);
  return file.empty() ? missing_image(name.substr(0, 80)) : ImagePlace{.path = file};
}

int image_number(std::vector<ImagePlace>& images, const ImagePlace& place) {
  const auto known = std::find(images.begin(), images.end(), place);
  if (known == images.end()) {
    images.push_back(place);
    return static_cast<int>(images.size()) - 1;
  }
  return static_cast<int>(known - images.begin());
}

Rgb rgb_of(double r, double g, double b) {
  // Programs write 0..1, and some 0..255; what is no number is black.
  const double scale = std::max({r, g, b}) > 1 ? 1 : 255;
  Rgb out;
  int k = 0;
  for (const double v : {r, g, b})
    out[k++] =
        static_cast<std::uint8_t>(std::lround(std::clamp(v >= 0 ? v * scale : 0, 0.0, 255.0)));
  return out;
}

void MtlLibrary::load(const std::string& names) {
  if (load_file(unquoted(names))) return;
  bool has_found = false;
  std::string_view rest = names;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(' '), rest.size());
    if (end > 0 && end < names.size()) has_found |= load_file(std::string(rest.substr(0, end)));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  if (has_found) return;
  missing_ = names.substr(0, 80);
  warnings_.push_back("its material file '" + missing_ +
                      "' is missing: faces have no colour of their own");
}

bool MtlLibrary::load_file(const std::string& name) {
  const std::string file = find_beside(path_, name);
  if (file.empty()) return false;
  try {
    parse(file, as_text(read_bytes(file, kLargestMtl)));
  } catch (const Error& e) {  // appearance alone: shapes go on
    missing_ = name.substr(0, 80);
    warnings_.push_back(std::string("its material file cannot be read: ") + e.what());
  }
  return true;
}

int MtlLibrary::find(const std::string& name) const {
  for (std::size_t i = 0; i < materials_.size(); ++i)
    if (materials_[i].material.name == name) return static_cast<int>(i);
  return -1;
}

int MtlLibrary::number(const std::string& name) {
  const int known = find(name);
  if (known >= 0) return known;
  materials_.emplace_back();
  materials_.back().material.name = name;
  materials_.back().material.color = {0.6f, 0.6f, 0.6f};
  return static_cast<int>(materials_.size()) - 1;
}

/// The options before the name, and the name, which may hold blanks.
void MtlLibrary::set_image(Lines& lines, MtlMaterial& m) {
  while (peek(lines).starts_with('-')) {
    const std::string option = lower(peek(lines));
    const auto [fewest, most] = arguments_of(option);
    if (fewest < 0) break;  // a file of that name
    lines.token();
    std::vector<double> numbers;
    for (int i = 0; i < most; ++i) {
      double value = 0;
      const bool is_number = parse_number(peek(lines), value);
      if (!is_number && i >= fewest) break;
      if (option == "-clamp" && peek(lines) == "on")
        m.material.wrap_u = m.material.wrap_v = Wrap::kClamp;
      lines.token();
      numbers.push_back(value);
    }
    Vec2* target = option == "-s" ? &m.scale : option == "-o" ? &m.shift : nullptr;
    for (std::size_t i = 0; target && i < std::min<std::size_t>(2, numbers.size()); ++i)
      (*target)[static_cast<int>(i)] = numbers[i];
  }
  m.material.image = image_number(images_, image_beside(path_, unquoted(lines.rest())));
  m.material.cutoff = kCutoff;
}

void MtlLibrary::parse(const std::string& file, const std::string& text) {
  Lines lines(file, text);
  MtlMaterial* m = nullptr;
  while (lines.next()) {
    const std::string key = lower(std::string(lines.token()));
    if (key == "newmtl") {
      m = &materials_[static_cast<std::size_t>(number(unquoted(lines.rest())))];
      m->is_defined = true;
    } else if (m && key == "kd") {
      double rgb[3] = {0.6, 0.6, 0.6};
      for (double& v : rgb)
        if (!parse_number(lines.token(), v)) break;  // a spectrum or XYZ, which none writes
      for (std::size_t k = 0; k < 3; ++k)
        m->material.color[k] = to_linear(static_cast<std::uint8_t>(
            std::lround(255 * std::clamp(rgb[k] >= 0 ? rgb[k] : 0, 0.0, 1.0))));
    } else if (m && key == "map_kd") {
      set_image(lines, *m);
    }
  }
  for (MtlMaterial& each : materials_)
    if (const int i = each.material.image;
        i >= 0 && !is_missing(images_[static_cast<std::size_t>(i)]))
      each.material.color = {1, 1, 1};
}

int MtlLibrary::lost_image() {
  return missing_.empty() ? -1 : image_number(images_, missing_image("of " + missing_));
}

void warn_of_unworn(RawFile& raw) {
  const auto is_textured = [&](int m) {
    return m >= 0 && raw.materials[static_cast<std::size_t>(m)].image >= 0;
  };
  if (!raw.images.empty() &&
      std::none_of(raw.face_material.begin(), raw.face_material.end(), is_textured))
    raw.warnings.push_back("its texture '" + fs::path(raw.images[0].path).filename().string() +
                           "' is on no face: it is left out");
}

void color_corners(RawFile& raw) {
  if (!raw.point_colors.empty() && raw.corner_colors.empty())
    for (const int c : raw.corners)
      raw.corner_colors.push_back(raw.point_colors[static_cast<std::size_t>(c)]);
  std::vector<Rgb>& colors = raw.corner_colors;
  if (std::adjacent_find(colors.begin(), colors.end(), std::not_equal_to<>()) == colors.end())
    colors.clear();
}

namespace {

/// Lets go of materials and images that no face wears: a file may hold those of a hundred
/// buildings.
void drop_unused(Appearance& look) {
  const Appearance all = look;
  look.materials.clear(), look.images.clear();
  std::vector<int> number(all.materials.size(), -1);
  for (int& m : look.face_material) {
    if (m < 0) continue;
    int& fresh = number[static_cast<std::size_t>(m)];
    if (fresh < 0) {
      fresh = static_cast<int>(look.materials.size());
      look.materials.push_back(all.materials[static_cast<std::size_t>(m)]);
      int& image = look.materials.back().image;
      if (image >= 0)
        image = image_number(look.images, all.images[static_cast<std::size_t>(image)]);
    }
    m = fresh;
  }
  if (look.images.empty()) look.uvs.clear();
}

}  // namespace

Appearance look_of(const RawFile& raw, const std::vector<Face>& corners,
                   const std::vector<int>& polygon, const std::vector<int>& chosen) {
  Appearance look;
  look.materials = raw.materials;
  look.images = raw.images;
  for (const int t : chosen) {
    const Face& c = corners[static_cast<std::size_t>(t)];
    if (!raw.face_material.empty())
      look.face_material.push_back(raw.face_material[static_cast<std::size_t>(polygon[t])]);
    if (!raw.corner_uvs.empty())
      look.uvs.push_back({raw.corner_uvs[c[0]], raw.corner_uvs[c[1]], raw.corner_uvs[c[2]]});
    if (!raw.corner_colors.empty())
      look.colors.push_back(
          {raw.corner_colors[c[0]], raw.corner_colors[c[1]], raw.corner_colors[c[2]]});
  }
  drop_unused(look);
  return look;
}

}  // namespace colod::mesh_io
