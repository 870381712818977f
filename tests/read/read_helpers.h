// Files written into a folder that goes away with the test.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "meshes.h"
#include "read/read.h"

namespace colod::test {

struct TempFolder {
  std::filesystem::path path;

  TempFolder() {
    static int number = 0;
    path = std::filesystem::temp_directory_path() /
           ("colod_mesh_io_" + std::to_string(getpid()) + "_" + std::to_string(number++));
    std::filesystem::create_directories(path);
  }
  ~TempFolder() { std::filesystem::remove_all(path); }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;

  std::string write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path / name, std::ios::binary) << bytes;
    return (path / name).string();
  }
};

/// Reads `bytes` as a file of that name.
inline ReadResult read_bytes(const std::string& name, const std::string& bytes,
                             const ReadOptions& options = {}) {
  const TempFolder folder;
  return read_sources({folder.write(name, bytes)}, options);
}

/// The only failure's message; "" when there is none.
inline std::string failure(const std::string& name, const std::string& bytes) {
  const ReadResult r = read_bytes(name, bytes);
  return r.failures.empty() ? "" : r.failures.front().message;
}

inline std::string off_text(const Mesh& m) {
  std::ostringstream out;
  out.precision(17);
  out << "OFF\n" << m.vertices.size() << ' ' << m.faces.size() << " 0\n";
  for (const Vec3& p : m.vertices) out << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
  for (const Face& f : m.faces) out << "3 " << f[0] << ' ' << f[1] << ' ' << f[2] << '\n';
  return out.str();
}

inline std::string obj_text(const Mesh& m, int base = 0) {
  std::ostringstream out;
  out.precision(17);
  for (const Vec3& p : m.vertices) out << "v " << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
  for (const Face& f : m.faces)
    out << "f " << f[0] + 1 + base << ' ' << f[1] + 1 + base << ' ' << f[2] + 1 + base << '\n';
  return out.str();
}

template <typename T>
void put(std::string& out, T value, bool is_big_endian) {
  std::string bytes(reinterpret_cast<const char*>(&value), sizeof value);
  out += is_big_endian ? std::string(bytes.rbegin(), bytes.rend()) : bytes;
}

/// A PLY with double or float vertices and, per face, its index as `object`.
template <typename Real>
std::string ply_bytes(const Mesh& m, bool is_big_endian) {
  const std::string real = sizeof(Real) == 8 ? "double" : "float";
  std::string out = "ply\nformat binary_";
  out += is_big_endian ? "big" : "little";
  out += "_endian 1.0\nelement vertex " + std::to_string(m.vertices.size());
  for (const char* axis : {"x", "y", "z"}) out += "\nproperty " + real + " " + axis;
  out += "\nproperty uchar red\nelement face " + std::to_string(m.faces.size());
  out += "\nproperty list uchar int vertex_indices\nproperty int object\nend_header\n";
  for (const Vec3& p : m.vertices) {
    for (int k = 0; k < 3; ++k) put(out, static_cast<Real>(p[k]), is_big_endian);
    out += '\7';
  }
  for (std::size_t f = 0; f < m.faces.size(); ++f) {
    out += '\3';
    for (const int v : m.faces[f]) put(out, v, is_big_endian);
    put(out, static_cast<int>(f), is_big_endian);
  }
  return out;
}

inline std::string stl_bytes(const Mesh& m) {
  std::string out(80, ' ');
  put(out, static_cast<std::uint32_t>(m.faces.size()), false);
  for (const Face& f : m.faces) {
    out += std::string(12, '\0');
    for (const int v : f)
      for (int k = 0; k < 3; ++k) put(out, static_cast<float>(m.vertices[v][k]), false);
    out += std::string(2, '\0');
  }
  return out;
}

/// A GLB of the mesh under the given `nodes` and `scenes` JSON; mesh 0 is the mesh, y up.
inline std::string glb_bytes(const Mesh& m, const std::string& nodes, const std::string& scene) {
  std::string bin;
  for (const Vec3& p : m.vertices)
    for (int k = 0; k < 3; ++k) put(bin, static_cast<float>(p[k]), false);
  const std::string positions = std::to_string(bin.size());
  for (const Face& f : m.faces)
    for (const int v : f) put(bin, static_cast<std::uint32_t>(v), false);
  const std::string total = std::to_string(bin.size());
  const std::string indices = std::to_string(12 * m.faces.size());
  std::string json = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":)" + scene;
  json += R"(}],"nodes":)" + nodes;
  json += R"(,"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],)";
  json += R"("buffers":[{"byteLength":)" + total + R"(}],"bufferViews":[)";
  json += R"({"buffer":0,"byteOffset":0,"byteLength":)" + positions + "},";
  json += R"({"buffer":0,"byteOffset":)" + positions + R"(,"byteLength":)" + indices + "}],";
  json += R"("accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":)";
  json += std::to_string(m.vertices.size());
  json += R"(,"min":[0,0,0],"max":[9,9,9]},{"bufferView":1,"componentType":5125,"type":"SCALAR",)";
  json += R"("count":)" + std::to_string(3 * m.faces.size()) + "}]}";
  while (json.size() % 4 != 0) json += ' ';
  std::string out = "glTF";
  put(out, std::uint32_t{2}, false);
  put(out, static_cast<std::uint32_t>(28 + json.size() + bin.size()), false);
  put(out, static_cast<std::uint32_t>(json.size()), false);
  out += "JSON" + json;
  put(out, static_cast<std::uint32_t>(bin.size()), false);
  return out + std::string("BIN\0", 4) + bin;
}

}  // namespace colod::test
