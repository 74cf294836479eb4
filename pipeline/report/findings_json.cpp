#include "pipeline/report/findings_json.hpp"

#include "pipeline/report/change_json.hpp"
#include "sizing/choice/feature_resolution.hpp"

#include <utility>

namespace aeroloom::report {

nlohmann::ordered_json to_json(const std::vector<domain::NamedBound>& faces) {
  auto json = nlohmann::ordered_json::array();
  for (const domain::NamedBound& each : faces)
    json.push_back({{"face", each.face},
                    {"fraction", each.fraction},
                    {"degrees", each.degrees},
                    {"share_of_body", each.body_fraction}});
  return json;
}

nlohmann::ordered_json to_json(const domain::TrailingEdgeReport& report) {
  auto edges = nlohmann::ordered_json::array();
  for (const domain::JudgedEdge& edge : report) {
    edges.push_back({{"face", edge.name},
                     {"fate", domain::name_of(edge.fate)},
                     {"what", edge.what},
                     {"at", to_json(edge.place)},
                     {"length", edge.length},
                     {"narrowest", edge.narrowest},
                     {"widest", edge.widest},
                     {"chord", edge.chord},
                     {"width_over_chord", edge.width_over_chord},
                     {"aspect", edge.aspect},
                     {"moved", edge.fate == domain::EdgeFate::closed ? domain::moved(edge) : 0.0}});
  }
  return edges;
}

nlohmann::ordered_json to_json(const domain::FeatureReport& report) {
  auto regions = nlohmann::ordered_json::array();
  for (const domain::UnresolvedRegion& region : report.regions) {
    regions.push_back({{"face", region.face},
                       {"width", region.width},
                       {"at", to_json(region.place)},
                       {"surface_degrees", region.surface_degrees}});
  }
  const bool nothing = report.resolution.aspect == sizing::no_aspect;
  double smallest = nothing ? report.resolution.minimum : report.resolution.floor;
  if (!regions.empty()) {
    const double width = report.regions.front().width;
    smallest = width * report.resolution.aspect_at(width);
  }
  return {{"aspect", nothing ? nlohmann::ordered_json() : nlohmann::ordered_json(report.resolution.aspect)},
          {"smallest_size", smallest},
          {"share", report.resolution.ratio},
          {"smallest_gap_size", report.resolution.gap_floor},
          {"gap_share", report.resolution.gap_ratio},
          {"predicted_tetrahedra", report.tetrahedra},
          {"wanted_tetrahedra", report.wanted_tetrahedra()},
          {"unresolved", std::move(regions)}};
}

nlohmann::ordered_json to_json(const domain::WallFindings& walls) {
  auto unseen = nlohmann::ordered_json::array(), coincident = nlohmann::ordered_json::array();
  for (const domain::UnseenWalls& each : walls.unseen)
    unseen.push_back({{"face", each.face}, {"at", to_json(each.place)}, {"size", each.size}});
  for (const domain::FacesOnOneAnother& each : walls.coincident) {
    coincident.push_back({{"faces", {each.first, each.second}},
                          {"area", each.area},
                          {"at", to_json(each.place)},
                          {"apart", each.apart}});
  }
  return {{"gaps_not_searched", std::move(unseen)}, {"coincident_faces", std::move(coincident)}};
}

}  // namespace aeroloom::report
