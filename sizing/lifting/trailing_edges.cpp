#include "sizing/lifting/trailing_edges.hpp"

#include "parallel/communication/collective_error.hpp"
#include "sizing/features/local_chord.hpp"
#include "sizing/features/skin_faces.hpp"

#include <algorithm>
#include <set>

namespace aeroloom::sizing {
namespace {

using cad::FaceId;
using Kind = cad::BluntEdgeFinding::Kind;

/// Of the chord near by, at an end of an edge: less is a section through a tip. Chosen, not measured.
constexpr double least_end_fraction = 0.5;

/// The faces on both sides of a blunt trailing edge and those that go on from them, over kinks.
std::set<FaceId> skin_of(const cad::Model& model, const cad::BluntEdge& strip) {
  std::vector<FaceId> neighbours;
  for (const auto& border : strip.borders) {
    for (const cad::BorderEdge& each : border) neighbours.push_back(each.neighbour);
  }
  return skin_faces(model, neighbours, strip.face, Kinks::all);
}

/// Facets of those faces, and their border, without the blunt face itself.
Skin cover(const SampledModel& sampled, const std::set<FaceId>& faces, FaceId blunt_face) {
  constexpr int intervals = 32;  // of each edge of a border; chosen, not measured
  const cad::Model& model = sampled.model();
  Skin skin;
  for (const ModelFacet& facet : sampled.facets().items) {
    if (faces.contains(facet.face)) skin.facets.push_back(facet.corners);
  }
  for (const FaceId face : faces) {
    for (const auto& loop : model.face(face).loops) {
      for (const cad::Coedge& use : loop) {
        const cad::Edge& edge = model.edge(use.edge);
        const bool inside =
            edge.degenerate || std::all_of(edge.faces.begin(), edge.faces.end(),
                                           [&](FaceId f) { return f == blunt_face || faces.contains(f); });
        if (inside) continue;
        const double step = (edge.last_parameter - edge.first_parameter) / intervals;
        geometry::Vec3 last = model.edge_point(use.edge, edge.first_parameter);
        for (int i = 1; i <= intervals; ++i) {
          const geometry::Vec3 next = model.edge_point(use.edge, edge.first_parameter + i * step);
          skin.border.push_back({last, next});
          last = next;
        }
      }
    }
  }
  return skin;
}

TrailingEdge measure(const SampledModel& sampled, cad::BluntEdge strip) {
  const Skin skin = cover(sampled, skin_of(sampled.model(), strip), strip.face);
  TrailingEdge edge{std::move(strip)};
  const std::vector<cad::BluntStation>& stations = edge.strip.stations;
  std::vector<double> chords(stations.size());
  for (std::size_t i = 1; i + 1 < stations.size(); ++i) {
    const cad::BluntStation& at = stations[i];
    chords[i] = local_chord(skin, {at.place, at.along, at.into, at.width});
  }
  const auto beyond = [](double near, double farther) {
    return std::max(least_end_fraction * near, 2 * near - farther);
  };
  const std::size_t last = stations.size() - 1;
  chords[0] = beyond(chords[1], chords[2]);
  chords[last] = beyond(chords[last - 1], chords[last - 2]);
  edge.chord = *std::min_element(chords.begin(), chords.end());
  for (std::size_t i = 0; i < stations.size(); ++i)
    edge.fraction = std::max(edge.fraction, chords[i] > 0 ? stations[i].width / chords[i] : 1);
  return edge;
}

}  // namespace

std::vector<TrailingEdge> find_trailing_edges(const SampledModel& sampled, double width) {
  const parallel::Communicator& communicator = sampled.communicator();
  const cad::Model& model = sampled.model();
  std::vector<FaceId> mine;
  parallel::agree(communicator, [&] {
    // Distributed as areas are measured, which widths of faces take.
    for (FaceId f = communicator.rank(); f < model.face_count(); f += communicator.size()) {
      const cad::BluntEdgeFinding found = cad::examine_blunt_edge(model, f, 0);
      if (found.kind == Kind::closable && found.edge.narrowest < width) mine.push_back(f);
    }
  });
  std::vector<FaceId> all = communicator.gather_sorted(mine);
  std::vector<TrailingEdge> edges;
  parallel::agree(communicator, [&] {
    for (const FaceId f : all) edges.push_back(measure(sampled, cad::examine_blunt_edge(model, f, 0).edge));
  });
  return edges;
}

}  // namespace aeroloom::sizing
