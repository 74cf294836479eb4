#include "surface/coarse_curves.hpp"

#include "surface/curve_segments.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace aeroloom::surface {
namespace {

using geometry::EdgeId;
using geometry::Model;
using geometry::Vec3;

/// The constraining edges of a face, ascending, each once.
std::vector<EdgeId> edges_of(const Model& model, geometry::FaceId face) {
  std::vector<EdgeId> edges;
  for (const auto& loop : model.face(face).loops) {
    for (const geometry::EdgeUse& use : loop) {
      if (is_constraining(model, use.edge)) edges.push_back(use.edge);
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

double angle_between(Vec3 a, Vec3 b) {
  return std::atan2(norm(cross(a, b)), dot(a, b));
}

/// How many coarse segments the chain up to each of its vertices is worth.
std::vector<double> cumulate(const CurveMesh& fine, const std::vector<CurveVertex>& chain, double factor,
                             double largest_turn) {
  std::vector<double> worth{0};
  const auto step = [&](std::size_t i) { return fine.points[chain[i]] - fine.points[chain[i - 1]]; };
  for (std::size_t i = 1; i < chain.size(); ++i) {
    double turn = 0;  // half of it at each end
    if (i > 1) turn += 0.5 * angle_between(step(i - 1), step(i));
    if (i + 1 < chain.size()) turn += 0.5 * angle_between(step(i), step(i + 1));
    worth.push_back(worth.back() + std::max(1 / factor, turn / largest_turn));
  }
  return worth;
}

EdgeMeasure measure(const CurveMesh& fine, const std::vector<CurveVertex>& chain, EdgeId edge, double worth) {
  EdgeMeasure result{edge, worth, 0, distance(fine.points[chain.front()], fine.points[chain.back()]), 0};
  for (std::size_t i = 1; i < chain.size(); ++i) {
    const Vec3 step = fine.points[chain[i]] - fine.points[chain[i - 1]];
    result.length += norm(step);
    if (i > 1) {
      result.turning += angle_between(fine.points[chain[i - 1]] - fine.points[chain[i - 2]], step);
    }
  }
  return result;
}

/// Indices of the chain's vertices to keep, ends included.
std::vector<std::size_t> choose(const std::vector<double>& worth, std::size_t segments) {
  const std::size_t last = worth.size() - 1;
  std::vector<std::size_t> kept{0};
  for (std::size_t k = 1; k < segments; ++k) {
    const double wanted = worth.back() * static_cast<double>(k) / static_cast<double>(segments);
    auto at = static_cast<std::size_t>(std::lower_bound(worth.begin(), worth.end(), wanted) - worth.begin());
    if (at > 0 && wanted - worth[at - 1] < worth[at] - wanted) --at;
    // Every coarse segment has a fine one at least.
    kept.push_back(std::clamp(at, kept.back() + 1, last - (segments - k)));
  }
  kept.push_back(last);
  return kept;
}

}  // namespace

CoarseCurves coarsen_curves(const Model& model, const CurveMesh& fine, geometry::FaceId face, double factor,
                            double largest_turn) {
  const std::vector<EdgeId> edges = edges_of(model, face);
  std::vector<EdgeMeasure> measures;
  std::vector<std::vector<double>> worth;
  for (const EdgeId edge : edges) {
    const auto chain = fine.chain(model, edge);
    worth.push_back(cumulate(fine, chain, factor, largest_turn));
    measures.push_back(measure(fine, chain, edge, worth.back().back()));
  }
  const std::vector<int> segments = count_segments(model, measures);

  CoarseCurves coarse;
  coarse.curves.points.assign(fine.points.begin(), fine.points.begin() + model.vertex_count());
  for (CurveVertex v = 0; v < model.vertex_count(); ++v) coarse.fine_vertex.push_back(v);
  coarse.curves.first_interior.assign(model.edge_count() + 1, model.vertex_count());
  std::size_t next = 0;
  for (EdgeId e = 0; e < model.edge_count(); ++e) {
    coarse.curves.first_interior[e] = static_cast<std::int32_t>(coarse.curves.points.size());
    if (next == edges.size() || edges[next] != e) continue;
    const auto chain = fine.chain(model, e);
    const auto parameters = fine.chain_parameters(model, e);
    const std::size_t wanted = std::min<std::size_t>(segments[e], chain.size() - 1);
    const std::vector<std::size_t> kept = choose(worth[next++], wanted);
    for (std::size_t i = 1; i + 1 < kept.size(); ++i) {
      coarse.curves.points.push_back(fine.points[chain[kept[i]]]);
      coarse.curves.parameters.push_back(parameters[kept[i]]);
      coarse.fine_vertex.push_back(chain[kept[i]]);
    }
  }
  coarse.curves.first_interior[model.edge_count()] = static_cast<std::int32_t>(coarse.curves.points.size());
  return coarse;
}

FineSegments::FineSegments(const Model& model, const CurveMesh& fine, const CoarseCurves& coarse,
                           geometry::FaceId face) {
  for (const EdgeId edge : edges_of(model, face)) {
    const auto chain = fine.chain(model, edge), kept = coarse.curves.chain(model, edge);
    std::size_t at = 0;
    for (std::size_t i = 1; i < kept.size(); ++i) {
      const CurveVertex from = chain[at], to = coarse.fine_vertex[kept[i]];
      Segment segment{std::min(from, to), std::max(from, to), static_cast<std::int32_t>(_interior.size()), 0};
      // On a closed edge the last vertex is the first again.
      for (++at; chain[at] != to || (i + 1 == kept.size() && at + 1 < chain.size()); ++at) {
        _interior.push_back(chain[at]);
      }
      segment.end = static_cast<std::int32_t>(_interior.size());
      if (from > to) std::reverse(_interior.begin() + segment.begin, _interior.end());
      _segments.push_back(segment);
    }
  }
  std::sort(_segments.begin(), _segments.end(), [](const Segment& a, const Segment& b) {
    return std::tie(a.low, a.high, a.begin) < std::tie(b.low, b.high, b.begin);
  });
}

std::vector<CurveVertex> FineSegments::between(CurveVertex first, CurveVertex second) const {
  const CurveVertex low = std::min(first, second), high = std::max(first, second);
  const auto at = std::lower_bound(_segments.begin(), _segments.end(), std::array{low, high},
                                   [](const Segment& s, const std::array<CurveVertex, 2>& key) {
                                     return std::array{s.low, s.high} < key;
                                   });
  if (at == _segments.end() || at->low != low || at->high != high) return {};
  std::vector<CurveVertex> result(_interior.begin() + at->begin, _interior.begin() + at->end);
  if (first > second) std::reverse(result.begin(), result.end());
  return result;
}

}  // namespace aeroloom::surface
