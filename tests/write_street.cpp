// Writes the tileset of a street of N small houses, as many as the clients' tests need for cells of their own: write_street OUT N
#include <cstdio>

#include "../exporters/deviation.h"
#include "../exporters/files.h"
#include "../exporters/tiles3d.h"
#include "exporters_helpers.h"

int main(int argc, char** argv) {
  if (argc != 3) return std::fprintf(stderr, "usage: write_street OUT N\n"), 2;
  std::vector<colod::ExportBuilding> buildings = colod::test::street(std::stoi(argv[2]));
  for (colod::ExportBuilding& b : buildings) colod::measure_visible_errors(b);
  for (const colod::Encoded& file : colod::encode_tileset(buildings))
    colod::write_file(argv[1], file);
}
