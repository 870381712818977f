// Any soup of triangles on a small grid, which makes every kind of contact and degeneracy likely,
// through `planes` to `extraction` but the co-analysis: a watertight mesh of all planes, or an
// Error.
//   fuzz_build CORPUS -max_len=512 -timeout=60   the first byte turns the grid and chooses options
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <numeric>

#include "extraction/extraction.h"
#include "measure/metrics.h"
#include "pipeline/pipeline.h"

using namespace colod;

namespace {

/// Three bytes a vertex, metres of 0 to 15; three vertices a face.
Mesh soup(const std::uint8_t* data, std::size_t size, double angle) {
  Mesh mesh;
  for (; size >= 9; data += 9, size -= 9) {
    Face face;
    for (int i = 0; i < 3; ++i) {
      const double x = data[3 * i] % 16, y = data[3 * i + 1] % 16, z = data[3 * i + 2] % 16;
      face[i] = static_cast<int>(mesh.vertices.size());
      mesh.vertices.emplace_back(std::cos(angle) * x - std::sin(angle) * y,
                                 std::sin(angle) * x + std::cos(angle) * y, z);
    }
    mesh.faces.push_back(face);
  }
  return mesh;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 10) return 0;
  Source source;
  source.name = "soup";
  source.mesh = soup(data + 1, size - 1, (data[0] % 8) * 0.1);
  Options options;
  options.rules = data[0] & 8 ? RuleSet::none() : RuleSet::all();
  options.visibility = data[0] & 16 ? Visibility::kSweep : Visibility::kEmbree;
  options.ns = 8, options.nr = 8, options.min_points = 1;
  const Building b = segment_building({std::move(source), 0, {}}, options);
  if (!b.failure.empty()) return 0;
  std::vector<int> planes(b.planes.planes.size());
  std::iota(planes.begin(), planes.end(), 0);
  Sight sight(b.planes);
  try {
    const Extraction result =
        extract_layer(b.planes, planes, sight,
                      {.rules = options.rules,
                       .nr = 8,
                       .tolerance = options.rules.is_all() && data[0] & 32 ? 0.2 : 0});
    if (!check_validity(result.mesh.mesh()).is_watertight) std::abort();
  } catch (const Error&) {
  }
  return 0;
}
