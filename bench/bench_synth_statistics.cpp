// What meshes of photogrammetry are like, in numbers: real cut-outs beside made-up ones. A row a
// folder.
//
//   bench_synth_statistics NAME=FOLDER...
//
// Of each number the median over the folder's buildings, and in brackets the tenth and the
// ninetieth of a hundred.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numeric>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/geometry.h"
#include "core/parallel.h"
#include "read/read.h"

namespace {

using namespace colod;

constexpr double kScales[] = {1, 3, 5};  // m
const char* const kNames[] = {"faces",         "edge, median m", "edge, p10 m",
                              "edge, p90 m",   "area per face",  "roof rms 1 m",
                              "roof rms 3 m",  "roof rms 5 m",   "wall rms 1 m",
                              "wall rms 3 m",  "wall rms 5 m",   "walls beyond 10 deg %",
                              "overhanging %", "border edges",   "border per root of faces"};
constexpr int kNumbers = std::size(kNames);

double quantile(std::vector<double> values, double share) {
  values.erase(std::remove_if(values.begin(), values.end(), [](double v) { return std::isnan(v); }),
               values.end());
  if (values.empty()) return NAN;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
}

struct Faces {
  std::vector<Vec3> normal, middle;
  std::vector<double> area;
};

Faces face_table(const Mesh& mesh) {
  Faces table;
  for (const Face& f : mesh.faces) {
    const Vec3 cross = face_cross(mesh, f);
    table.area.push_back(cross.norm() / 2);
    table.normal.push_back(cross.norm() > 0 ? Vec3(cross.normalized()) : Vec3(Vec3::Zero()));
    table.middle.push_back((mesh.vertices[f[0]] + mesh.vertices[f[1]] + mesh.vertices[f[2]]) / 3);
  }
  return table;
}

/// Root mean square from the best plane of what faces alike about a face: moments of triangles.
/// NaN: too few.
double residual(const Mesh& mesh, const Faces& table, std::size_t about, double radius) {
  constexpr double kAlike = 0.7;  // cosine
  constexpr int kFewest = 5;      // faces, fewer lie on any plane
  double area = 0;
  Vec3 sum = Vec3::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  int faces = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    if ((table.middle[f] - table.middle[about]).squaredNorm() > radius * radius) continue;
    if (table.normal[f].dot(table.normal[about]) < kAlike) continue;
    const Vec3 m = table.middle[f] - table.middle[about];
    Eigen::Matrix3d corners = 9 * m * m.transpose();
    for (int v : mesh.faces[f]) {
      const Vec3 p = mesh.vertices[v] - table.middle[about];
      corners += p * p.transpose();
    }
    second += table.area[f] / 12 * corners, sum += table.area[f] * m, area += table.area[f],
        ++faces;
  }
  if (faces < kFewest || area <= 0) return NAN;
  const Eigen::Matrix3d covariance = second / area - sum * sum.transpose() / (area * area);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues()[0]));
}

/// Places spread evenly over the area of roofs or walls; no ground, which lies near the lowest
/// point.
std::vector<std::size_t> places(const Faces& table, bool is_wall, double low, double high) {
  constexpr int kPlaces = 60;
  const double floor = low + 0.25 * (high - low);
  std::vector<double> until(table.area.size());
  double total = 0;
  for (std::size_t f = 0; f < until.size(); ++f) {
    const bool is_kind = is_wall ? std::abs(table.normal[f].z()) < 0.5
                                 : table.normal[f].z() > 0.6 && table.middle[f].z() > floor;
    until[f] = total += is_kind ? table.area[f] : 0;
  }
  std::vector<std::size_t> chosen;
  for (int i = 0; i < kPlaces && total > 0; ++i)
    chosen.push_back(static_cast<std::size_t>(
        std::upper_bound(until.begin(), until.end(), (i + 0.5) / kPlaces * total) - until.begin()));
  return chosen;
}

std::map<std::pair<int, int>, int> edge_counts(const Mesh& mesh) {
  std::map<std::pair<int, int>, int> counts;
  for (const Face& f : mesh.faces)
    for (int k = 0; k < 3; ++k) ++counts[std::minmax(f[k], f[(k + 1) % 3])];
  return counts;
}

std::vector<double> measure(const Mesh& mesh) {
  const Faces table = face_table(mesh);
  const Box box = bounding_box(mesh.vertices);
  std::vector<double> lengths;
  double border = 0;
  for (const auto& [edge, count] : edge_counts(mesh)) {
    lengths.push_back((mesh.vertices[edge.first] - mesh.vertices[edge.second]).norm());
    border += count == 1;
  }
  const double faces = static_cast<double>(mesh.faces.size());
  const double area = std::accumulate(table.area.begin(), table.area.end(), 0.0);
  std::vector<double> row = {faces, quantile(lengths, 0.5), quantile(lengths, 0.1),
                             quantile(lengths, 0.9), area / faces};
  for (bool is_wall : {false, true})
    for (double scale : kScales) {
      std::vector<double> residuals;
      for (std::size_t f : places(table, is_wall, box.min.z(), box.max.z()))
        residuals.push_back(residual(mesh, table, f, scale));
      row.push_back(quantile(residuals, 0.5));
    }
  double steep = 0, leaning = 0, overhanging = 0;
  for (std::size_t f = 0; f < table.area.size(); ++f) {
    const double z = table.normal[f].z();
    if (std::abs(z) < std::sin(40 * M_PI / 180)) {
      steep += table.area[f];
      if (std::abs(z) > std::sin(10 * M_PI / 180)) leaning += table.area[f];
    }
    if (z < -0.1) overhanging += table.area[f];
  }
  row.insert(row.end(),
             {100 * leaning / steep, 100 * overhanging / area, border, border / std::sqrt(faces)});
  return row;
}

}  // namespace

int main(int argc, char** argv) try {
  std::vector<std::string> names;
  std::vector<std::vector<std::vector<double>>> sets;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const std::size_t sign = argument.find('=');
    if (sign == std::string::npos) throw Error(Stage::kUsage, argument, "must be NAME=FOLDER");
    names.push_back(argument.substr(0, sign));
    const ReadResult read =
        read_sources({argument.substr(sign + 1)}, {.split = Split::kNone, .up = Up::kZ});
    std::vector<std::vector<double>> rows(read.sources.size());
    parallel_for(rows.size(), [&](std::size_t k) { rows[k] = measure(read.sources[k].mesh); });
    sets.push_back(rows);
  }
  std::printf("| number |");
  for (std::size_t s = 0; s < names.size(); ++s)
    std::printf(" %s (%zu) |", names[s].c_str(), sets[s].size());
  std::printf("\n|---|");
  for (std::size_t s = 0; s < names.size(); ++s) std::printf("---|");
  for (int n = 0; n < kNumbers; ++n) {
    std::printf("\n| %s |", kNames[n]);
    for (const auto& rows : sets) {
      std::vector<double> values;
      for (const auto& row : rows) values.push_back(row[n]);
      std::printf(" %.3g (%.3g–%.3g) |", quantile(values, 0.5), quantile(values, 0.1),
                  quantile(values, 0.9));
    }
  }
  std::printf("\n");
} catch (const std::exception& error) {
  std::fprintf(stderr, "bench_synth_statistics: %s\n", error.what());
  return 1;
}
