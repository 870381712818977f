// Writes the tileset of a street of N small houses, as many as the clients' tests need for cells of
// their own: write_street OUT N
#include <cstdio>
#include <numbers>

#include "exporters/exporters_helpers.h"
#include "exporters/files.h"
#include "exporters/tiles3d/tiles3d.h"

namespace {

/// A plane that touches a ball of the Earth's size at 48° north, 11° east.
colod::Vec3 touching_plane(const colod::Vec3& world) {
  const double degree = std::numbers::pi / 180, latitude = 48 * degree, longitude = 11 * degree;
  const colod::Vec3 up(std::cos(latitude) * std::cos(longitude),
                       std::cos(latitude) * std::sin(longitude), std::sin(latitude));
  const colod::Vec3 east = colod::Vec3::UnitZ().cross(up).normalized(), north = up.cross(east);
  const colod::Vec3 p = world - colod::Vec3(691234.567, 5334567.891, 512.345);
  return p.x() * east + p.y() * north + (p.z() + 6.37e6) * up;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return std::fprintf(stderr, "usage: write_street OUT N\n"), 2;
  const std::vector<colod::ExportBuilding> buildings = colod::test::street(std::stoi(argv[2]));
  const colod::TilesOptions options = {.placement = {touching_plane, "a touching plane"}};
  for (const colod::Encoded& file : colod::encode_tileset(buildings, options))
    colod::write_file(argv[1], file);
}
