#include "kept.h"

#include <iomanip>
#include <sstream>

#include "core/hash.h"

namespace colod {
namespace {

/// Texts by their lengths, so that no two lists of them read alike.
class Facts {
 public:
  Facts() { text_ << std::setprecision(17); }
  Facts& operator<<(const std::string& s) {
    text_ << s.size() << ':' << s << ' ';
    return *this;
  }
  template <typename T>
  requires std::is_arithmetic_v<T> Facts& operator<<(T value) {
    text_ << value << ' ';
    return *this;
  }
  Facts& operator<<(const Vec3& v) { return *this << v.x() << v.y() << v.z(); }
  std::string hash() const { return hash_of(text_.str()); }

 private:
  std::ostringstream text_;
};

void add_frame(const TileFrame& frame, Facts& facts) {
  facts << frame.origin() << frame.is_on_earth();
  if (frame.is_on_earth())
    for (const double x : frame.to_ecef()) facts << x;
}

void add_part(const TilePart& part, const KeptTiles& kept, Facts& facts) {
  facts << part.buildings.size() << part.origin << part.gsd << part.deviation;
  Hash buildings;
  for (const int b : part.buildings)
    buildings.add(&kept.keys[static_cast<std::size_t>(b)], sizeof(BuildingKey));
  facts << buildings.hex();
  if (part.level) {  // of one building
    facts << part.level->layers.front() << part.level->layers.back();
    return;
  }
  facts << "stand-in" << part.mesh->vertices.size();
  for (const Vec3& v : part.mesh->vertices) facts << v;
}

}  // namespace

std::string tile_key(const PlannedTile& tile, const TileFrame& frame, const TilesOptions& options) {
  Facts facts;
  facts << tile.name << tile.is_finest << tile.parts.size();
  facts << static_cast<int>(options.compression) << options.quantization << options.target_sse
        << options.largest_texture;
  add_frame(frame, facts);
  for (const TilePart& part : tile.parts) add_part(part, *options.kept, facts);
  return facts.hash();
}

}  // namespace colod
