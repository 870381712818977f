// Based on: own work.
#include "airborne.h"

#include <filesystem>

#include "files.h"
#include "formats.h"
#include "streams.h"

namespace colod {

namespace {

constexpr int kLowNoise = 7, kHighNoise = 18;  // classes of LAS

std::string suffix_of(const std::string& path) {
  return mesh_io::lower(std::filesystem::path(path).extension().string());
}

mesh_io::PointStream stream_of(const std::string& path, const ReadOptions& options) {
  if (is_las(path)) return mesh_io::stream_las(path, options);
  return suffix_of(path) == ".ply" ? mesh_io::stream_ply(path, options)
                                   : mesh_io::stream_table(path, options);
}

}  // namespace

struct AirborneCloud::Impl {
  mesh_io::PointStream stream;
  bool is_y_up = false;
};

AirborneCloud::AirborneCloud(const std::string& path, const ReadOptions& options)
    : impl_(new Impl{stream_of(path, options), options.up == Up::kY && !is_las(path)}) {}

AirborneCloud::~AirborneCloud() = default;
AirborneCloud::AirborneCloud(AirborneCloud&&) noexcept = default;

bool AirborneCloud::has_color() const { return impl_->stream.has_color; }
bool AirborneCloud::is_single() const { return impl_->stream.is_single; }
const std::vector<std::string>& AirborneCloud::warnings() const { return impl_->stream.warnings; }

void AirborneCloud::visit(const std::function<void(const AirbornePoint&)>& take) const {
  const Vec3 unit = impl_->stream.unit;
  impl_->stream.visit([&](const AirbornePoint& as_written) {
    if (as_written.kind == kLowNoise || as_written.kind == kHighNoise) return;
    AirbornePoint p = as_written;
    p.at = unit.cwiseProduct(p.at);
    if (!mesh_io::is_usable(p.at)) return;
    if (impl_->is_y_up) p.at = {p.at.x(), -p.at.z(), p.at.y()};
    take(p);
  });
}

bool is_las(const std::string& path) {
  const std::string e = suffix_of(path);
  return e == ".las" || e == ".laz";
}

bool is_cloud(const std::string& path) {
  const std::string e = suffix_of(path);
  if (is_las(path) || e == ".xyz" || e == ".pts" || e == ".pwn") return true;
  if (e == ".ply") return mesh_io::is_ply_cloud(path);
  return (e == ".asc" || e == ".csv" || e == ".txt") && mesh_io::is_table_file(path);
}

}  // namespace colod
