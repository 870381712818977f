// Draws what a viewer sees at each switch: a layer beside the finest one at the GSD where it may
// stand, as many pixels as there would be, each drawn as a square of several.
//   bench_switches OUT -o sheet.png     OUT: a folder of `colod build --format obj`
#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/rays.h"
#include "measure/switching_views.h"
#include "picture/picture.h"
#include "read/read.h"

using namespace colod;

namespace {

constexpr int kSamples = 8;  // along a pixel's side
constexpr std::array kElevations_deg{8.0, 30.0, 60.0};

/// Each pixel as a square of `scale`.
Image enlarged(const GreyPicture& grey, int scale) {
  Image out{grey.width * scale, grey.height * scale, {}};
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x)
      out.rgb.insert(out.rgb.end(), 3,
                     static_cast<std::uint8_t>(
                         std::lround(255 * grey.luminance[y / scale * grey.width + x / scale])));
  return out;
}

struct Sheet {
  std::vector<Image> images;
  std::vector<std::string> captions;
};

/// One row: layer and finest from three sides.
void add_pairs(Sheet& sheet, const Mesh& coarse, const Mesh& finest, double gsd, int scale,
               const std::string& caption) {
  Box box = bounding_box(coarse.vertices);
  box.extend(bounding_box(finest.vertices));
  const std::vector<Vec3> directions = ring_directions(18, kElevations_deg);
  for (const int d : {1, 7, 15}) {
    const FarView view = far_view(box, directions[d], gsd / kSamples);
    const GreyPicture a = FarPicture(coarse, view).at(kSamples);
    const GreyPicture b = FarPicture(finest, view).at(kSamples);
    const PictureDifference difference = compare_pictures(a, b);
    char text[80];
    std::snprintf(text, sizeof text, "piece %.1f outline %.1f", difference.piece,
                  difference.outline);
    sheet.images.push_back(enlarged(a, scale));
    sheet.captions.push_back(caption);
    sheet.images.push_back(enlarged(b, scale));
    sheet.captions.push_back(text);
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Pictures at each switch");
  std::string folder, out = "switches.png";
  int scale = 3;
  std::size_t most = 8;
  app.add_option("OUT", folder, "what colod build --format obj wrote")->required();
  app.add_option("-o,--out", out, "picture to write");
  app.add_option("--scale", scale, "side of a pixel in the sheet");
  app.add_option("--most", most, "buildings to draw");
  bool is_own = false;
  app.add_flag("--own", is_own, "at each building's own gsd instead of the one in force");
  CLI11_PARSE(app, argc, argv);
  nlohmann::json report;
  std::ifstream(folder + "/report.json") >> report;
  Sheet sheet;
  for (const auto& b : report["buildings"]) {
    if (most-- == 0) break;
    const std::string stem = folder + "/buildings/" + b["name"].get<std::string>() + ".layer";
    const auto& layers = b["layers"];
    const Mesh finest = read_single(stem + std::to_string(layers.size() - 1) + ".obj", {}).mesh;
    for (std::size_t k = 0; k + 1 < layers.size(); ++k) {
      if (layers[k]["like_finer"]) continue;
      const double gsd = layers[k][is_own ? "own_gsd" : "gsd"];
      char caption[120];
      std::snprintf(caption, sizeof caption, "%s layer %zu %.2f m/px",
                    b["name"].get<std::string>().c_str(), k, gsd);
      add_pairs(sheet, read_single(stem + std::to_string(k) + ".obj", {}).mesh, finest, gsd, scale,
                caption);
    }
  }
  std::ofstream(out, std::ios::binary)
      << encode_png(contact_sheet(sheet.images, sheet.captions, 6));
}
