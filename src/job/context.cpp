// Based on: own work.
// Differs: a source's own coarse tiles are taken where it has them: they were made from the
// photographs, and what is cut out of them has the same borders on all levels. Their images are
// brought down to the pixels that they are seen at.
#include "context.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

#include "core/error.h"
#include "scene/closing.h"
#include "scene/coarse_images.h"
#include "scene/context_chain.h"
#include "scene/lighter.h"
#include "scene/own_images.h"
#include "scene/skirts.h"

namespace colod {

namespace {

constexpr double kCell = 64;            // metres: bare ground comes in such squares
constexpr double kServing = 0.5;        // of the finest tiles: so many with coarser ones above them
constexpr double kFinest = 2048;        // pixels along a square of ground, at most
constexpr double kFlat = 0.05;          // metres: ground that nobody has seen needs no finer detail
constexpr double kStraight = 1e-3;      // metres: a corner that is off by less is none
constexpr double kRounding = 1.0 / 16;  // of a texel: such tiles fit their neighbours no better
constexpr double kOff = 0.25;           // of a texel: so far faces may be off, for pictures to stay
constexpr double kOffInPlan = 2;        // times that: a border between ground and a building
constexpr double kOffBelow = 2;         // times that: ground of which next to nothing is seen
constexpr double kDeeper = 2;           // times what a rim may move
constexpr std::size_t kChainImages = std::size_t{128} << 20;  // bytes of decoded images

using Pieces = std::vector<Territories::Piece>;

/// What of a plan buildings stand for, as exactly as tiles need it.
class BuiltPlan {
 public:
  explicit BuiltPlan(Territories all) : all_(std::move(all)), exact_(all_.coarser(kStraight)) {}

  const Territories& exact() const { return exact_; }

  /// With corners that may be off by `error`, in metres, or by half of that. Thread-safe.
  const Territories& within(double error) const {
    const double tolerance = std::exp2(std::floor(std::log2(error)));
    if (!(tolerance > kStraight)) return exact_;
    const std::lock_guard lock(mutex_);
    const auto known = coarse_.find(tolerance);
    return (known != coarse_.end() ? known
                                   : coarse_.emplace(tolerance, all_.coarser(tolerance)).first)
        ->second;
  }

 private:
  Territories all_, exact_;
  mutable std::mutex mutex_;
  mutable std::map<double, Territories> coarse_;
};

/// A scene, and what of its plan buildings stand for.
struct Around {
  std::shared_ptr<const PartedScene> scene;
  BuiltPlan built;
  ClosingGround ground;

  Around(const std::shared_ptr<const PartedScene>& whole, const std::vector<char>& is_unbuilt)
      : scene(whole),
        built(whole->territories.without(is_unbuilt)),
        ground(whole->map, whole->classes) {}
};
using Place = std::shared_ptr<const Around>;

std::string cause_of(const Error& e) { return std::string(e.what()).substr(e.item.size() + 2); }

/// By the rule of all tiles: from where on a pixel covers no less than a texel, nor than a share of
/// how far it is off.
double error_of(const ChainNode& node, const SceneOutput& output) {
  return output.target_sse * std::max(node.texel, node.deviation / output.pixel_error);
}

/// Per node of the tree: whether it lies below the finest ones, and is not asked for.
std::vector<char> too_fine(const SceneTiles& tiles) {
  const std::vector<TileNode>& nodes = tiles.tree().nodes;
  std::vector<char> is_end(nodes.size(), 0), is_below(nodes.size(), 0);
  for (const int i : tiles.finest()) is_end[static_cast<std::size_t>(i)] = 1;
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    const auto above = static_cast<std::size_t>(nodes[i].parent);
    is_below[i] = is_below[above] || (is_end[above] && !nodes[above].is_added);
  }
  return is_below;
}

/// Per node: whether finer ones are asked for and take its place.
std::vector<char> replaced(const std::vector<TileNode>& nodes,
                           const std::vector<char>& is_left_out) {
  std::vector<char> out(nodes.size(), 0);
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    const auto above = static_cast<std::size_t>(nodes[i].parent);
    if (!is_left_out[i] && !nodes[above].is_added) out[above] = 1;
  }
  return out;
}

/// Per node: whether something coarser that it replaces is shown from afar.
std::vector<char> with_coarser(const std::vector<TileNode>& nodes) {
  std::vector<char> out(nodes.size(), 0);
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    const auto above = static_cast<std::size_t>(nodes[i].parent);
    out[i] = out[above] || (!nodes[above].contents.empty() && !nodes[above].is_added);
  }
  return out;
}

/// Whether most of what is finest has something coarser that stands for it from afar.
bool has_own_chain(const SceneTiles& tiles) {
  const std::vector<char> is_served = with_coarser(tiles.tree().nodes);
  std::size_t served = 0;
  for (const int i : tiles.finest()) served += is_served[static_cast<std::size_t>(i)];
  return static_cast<double>(served) >= kServing * static_cast<double>(tiles.finest().size());
}

/// What of a tile is no building's, closed where it was cut, and as much lighter as `error` allows;
/// 0: as it is. Where a rim moves, what hangs from it hides what opens beside it.
Source beside_buildings(const Around& place, const Source& tile, double error) {
  const Territories& built = place.built.within(kOffInPlan * error);
  Source out = built.cut_out(tile, -1);
  const std::vector<char> is_joint = add_skirts(built, place.ground, out, kDeeper * error);
  return error > 0 ? lighter(out, is_joint, error) : out;
}

/// The ground below buildings. Where nothing else is lighter its rim stays where it is.
Source below_buildings(const Around& place, const Pieces& pieces, double error) {
  Source out = place.ground.below(pieces);
  const bool is_finest = error <= 0;
  std::vector<char> is_rim = on_border(out.mesh);
  const std::vector<char> is_joint =
      add_skirts(place.built.exact(), place.ground, out, kDeeper * error);
  is_rim.resize(is_joint.size(), 0);
  return lighter(out, is_finest ? is_rim : is_joint, is_finest ? kFlat : kOffBelow * error);
}

Vec2 middle_of(const Territories::Piece& piece) {
  return (piece.corners[0] + piece.corners[1] + piece.corners[2]) / 3;
}

/// Whose tile closes a piece of ground: that over its middle, or the nearest.
std::size_t tile_below(const SceneTiles& tiles, const Vec2& p) {
  std::size_t best = 0;
  double least = INFINITY;
  for (std::size_t i = 0; i < tiles.count(); ++i) {
    const Box& box = tiles.box(i);
    const Vec2 off = (box.min.head<2>() - p).cwiseMax(p - box.max.head<2>()).cwiseMax(0);
    if (off.norm() < least) least = off.norm(), best = i;
    if (least == 0) break;
  }
  return best;
}

/// Per node of the tree the pieces of the plan that its ground closes: those of the finest tile
/// over each, and of all coarser ones that such a tile replaces.
std::vector<Pieces> closed_by(const Around& place) {
  const SceneTiles& tiles = place.scene->tiles;
  const std::vector<TileNode>& nodes = tiles.tree().nodes;
  std::vector<Pieces> out(nodes.size());
  for (const Territories::Piece& piece : place.built.exact().pieces()) {
    int node = tiles.node(tile_below(tiles, middle_of(piece)));
    while (node >= 0) {
      const auto n = static_cast<std::size_t>(node);
      if (!nodes[n].contents.empty()) out[n].push_back(piece);
      node = nodes[n].parent;
      if (node >= 0 && nodes[static_cast<std::size_t>(node)].is_added) break;  // both are seen
    }
  }
  return out;
}

/// What a node shows beside the buildings, as light as `error` allows; what of it cannot be read is
/// among its warnings.
Source read_node(const Around& place, std::size_t i, const Pieces& closed, double error,
                 const ReadOptions& options) {
  const SceneTiles& tiles = place.scene->tiles;
  const TileNode& node = tiles.tree().nodes[i];
  std::vector<std::string> problems;
  std::vector<Source> parts;
  for (const std::string& content : node.contents) {
    try {
      const Source tile = read_tile(node, content, tiles.to_scene(), options);
      parts.push_back(beside_buildings(place, tile, error));
    } catch (const Error& e) {
      problems.push_back(content + ": " + cause_of(e));
    } catch (const std::exception& e) {  // a library gave up: this tile's problem only
      problems.push_back(content + ": cannot be read: " + e.what());
    }
  }
  parts.push_back(below_buildings(place, closed, error));
  Source whole = joined(parts);
  whole.warnings = std::move(problems);
  return whole;
}

/// A tree of nodes that is put together from several.
class Nodes {
 public:
  explicit Nodes(const SceneOutput& output) : output_(output) {}

  /// The scene's own tiles on all their levels, each with the ground that closes it. One that finer
  /// ones replace is seen while its error is no more than the pixels asked for: it needs neither a
  /// texel nor a face below that error's share of a pixel.
  void add_tree(const Place& place, const ReadOptions& options) {
    const std::vector<TileNode>& tree = place->scene->tiles.tree().nodes;
    const std::vector<char> is_left_out = too_fine(place->scene->tiles);
    const std::vector<char> is_replaced = replaced(tree, is_left_out);
    const std::vector<char> has_coarser = with_coarser(tree);
    const auto images = std::make_shared<const CoarseImages>(kChainImages);
    const auto closed = std::make_shared<const std::vector<Pieces>>(closed_by(*place));
    std::vector<int> number;
    for (std::size_t i = 0; i < tree.size(); ++i) {
      number.push_back(static_cast<int>(nodes_.size()));
      if (is_left_out[i]) continue;
      const int above = tree[i].parent;
      const double texel = is_replaced[i] ? tree[i].geometric_error / output_.target_sse : 0;
      nodes_.push_back({above < 0 ? -1 : number[static_cast<std::size_t>(above)],
                        tree[i].geometric_error, tree[i].is_added, kRounding * texel,
                        !has_coarser[i]});
      const bool is_farthest = !has_coarser[i];
      read_.push_back([place, options, images, closed, texel, is_farthest, i] {
        Source shown = read_node(*place, i, (*closed)[i], kOff * texel, options);
        if (texel > 0) images->give(shown, texel, is_farthest);
        return shown;
      });
    }
  }

  /// Coarser tiles above leaves; `read` gives what a leaf shows.
  void add_chain(const std::vector<ChainLeaf>& leaves,
                 const std::function<Source(std::size_t)>& read) {
    if (leaves.empty()) return;
    const auto chain = std::make_shared<const ContextChain>(leaves, kChainImages);
    std::vector<int> number;  // of a chain's node here
    for (std::size_t i = 0; i < chain->nodes().size(); ++i) {
      const ChainNode& node = chain->nodes()[i];
      number.push_back(static_cast<int>(nodes_.size()));
      const auto leaf = static_cast<std::size_t>(std::max(node.leaf, 0));
      if (node.leaf >= 0 && leaves[leaf].texel > 0) continue;  // no tile itself
      nodes_.push_back({node.parent < 0 ? -1 : number[static_cast<std::size_t>(node.parent)],
                        error_of(node, output_), false, 0, node.parent < 0});
      if (node.leaf >= 0)
        read_.push_back([read, leaf] { return read(leaf); });
      else
        read_.push_back([chain, i] { return chain->read(i); });
    }
  }

  std::shared_ptr<const Context> take(const std::shared_ptr<const PartedScene>& scene) {
    auto context = std::make_shared<Context>();
    context->nodes = std::move(nodes_);
    context->read = [read = std::move(read_)](std::size_t i) { return read[i](); };
    context->shown = [scene](const std::string& text) { return shown(scene->tiles.tree(), text); };
    return context;
  }

 private:
  const SceneOutput& output_;
  std::vector<Context::Node> nodes_;
  std::vector<std::function<Source()>> read_;
};

/// The finest tiles, each with the ground that closes it, and coarser ones of the program's own.
void add_own_chain(const Place& place, Nodes& nodes) {
  const SceneTiles& tiles = place->scene->tiles;
  const auto pieces = std::make_shared<std::vector<Pieces>>(tiles.count());
  for (const Territories::Piece& piece : place->built.exact().pieces())
    (*pieces)[tile_below(tiles, middle_of(piece))].push_back(piece);
  const auto show = [place, pieces](std::size_t i, const Source& tile) {
    return joined({beside_buildings(*place, tile, 0), below_buildings(*place, (*pieces)[i], 0)});
  };
  std::vector<ChainLeaf> leaves;
  for (std::size_t i = 0; i < pieces->size(); ++i) {
    const auto read = [place, show, i] {
      const std::shared_ptr<const Source> tile = place->scene->tiles.get(i);
      ChainPart part{show(i, *tile), {}, {}};
      part.is_joint = marked_as(part.source.mesh, tile->mesh, on_border(tile->mesh));
      return part;
    };
    leaves.push_back({tiles.box(i), read, 0});
  }
  const auto images = std::make_shared<const OwnImages>(kChainImages);
  nodes.add_chain(leaves, [place, show, images](std::size_t i) {
    Source lost;
    try {
      Source shown = show(i, *place->scene->tiles.get(i));
      if (place->scene->tiles.is_piece(i)) images->give(shown);
      return shown;
    } catch (const Error& e) {
      lost.warnings.push_back(e.what());
    }
    return lost;
  });
}

/// A square of the map, in cells, both ends included.
struct Square {
  int x0, y0, x1, y1;
};

/// Terrain alone, and what it looks like where it was seen.
ChainPart bare_part(const Around& place, const Square& s, const Box& box) {
  const PartedScene& scene = *place.scene;
  ChainPart part{place.ground.terrain(s.x0, s.y0, s.x1, s.y1), {}, {}};
  const Vec2 low = scene.map.middle(s.x0, s.y0), high = scene.map.middle(s.x1, s.y1);
  for (const Vec3& p : part.source.mesh.vertices)
    part.is_joint.push_back(p.x() == low.x() || p.y() == low.y() || p.x() == high.x() ||
                            p.y() == high.y());
  for (const std::size_t t : scene.tiles.over(box))
    part.painted.push_back(place.ground.bare(*scene.tiles.get(t)));
  return part;
}

/// No plants, no clutter: the terrain, closed below all that stands on it.
void add_bare_ground(const Place& place, Nodes& nodes) {
  const HeightMap& map = place->scene->map;
  const int cells = std::max(2, static_cast<int>(kCell / map.cell));
  std::vector<ChainLeaf> leaves;
  for (int y = 0; y + 1 < map.height; y += cells)
    for (int x = 0; x + 1 < map.width; x += cells) {
      const Square s{x, y, std::min(x + cells, map.width - 1), std::min(y + cells, map.height - 1)};
      Box box;
      for (const Vec2& p : {map.middle(s.x0, s.y0), map.middle(s.x1, s.y1)})
        box.extend(Vec3(p.x(), p.y(), 0));
      leaves.push_back({box, [place, s, box] { return bare_part(*place, s, box); },
                        box.size().maxCoeff() / kFinest});
    }
  nodes.add_chain(leaves, {});
}

}  // namespace

std::shared_ptr<const Context> context_of(const std::shared_ptr<const PartedScene>& scene,
                                          const std::vector<char>& is_unbuilt, ContextMode mode,
                                          const ReadOptions& options, const SceneOutput& output) {
  Nodes nodes(output);
  const Place place = std::make_shared<const Around>(scene, is_unbuilt);
  if (mode == ContextMode::kGround) {
    add_bare_ground(place, nodes);
  } else if (has_own_chain(scene->tiles)) {
    nodes.add_tree(place, options);
  } else {
    add_own_chain(place, nodes);
  }
  return nodes.take(scene);
}

}  // namespace colod
