// Based on: GDAL/OGR's simple features; GEOS mends polygons behind it.
// Differs: a scene that is nowhere on Earth has footprints in its own metres. GeoJSON says WGS 84
// of itself whatever it holds, so that nothing else could be told.
#include "footprints.h"

#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>

#include "core/error.h"
#include "core/flat.h"
#include "local.h"

namespace colod {
namespace {

constexpr double kLeastArea = 1;          // m²: smaller outlines are slips of the pen
constexpr std::size_t kMost = 5'000'000;  // features of a file

struct DatasetDeleter {
  void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<GDALDataset, DatasetDeleter>;
using Feature = OGRFeatureUniquePtr;
using Ring = std::vector<Vec2>;

/// GDAL writes to stderr unless told otherwise.
struct Quiet {
  Quiet() { CPLPushErrorHandler(CPLQuietErrorHandler); }
  ~Quiet() { CPLPopErrorHandler(); }
  static std::string last() {
    std::string text = CPLGetLastErrorMsg();
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text.substr(0, 200);
  }
};

/// The file's coordinates → the scene's.
class Mover {
 public:
  /// `from`: nullptr: the file says nothing.
  Mover(const std::string& path, const OGRSpatialReference* from,
        const std::optional<Georeference>& scene)
      : scene_(scene) {
    if (!scene || !from) return;
    OGRSpatialReference source(*from), target;
    source.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    const bool is_local = scene->crs.starts_with("ENU:");
    const OGRErr error =
        is_local ? target.importFromEPSG(4326) : target.SetFromUserInput(scene->crs.c_str());
    target.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    if (error == OGRERR_NONE) transform_.reset(OGRCreateCoordinateTransformation(&source, &target));
    if (!transform_)
      throw Error(Stage::kInput, path,
                  "no way from its reference system to the scene's is known: " + Quiet::last());
    if (is_local) local_ = local_place(*scene);
  }

  /// False: the point is nowhere in the scene's system.
  bool move(Vec2& p) const {
    if (transform_ && !transform_->Transform(1, &p.x(), &p.y())) return false;
    if (local_) {
      const Vec3 ground = ecef_to_geodetic(local_->centre);
      const Vec3 ecef = geodetic_to_ecef(p.y() * kDegree, p.x() * kDegree, ground.z());
      p = (local_->axes.transpose() * (ecef - local_->centre)).head<2>();
    }
    if (scene_) p -= scene_->offset.head<2>();
    return p.allFinite();
  }

 private:
  std::optional<Georeference> scene_;
  std::unique_ptr<OGRCoordinateTransformation> transform_;
  std::optional<LocalPlace> local_;
};

/// Counter-clockwise when `is_outer`, else clockwise; without points that stand for nothing.
Ring ring_of(const OGRLinearRing& from, bool is_outer, const Mover& mover, bool& is_good) {
  Ring ring;
  for (int i = 0; i < from.getNumPoints(); ++i) {
    Vec2 p(from.getX(i), from.getY(i));
    is_good = mover.move(p) && is_good;
    if (ring.empty() || ring.back() != p) ring.push_back(p);
  }
  while (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
  if ((signed_area(ring) > 0) != is_outer) std::reverse(ring.begin(), ring.end());
  return ring;
}

/// One file while its features are taken.
class Taker {
 public:
  Taker(const std::string& path, const std::string& id, const std::optional<Georeference>& scene)
      : path_(path), id_(id), scene_(scene) {}

  void take(OGRLayer& layer) {
    const OGRSpatialReference* system = layer.GetSpatialRef();
    if (system && system->GetName()) out_.crs = system->GetName();
    if (!system && scene_) has_unknown_system_ = true;
    const Mover mover(path_, system, scene_);
    const int field = id_field(layer);
    layer.ResetReading();
    for (Feature feature(layer.GetNextFeature()); feature; feature.reset(layer.GetNextFeature())) {
      if (++seen_ > kMost)
        throw Error(Stage::kInput, path_, "has more than " + std::to_string(kMost) + " features");
      add(*feature, field, mover);
    }
  }

  Footprints finish() {
    if (has_unknown_system_)
      out_.warnings.push_back(path_ +
                              ": says no reference system: its coordinates are taken for the "
                              "scene's own");
    tell(mended_, "cross themselves and were mended");
    tell(renamed_, "have an id that others have, too, and were numbered");
    if (out_.all.empty() && out_.problems.empty())
      throw Error(Stage::kInput, path_, "holds no polygon");
    return std::move(out_);
  }

 private:
  int id_field(OGRLayer& layer) const {
    OGRFeatureDefn& fields = *layer.GetLayerDefn();
    if (!id_.empty()) {
      const int field = fields.GetFieldIndex(id_.c_str());
      if (field >= 0) return field;
      std::string names;
      for (int i = 0; i < fields.GetFieldCount(); ++i)
        names.append(i ? ", " : "").append(fields.GetFieldDefn(i)->GetNameRef());
      throw Error(Stage::kUsage, "--footprint-id",
                  "'" + id_ + "' is no attribute of " + path_ + ", which has: " + names);
    }
    for (const char* name : {"id", "name"})
      if (const int field = fields.GetFieldIndex(name); field >= 0) return field;
    return -1;
  }

  void add(OGRFeature& feature, int field, const Mover& mover) {
    Footprint footprint;
    if (field >= 0 && feature.IsFieldSetAndNotNull(field))
      footprint.id = feature.GetFieldAsString(field);
    if (footprint.id.empty()) footprint.id = "footprint-" + std::to_string(feature.GetFID());
    for (int i = 0; i < feature.GetFieldCount(); ++i)
      if (feature.IsFieldSetAndNotNull(i))
        footprint.attributes.push_back(
            {feature.GetFieldDefnRef(i)->GetNameRef(), feature.GetFieldAsString(i)});
    make_unique(footprint);
    std::unique_ptr<OGRGeometry> shape(feature.StealGeometry());
    if (!shape || shape->IsEmpty()) return leave_out(footprint, "has no shape");
    shape->flattenTo2D();
    if (wkbFlatten(shape->getGeometryType()) != wkbPolygon &&
        wkbFlatten(shape->getGeometryType()) != wkbMultiPolygon)
      shape.reset(OGRGeometryFactory::forceToMultiPolygon(shape.release()));
    if (!shape->IsValid()) {
      shape.reset(shape->MakeValid());
      mended_.push_back(footprint.id);
    }
    if (!shape) return leave_out(footprint, "crosses itself and cannot be mended");
    bool is_good = true;
    add_parts(*shape, mover, footprint, is_good);
    if (!is_good) return leave_out(footprint, "lies outside of what its reference system is for");
    double area = 0;
    for (const auto& part : footprint.parts)
      for (const Ring& ring : part) area += signed_area(ring);
    if (area < kLeastArea)
      return leave_out(footprint, "covers " + std::to_string(area) + " m², less than a building");
    out_.all.push_back(std::move(footprint));
  }

  void add_parts(const OGRGeometry& shape, const Mover& mover, Footprint& footprint,
                 bool& is_good) const {
    if (const auto type = wkbFlatten(shape.getGeometryType()); type == wkbPolygon) {
      std::vector<Ring> rings;
      bool is_outer = true;
      for (const OGRLinearRing* ring : *shape.toPolygon()) {
        Ring own = ring_of(*ring, is_outer, mover, is_good);
        if (own.size() >= 3) rings.push_back(std::move(own));
        if (rings.empty()) return;  // no outer ring
        is_outer = false;
      }
      if (!rings.empty()) footprint.parts.push_back(std::move(rings));
    } else if (type == wkbMultiPolygon || type == wkbGeometryCollection) {
      for (const OGRGeometry* part : *shape.toGeometryCollection())
        add_parts(*part, mover, footprint, is_good);
    }
  }

  void make_unique(Footprint& footprint) {
    const std::string base = footprint.id;
    for (int i = 2; !ids_.insert(footprint.id).second; ++i)
      footprint.id = base + "_" + std::to_string(i);
    if (footprint.id != base) renamed_.push_back(footprint.id);
  }

  void leave_out(const Footprint& footprint, const std::string& why) {
    out_.problems.push_back({footprint.id, why});
  }

  void tell(const std::vector<std::string>& ids, const std::string& what) {
    if (ids.empty()) return;
    out_.warnings.push_back(path_ + ": " + std::to_string(ids.size()) + " footprints " + what +
                            ", first " + ids.front());
  }

  const std::string& path_;
  const std::string& id_;
  const std::optional<Georeference>& scene_;
  Footprints out_;
  std::set<std::string> ids_;
  std::vector<std::string> mended_, renamed_;
  std::size_t seen_ = 0;
  bool has_unknown_system_ = false;
};

}  // namespace

bool can_read_footprints() { return true; }

Footprints read_footprints(const std::string& path, const std::string& id,
                           const std::optional<Georeference>& scene) {
  static const bool is_ready = (GDALAllRegister(), true);
  (void)is_ready;
  const Quiet quiet;
  const Dataset dataset(GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY));
  if (!dataset) throw Error(Stage::kInput, path, "GDAL cannot read it: " + Quiet::last());
  Taker taker(path, id, scene);
  for (OGRLayer* layer : dataset->GetLayers()) taker.take(*layer);
  return taker.finish();
}

}  // namespace colod
