#include "cad/faceted/faceted_bytes.hpp"
#include "cad/model/evaluation/face_cache.hpp"
#include "cad/model/library_unit.hpp"
#include "cad/model/model_bytes.hpp"
#include "cad/model/model_data.hpp"
#include "cad/model/occ_guard.hpp"
#include "cad/model/scaled_model.hpp"
#include "cad/model/shape_map.hpp"
#include "cad/model/step_trace.hpp"
#include "cad/model/topology/blunt_edges.hpp"
#include "cad/model/topology/model_topology.hpp"

#include <algorithm>
#include <cstring>
#include <sstream>

#include <BRepTools.hxx>
#include <BinTools.hxx>
#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

constexpr std::uint64_t magic = 0x354d4c4145524f41;  // "AOREALM5"

/// Of everything, and of all that is not far field.
struct Bounds {
  Box all, body;
};

Bounds bounds_of(const TopTools_IndexedMapOfShape& faces, const FacetedGeometry* faceted,
                 const std::vector<FaceTag>& tags) {
  std::vector<TopoDS_Shape> body, far_field;
  for (int i = 1; i <= faces.Extent(); ++i) (tags[i - 1].far_field ? far_field : body).push_back(faces(i));
  Box of_body = tight_box(body), of_far_field = tight_box(far_field);
  for (std::size_t t = 0; faceted && t < faceted->complex().triangles.size(); ++t) {
    const FacetComplex& complex = faceted->complex();
    const bool far = tags[faces.Extent() + complex.face_of[t]].far_field;
    for (const Vec3 p : corners_of(complex, static_cast<std::int32_t>(t)))
      (far ? of_far_field : of_body).add(p);
  }
  Box all = of_far_field;
  if (!of_body.empty()) all.add(of_body);
  return {all, of_body.empty() ? all : of_body};
}

void put_labels(const NamedShape& named, const FacetedGeometry* faceted, const std::vector<FaceTag>& tags,
                ByteWriter& writer) {
  writer.put_text(named.unit_name);
  writer.put(named.unit_in_metres);
  writer.put(named.gap);
  std::vector<std::string> regions = region_names(named);
  if (faceted)
    regions.insert(regions.end(), faceted->complex().regions.begin(), faceted->complex().regions.end());
  writer.put_texts(regions);
  writer.put<std::uint64_t>(tags.size());
  for (const FaceTag& tag : tags) {
    writer.put_text(tag.name);
    writer.put_text(tag.patch);
    writer.put<char>(tag.far_field);
    for (const std::string* text : {&tag.part, &tag.layer, &tag.colour}) writer.put_text(*text);
    writer.put(tag.number);
  }
}

std::vector<FaceTag> get_labels(ByteReader& reader, Model::Data& data) {
  data.unit_name = reader.get_text();
  data.unit_in_metres = reader.get<double>();
  data.gap = reader.get<double>();
  data.region_names = reader.get_texts();
  std::vector<FaceTag> tags(reader.get<std::uint64_t>());
  for (FaceTag& tag : tags) {
    tag.name = reader.get_text();
    tag.patch = reader.get_text();
    tag.far_field = reader.get<char>() != 0;
    for (std::string* text : {&tag.part, &tag.layer, &tag.colour}) *text = reader.get_text();
    tag.number = reader.get<std::int32_t>();
  }
  return tags;
}

void apply_tags(const std::vector<FaceTag>& tags, Model::Data& data) {
  if (tags.size() != data.faces.size()) throw CadError("the model's bytes disagree with its shape");
  for (std::size_t i = 0; i < tags.size(); ++i) {
    Face& face = data.faces[i];
    face.name = tags[i].name.empty() ? fmt::format("face_{}", i) : tags[i].name;
    face.part = tags[i].part, face.layer = tags[i].layer, face.colour = tags[i].colour;
    face.number = tags[i].number;
    face.patch = patch_number(data.patches, tags[i].patch.empty() ? face.name : tags[i].patch);
    data.far_field.push_back(tags[i].far_field);
  }
}

}  // namespace

/// A region is called as the solid of its faces; a face between two regions may carry the other one's label.
std::vector<std::string> region_names(const NamedShape& named) {
  const TopTools_IndexedMapOfShape solids = map_of(named.shape, TopAbs_SOLID);
  const TopTools_IndexedMapOfShape faces = map_of(named.shape, TopAbs_FACE);
  const std::vector<std::vector<int>> around = solids_around_faces(named.shape);
  std::vector<std::string> names(solids.Extent());
  for (const std::size_t most : {1, 2}) {
    for (int f = 1; f <= faces.Extent(); ++f) {
      const FaceLabel* label = named.labels.Seek(faces(f));
      if (label == nullptr || around[f - 1].size() > most) continue;
      for (const int solid : around[f - 1]) {
        if (names[solid].empty()) names[solid] = label->solid;
      }
    }
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i].empty()) names[i] = fmt::format("region_{}", i);
  }
  return names;
}

std::vector<std::vector<int>> solids_around_faces(const TopoDS_Shape& shape) {
  const TopTools_IndexedMapOfShape solids = map_of(shape, TopAbs_SOLID);
  const TopTools_IndexedMapOfShape faces = map_of(shape, TopAbs_FACE);
  std::vector<std::vector<int>> around(faces.Extent());
  for (int i = 1; i <= solids.Extent(); ++i) {
    const TopTools_IndexedMapOfShape own = map_of(solids(i), TopAbs_FACE);
    for (int f = 1; f <= own.Extent(); ++f) around[faces.FindIndex(own(f)) - 1].push_back(i - 1);
  }
  return around;
}

Model build_model(const NamedShape& named, const std::vector<FaceTag>& tags, const FacetedGeometry* faceted) {
  report_step("building the model");
  return guarded("building the model", [&] {
    TopTools_IndexedMapOfShape faces;
    std::ostringstream stream;
    if (!named.shape.IsNull()) {
      TopExp::MapShapes(named.shape, TopAbs_FACE, faces);
      BRepTools::Clean(named.shape);
      BinTools::Write(named.shape, stream, false, false, BinTools_FormatVersion_CURRENT);
    }
    ByteWriter writer;
    writer.put(magic);
    put_labels(named, faceted, tags, writer);
    const Bounds bounds = bounds_of(faces, faceted, tags);
    writer.put(bounds.all);
    writer.put(bounds.body);
    writer.put_text(stream.str());
    put_faceted(faceted, writer);
    writer.put<std::uint64_t>(0);  // strips closed
    return Model::from_bytes(writer.bytes);
  });
}

std::vector<std::byte> with_closed_edges(std::span<const std::byte> bytes,
                                         const std::vector<FaceId>& strips) {
  ByteWriter writer;
  const std::span<const std::byte> shape = bytes.first(bytes.size() - sizeof(std::uint64_t));
  writer.bytes.assign(shape.begin(), shape.end());
  writer.put<std::uint64_t>(strips.size());
  for (const FaceId strip : strips) writer.put(strip);
  return std::move(writer.bytes);
}

Model Model::from_bytes(std::span<const std::byte> bytes) {
  return guarded("rebuilding the model from its bytes", [&] {
    if (are_of_scaled_model(bytes)) return scaled_from_bytes(bytes);
    ByteReader reader(bytes);
    if (reader.get<std::uint64_t>() != magic) throw CadError("these bytes are no model of this version");
    auto data = std::make_shared<Model::Data>();
    const std::vector<FaceTag> tags = get_labels(reader, *data);
    data->bounds = reader.get<Box>();
    data->body_bounds = reader.get<Box>();
    const std::string shape = reader.get_text();
    data->faceted = get_faceted(reader);
    if (!shape.empty()) {
      std::istringstream stream(shape);
      BinTools::Read(data->shape, stream);
    }
    if (data->shape.IsNull() && !data->faceted) throw CadError("the model's bytes hold no shape");
    if (!data->shape.IsNull()) index_topology(*data);
    if (data->faceted) number_facets(*data);
    apply_tags(tags, *data);
    data->cache = std::make_shared<FaceCache>(data->faces.size());
    std::vector<FaceId> strips(reader.get<std::uint64_t>());
    for (FaceId& strip : strips) strip = reader.get<FaceId>();
    if (strips.empty()) {
      data->bytes.assign(bytes.begin(), bytes.end());
      return Model(std::move(data));
    }
    data->bytes = with_closed_edges(bytes.first(bytes.size() - strips.size() * sizeof(FaceId)), {});
    const Model open(std::move(data));
    std::vector<BluntEdge> edges;
    edges.reserve(strips.size());
    for (const FaceId strip : strips) edges.push_back(examine_blunt_edge(open, strip, 0).edge);
    return close_blunt_edges(open, edges);
  });
}

std::string Model::Data::describe_face(FaceId id) const {
  Vec3 at;
  if (const FacetedGeometry* faceted = faceted_face(id)) {
    at = faceted->complex().points[faceted->faces()[id - first_faceted_face].points.front()];
  } else {
    const FaceEvaluator& face = face_evaluators.at(id);
    at = face.surface.point(0.5 * (face.uv_low + face.uv_high));
  }
  const std::string& name = static_cast<std::size_t>(id) < faces.size() ? faces[id].name : std::string();
  return fmt::format("face {} '{}' near {}", id, name, place_in_file(at));
}

}  // namespace aeroloom::cad
