#include "cad/read/cad_facts.hpp"

#include "cad/faceted/facet_soup.hpp"
#include "cad/faceted/faceted_domain.hpp"
#include "cad/model/model_data.hpp"
#include "cad/model/occ_guard.hpp"
#include "cad/model/scaled_model.hpp"
#include "cad/model/shape_map.hpp"
#include "cad/read/cad_reader.hpp"

#include <map>

#include <TopoDS.hxx>

namespace aeroloom::cad {
namespace {

using Counts = std::map<std::string, std::int32_t>;

std::vector<NamedFaces> listed(const Counts& counts) {
  std::vector<NamedFaces> list;
  for (const auto& [name, faces] : counts) {
    if (!name.empty()) list.push_back({name, faces});
  }
  return list;
}

void list_labels(const NamedShape& named, CadFacts& facts) {
  const TopTools_IndexedMapOfShape faces = map_of(named.shape, TopAbs_FACE);
  Counts parts, names, layers, colours;
  for (int i = 1; i <= faces.Extent(); ++i) {
    const FaceLabel* label = named.labels.Seek(faces(i));
    if (label == nullptr) continue;
    ++parts[label->solid];
    ++names[label->name];
    ++layers[label->layer];
    ++colours[label->colour];
    facts.face_table.push_back({shown_name(*label), label->solid, label->layer, label->colour,
                                scaled(place_of(TopoDS::Face(faces(i))), named.unit)});
  }
  facts.parts = listed(parts);
  facts.face_names = listed(names);
  facts.layers = listed(layers);
  facts.colours = listed(colours);
}

}  // namespace

CadFacts look_at_cad_file(const std::string& file, const std::string& encoding) {
  if (is_faceted_file(file)) return look_at_faceted_file(file, encoding);
  CadFacts facts;
  facts.format = format_of_cad_file(file);
  guarded("looking at the geometry", [&] {
    const NamedShape named = read_cad_file(file, encoding);
    facts.unit_name = named.unit_name;
    facts.unit_in_metres = named.unit_in_metres;
    facts.bounds = scaled(tight_box(named.shape), named.unit);
    facts.solids = map_of(named.shape, TopAbs_SOLID).Extent();
    facts.shells = map_of(named.shape, TopAbs_SHELL).Extent();
    facts.faces = map_of(named.shape, TopAbs_FACE).Extent();
    facts.edges = map_of(named.shape, TopAbs_EDGE).Extent();
    list_labels(named, facts);
  });
  return facts;
}

}  // namespace aeroloom::cad
