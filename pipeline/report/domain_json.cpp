#include "pipeline/report/change_json.hpp"
#include "pipeline/report/findings_json.hpp"
#include "pipeline/report/parts_json.hpp"

namespace aeroloom::report {
Json geometry_json(const RunRecord& record) {
  Json json;
  json["unit"] = record.unit;
  json["unit_in_metres"] = record.unit_in_metres;
  if (!record.bounds.empty()) json["bounds"] = {to_json(record.bounds.low), to_json(record.bounds.high)};
  json["regions"] = record.regions;
  json["faces"] = record.faces;
  json["edges"] = record.edges;
  json["domain"] = record.domain.kind == cad::DomainKind::fluid  ? "fluid"
                   : record.domain.kind == cad::DomainKind::body ? "body"
                                                                 : "auto";
  json["domain_reason"] = record.domain.reason;
  json["reference_length"] = record.domain.reference_length;
  json["changes"] = to_json(record.domain.changes);
  return json;
}

Json sizing_json(const RunRecord& record) {
  const domain::SizingFindings& findings = record.findings;
  return {{"features", findings.features ? to_json(*findings.features) : Json()},
          {"bounded_by_minimum", to_json(findings.bounded)},
          {"walls", to_json(findings.walls)},
          {"minimum", record.sizes.minimum},
          {"feature_minimum", sizing::smallest_feature_size(record.sizes)},
          {"strip_minimum", sizing::smallest_narrow_size(record.sizes)},
          {"gap_minimum", sizing::smallest_gap_size(record.sizes)},
          {"maximum", record.sizes.maximum},
          {"surface_maximum", record.sizes.surface_maximum},
          {"curvature_angle", record.sizes.curvature_angle},
          {"chordal_deviation", record.sizes.chordal_deviation},
          {"growth", record.sizes.growth},
          {"trailing_edges", to_json(findings.edges)},
          {"joined_faces", to_json(findings.joined.changes)},
          {"far_field", findings.far_field},
          {"missed_target", findings.missed_target.empty() ? Json() : Json(findings.missed_target)},
          {"octree_leaves", record.size_field_leaves}};
}

}  // namespace aeroloom::report
