#include "cad/repair/noise_faces.hpp"

#include "cad/model/model_data.hpp"
#include "cad/model/shape_map.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <vector>

#include <BRepGProp.hxx>
#include <BRep_Tool.hxx>
#include <GProp_GProps.hxx>
#include <TopoDS.hxx>

namespace aeroloom::cad {
namespace {

/// Edges of a face that have a length.
std::vector<SampledEdge> sample_border(const TopoDS_Face& face) {
  const TopTools_IndexedMapOfShape edges = map_of(face, TopAbs_EDGE);
  std::vector<SampledEdge> border;
  for (int i = 1; i <= edges.Extent(); ++i) {
    const TopoDS_Edge edge = TopoDS::Edge(edges(i).Oriented(TopAbs_FORWARD));
    double first, last;
    if (BRep_Tool::Degenerated(edge)) continue;
    if (BRep_Tool::Curve(edge, first, last).IsNull()) return {};
    border.emplace_back(edge);
  }
  return border;
}

/// From a place on one edge to the nearest other one.
double away_from_others(const std::vector<SampledEdge>& border, std::size_t own, Vec3 point, double bound) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t other = 0; other < border.size(); ++other) {
    if (other != own) least = std::min(least, border[other].nearest(point, std::min(least, bound)).away);
  }
  return least;
}

}  // namespace

std::optional<NoiseFace> examine_noise(const TopoDS_Face& face, double tolerance) {
  // Of an edge, coarse ones first: most faces are told to be wide at the first place that is looked at. The
  // last two look beside the ends, where a strip that is wide for a short way only would be missed.
  constexpr double fractions[] = {0.5, 0.25, 0.75, 0.125, 0.375, 0.625, 0.875, 0.01, 0.99};
  const std::vector<SampledEdge> border = sample_border(face);
  if (border.size() < 2) return std::nullopt;
  std::vector<std::size_t> order(border.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(
      order, [&](std::size_t a, std::size_t b) { return border[a].length() > border[b].length(); });
  NoiseFace noise;
  noise.place = border[order.front()].point(border[order.front()].parameter(0.5));
  for (const std::size_t own : order) {
    noise.length += 0.5 * border[own].length();
    if (border[own].length() <= tolerance) continue;
    for (const double fraction : fractions) {
      const double away =
          away_from_others(border, own, border[own].point(border[own].parameter(fraction)), tolerance);
      if (away > tolerance) return std::nullopt;
      noise.widest = std::max(noise.widest, away);
    }
  }
  if (noise.widest == 0) {  // a spot
    for (const SampledEdge& edge : border) noise.widest = std::max(noise.widest, edge.length());
  }
  GProp_GProps properties;
  BRepGProp::SurfaceProperties(face, properties, area_precision);
  if (properties.Mass() > 2 * tolerance * noise.length) return std::nullopt;
  return noise;
}

}  // namespace aeroloom::cad
