// Based on: own work.
#include "pieces.h"

#include <array>

#include "core/bytes.h"

namespace colod {

namespace {

constexpr int kDeepest = 16;  // quarters of quarters: what lies on one place is not parted

Vec2 middle_of(const Mesh& mesh, int face) {
  const Face& f = mesh.faces[static_cast<std::size_t>(face)];
  Vec3 sum = Vec3::Zero();
  for (const int v : f) sum += mesh.vertices[static_cast<std::size_t>(v)];
  return sum.head<2>() / 3;
}

}  // namespace

std::vector<std::size_t> Pieces::cut(const Source& source, std::size_t most) {
  auto frame = std::make_shared<Source>();
  frame->path = source.path;
  frame->look.images = source.look.images;
  frame->look.materials = source.look.materials;
  std::vector<int> all(source.mesh.faces.size());
  for (std::size_t f = 0; f < all.size(); ++f) all[f] = static_cast<int>(f);
  std::vector<std::size_t> out;
  quarter(source, frame, std::move(all), most, 0, out);
  return out;
}

void Pieces::quarter(const Source& source, const std::shared_ptr<const Source>& frame,
                     std::vector<int> faces, std::size_t most, int depth,
                     std::vector<std::size_t>& out) {
  if (faces.empty()) return;
  if (faces.size() <= most || depth >= kDeepest) return out.push_back(put(source, frame, faces));
  Box box;
  for (const int f : faces) {
    const Vec2 p = middle_of(source.mesh, f);
    box.extend(Vec3(p.x(), p.y(), 0));
  }
  std::array<std::vector<int>, 4> quarters;
  for (const int f : faces) {
    const Vec2 p = middle_of(source.mesh, f);
    quarters[(p.x() > box.center().x() ? 1 : 0) + (p.y() > box.center().y() ? 2 : 0)].push_back(f);
  }
  faces = {};
  for (std::vector<int>& q : quarters) quarter(source, frame, std::move(q), most, depth + 1, out);
}

std::size_t Pieces::put(const Source& source, const std::shared_ptr<const Source>& frame,
                        const std::vector<int>& faces) {
  std::vector<int> number(source.mesh.vertices.size(), -1);
  std::vector<Vec3> vertices;
  std::vector<Face> own;
  for (const int f : faces) {
    Face face = source.mesh.faces[static_cast<std::size_t>(f)];
    for (int& v : face) {
      int& n = number[static_cast<std::size_t>(v)];
      if (n < 0) {
        n = static_cast<int>(vertices.size());
        vertices.push_back(source.mesh.vertices[static_cast<std::size_t>(v)]);
      }
      v = n;
    }
    own.push_back(face);
  }
  Appearance look = source.look;
  look.pick(faces);
  std::string bytes;
  put_all(bytes, vertices), put_all(bytes, own);
  put_all(bytes, look.face_material), put_all(bytes, look.uvs), put_all(bytes, look.colors);
  Piece piece;
  piece.frame = frame, piece.box = bounding_box(vertices);
  piece.at = file_.append(bytes), piece.bytes = bytes.size();
  piece.vertices = vertices.size(), piece.faces = own.size();
  piece.has_materials = !look.face_material.empty();
  piece.has_uvs = !look.uvs.empty(), piece.has_colors = !look.colors.empty();
  const std::lock_guard lock(mutex_);
  pieces_.push_back(std::move(piece));
  return pieces_.size() - 1;
}

Pieces::Piece Pieces::find(std::size_t piece) const {
  const std::lock_guard lock(mutex_);
  return pieces_[piece];
}

Source Pieces::get(std::size_t number) const {
  const Piece piece = find(number);
  const std::string bytes = file_.read(piece.at, piece.bytes);
  Source out = *piece.frame;
  const char* at = take_all(bytes.data(), piece.vertices, out.mesh.vertices);
  at = take_all(at, piece.faces, out.mesh.faces);
  at = take_all(at, piece.has_materials ? piece.faces : 0, out.look.face_material);
  at = take_all(at, piece.has_uvs ? piece.faces : 0, out.look.uvs);
  take_all(at, piece.has_colors ? piece.faces : 0, out.look.colors);
  return out;
}

}  // namespace colod
