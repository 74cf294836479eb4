#include "pipeline/domain/level_findings.hpp"

#include "sizing/lifting/level_requests.hpp"

#include <algorithm>

namespace aeroloom::domain {
namespace {

std::string names_of(const cad::Model& model, const sizing::LiftingElement& element) {
  if (element.blunt_face != cad::no_entity) return model.face(element.blunt_face).name;
  std::string names;
  for (const cad::FaceId face : model.edge(element.edge).faces)
    names += (names.empty() ? "" : ", ") + model.face(face).name;
  return names;
}

FoundTrailingEdge describe_trailing_edge(const cad::Model& model, const sizing::LiftingElement& element,
                                         const sizing::LevelSizes& sizes) {
  FoundTrailingEdge found;
  found.faces = names_of(model, element);
  found.is_blunt = element.blunt_face != cad::no_entity;
  const sizing::EdgeLine& line = element.trailing;
  for (std::size_t i = 1; i < line.points.size(); ++i)
    found.length += distance(line.points[i - 1], line.points[i]);
  for (std::size_t i = 0; i < element.opposite.size(); ++i)
    found.width = std::max(found.width, distance(line.points[i], element.opposite[i]));
  const auto [shortest, longest] = std::minmax_element(line.chords.begin(), line.chords.end());
  found.shortest_chord = *shortest, found.longest_chord = *longest;
  const std::vector<double> asked = sizing::trailing_sizes(element, sizes);
  found.smallest_size = *std::min_element(asked.begin(), asked.end());
  return found;
}

}  // namespace

LevelFindings describe_level(const cad::Model& model, const sizing::LiftingBodies& bodies,
                             const sizing::LevelSizes& sizes) {
  LevelFindings findings;
  findings.reference_chord = bodies.reference_chord;
  findings.semispan = bodies.semispan;
  findings.wall_size = sizes.body * bodies.reference_chord;
  const geometry::Vec3 extent = model.bounds().size();
  findings.far_field = 0.5 * std::max({extent.x, extent.y, extent.z}) / bodies.semispan;
  for (const sizing::LiftingElement& element : bodies.elements)
    findings.edges.push_back(describe_trailing_edge(model, element, sizes));
  return findings;
}

}  // namespace aeroloom::domain
