#include "sizing/lifting/level_requests.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace aeroloom::sizing {
namespace {

using geometry::Vec3;

/// Parts into which an edge of the CAD is cut, for the line along it. Chosen, not measured.
constexpr int intervals_of_edges = 128;
/// The diagonal of everything over the largest size, at B and at coarse: as where sizes are chosen.
constexpr double domain_over_maximum = 20;

/// Of the local chord, and of the widest place of a narrow face: where it is thinner, as where it runs out to
/// a point, it counts as sharp. Chosen, not measured.
constexpr double thinnest = 1e-4, thinnest_of_widest = 0.05;

SizeLine along(const EdgeLine& edge, double fraction) {
  SizeLine line{edge.points, {}};
  for (const double chord : edge.chords) line.sizes.push_back(fraction * chord);
  return line;
}

/// The width of a narrow face at each point of its side.
std::vector<double> widths_of(const LiftingElement& element) {
  std::vector<double> widths;
  for (std::size_t i = 0; i < element.opposite.size(); ++i)
    widths.push_back(distance(element.trailing.points[i], element.opposite[i]));
  return widths;
}

/// Lines on a trailing edge: one where it is sharp; from border to border where it is blunt, no farther
/// apart than elements are large.
void add_trailing(const LiftingElement& element, const LevelSizes& level, std::vector<SizeLine>& lines) {
  SizeLine border{element.trailing.points, trailing_sizes(element, level)};
  if (element.opposite.empty()) return lines.push_back(std::move(border));
  double most_across = 1;
  const std::vector<double> widths = widths_of(element);
  for (std::size_t i = 0; i < widths.size(); ++i)
    most_across = std::max(most_across, widths[i] / border.sizes[i]);
  const int across = static_cast<int>(std::ceil(most_across));
  for (int k = 0; k <= across; ++k) {
    SizeLine line = border;
    for (std::size_t i = 0; i < line.points.size(); ++i)
      line.points[i] =
          line.points[i] + static_cast<double>(k) / across * (element.opposite[i] - line.points[i]);
    lines.push_back(std::move(line));
  }
}

/// Lines along the flow behind a trailing edge, no farther apart than elements are large.
void add_wake(const LiftingElement& element, const LevelSizes& level, Vec3 flow,
              std::vector<SizeLine>& lines) {
  const auto& points = element.trailing.points;
  const auto add = [&](Vec3 from, double chord) {
    const double size = level.body * chord;
    lines.push_back({{from, from + level.wake * chord * flow}, {size, size}});
  };
  double gone = 0, next = 0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const double length = distance(points[i], points[i + 1]);
    while (next <= gone + length && length > 0) {
      const double part = (next - gone) / length;
      const double chord =
          element.trailing.chords[i] + part * (element.trailing.chords[i + 1] - element.trailing.chords[i]);
      add(points[i] + part * (points[i + 1] - points[i]), chord);
      next += level.body * chord;
    }
    gone += length;
  }
  add(points.back(), element.trailing.chords.back());
}

SizeLine along(const cad::Model& model, cad::EdgeId id, double size) {
  const cad::Edge& edge = model.edge(id);
  SizeLine line;
  for (int i = 0; i <= intervals_of_edges; ++i) {
    line.points.push_back(model.edge_point(
        id, edge.first_parameter + (edge.last_parameter - edge.first_parameter) * i / intervals_of_edges));
    line.sizes.push_back(size);
  }
  return line;
}

}  // namespace

std::vector<double> trailing_sizes(const LiftingElement& element, const LevelSizes& level) {
  std::vector<double> sizes = along(element.trailing, level.edge).sizes;
  const std::vector<double> widths = widths_of(element);
  if (widths.empty()) return sizes;
  const double widest = *std::max_element(widths.begin(), widths.end());
  for (std::size_t i = 0; i < widths.size(); ++i) {
    if (widths[i] > std::max(thinnest * element.trailing.chords[i], thinnest_of_widest * widest))
      sizes[i] = std::min(sizes[i], widths[i] / level.trailing_cells);
  }
  return sizes;
}

std::vector<SizeLine> level_lines(const cad::Model& model, const LiftingBodies& bodies,
                                  const LevelSizes& level, Vec3 flow) {
  std::vector<SizeLine> lines;
  std::set<cad::EdgeId> ends;
  std::set<cad::FaceId> blunt_faces;
  for (const LiftingElement& element : bodies.elements) {
    for (const EdgeLine& line : element.leading) lines.push_back(along(line, level.edge));
    add_trailing(element, level, lines);
    add_wake(element, level, flow, lines);
    ends.insert(element.ends.begin(), element.ends.end());
    blunt_faces.insert(element.blunt_face);
  }
  for (const cad::EdgeId id : ends) {
    const auto& faces = model.edge(id).faces;
    const bool is_trailing =
        std::any_of(faces.begin(), faces.end(), [&](cad::FaceId face) { return blunt_faces.contains(face); });
    if (!is_trailing) lines.push_back(along(model, id, level.span * bodies.semispan));
  }
  return lines;
}

GivenSizes level_bounds(const cad::Model& model, const LiftingBodies& bodies, const LevelSizes& level) {
  double shortest = bodies.reference_chord;
  for (const LiftingElement& element : bodies.elements) {
    for (const LiftingStation& station : element.stations) shortest = std::min(shortest, station.chord);
  }
  GivenSizes given;
  given.minimum = level.edge * shortest;
  given.feature_minimum = given.minimum;
  given.surface_maximum = level.body * bodies.reference_chord;
  given.maximum =
      std::max(*given.surface_maximum, level.factor * model.bounds().diagonal() / domain_over_maximum);
  given.growth = level.growth;
  given.curvature_angle = level.curvature_angle;
  return given;
}

}  // namespace aeroloom::sizing
