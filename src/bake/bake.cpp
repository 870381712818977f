// Based on: texture atlases of planar charts; Gortler et al. (fill.cpp).
// Differs: facets are planar, so charts need no parametrization; each texel asks the source itself.
// Notation: q: a place on a chart, metres from its upper left corner; texels of the atlas are
// pixels.
#include "bake.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "blank.h"
#include "charts.h"
#include "core/error.h"
#include "core/flat.h"
#include "core/nearest.h"
#include "core/parallel.h"
#include "facet_colors.h"
#include "fill.h"
#include "image/look_sampler.h"
#include "owners.h"
#include "panes.h"
#include "parameters.h"
#include "probe.h"
#include "sight.h"
#include "smooth_normals.h"

namespace colod {

using namespace bake;
using namespace parameters::bake;

namespace {

constexpr int kSquare = 64;  // texels a side that one task draws
constexpr int kUnasked = -2;

/// How often texels were found in which way, and the sum of the light of those seen: the others
/// repeat the rim of what is.
struct Tally {
  std::int64_t seen = 0, nearest = 0, missing = 0;
  Eigen::Vector3d light = Eigen::Vector3d::Zero();

  std::int64_t found() const { return seen + nearest; }
  std::int64_t all() const { return seen + nearest + missing; }
  void add(const Tally& t) {
    seen += t.seen, nearest += t.nearest, missing += t.missing, light += t.light;
  }
};

/// A square of texels of a chart; windows are of the atlas.
struct Task {
  int chart;
  Window window;
};

void put(std::uint8_t* pixel, const Light& light) {
  for (int c = 0; c < 3; ++c) pixel[c] = to_srgb(light[c]);
}

/// A normal map's texel: x right, y up, z outward.
void put_normal(std::uint8_t* pixel, const Vec3& normal) {
  for (int c = 0; c < 3; ++c)
    pixel[c] = static_cast<std::uint8_t>(std::lround(127.5 * (normal[c] + 1)));
}

/// What a texel shows, or the sum of what its samples do.
struct Texel {
  Light light = Light::Zero();
  Vec3 normal = Vec3::Zero();  // the source's, not unit; zero: not asked for
};

/// Draws one layer's atlas. `normals` may be null: no normal map.
class Painter {
 public:
  Painter(const Mesh& source, const Probe& probe, const LookSampler& sampler,
          const SmoothNormals* normals, const ImageCache& cache, const PolygonMesh& mesh,
          const BakeOptions& options)
      : source_(source),
        probe_(probe),
        sampler_(sampler),
        normals_(normals),
        cache_(cache),
        mesh_(mesh),
        reach_(options.reach) {
    charts_ = find_charts(mesh);
    sights_.resize(charts_.size());
    parallel_for(charts_.size(), [&](std::size_t c) {
      sights_[c] = Sight(source_, probe_, charts_[c], reach_);
      charts_[c].is_blank = is_blank(mesh_, charts_[c], sights_[c]);
    });
    atlas_ = pack_charts(charts_, std::max(options.texel, sampler.texel()), options.largest);
    if (atlas_.width == 0)
      throw Error(Stage::kProcess, "texture",
                  std::to_string(charts_.size()) + " facets do not fit into " +
                      std::to_string(options.largest) + " texels: more --texture-size");
    const double ratio = atlas_.texel / std::max(sampler.texel(), 1e-9);
    // Images have mip levels, colours of faces have none: a sample shows one of them.
    const double covered = sampler.has_images() ? kMostTexels : 1;
    samples_ = ratio <= kOneSample
                   ? 1
                   : std::clamp(static_cast<int>(std::ceil(ratio / covered)), 2, kMostSamples);
  }

  BakedTexture paint() {
    BakedTexture out;
    out.image = Raster(atlas_.width, atlas_.height);
    is_known_.assign(out.image.rgb.size() / 3, 0);
    if (normals_) out.normals = flat_normals();
    const std::vector<Task> tasks = list_tasks();
    std::vector<Tally> tallies(tasks.size());
    parallel_for(tasks.size(), [&](std::size_t i) { draw(tasks[i], out, tallies[i]); });
    std::vector<Tally> of_chart(charts_.size());
    Tally total;
    for (std::size_t i = 0; i < tasks.size(); ++i) {
      of_chart[static_cast<std::size_t>(tasks[i].chart)].add(tallies[i]);
      total.add(tallies[i]);
    }
    count_blank(of_chart, total);
    fill(of_chart, total, out.image);
    out.facts = facts(of_chart, total);
    out.uvs = coordinates();
    return out;
  }

 private:
  Raster flat_normals() const {
    Raster flat(atlas_.width, atlas_.height);
    for (std::size_t i = 0; i < flat.rgb.size(); i += 3) put_normal(&flat.rgb[i], Vec3::UnitZ());
    return flat;
  }

  std::vector<Task> list_tasks() const {
    std::vector<Task> tasks;
    for (std::size_t c = 0; c < charts_.size(); ++c) {
      if (charts_[c].is_blank) continue;
      const PackedRect& r = atlas_.rects[c];
      for (int y = 0; y < r.height; y += kSquare)
        for (int x = 0; x < r.width; x += kSquare)
          tasks.push_back({static_cast<int>(c),
                           {r.x + x, r.y + y, std::min(kSquare, r.width - x),
                            std::min(kSquare, r.height - y)}});
    }
    return tasks;
  }

  /// As if blank charts had the texels that others have.
  void count_blank(std::vector<Tally>& of_chart, Tally& total) const {
    for (std::size_t c = 0; c < charts_.size(); ++c) {
      if (!charts_[c].is_blank) continue;
      of_chart[c].missing = std::llround(charts_[c].area / (atlas_.texel * atlas_.texel));
      total.add(of_chart[c]);
    }
  }

  /// The chart's triangles that come near a window, in texels.
  std::vector<Corners> triangles_near(const Task& task) const {
    const auto chart = static_cast<std::size_t>(task.chart);
    const Window& w = task.window;
    std::vector<Corners> near;
    for (const int t : charts_[chart].triangles) {
      Corners c;
      Vec2 least = Vec2::Constant(INFINITY), most = Vec2::Constant(-INFINITY);
      for (int k = 0; k < 3; ++k) {
        c.at[k] = place(chart, t, k);
        least = least.cwiseMin(c.at[k]), most = most.cwiseMax(c.at[k]);
      }
      c.orient();
      if (most.x() < w.x - kBorder || most.y() < w.y - kBorder ||
          least.x() > w.x + w.width + kBorder || least.y() > w.y + w.height + kBorder)
        continue;
      near.push_back(c);
    }
    return near;
  }

  /// A window while it is drawn.
  struct View {
    const Chart& chart;
    const PackedRect& rect;
    const Sight& sight;
    std::vector<Corners> triangles;  ///< of the chart, near the window
    SampleGrid grid;                 ///< all samples of the window
    std::vector<Sighting> sightings;
    Lens& lens;
    Probe::Holes holes;
    Panes panes;
    int together;  ///< samples along each side of a square that show one face beside them
    std::vector<int> faces_beside;  ///< of each such square; −1: none
    NearestInTurn nearest;
  };

  SampleGrid grid_of(const Task& task) const {
    const auto c = static_cast<std::size_t>(task.chart);
    const Window& w = task.window;
    const PackedRect& r = atlas_.rects[c];
    const double step = atlas_.texel / samples_;
    const Vec2 corner(w.x - r.x - kGutter, w.y - r.y - kGutter);
    return {atlas_.texel * corner + Vec2::Constant(0.5 * step), step, w.width * samples_,
            w.height * samples_};
  }

  static int together(const SampleGrid& grid, const Probe::Holes& holes) {
    return holes ? 1 : std::clamp(static_cast<int>(kTogether / grid.step), 1, kMostTogether);
  }

  void draw(const Task& task, BakedTexture& out, Tally& tally) {
    const Window& w = task.window;
    std::vector<Corners> triangles = triangles_near(task);
    if (triangles.empty()) return;
    const auto c = static_cast<std::size_t>(task.chart);
    Lens lens(cache_);
    const SampleGrid grid = grid_of(task);
    const Probe::Holes holes = holes_in(sampler_, lens);
    View view{charts_[c],
              atlas_.rects[c],
              sights_[c],
              std::move(triangles),
              grid,
              sights_[c].look(grid, holes),
              lens,
              holes,
              Panes(sights_[c], grid, sampler_, lens),
              together(grid, holes),
              {},
              probe_.in_turn()};
    if (view.together > 1) view.faces_beside.assign(view.sightings.size(), kUnasked);
    const std::vector<Owner> owners_of = owners(w, view.triangles);
    for (int y = 0; y < w.height; ++y)
      for (int x = 0; x < w.width; ++x) {
        const Owner& own = owners_of[static_cast<std::size_t>(y) * w.width + x];
        if (own.triangle < 0) continue;
        Texel texel;
        const Finding how = look(view, w, x, y, own, texel);
        if (how != Finding::kNone) {
          put(out.image.at(w.x + x, w.y + y), texel.light);
          is_known_[static_cast<std::size_t>(w.y + y) * out.image.width + w.x + x] = 1;
          if (normals_)
            put_normal(out.normals.at(w.x + x, w.y + y), view.chart.turned(texel.normal));
        }
        if (own.distance > 0) continue;
        (how == Finding::kSeen      ? tally.seen
         : how == Finding::kNearest ? tally.nearest
                                    : tally.missing) += 1;
        if (how == Finding::kSeen) tally.light += texel.light.cast<double>();
      }
  }

  /// The mean of a texel's samples; each lies on the chart.
  Finding look(View& view, const Window& w, int x, int y, const Owner& own, Texel& mean) const {
    const Corners& nearest = view.triangles[static_cast<std::size_t>(own.triangle)];
    if (samples_ == 1 && own.distance <= 0) return sighted(view, x, y, mean);
    int found = 0, seen = 0;
    for (int j = 0; j < samples_; ++j)
      for (int i = 0; i < samples_; ++i) {
        const Vec2 at = Vec2(w.x + x, w.y + y) + Vec2(i + 0.5, j + 0.5) / samples_;
        const Finding how = is_on_chart(view, at, own)
                                ? sighted(view, x * samples_ + i, y * samples_ + j, mean)
                                : sought(view, nearest.nearest(at), mean);
        found += how != Finding::kNone, seen += how == Finding::kSeen;
      }
    if (found == 0) return Finding::kNone;
    mean.light /= static_cast<float>(found);
    return 2 * seen >= found ? Finding::kSeen : Finding::kNearest;
  }

  /// Whether a sample of a texel lies on one of the triangles; a single one lies in its middle.
  bool is_on_chart(const View& view, const Vec2& at, const Owner& own) const {
    if (samples_ == 1) return own.distance <= 0;
    return view.triangles[static_cast<std::size_t>(own.triangle)].holds(at) ||
           std::any_of(view.triangles.begin(), view.triangles.end(),
                       [&](const Corners& t) { return t.holds(at); });
  }

  /// Adds what a sample of the window's grid shows.
  Finding sighted(View& view, int x, int y, Texel& sum) const {
    const int face = view.sightings[view.grid.index(x, y)].face;
    if (face >= 0) return show(view, face, view.panes.of(face).weight(Vec2(x, y)), sum);
    const Vec2 q = view.grid.at(x, y);
    if (!view.sight.may_be_near(q)) return Finding::kNone;
    if (view.together > 1) return beside(view, x, y, sum);
    return show(view, found_beside(view, q), sum);
  }

  /// Samples that lie together show the same face beside them, each its own place of it.
  Finding beside(View& view, int x, int y, Texel& sum) const {
    const int n = view.together, columns = (view.grid.columns + n - 1) / n;
    int& face = view.faces_beside[static_cast<std::size_t>(y / n) * columns + x / n];
    if (face == kUnasked)
      face = found_beside(view, view.grid.at(x / n * n + n / 2, y / n * n + n / 2)).face;
    if (face < 0) return Finding::kNone;
    const Face& corners = source_.faces[static_cast<std::size_t>(face)];
    show(view, face, nearest_weights(source_, corners, view.chart.lift(view.grid.at(x, y))), sum);
    return Finding::kNearest;
  }

  Found found_beside(View& view, const Vec2& q) const {
    return probe_.beside(view.chart.lift(q), view.chart.normal, reach_, view.holes, view.nearest);
  }

  /// Adds what a place between the samples shows; in texels of the atlas.
  Finding sought(View& view, const Vec2& at, Texel& sum) const {
    const Vec2 begin(view.rect.x + kGutter, view.rect.y + kGutter);
    const Vec2 q = (at - begin) * atlas_.texel;
    const Vec2 on_grid = (q - view.grid.begin) / view.grid.step;
    const int face = view.holes ? -1 : view.panes.about(on_grid, view.sightings, reach_);
    if (face >= 0) return show(view, face, view.panes.of(face).weight(on_grid), sum);
    return show(view, probe_.find(view.chart.lift(q), view.chart.normal, reach_, view.holes), sum);
  }

  /// Adds what a face shows at a place along the normal, by the weights of its corners.
  Finding show(View& view, int face, const Vec3& weight, Texel& sum) const {
    sum.light += view.panes.of(face).look.at(weight);
    if (normals_) {
      const Face& f = source_.faces[static_cast<std::size_t>(face)];
      sum.normal += normals_->at(face, weight[0] * source_.vertices[f[0]] +
                                           weight[1] * source_.vertices[f[1]] +
                                           weight[2] * source_.vertices[f[2]]);
    }
    return Finding::kSeen;
  }

  Finding show(View& view, const Found& found, Texel& sum) const {
    if (found.how == Finding::kNone) return found.how;
    sum.light += sampler_.sample(found.face, found.point, view.grid.step, view.lens);
    if (normals_) sum.normal += normals_->at(found.face, found.point);
    return found.how;
  }

  static bool is_hardly_seen(const Tally& t) {
    return static_cast<double>(t.found()) < kLeastSeen * static_cast<double>(t.all());
  }

  static Light mean_of(const Tally& t, const Light& otherwise) {
    return t.seen > 0 ? Light((t.light / static_cast<double>(t.seen)).cast<float>()) : otherwise;
  }

  /// The mean of walls for walls, of the rest for the rest; of all where hardly any is seen.
  std::array<Light, 2> means(const std::vector<Tally>& of_chart, const Light& mean) const {
    std::array<Tally, 2> of_kind;
    for (std::size_t c = 0; c < charts_.size(); ++c) of_kind[is_wall(c)].add(of_chart[c]);
    std::array<Light, 2> out;
    for (std::size_t k = 0; k < 2; ++k)
      out[k] = is_hardly_seen(of_kind[k]) ? mean : mean_of(of_kind[k], mean);
    return out;
  }

  bool is_wall(std::size_t chart) const { return std::abs(charts_[chart].normal.z()) < kUpright; }

  /// What a chart that nobody saw lies against, whichever way that faces: a riser between two parts
  /// of a roof looks like the roof. Nothing unless the source is near to half of the chart.
  std::optional<Light> light_about(const Chart& chart) const {
    NearestInTurn nearest = probe_.in_turn();
    Lens lens(cache_);
    Light sum = Light::Zero();
    int asked = 0, found = 0;
    for (const int t : chart.triangles)
      for (int i = 0; i < kParts; ++i)
        for (int j = 0; i + j < kParts; ++j) {
          const double u = (i + 1 / 3.) / kParts, v = (j + 1 / 3.) / kParts;
          const auto corner = [&](int k) { return mesh_.vertices[mesh_.triangles[t][k]]; };
          const NearestPoint near =
              nearest((1 - u - v) * corner(0) + u * corner(1) + v * corner(2), kNearest);
          ++asked;
          if (near.triangle < 0) continue;
          ++found;
          sum += sampler_.sample(near.triangle, near.point, atlas_.texel, lens);
        }
    if (found == 0 || 2 * found < asked) return {};
    return Light(sum / static_cast<float>(found));
  }

  /// What is far from all that is seen has its chart's mean, or the building's. What little is
  /// known of a chart is no picture of it.
  void fill(const std::vector<Tally>& of_chart, const Tally& total, Raster& image) {
    const Light mean = mean_of(total, Light::Constant(0.5f));
    const std::array<Light, 2> of_kind = means(of_chart, mean);
    parallel_for(charts_.size(), [&](std::size_t c) {
      const PackedRect& r = atlas_.rects[c];
      const bool is_told = !is_hardly_seen(of_chart[c]);
      const Window w{r.x, r.y, r.width, r.height};
      if (is_told)
        push_pull(image, is_known_, w, kCarried / atlas_.texel,
                  mean_of(of_chart[c], of_kind[is_wall(c)]));
      else
        fill_evenly(image, w, light_about(charts_[c]).value_or(of_kind[is_wall(c)]));
    });
    std::vector<std::uint8_t> is_taken(is_known_.size(), 0);
    for (const PackedRect& r : atlas_.rects)
      for (int y = r.y; y < r.y + r.height; ++y)
        std::fill_n(&is_taken[static_cast<std::size_t>(y) * atlas_.width + r.x], r.width, 1);
    for (std::size_t i = 0; i < is_taken.size(); ++i)
      if (!is_taken[i]) put(&image.rgb[3 * i], mean);
  }

  BakeFacts facts(const std::vector<Tally>& of_chart, const Tally& total) const {
    BakeFacts f{atlas_.width, atlas_.height, atlas_.texel, static_cast<int>(charts_.size())};
    Tally kept;
    std::int64_t unseen = 0;
    for (const Tally& t : of_chart)
      if (is_hardly_seen(t))
        unseen += t.all();
      else
        kept.add(t);
    const double all = static_cast<double>(std::max<std::int64_t>(1, total.all()));
    f.seen = static_cast<double>(kept.seen) / all;
    f.nearest = static_cast<double>(kept.nearest) / all;
    f.filled = static_cast<double>(kept.missing) / all;
    f.unseen = static_cast<double>(unseen) / all;
    return f;
  }

  /// Of a triangle's corner, in texels.
  Vec2 place(std::size_t chart, int triangle, int corner) const {
    const Chart& c = charts_[chart];
    return atlas_.place(c, chart, c.flat(mesh_.vertices[mesh_.triangles[triangle][corner]]));
  }

  std::vector<std::array<Vec2f, 3>> coordinates() const {
    std::vector<std::array<Vec2f, 3>> uvs(mesh_.triangles.size());
    const Vec2 size(atlas_.width, atlas_.height);
    for (std::size_t c = 0; c < charts_.size(); ++c)
      for (const int t : charts_[c].triangles)
        for (int k = 0; k < 3; ++k)
          uvs[static_cast<std::size_t>(t)][k] = place(c, t, k).cwiseQuotient(size).cast<float>();
    return uvs;
  }

  const Mesh& source_;
  const Probe& probe_;
  const LookSampler& sampler_;
  const SmoothNormals* normals_;
  const ImageCache& cache_;
  const PolygonMesh& mesh_;
  double reach_;
  int samples_ = 1;  // along each side of a texel
  std::vector<Chart> charts_;
  std::vector<Sight> sights_;  // per chart
  Atlas atlas_;
  std::vector<std::uint8_t> is_known_;  // per texel: a sample gave it a colour
};

}  // namespace

struct Baker::Impl {
  LookSampler sampler;
  Probe probe;
  const ImageCache& cache;
  const Mesh& mesh;

  Impl(const Mesh& source, const Appearance& look, const ImageCache& images, Sides sides)
      : sampler(source, look, images), probe(source, sides), cache(images), mesh(source) {}
};

Baker::Baker(const Mesh& source, const Appearance& look, const ImageCache& cache, Sides sides)
    : impl_(std::make_unique<Impl>(source, look, cache, sides)) {}
Baker::~Baker() = default;

bool Baker::has_detail() const { return impl_->sampler.has_detail(); }
const std::vector<std::string>& Baker::warnings() const { return impl_->sampler.warnings(); }
const std::vector<std::string>& Baker::losses() const { return impl_->sampler.losses(); }
double Baker::source_texel() const { return impl_->sampler.texel(); }

BakedTexture Baker::bake(const PolygonMesh& mesh, const BakeOptions& options) const {
  std::optional<SmoothNormals> normals;
  if (options.has_normals) normals.emplace(impl_->mesh);
  return Painter(impl_->mesh, impl_->probe, impl_->sampler, normals ? &*normals : nullptr,
                 impl_->cache, mesh, options)
      .paint();
}

std::vector<Rgb> Baker::facet_colors(const PolygonMesh& mesh, double reach) const {
  return colors_of_facets(mesh, {impl_->probe, impl_->sampler, impl_->cache, reach});
}

}  // namespace colod
