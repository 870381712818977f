// Based on: KHR_draco_mesh_compression (ratified), Google Draco's expert encoder.
// Differs: the grid is given from outside, in metres, instead of a number of bits per mesh, and
// counts, bounds and ids come from decoding the result, since the encoder may merge and reorder.
#include "draco.h"

#include <draco/compression/decode.h>
#include <draco/compression/expert_encode.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <utility>

#include "core/error.h"

namespace colod {

namespace {

constexpr int kNormalBits = 10;  // octahedral: at most about 0.1 degrees off

/// How Draco may predict: what packs a small faceted mesh best differs from mesh to mesh.
struct Packing {
  int speed;                                   // also decides how the mesh is walked
  int position = draco::PREDICTION_UNDEFINED;  // the speed's own choice
  int normal = draco::PREDICTION_UNDEFINED;
};
constexpr std::array kPackings{
    Packing{0},
    Packing{4},
    Packing{0, draco::MESH_PREDICTION_PARALLELOGRAM},
    Packing{0, draco::MESH_PREDICTION_PARALLELOGRAM, draco::PREDICTION_DIFFERENCE},
    Packing{5, draco::MESH_PREDICTION_CONSTRAINED_MULTI_PARALLELOGRAM,
            draco::MESH_PREDICTION_GEOMETRIC_NORMAL},
};
constexpr int kDecodingSpeed = 0;

/// The two best of these are tried from this many first faces: the walk goes elsewhere then. It
/// matters where a prediction is a few bytes of a few hundred, so larger meshes do without.
constexpr std::size_t kStarts = 8, kMaxFacesToTurn = 1000;

/// Faces or vertices that a byte of a stream stands for at most: a dense regular grid takes about a
/// bit a face.
constexpr std::size_t kBestDraco = 64;

constexpr int kMaxIntegerId = 65535;  // beyond it glTF wants floats, exact to 2^24

[[noreturn]] void refuse(const std::string& cause) { throw Error(Stage::kOutput, "draco", cause); }

void check(const draco::Status& status) {
  if (!status.ok()) refuse(status.error_msg_string());
}

template <typename T, int kComponents>
int add_attribute(draco::Mesh& mesh, draco::GeometryAttribute::Type kind, draco::DataType type,
                  const std::vector<std::array<T, kComponents>>& values) {
  draco::GeometryAttribute attribute;
  attribute.Init(kind, nullptr, kComponents, type, false, sizeof(values[0]), 0);
  const auto n = static_cast<std::uint32_t>(values.size());
  const int id = mesh.AddAttribute(attribute, true, n);
  for (std::uint32_t i = 0; i < n; ++i)
    mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), values[i].data());
  return id;
}

std::vector<std::array<float, 3>> as_floats(const std::vector<Vec3>& values) {
  std::vector<std::array<float, 3>> out;
  for (const Vec3& v : values)
    out.push_back(
        {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())});
  return out;
}

template <typename T>
std::vector<std::array<T, 1>> as_scalars(const std::vector<std::uint32_t>& ids) {
  std::vector<std::array<T, 1>> out;
  for (const std::uint32_t id : ids) out.push_back({static_cast<T>(id)});
  return out;
}

struct Attributes {
  int position = 0, normal = -1, feature = -1, uv = -1, color = -1;
  int uv_bits = 0;
  bool is_one_feature = false;
};

void add_features(const std::vector<std::uint32_t>& features, draco::Mesh& mesh, Attributes& ids) {
  constexpr auto kKind = draco::GeometryAttribute::GENERIC;
  const auto [least, most] = std::minmax_element(features.begin(), features.end());
  ids.is_one_feature = *least == *most;
  ids.feature =
      *most <= kMaxIntegerId
          ? add_attribute<std::uint16_t, 1>(mesh, kKind, draco::DT_UINT16,
                                            as_scalars<std::uint16_t>(features))
          : add_attribute<float, 1>(mesh, kKind, draco::DT_FLOAT32, as_scalars<float>(features));
}

std::unique_ptr<draco::Mesh> as_draco(const FlatMesh& mesh, const QuantizationGrid& grid,
                                      Attributes& ids) {
  auto out = std::make_unique<draco::Mesh>();
  out->set_num_points(static_cast<std::uint32_t>(mesh.positions.size()));
  out->SetNumFaces(mesh.triangles.size());
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    draco::Mesh::Face face;
    for (int c = 0; c < 3; ++c) face[c] = static_cast<std::uint32_t>(mesh.triangles[f][c]);
    out->SetFace(draco::FaceIndex(static_cast<std::uint32_t>(f)), face);
  }
  std::vector<Vec3> rounded;
  for (const Vec3& p : mesh.positions) rounded.push_back(grid.round(p));
  using Kind = draco::GeometryAttribute;
  ids.position =
      add_attribute<float, 3>(*out, Kind::POSITION, draco::DT_FLOAT32, as_floats(rounded));
  if (!mesh.normals.empty())
    ids.normal =
        add_attribute<float, 3>(*out, Kind::NORMAL, draco::DT_FLOAT32, as_floats(mesh.normals));
  if (!mesh.feature_ids.empty()) add_features(mesh.feature_ids, *out, ids);
  if (!mesh.uvs.empty()) {
    std::vector<std::array<float, 2>> uvs;
    for (const Vec2f& uv : mesh.uvs) uvs.push_back({uv.x(), uv.y()});
    ids.uv = add_attribute<float, 2>(*out, Kind::TEX_COORD, draco::DT_FLOAT32, uvs);
    // Steps of a quarter of a texel.
    ids.uv_bits = std::clamp(
        static_cast<int>(std::ceil(std::log2(std::max(mesh.texture_side, 1)))) + 2, 8, 20);
  }
  if (!mesh.colors.empty()) {
    std::vector<std::array<std::uint16_t, 4>> colors;
    for (const Rgb& rgb : mesh.colors) colors.push_back(linear_color(rgb));
    ids.color = add_attribute<std::uint16_t, 4>(*out, Kind::COLOR, draco::DT_UINT16, colors);
  }
  out->DeduplicateAttributeValues();  // equal positions of neighbouring facets share connectivity
  out->DeduplicatePointIds();
  return out;
}

/// Written out in full: Draco's own setters keep six decimals, and steps are finer powers of two.
std::string in_full(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

draco::Options position_options(const QuantizationGrid& grid) {
  draco::Options options;
  options.SetInt("quantization_bits", grid.bits);
  options.SetString(
      "quantization_origin",
      in_full(grid.origin.x()) + ' ' + in_full(grid.origin.y()) + ' ' + in_full(grid.origin.z()));
  options.SetString("quantization_range", in_full(grid.range));
  return options;
}

std::string encode_at(const draco::Mesh& mesh, const Attributes& ids, const QuantizationGrid& grid,
                      const Packing& packing) {
  draco::ExpertEncoder encoder(mesh);
  encoder.SetSpeedOptions(packing.speed, kDecodingSpeed);
  encoder.options().SetAttributeOptions(ids.position, position_options(grid));
  if (ids.normal >= 0) encoder.SetAttributeQuantization(ids.normal, kNormalBits);
  if (ids.uv >= 0) encoder.SetAttributeQuantization(ids.uv, ids.uv_bits);
  if (packing.position != draco::PREDICTION_UNDEFINED)
    check(encoder.SetAttributePredictionScheme(ids.position, packing.position));
  if (ids.normal >= 0 && packing.normal != draco::PREDICTION_UNDEFINED)
    check(encoder.SetAttributePredictionScheme(ids.normal, packing.normal));
  if (ids.is_one_feature)  // nothing to predict; half of the 32 bytes that ids else take
    check(encoder.SetAttributePredictionScheme(ids.feature, draco::PREDICTION_NONE));
  draco::EncoderBuffer buffer;
  check(encoder.EncodeToBuffer(&buffer));
  return {buffer.data(), buffer.size()};
}

/// The same mesh, walked from another face on.
void turn_faces(draco::Mesh& mesh, std::size_t by) {
  std::vector<draco::Mesh::Face> faces;
  for (std::uint32_t f = 0; f < mesh.num_faces(); ++f)
    faces.push_back(mesh.face(draco::FaceIndex(f)));
  std::rotate(faces.begin(), faces.begin() + static_cast<std::ptrdiff_t>(by), faces.end());
  for (std::uint32_t f = 0; f < mesh.num_faces(); ++f) mesh.SetFace(draco::FaceIndex(f), faces[f]);
}

/// The shortest stream found.
std::string encode_shortest(draco::Mesh& mesh, const Attributes& ids,
                            const QuantizationGrid& grid) {
  std::vector<std::pair<std::string, Packing>> found;
  for (const Packing& packing : kPackings)
    found.emplace_back(encode_at(mesh, ids, grid, packing), packing);
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first.size() < b.first.size(); });
  std::string shortest = found[0].first;
  if (mesh.num_faces() > kMaxFacesToTurn) return shortest;
  std::size_t turned = 0;
  for (std::size_t k = 1; k < kStarts; ++k) {
    const std::size_t start = k * mesh.num_faces() / kStarts;
    if (start == turned) continue;
    turn_faces(mesh, start - turned);
    turned = start;
    for (int rank = 0; rank < 2; ++rank) {
      std::string bytes = encode_at(mesh, ids, grid, found[rank].second);
      if (bytes.size() < shortest.size()) shortest = std::move(bytes);
    }
  }
  return shortest;
}

/// What a client will see.
void read_back(DracoResult& result) {
  draco::DecoderBuffer buffer;
  buffer.Init(result.bytes.data(), result.bytes.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  check(decoded.status());
  const draco::Mesh& mesh = *decoded.value();
  result.vertices = mesh.num_points();
  result.faces = mesh.num_faces();
  const draco::PointAttribute* position =
      mesh.GetNamedAttribute(draco::GeometryAttribute::POSITION);
  if (!position) refuse("the positions got lost");
  const auto id_of = [&](draco::GeometryAttribute::Type kind) {
    const draco::PointAttribute* attribute = mesh.GetNamedAttribute(kind);
    return attribute ? static_cast<int>(attribute->unique_id()) : -1;
  };
  result.position_id = static_cast<int>(position->unique_id());
  result.normal_id = id_of(draco::GeometryAttribute::NORMAL);
  result.feature_id = id_of(draco::GeometryAttribute::GENERIC);
  result.uv_id = id_of(draco::GeometryAttribute::TEX_COORD);
  result.color_id = id_of(draco::GeometryAttribute::COLOR);
  Box box;
  for (std::uint32_t i = 0; i < result.vertices; ++i) {
    std::array<float, 3> p;
    position->GetMappedValue(draco::PointIndex(i), p.data());
    box.extend(Vec3(p[0], p[1], p[2]));
  }
  result.min = box.min, result.max = box.max;
}

}  // namespace

std::array<std::uint16_t, 4> linear_color(const Rgb& rgb) {
  std::array<std::uint16_t, 4> out = {0, 0, 0, 65535};
  for (std::size_t k = 0; k < 3; ++k)
    out[k] = static_cast<std::uint16_t>(std::lround(65535 * to_linear(rgb[k])));
  return out;
}

QuantizationGrid fit_grid(const Box& box, double bound) {
  double step = std::exp2(std::floor(std::log2(2 * bound / std::sqrt(3.0))));
  const double reach =
      box.is_empty() ? 0 : std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff());
  while (reach / step + 2 > (1 << 24)) step *= 2;
  return grid_about(box, step);
}

QuantizationGrid grid_about(const Box& box, double step) {
  QuantizationGrid grid;
  if (!box.is_empty()) grid.origin = (box.min / step).array().floor().matrix() * step;
  const double longest = box.is_empty() ? 0 : box.size().maxCoeff();
  const double cells = std::ceil(longest / step) + 1;
  grid.bits = std::clamp(static_cast<int>(std::ceil(std::log2(cells + 1))), 8, 24);
  grid.range = step * ((1 << grid.bits) - 1);
  return grid;
}

DracoResult encode_draco(const FlatMesh& mesh, const QuantizationGrid& grid) {
  if (mesh.triangles.empty()) refuse("a mesh without triangles");
  Attributes ids;
  const std::unique_ptr<draco::Mesh> input = as_draco(mesh, grid, ids);
  DracoResult result;
  result.bytes = encode_shortest(*input, ids, grid);
  read_back(result);
  if (result.faces != mesh.triangles.size()) refuse("the encoder lost faces");
  const bool has_all = (result.normal_id >= 0) == (ids.normal >= 0) &&
                       (result.feature_id >= 0) == (ids.feature >= 0) &&
                       (result.uv_id >= 0) == (ids.uv >= 0) &&
                       (result.color_id >= 0) == (ids.color >= 0);
  if (!has_all) refuse("an attribute got lost");
  return result;
}

DracoCounts stated_counts(const std::string& bytes) {
  constexpr std::size_t kHeader = 11;
  const auto fail = [](const char* cause) -> DracoCounts {
    throw Error(Stage::kInput, "draco", cause);
  };
  if (bytes.size() < kHeader + 1 || bytes.compare(0, 5, "DRACO") != 0) return fail("no stream");
  if (bytes[5] != 2 || bytes[6] != 2 || bytes[7] != 1) return fail("no mesh of version 2.2");
  if (bytes[9] != 0 || bytes[10] != 0) return fail("a stream with metadata is not read");
  const bool is_edgebreaker = bytes[8] == 1;  // which has a byte more, and vertices before faces
  std::size_t at = kHeader + (is_edgebreaker ? 1 : 0);
  const auto varint = [&] {
    std::size_t value = 0;
    for (int shift = 0; shift < 35 && at < bytes.size(); shift += 7) {
      const auto byte = static_cast<unsigned char>(bytes[at++]);
      value |= static_cast<std::size_t>(byte & 127) << shift;
      if (byte < 128) break;
    }
    return value;
  };
  const std::size_t first = varint(), second = varint();
  if (std::max(first, second) > kBestDraco * bytes.size()) return fail("cannot hold its counts");
  return is_edgebreaker ? DracoCounts{second, first} : DracoCounts{first, second};
}

DracoContent decode_draco(const std::string& bytes) {
  stated_counts(bytes);
  draco::DecoderBuffer buffer;
  buffer.Init(bytes.data(), bytes.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) throw Error(Stage::kInput, "draco", decoded.status().error_msg_string());
  const draco::Mesh& mesh = *decoded.value();
  DracoContent out;
  out.vertices = mesh.num_points();
  for (draco::FaceIndex f(0); f < mesh.num_faces(); ++f)
    out.faces.push_back({static_cast<int>(mesh.face(f)[0].value()),
                         static_cast<int>(mesh.face(f)[1].value()),
                         static_cast<int>(mesh.face(f)[2].value())});
  for (int a = 0; a < mesh.num_attributes(); ++a) {
    const draco::PointAttribute& attribute = *mesh.attribute(a);
    auto& values = out.attributes[static_cast<int>(attribute.unique_id())];
    values.components = attribute.num_components();
    std::vector<float> element(values.components);
    for (draco::PointIndex p(0); p < mesh.num_points(); ++p) {
      attribute.ConvertValue<float>(attribute.mapped_index(p), attribute.num_components(),
                                    element.data());
      values.values.insert(values.values.end(), element.begin(), element.end());
    }
  }
  return out;
}

}  // namespace colod
