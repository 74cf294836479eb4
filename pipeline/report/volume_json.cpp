#include "pipeline/report/change_json.hpp"
#include "pipeline/report/parts_json.hpp"

namespace aeroloom::report {
namespace {

std::string face_name(const RunRecord& record, std::int32_t face) {
  return face >= 0 && static_cast<std::size_t>(face) < record.face_names.size() ? record.face_names[face]
                                                                                : std::string("unknown");
}

/// Angles are null where there are no such tetrahedra.
Json missed_target_json(const attribution::MissedTarget& kind) {
  const bool any = kind.tetrahedra > 0;
  return {{"tetrahedra", kind.tetrahedra},
          {"smallest_dihedral_deg", any ? Json(kind.smallest_angle) : Json()},
          {"largest_dihedral_deg", any ? Json(kind.largest_angle) : Json()}};
}

}  // namespace

Json unresolved_json(const RunRecord& record) {
  Json list = Json::array();
  for (const attribution::UnresolvedFeature& feature : record.pinned.features) {
    const bool is_gap = feature.opposite >= 0;
    list.push_back({{"kind", is_gap ? "gap" : "strip"},
                    {"face", face_name(record, feature.face)},
                    {"opposite", is_gap ? Json(face_name(record, feature.opposite)) : Json()},
                    {"width", feature.width},
                    {"at", to_json(feature.at)},
                    {"tetrahedra", feature.tetrahedra},
                    {"smallest_dihedral_deg", feature.smallest_dihedral}});
  }
  return list;
}

Json pinned_json(const RunRecord& record) {
  Json list = Json::array();
  const auto name = [&](std::int32_t face) { return face_name(record, face); };
  for (const attribution::PinningEntity& entity : record.pinned.entities) {
    const bool between_faces = entity.kind == attribution::PinningEntity::Kind::faces;
    Json item = {{"kind", between_faces ? "faces" : "curves"},
                 {"angle_deg", entity.angle},
                 {"smallest_dihedral_deg", entity.smallest_dihedral},
                 {"tetrahedra", entity.tetrahedra},
                 {"at", {entity.at.x, entity.at.y, entity.at.z}}};
    item["faces"] = Json::array({name(entity.faces[0])});
    if (entity.faces[1] != entity.faces[0]) item["faces"].push_back(name(entity.faces[1]));
    if (!between_faces) item["cad_vertex"] = entity.vertex;
    list.push_back(std::move(item));
  }
  return list;
}

Json volume_json(const RunRecord& record) {
  const volume::DecompositionReport& decomposition = record.decomposition;
  Json retries = Json::array(), disagreements = Json::array();
  for (const volume::Retry& retry : record.volume.retries)
    retries.push_back({{"zone", retry.zone}, {"change", retry.change}, {"reason", retry.reason}});
  for (const volume::Disagreement& disagreement : record.volume.disagreements) {
    disagreements.push_back({{"place", to_json(disagreement.place)},
                             {"zone", disagreement.zone},
                             {"faces", disagreement.faces},
                             {"round", disagreement.round}});
  }
  return {{"zones", decomposition.zones},
          {"blocks", decomposition.blocks},
          {"lattice_points", decomposition.lattice_points},
          {"shell_points", decomposition.shell_points},
          {"core_tetrahedra", record.volume.core_tetrahedra},
          {"left_core", record.volume.left_core},
          {"expected_tetrahedra", decomposition.expected_tetrahedra},
          {"overlap", record.volume.overlap},
          {"imbalance", decomposition.imbalance},
          {"rounds", record.volume.rounds},
          {"steiner_points", record.volume.steiner_points},
          {"retries", retries},
          {"disagreements", disagreements},
          {"load_error_90", record.volume.load_error_90},
          {"good_edges", record.conformity.good_edges},
          {"fair_edges", record.conformity.fair_edges},
          {"mean_edge", record.conformity.mean_edge},
          {"bytes_per_tetrahedron", record.conformity.bytes_per_cell}};
}

Json improve_json(const cases::Case& input, const RunRecord& record) {
  return {{"enabled", input.improve.enabled},
          {"target_angle_deg", input.improve.target_angle},
          {"bad_before", record.improve.bad_before},
          {"bad_after", record.improve.bad_after},
          {"smoothed", record.improve.smoothed},
          {"replaced_cavities", record.improve.replaced},
          {"slid", record.improve.slid},
          {"changed_triangles", record.improve.changed_triangles},
          {"pinned_tetrahedra", record.pinned.tetrahedra},
          {"unpinned_below_target", record.pinned.others},
          {"below_target",
           {{"pinned", missed_target_json(record.pinned.pinned)},
            {"unresolved_features", missed_target_json(record.pinned.at_features)},
            {"held_by_surface", missed_target_json(record.pinned.held)},
            {"beside", missed_target_json(record.pinned.beside)},
            {"rest", missed_target_json(record.pinned.rest)}}}};
}

}  // namespace aeroloom::report
