#include "pipeline/case/layer_gate.hpp"
#include "pipeline/case/quality_gate.hpp"
#include "pipeline/report/change_json.hpp"
#include "pipeline/report/mixed_quality_json.hpp"
#include "pipeline/report/parts_json.hpp"
#include "pipeline/report/places_json.hpp"
#include "pipeline/report/solver_quality_json.hpp"

#include <cstdint>
#include <set>
#include <string>
#include <vector>

namespace aeroloom::report {

namespace {

/// Over triangles whose columns are of unequal heights.
std::int64_t tetrahedra_of_layers(const RunRecord& record) {
  std::int64_t count = 0;
  if (!record.layers) return count;
  for (const layers::PatchLayers& patch : record.layers->report.patches) count += patch.tetrahedra;
  return count;
}

}  // namespace

Json mesh_json(const RunRecord& record) {
  return {{"points", record.counts.vertices},
          {"tetrahedra", record.counts.of(mesh::CellShape::tetrahedron)},
          {"layer_tetrahedra", tetrahedra_of_layers(record)},
          {"prisms", record.counts.prisms},
          {"pyramids", record.counts.pyramids},
          {"hexahedra", record.counts.hexahedra},
          {"boundary_triangles", record.counts.boundary_triangles},
          {"boundary_quadrilaterals", record.counts.boundary_quads},
          {"volume", record.mesh_volume},
          {"hash", record.hash}};
}

namespace {

Json distribution_json(const mesh::Distribution& d) {
  return {
      {"minimum", d.minimum},
      {"maximum", d.maximum},
      {"mean", d.mean},
      {"percentile_0.1", d.percentile_01},
      {"percentile_1", d.percentile_1},
      {"percentile_5", d.percentile_5},
      {"histogram", {{"low", d.histogram.low}, {"high", d.histogram.high}, {"counts", d.histogram.counts}}}};
}

Json gate_json(const cases::Case& input, const RunRecord& record) {
  Json limits = Json::array();
  std::vector<cases::GateLimit> rows =
      cases::compare_with_gate(input.gate, *record.quality, record.pinned, record.measured_cells());
  if (record.layers) {
    const auto more =
        cases::compare_with_gate(input.layers.gate, record.layers->asked, record.layers->report);
    rows.insert(rows.end(), more.begin(), more.end());
  }
  for (const cases::GateLimit& row : rows) {
    limits.push_back({{"key", row.key},
                      {"limit", row.limit},
                      {"side", row.at_most ? "at most" : "at least"},
                      {"value", row.value},
                      {"met", row.met()}});
  }
  return limits;
}

}  // namespace

Json quality_json(const cases::Case& input, const RunRecord& record) {
  const mesh::QualitySummary& quality = *record.quality;
  Json json = {{"min_dihedral_deg", quality.min_dihedral.minimum},
               {"max_dihedral_deg", quality.max_dihedral.maximum},
               {"min_mean_ratio", quality.mean_ratio.minimum},
               {"mean_mean_ratio", quality.mean_ratio.mean},
               {"min_dihedral", distribution_json(quality.min_dihedral)},
               {"max_dihedral", distribution_json(quality.max_dihedral)},
               {"mean_ratio", distribution_json(quality.mean_ratio)},
               {"radius_ratio", distribution_json(quality.radius_ratio)}};
  json["gate"] = gate_json(input, record);
  json["worst"] = Json::array();
  for (const mesh::WorstCell& cell : quality.worst) {
    json["worst"].push_back(
        {{"min_dihedral_deg", cell.value}, {"cell", cell.cell}, {"center", to_json(cell.center)}});
  }
  json["flaws"] = to_json(worst_flaws(record));
  json["places"] = to_json(worst_places(record));
  if (record.solver) json["solver"] = to_json(*record.solver);
  if (!record.cells) return json;
  json["cells"] = to_json(*record.cells);
  json["cells"].erase("places");
  return json;
}

Json patches_json(const RunRecord& record) {
  Json json = Json::array();
  for (const PatchRow& patch : record.patches) {
    json.push_back({{"name", patch.name},
                    {"type", mesh::name_of(patch.type)},
                    {"area", patch.area},
                    {"cad_area", patch.cad_area > 0 ? Json(patch.cad_area) : Json()},
                    {"triangles", patch.triangles},
                    {"inner", patch.inner}});
  }
  return json;
}

Json faces_json(const cases::Case& input, const RunRecord& record) {
  std::set<std::string> groups;
  for (const cases::GroupRule& rule : input.groups.rules) groups.insert(rule.name);
  Json json = Json::array();
  for (const FaceRow& face : record.face_table) {
    json.push_back({{"id", face.number >= 0 ? Json(face.number) : Json()},
                    {"name", face.name},
                    {"group", groups.count(face.patch) > 0 ? Json(face.patch) : Json()},
                    {"patch", face.patch},
                    {"area", face.area},
                    {"cad_area", face.cad_area},
                    {"triangles", face.triangles}});
  }
  return json;
}

Json regions_json(const RunRecord& record) {
  Json json = Json::array();
  for (const RegionRow& region : record.regions_filled) {
    json.push_back({{"name", region.name},
                    {"volume", region.volume},
                    {"cad_volume", region.cad_volume > 0 ? Json(region.cad_volume) : Json()},
                    {"tetrahedra", region.tetrahedra}});
  }
  return json;
}

}  // namespace aeroloom::report
