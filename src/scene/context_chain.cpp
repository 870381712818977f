// Based on: own work. Differs: the look of coarser tiles is drawn from straight above, which is how
// such surfaces were seen: what is upright is as wide as a pixel there.
#include "context_chain.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "context_picture.h"
#include "core/bytes.h"
#include "core/error.h"
#include "core/parallel.h"
#include "image/look_sampler.h"
#include "parameters.h"
#include "scratch_file.h"
#include "simplification.h"
#include "tiles.h"

namespace colod {

namespace {

using namespace parameters::context;

/// A tile above others while the tree grows: children come before parents.
struct Growing {
  std::vector<int> children;
  int leaf = -1;
  Box box;
};

/// Up to four to a tile, by quarters of the plan.
class Grouping {
 public:
  explicit Grouping(const std::vector<ChainLeaf>& leaves) : leaves_(leaves) {}

  std::vector<Growing> tree() {
    std::vector<int> all;
    for (std::size_t i = 0; i < leaves_.size(); ++i) {
      out_.push_back({{}, static_cast<int>(i), leaves_[i].box});
      all.push_back(leaves_[i].texel > 0 ? above({static_cast<int>(i)}) : static_cast<int>(i));
    }
    group(std::move(all));
    return std::move(out_);
  }

 private:
  int above(const std::vector<int>& children) {
    Growing node{children, -1, {}};
    for (const int c : children) node.box.extend(out_[static_cast<std::size_t>(c)].box);
    out_.push_back(std::move(node));
    return static_cast<int>(out_.size()) - 1;
  }

  int group(std::vector<int> open) {
    if (open.size() <= kMostChildren) return above(open);
    Box middles;
    for (const int i : open) middles.extend(out_[static_cast<std::size_t>(i)].box.center());
    std::array<std::vector<int>, 4> quarters;
    for (const int i : open) {
      const Vec3 p = out_[static_cast<std::size_t>(i)].box.center();
      const bool is_right = p.x() > middles.center().x(), is_upper = p.y() > middles.center().y();
      quarters[(is_right ? 1 : 0) + (is_upper ? 2 : 0)].push_back(i);
    }
    std::vector<int> children;
    for (const std::vector<int>& quarter : quarters) {
      if (quarter.size() == open.size()) return above(in_fours(open));  // all on one place
      if (quarter.size() == 1) children.push_back(quarter[0]);
      if (quarter.size() > 1) children.push_back(group(quarter));
    }
    return above(children);
  }

  std::vector<int> in_fours(std::vector<int> open) {
    while (open.size() > kMostChildren) {
      std::vector<int> next;
      for (std::size_t i = 0; i < open.size(); i += kMostChildren) {
        const std::size_t end = std::min(open.size(), i + kMostChildren);
        next.push_back(above({open.begin() + static_cast<std::ptrdiff_t>(i),
                              open.begin() + static_cast<std::ptrdiff_t>(end)}));
      }
      open.swap(next);
    }
    return open;
  }

  const std::vector<ChainLeaf>& leaves_;
  std::vector<Growing> out_;
};

double plan_side(const Box& box) { return std::max(box.size().x(), box.size().y()); }

/// One mesh of all; joints are those that are still on a border.
Work join(const std::vector<ChainPart>& parts) {
  std::vector<Source> bare;
  for (const ChainPart& part : parts) {
    bare.emplace_back();
    bare.back().mesh = part.source.mesh;
  }
  Work work{joined(bare).mesh, {}, {}, 0};
  work.is_joint.assign(work.mesh.vertices.size(), 0);
  for (const ChainPart& part : parts) {
    const std::vector<char> marks = marked_as(work.mesh, part.source.mesh, part.is_joint);
    for (std::size_t v = 0; v < marks.size(); ++v) work.is_joint[v] |= marks[v];
  }
  const std::vector<char> is_open = on_border(work.mesh);
  for (std::size_t v = 0; v < is_open.size(); ++v) work.is_joint[v] &= is_open[v];
  return work;
}

/// As many faces as the room for a tile has, or as its detail needs.
Work simplified(const Work& from, double error) {
  Work out;
  for (int i = 0; i < kMostRelaxed; ++i, error *= 2) {
    const Work large = without_small(from, error);
    out = collapsed(large, error);
    out.deviation = std::max(out.deviation, large.deviation);
    if (out.mesh.faces.size() <= kMostFaces) break;
  }
  return out;
}

}  // namespace

struct ContextChain::Impl {
  /// Where in the file a coarser tile lies.
  struct Place {
    std::size_t vertices = 0, faces = 0, at = 0, image = 0, image_bytes = 0;
    PictureFrame frame;
  };
  ScratchFile file;
  ImageCache images;
  std::vector<ChainNode> nodes;
  std::vector<Place> places;  // per node
  std::vector<std::vector<std::size_t>> children;

  explicit Impl(std::size_t memory) : images(memory) {}

  void number(std::vector<Growing> growing);
  void make(std::size_t node, const std::vector<ChainLeaf>& leaves);
  void grow_up();
  void store(std::size_t node, const Work& work, const std::string& picture);
  ChainPart part(std::size_t node) const;
  std::vector<ChainPart> parts_below(std::size_t node, const std::vector<ChainLeaf>& leaves,
                                     double& texel);
};

/// Parents first.
void ContextChain::Impl::number(std::vector<Growing> growing) {
  const std::size_t n = growing.size();
  std::vector<std::size_t> order, place(n);
  order.push_back(n - 1);
  for (std::size_t i = 0; i < order.size(); ++i) {
    place[order[i]] = i;
    for (const int c : growing[order[i]].children) order.push_back(static_cast<std::size_t>(c));
  }
  nodes.resize(order.size());
  places.resize(order.size());
  children.resize(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    nodes[i].leaf = growing[order[i]].leaf;
    for (const int c : growing[order[i]].children) {
      const std::size_t child = place[static_cast<std::size_t>(c)];
      children[i].push_back(child);
      nodes[child].parent = static_cast<int>(i);
    }
  }
}

/// What its children show; `texel`: the finest leaf's, or that of the coarsest tile which was made,
/// so that texels grow with each level.
std::vector<ChainPart> ContextChain::Impl::parts_below(std::size_t node,
                                                       const std::vector<ChainLeaf>& leaves,
                                                       double& texel) {
  std::vector<ChainPart> parts;
  double coarse = 0, fine = INFINITY;
  for (const std::size_t c : children[node]) {
    if (nodes[c].leaf < 0) {
      parts.push_back(part(c));
      coarse = std::max(coarse, nodes[c].texel);
      continue;
    }
    const ChainLeaf& leaf = leaves[static_cast<std::size_t>(nodes[c].leaf)];
    try {
      parts.push_back(leaf.read());
    } catch (const Error&) {
      continue;  // whoever reads it as a tile of its own tells of it
    }
    const Source& s = parts.back().source;
    if (leaf.texel > 0)
      fine = std::min(fine, leaf.texel / 2);
    else if (!s.mesh.faces.empty())
      fine = std::min(fine, LookSampler(s.mesh, s.look, images).texel());
  }
  texel = std::max(coarse, std::isfinite(fine) ? fine : 0);
  return parts;
}

void ContextChain::Impl::make(std::size_t node, const std::vector<ChainLeaf>& leaves) {
  double texel = 0, below = 0;
  const std::vector<ChainPart> parts = parts_below(node, leaves, texel);
  for (const std::size_t c : children[node]) below = std::max(below, nodes[c].deviation);
  Work whole = join(parts);
  if (whole.mesh.faces.empty()) return;
  const Box box = bounding_box(whole.mesh.vertices);
  texel = std::max({2 * texel, plan_side(box) / kLargestPicture, kLeastTexel});
  PictureFrame& frame = places[node].frame;
  std::string picture = draw_context(parts, box, texel, images, frame);
  const Work work = simplified(whole, texel);
  nodes[node].texel = texel;
  nodes[node].deviation = below + work.deviation;
  store(node, work, picture);
}

void ContextChain::Impl::store(std::size_t node, const Work& work, const std::string& picture) {
  Place& place = places[node];
  place.vertices = work.mesh.vertices.size(), place.faces = work.mesh.faces.size();
  std::string bytes;
  put_all(bytes, work.mesh.vertices);
  put_all(bytes, work.mesh.faces);
  put_all(bytes, work.is_joint);
  place.at = file.append(bytes);
  place.image_bytes = picture.size();
  if (!picture.empty()) place.image = file.append(picture);
}

ChainPart ContextChain::Impl::part(std::size_t node) const {
  const Place& place = places[node];
  ChainPart out;
  if (place.faces == 0) return out;
  const std::string bytes =
      file.read(place.at, place.vertices * (sizeof(Vec3) + 1) + place.faces * sizeof(Face));
  const char* at = take_all(bytes.data(), place.vertices, out.source.mesh.vertices);
  at = take_all(at, place.faces, out.source.mesh.faces);
  take_all(at, place.vertices, out.is_joint);
  if (place.image_bytes > 0)
    wear(place.frame, {file.path(), place.image, place.image_bytes, false, 0, 0}, out.source);
  return out;
}

/// Above the one root as many as it takes for its picture to be small.
void ContextChain::Impl::grow_up() {
  for (int i = 0; i < kMostAbove; ++i) {
    const Place& root = places[0];
    const bool is_small = std::max(root.frame.width, root.frame.height) <= kSmallPicture;
    if (root.faces == 0 || (is_small && root.faces <= kFewFaces)) return;
    for (ChainNode& node : nodes) ++node.parent;
    for (auto& own : children)
      for (std::size_t& c : own) ++c;
    nodes.insert(nodes.begin(), ChainNode{});
    places.insert(places.begin(), Place{});
    children.insert(children.begin(), std::vector<std::size_t>{1});
    make(0, {});
  }
}

ContextChain::ContextChain(const std::vector<ChainLeaf>& leaves, std::size_t image_memory)
    : impl_(std::make_unique<Impl>(image_memory)) {
  if (leaves.empty()) return;
  impl_->number(Grouping(leaves).tree());
  std::vector<int> height(impl_->nodes.size(), 0);
  int top = 0;
  for (std::size_t i = height.size(); i-- > 1;) {
    int& above = height[static_cast<std::size_t>(impl_->nodes[i].parent)];
    above = std::max(above, height[i] + 1);
    top = std::max(top, above);
  }
  for (int h = 1; h <= top; ++h) {
    std::vector<std::size_t> level;
    for (std::size_t i = 0; i < height.size(); ++i)
      if (height[i] == h) level.push_back(i);
    parallel_for(level.size(), [&](std::size_t i) { impl_->make(level[i], leaves); });
  }
  impl_->grow_up();
}

ContextChain::~ContextChain() = default;
ContextChain::ContextChain(ContextChain&&) noexcept = default;

const std::vector<ChainNode>& ContextChain::nodes() const { return impl_->nodes; }
Source ContextChain::read(std::size_t node) const { return impl_->part(node).source; }

std::vector<char> on_border(const Mesh& mesh) {
  std::set<std::array<int, 2>> open;
  for (const Face& f : mesh.faces)
    for (std::size_t k = 0; k < 3; ++k)
      if (const int a = f[k], b = f[(k + 1) % 3]; open.erase({b, a}) == 0) open.insert({a, b});
  std::vector<char> out(mesh.vertices.size(), 0);
  for (const auto& edge : open)
    for (const int v : edge) out[static_cast<std::size_t>(v)] = 1;
  return out;
}

std::vector<char> marked_as(const Mesh& mesh, const Mesh& other, const std::vector<char>& marks) {
  std::set<std::array<double, 3>> places;
  const auto key = [](const Vec3& p) { return std::array<double, 3>{p.x(), p.y(), p.z()}; };
  for (std::size_t v = 0; v < marks.size(); ++v)
    if (marks[v]) places.insert(key(other.vertices[v]));
  std::vector<char> out;
  for (const Vec3& p : mesh.vertices) out.push_back(places.contains(key(p)));
  return out;
}

}  // namespace colod
