#include <filesystem>
#include <memory>

#include "bake/bake.h"
#include "cli.h"
#include "core/parallel.h"
#include "exporters/files.h"
#include "image/look_sampler.h"
#include "input_options.h"
#include "log.h"
#include "numbers.h"
#include "picture/picture.h"
#include "read/frame.h"

namespace colod::cli {
namespace {

struct PreviewArguments {
  std::vector<std::string> files;
  std::string out;
  ReadOptions read;
  PreviewOptions preview;
  int columns = 4, threads = 0;
  double memory = 512;  // MiB
  bool is_plain = false;
};

/// Textured where it has textures or colours of its own.
Image render(const Source& source, const PreviewArguments& a, const PreviewOptions& options) {
  if (!source.is_mesh() && (a.is_plain || source.look.colors.empty()))
    return render_preview(source.cloud, options);
  if (!source.is_mesh()) {
    const Splats splats = splat_points(source.cloud, source.look.colors);
    return render_preview(splats.mesh, LookSampler(splats.mesh, splats.look, ImageCache(0)),
                          options);
  }
  if (a.is_plain || !source.look.has_detail()) return render_preview(source.mesh, options);
  const ImageCache images(static_cast<std::size_t>(a.memory * (1 << 20)));
  const LookSampler look(source.mesh, source.look, images);
  for (const std::vector<std::string>* lines : {&look.losses(), &look.warnings()})
    for (const std::string& line : *lines)
      Log(false, false).message({Level::kWarning, source.name + ": " + line});
  return render_preview(source.mesh, look, options);
}

/// Meshes of one row share the camera, so that they can be compared.
int preview(const PreviewArguments& a) {
  limit_threads(a.threads);
  std::vector<Image> images;
  std::vector<std::string> captions;
  for (std::size_t row = 0; row < a.files.size(); row += a.columns) {
    const std::size_t end = std::min(a.files.size(), row + a.columns);
    std::vector<Source> sources;
    PreviewOptions options = a.preview;
    for (std::size_t i = row; i < end; ++i) {
      sources.push_back(read_single(a.files[i], a.read));
      const Source& s = sources.back();
      if (i == row) options.box = bounding_box(s.is_mesh() ? s.mesh.vertices : s.cloud.points);
    }
    for (const Source& s : sources) {
      images.push_back(render(s, a, options));
      const std::string size = s.is_mesh() ? std::to_string(s.mesh.faces.size()) + " faces"
                                           : std::to_string(s.cloud.points.size()) + " points";
      captions.push_back(std::filesystem::path(s.path).stem().string() + ", " + size);
    }
  }
  const std::filesystem::path out(a.out);
  const std::string folder = out.has_parent_path() ? out.parent_path().string() : ".";
  write_file(folder,
             {out.filename().string(), encode_png(contact_sheet(images, captions, a.columns))});
  return 0;
}

}  // namespace

Run add_preview(CLI::App& app) {
  auto a = std::make_shared<PreviewArguments>();
  app.add_option("FILE", a->files, "meshes or points; each row has the camera of its first")
      ->required();
  app.add_option("-o,--out", a->out, "PNG to write")->required();
  add_input_options(app, a->read);
  app.add_option("--columns", a->columns, "pictures a row, default 4")
      ->check(number_between(1, 100));
  app.add_option("--width", a->preview.width, "of a picture")->check(number_between(16, 8192));
  app.add_option("--height", a->preview.height, "of a picture")->check(number_between(16, 8192));
  app.add_option("--azimuth", a->preview.azimuth_deg,
                 "where the camera stands [deg], 0 = south of the building")
      ->check(number_between(-360.0, 360.0));
  app.add_option("--elevation", a->preview.elevation_deg, "of the camera [deg]")
      ->check(number_between(-90.0, 90.0));
  app.add_flag("--plain", a->is_plain, "shaded shapes, also of what has textures or colours");
  app.add_option("--texture-memory", a->memory,
                 "MiB that decoded images may take together, default 512; an image that takes more "
                 "is left out")
      ->check(number_between(1.0, 1e6));
  app.add_option("--threads", a->threads, "threads to use, 0 = all cores")
      ->check(number_between(0, 4096));
  return [a] { return preview(*a); };
}

}  // namespace colod::cli
