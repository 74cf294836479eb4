#include "surface/curves/curve_segments.hpp"

#include <algorithm>
#include <cmath>

namespace aeroloom::surface {
namespace {

using cad::Model;

int least_of_edge(const Model& model, const EdgeMeasure& measure) {
  const cad::Edge& edge = model.edge(measure.edge);
  if (edge.first != edge.last) return 1;
  constexpr double three_quarters = 4.7;  // of a full turn: a triangle is a poor circle, but fits a teardrop
  return measure.turning > three_quarters ? least_of_loop + 1 : least_of_loop;
}

/// Leaves one single segment, the straightest, among the edges that join the same two vertices.
void separate_parallel_edges(const Model& model, const std::vector<EdgeMeasure>& measures,
                             std::vector<int>& segments) {
  struct Joint {
    cad::VertexId low, high;
    double excess;  // of length over chord
    cad::EdgeId edge;
  };
  std::vector<Joint> joints;
  for (const EdgeMeasure& measure : measures) {
    const cad::Edge& edge = model.edge(measure.edge);
    joints.push_back({std::min(edge.first, edge.last), std::max(edge.first, edge.last),
                      measure.length - measure.chord, measure.edge});
  }
  std::sort(joints.begin(), joints.end(), [](const Joint& a, const Joint& b) {
    return std::tie(a.low, a.high, a.excess, a.edge) < std::tie(b.low, b.high, b.excess, b.edge);
  });
  bool taken = false;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (i == 0 || joints[i].low != joints[i - 1].low || joints[i].high != joints[i - 1].high) taken = false;
    int& count = segments[joints[i].edge];
    if (count == 1 && taken) count = 2;
    taken = taken || count == 1;
  }
}

/// Adds segments to the longest edge of every loop that would have fewer than three.
void close_loops(const Model& model, const std::vector<double>& lengths, std::vector<int>& segments) {
  for (cad::FaceId f = 0; f < model.face_count(); ++f) {
    for (const auto& loop : model.face(f).loops) {
      int total = 0;
      cad::EdgeId longest = cad::no_entity;
      for (const auto& use : loop) {
        total += segments[use.edge];
        if (segments[use.edge] == 0) continue;
        if (longest == cad::no_entity || lengths[use.edge] > lengths[longest]) longest = use.edge;
      }
      if (longest != cad::no_entity && total < least_of_loop) segments[longest] += least_of_loop - total;
    }
  }
}

}  // namespace

std::vector<int> count_segments(const Model& model, std::vector<EdgeMeasure> measures) {
  std::sort(measures.begin(), measures.end(),
            [](const EdgeMeasure& a, const EdgeMeasure& b) { return a.edge < b.edge; });
  std::vector<int> segments(model.edge_count(), 0);
  std::vector<double> lengths(model.edge_count(), 0);
  for (const EdgeMeasure& measure : measures) {
    const double wanted = std::min(std::round(measure.metric_length), most_segments);
    segments[measure.edge] = std::max(least_of_edge(model, measure), static_cast<int>(wanted));
    lengths[measure.edge] = measure.length;
  }
  separate_parallel_edges(model, measures, segments);
  close_loops(model, lengths, segments);
  return segments;
}

}  // namespace aeroloom::surface
