// Based on: own work.
// Differs: bounding volumes of tilesets are not asked: writers get them wrong.
#include "tiles.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <list>
#include <map>
#include <mutex>

#include "cloud_surface.h"
#include "core/error.h"
#include "core/parallel.h"
#include "parameters.h"
#include "pieces.h"

namespace colod {

namespace {

constexpr std::size_t kRoom = std::size_t{256} << 20;  // bytes of tiles that are kept
constexpr double kLeaning = 2;  // times what faces up, that faces another way, before it is turned
constexpr double kOneSided = 0.2;  // of a surface: a closed body faces all ways alike

std::size_t bytes_of(const Source& s) {
  return s.mesh.vertices.size() * sizeof(Vec3) + s.mesh.faces.size() * sizeof(Face) +
         s.look.face_material.size() * sizeof(int) +
         s.look.uvs.size() * sizeof(std::array<Vec2f, 3>) +
         s.look.colors.size() * sizeof(std::array<Rgb, 3>);
}

/// What is learnt of a tile when it is read for the first time.
struct Facts {
  Box box;
  Vec3 facing = Vec3::Zero();  // area times normal, of all faces
  double area = 0;
  std::size_t faces = 0;
  std::string problem;
};

Facts facts_of(const Source& s) {
  Facts facts;
  facts.box = bounding_box(s.mesh.vertices);
  facts.faces = s.mesh.faces.size();
  for (const Face& f : s.mesh.faces) {
    const Vec3 cross = 0.5 * face_cross(s.mesh, f);
    facts.facing += cross;
    facts.area += cross.norm();
  }
  return facts;
}

/// Where most tiles lie; of two the one nearer to the frame's origin.
Vec3 middle_of(const std::vector<Facts>& facts) {
  Vec3 middle = Vec3::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> all;
    for (const Facts& f : facts)
      if (f.faces > 0) all.push_back(f.box.center()[axis]);
    if (all.empty()) return middle;
    const auto at = all.begin() + static_cast<long>((all.size() - 1) / 2);
    std::nth_element(all.begin(), at, all.end(),
                     [](double a, double b) { return std::abs(a) < std::abs(b); });
    middle[axis] = *at;
  }
  return middle;
}

/// One wrong vertex or transform would stretch the map of a whole place beyond all use.
void drop_strays(std::vector<Facts>& facts) {
  const auto drop = [](Facts& f, double reach, const std::string& what) {
    char text[160];
    std::snprintf(text, sizeof text,
                  "%s %.3g km: a transform or a vertex of it is wrong; the tile is left out",
                  what.c_str(), reach / 1000);
    f.problem = text, f.faces = 0;
  };
  for (Facts& f : facts)
    if (const double size = f.box.size().maxCoeff();
        f.faces > 0 && size > parameters::survey::kFarthestTile)
      drop(f, size, "reaches over");
  const Vec3 middle = middle_of(facts);
  for (Facts& f : facts) {
    if (f.faces == 0) continue;
    const double off = (f.box.center() - middle).cwiseAbs().maxCoeff();
    if (off > parameters::survey::kFarthestTile) drop(f, off, "lies apart from most tiles by");
  }
}

using Matrix = Eigen::Matrix4d;

/// Quarter turns that make what faces +y, or −y, face up.
Matrix upright(bool is_y_up) {
  Matrix turn = Matrix::Identity();
  turn.topLeftCorner<3, 3>() << 1, 0, 0, 0, 0, is_y_up ? -1 : 1, 0, is_y_up ? 1 : -1, 0;
  return turn;
}

Box turned(const Box& box, const Matrix& turn) {
  Box out;
  if (box.is_empty()) return out;
  out.extend(Vec3((turn * box.min.homogeneous()).head<3>()));
  out.extend(Vec3((turn * box.max.homogeneous()).head<3>()));
  return out;
}

}  // namespace

struct SceneTiles::Impl {
  struct Tile {
    int node;
    std::string content;
    Box box;
    long piece = -1;  // of `pieces`; −1: the whole content
  };
  struct Kept {
    std::shared_ptr<const Source> source;
    std::list<std::size_t>::iterator place;
  };
  TileTree tree;
  std::shared_ptr<const HeightMap> surface;
  Matrix to_scene = Matrix::Identity();
  ReadOptions options;
  Matrix turn = Matrix::Identity();  // of pieces, which were cut before it was known
  std::unique_ptr<Pieces> pieces;    // null: no tile is too large
  std::vector<Tile> tiles;
  std::vector<int> finest;
  Box box;
  std::size_t faces = 0;
  std::vector<ReadFailure> failures;
  std::vector<std::string> warnings;
  mutable std::mutex mutex;
  mutable std::map<std::size_t, Kept> kept;
  mutable std::list<std::size_t> used;  // last used first
  mutable std::size_t bytes = 0;

  void look_through(int coarser, bool may_turn);
  void set_upright(std::vector<Facts>& facts, bool may_turn);
  Source read(std::size_t i) const {
    const Tile& tile = tiles[i];
    if (surface) return surface_tile(*surface, tile.node - 1);
    if (tile.piece >= 0) return read_piece(static_cast<std::size_t>(tile.piece));
    return read_tile(tree.nodes[static_cast<std::size_t>(tile.node)], tile.content, to_scene,
                     options);
  }
  Source read_piece(std::size_t piece) const {
    Source source = pieces->get(piece);
    if (!turn.isIdentity(0))
      for (Vec3& p : source.mesh.vertices) p = (turn * p.homogeneous()).head<3>();
    return source;
  }
  std::vector<Tile> cut(const Tile& tile, const Source& source);
  std::shared_ptr<const Source> find(std::size_t i) const;
  void keep(std::size_t i, const std::shared_ptr<const Source>& source) const;
};

void SceneTiles::Impl::look_through(int coarser, bool may_turn) {
  finest = finest_nodes(tree, coarser);
  for (const int node : finest)
    for (const std::string& content : tree.nodes[static_cast<std::size_t>(node)].contents)
      tiles.push_back({node, content, {}});
  if (!tree.is_tileset && !surface) pieces = std::make_unique<Pieces>();
  std::vector<Facts> facts(tiles.size());
  std::vector<std::vector<Tile>> parts(tiles.size());
  std::vector<std::vector<std::string>> said(tiles.size());
  parallel_for(tiles.size(), [&](std::size_t i) {
    try {
      const Source source = read(i);
      facts[i] = facts_of(source);
      said[i] = source.warnings;
      if (source.mesh.faces.empty() && !said[i].empty())  // all of them had to be left out
        facts[i].problem = said[i].back(), said[i].pop_back();
      if (pieces && facts[i].faces > parameters::context::kMostFaces)
        parts[i] = cut(tiles[i], source);
    } catch (const Error& e) {
      facts[i].problem = std::string(e.what()).substr(e.item.size() + 2);
    } catch (const std::exception& e) {  // a library gave up: this tile's problem only
      facts[i].problem = std::string("cannot be read: ") + e.what();
    }
  });
  drop_strays(facts);
  set_upright(facts, may_turn);
  std::map<std::string, std::pair<std::size_t, std::string>> by_text;  // how often, first tile
  std::vector<Tile> good;
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    if (!facts[i].problem.empty())
      failures.push_back({shown(tree, tiles[i].content), shown(tree, facts[i].problem)});
    for (const std::string& text : said[i]) {
      auto& [count, first] = by_text[text];
      if (count++ == 0) first = tiles[i].content;
    }
    if (facts[i].faces == 0) continue;
    tiles[i].box = facts[i].box;
    box.extend(facts[i].box);
    faces += facts[i].faces;
    for (Tile& part : parts[i]) {
      part.box = turned(part.box, turn);
      good.push_back(std::move(part));
    }
    if (parts[i].empty()) good.push_back(std::move(tiles[i]));
  }
  tiles = std::move(good);
  for (const auto& [text, where] : by_text)
    warnings.push_back(
        shown(tree, where.second + ": " + text) +
        (where.first > 1 ? " (and " + std::to_string(where.first - 1) + " more tiles)" : ""));
}

/// What no client draws at once becomes several tiles, whose borders are alike.
std::vector<SceneTiles::Impl::Tile> SceneTiles::Impl::cut(const Tile& tile, const Source& source) {
  std::vector<Tile> out;
  for (const std::size_t piece : pieces->cut(source, parameters::context::kMostFaces))
    out.push_back({tile.node, tile.content, pieces->box(piece), static_cast<long>(piece)});
  return out;
}

void SceneTiles::Impl::set_upright(std::vector<Facts>& facts, bool may_turn) {
  Vec3 facing = Vec3::Zero();
  double area = 0;
  for (const Facts& f : facts) facing += f.facing, area += f.area;
  const bool is_aside = std::abs(facing.y()) > kLeaning * std::abs(facing.z()) &&
                        std::abs(facing.y()) > kOneSided * area;
  const bool is_told = options.up == Up::kY || options.up == Up::kZ;
  const bool is_other = tree.is_tileset ? options.up == Up::kZ : options.up == Up::kY;
  if (is_aside && !may_turn)
    warnings.push_back(tree.path +
                       ": most of its surface faces sideways where its tileset puts it on Earth: "
                       "its transform may be wrong");
  if (!may_turn || (is_told ? !is_other : !is_aside)) return;
  const bool is_y_up = is_told ? !tree.is_tileset : facing.y() > 0;
  turn = upright(is_y_up);
  to_scene = turn * to_scene;
  for (Facts& f : facts) f.box = turned(f.box, turn);
  if (!is_told)
    warnings.push_back(
        tree.path + ": turned: most of its surface faces " +
        (is_y_up ? "+y" : "-y, as where z up content is read as glTF, which is y up") + "; --up " +
        (tree.is_tileset ? "y" : "z") + " reads it as it stands");
}

std::shared_ptr<const Source> SceneTiles::Impl::find(std::size_t i) const {
  const std::lock_guard lock(mutex);
  const auto found = kept.find(i);
  if (found == kept.end()) return nullptr;
  used.splice(used.begin(), used, found->second.place);
  return found->second.source;
}

void SceneTiles::Impl::keep(std::size_t i, const std::shared_ptr<const Source>& source) const {
  const std::lock_guard lock(mutex);
  if (kept.contains(i)) return;
  used.push_front(i);
  kept[i] = {source, used.begin()};
  bytes += bytes_of(*source);
  while (bytes > kRoom && used.size() > 1) {
    bytes -= bytes_of(*kept[used.back()].source);
    kept.erase(used.back());
    used.pop_back();
  }
}

SceneTiles::SceneTiles(TileTree tree, const Matrix& to_scene, int coarser, bool may_turn,
                       const ReadOptions& options)
    : impl_(std::make_unique<Impl>()) {
  impl_->tree = std::move(tree);
  impl_->to_scene = to_scene;
  impl_->options = options;
  impl_->failures = impl_->tree.failures;
  impl_->warnings = impl_->tree.warnings;
  impl_->look_through(coarser, may_turn);
}

SceneTiles::SceneTiles(const std::string& path, std::shared_ptr<const HeightMap> surface)
    : impl_(std::make_unique<Impl>()) {
  TileTree& tree = impl_->tree;
  tree.path = path;
  tree.nodes.emplace_back();
  tree.nodes[0].is_added = true;
  for (int i = 0; i < tile_count(*surface); ++i) {
    tree.nodes[0].children.push_back(i + 1);
    TileNode& node = tree.nodes.emplace_back();
    node.contents = {path};
    node.parent = 0;
  }
  impl_->surface = std::move(surface);
  impl_->look_through(0, false);
}

SceneTiles::~SceneTiles() = default;
SceneTiles::SceneTiles(SceneTiles&&) noexcept = default;

std::size_t SceneTiles::count() const { return impl_->tiles.size(); }
const Box& SceneTiles::box(std::size_t tile) const { return impl_->tiles[tile].box; }
const Box& SceneTiles::box() const { return impl_->box; }
const TileTree& SceneTiles::tree() const { return impl_->tree; }
const std::vector<int>& SceneTiles::finest() const { return impl_->finest; }
const Matrix& SceneTiles::to_scene() const { return impl_->to_scene; }
std::size_t SceneTiles::faces() const { return impl_->faces; }
const std::vector<ReadFailure>& SceneTiles::failures() const { return impl_->failures; }
const std::vector<std::string>& SceneTiles::warnings() const { return impl_->warnings; }

int SceneTiles::node(std::size_t tile) const { return impl_->tiles[tile].node; }
bool SceneTiles::is_piece(std::size_t tile) const { return impl_->tiles[tile].piece >= 0; }
const std::shared_ptr<const HeightMap>& SceneTiles::surface() const { return impl_->surface; }

std::shared_ptr<const Source> SceneTiles::get(std::size_t tile) const {
  if (auto kept = impl_->find(tile)) return kept;
  const auto source = std::make_shared<const Source>(impl_->read(tile));
  impl_->keep(tile, source);
  return source;
}

std::vector<std::size_t> SceneTiles::over(const Box& area) const {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < count(); ++i) {
    const Box& own = box(i);
    if ((own.min.head<2>().array() <= area.max.head<2>().array()).all() &&
        (own.max.head<2>().array() >= area.min.head<2>().array()).all())
      out.push_back(i);
  }
  return out;
}

namespace {

/// Parts of one scene while they become one source.
class Joiner {
 public:
  explicit Joiner(const std::vector<Source>& parts) {
    for (const Source& s : parts) {
      has_uvs_ |= !s.look.uvs.empty();
      has_colors_ |= !s.look.colors.empty();
      has_materials_ |= !s.look.face_material.empty();
    }
    for (const Source& s : parts) add(s);
  }

  Source take() { return std::move(out_); }

 private:
  void add(const Source& s) {
    std::vector<int> number;
    for (const Vec3& p : s.mesh.vertices) {
      const auto [at, is_new] =
          known_.try_emplace({p.x(), p.y(), p.z()}, static_cast<int>(out_.mesh.vertices.size()));
      if (is_new) out_.mesh.vertices.push_back(p);
      number.push_back(at->second);
    }
    const int first = add_materials(s.look);
    for (std::size_t f = 0; f < s.mesh.faces.size(); ++f) {
      Face face = s.mesh.faces[f];
      for (int& v : face) v = number[static_cast<std::size_t>(v)];
      out_.mesh.faces.push_back(face);
      add_look(s.look, f, first);
    }
  }

  /// The number of its first material.
  int add_materials(const Appearance& look) {
    std::vector<int> image;
    for (const ImagePlace& place : look.images) {
      std::vector<ImagePlace>& all = out_.look.images;
      const auto at = std::find(all.begin(), all.end(), place);
      image.push_back(static_cast<int>(at - all.begin()));
      if (at == all.end()) all.push_back(place);
    }
    const int first = static_cast<int>(out_.look.materials.size());
    for (Material m : look.materials) {
      if (m.image >= 0) m.image = image[static_cast<std::size_t>(m.image)];
      out_.look.materials.push_back(std::move(m));
    }
    return first;
  }

  void add_look(const Appearance& look, std::size_t f, int first) {
    if (has_materials_) {
      const int m = look.face_material.empty() ? -1 : look.face_material[f];
      out_.look.face_material.push_back(m < 0 ? -1 : m + first);
    }
    const Vec2f none(NAN, NAN);
    constexpr Rgb kWhite = {255, 255, 255};
    if (has_uvs_)
      out_.look.uvs.push_back(look.uvs.empty() ? std::array{none, none, none} : look.uvs[f]);
    if (has_colors_)
      out_.look.colors.push_back(look.colors.empty() ? std::array{kWhite, kWhite, kWhite}
                                                     : look.colors[f]);
  }

  Source out_;
  std::map<std::array<double, 3>, int> known_;
  bool has_uvs_ = false, has_colors_ = false, has_materials_ = false;
};

}  // namespace

Source joined(const std::vector<Source>& parts) { return Joiner(parts).take(); }

}  // namespace colod
