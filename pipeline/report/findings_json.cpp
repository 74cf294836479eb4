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
                    {"share_of_body", each.share_of_body}});
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
                     {"width_over_chord", edge.share},
                     {"aspect", edge.aspect},
                     {"moved", edge.fate == domain::EdgeFate::closed ? domain::moved(edge) : 0.0}});
  }
  return edges;
}

nlohmann::ordered_json to_json(const domain::FeatureReport& report) {
  auto strips = nlohmann::ordered_json::array();
  for (const domain::UnresolvedStrip& strip : report.strips) {
    strips.push_back({{"face", strip.face},
                      {"width", strip.width},
                      {"at", to_json(strip.place)},
                      {"surface_degrees", strip.surface_degrees}});
  }
  const bool nothing = report.share.aspect == sizing::no_aspect;
  double smallest = nothing ? report.share.minimum : report.share.floor;
  if (!strips.empty()) {
    const double width = report.strips.front().width;
    smallest = width * report.share.aspect_at(width);
  }
  return {{"aspect", nothing ? nlohmann::ordered_json() : nlohmann::ordered_json(report.share.aspect)},
          {"smallest_size", smallest},
          {"share", report.share.ratio},
          {"smallest_gap_size", report.share.gap_floor},
          {"gap_share", report.share.gap_ratio},
          {"predicted_tetrahedra", report.tetrahedra},
          {"wanted_tetrahedra", report.wanted_tetrahedra()},
          {"unresolved", std::move(strips)}};
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
