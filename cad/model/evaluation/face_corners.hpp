/// Corners of CAD faces, and how far their two edges open near them.
#pragma once

#include "cad/model/model.hpp"

#include <array>
#include <optional>
#include <vector>

namespace aeroloom::cad {

/// Where a loop of a face goes from one edge to the next.
struct FaceCorner {
  FaceId face = no_entity;
  VertexId vertex = no_entity;
  Coedge arriving, leaving;
};

/// One end of an edge.
struct EdgeEnd {
  EdgeId edge = no_entity;
  bool first = true;  ///< at the edge's first parameter
};
inline EdgeEnd end_at_corner(const Coedge& use, bool leaving) {
  return {use.edge, leaving != use.reversed};
}

/// The corners of a face, in the order of its loops. Ends of seams are not listed. At a pole, the edges
/// before and after the degenerate edge form one corner.
std::vector<FaceCorner> corners_of(const Model& model, FaceId face);

/// The face on the other side of an edge. no_entity unless the edge has exactly two faces and the other one
/// uses it once.
FaceId neighbour_face(const Model& model, FaceId face, EdgeId edge);

/// The coedge of a face along an edge that it uses once. Throws std::logic_error if it does not use it.
Coedge coedge_along(const Model& model, FaceId face, EdgeId edge);

/// The other faces along the two edges of a corner. `two_faces` have no further edge in common at its vertex;
/// `faces_that_meet` do, as at the end of a wedge.
enum class CornerNeighbours { two_faces, faces_that_meet, other };
CornerNeighbours neighbours_at_corner(const Model& model, const FaceCorner& corner);

/// The first parameter at which the edge is at a distance from the vertex at this end. Empty if there is none
/// on the near half of the edge.
std::optional<double> parameter_at(const Model& model, EdgeEnd end, double distance);

/// The chord that cuts off a corner, with its ends at the same distance from the vertex.
struct CornerOpening {
  std::array<Vec3, 2> points;  ///< on the arriving and on the leaving edge
  std::array<double, 2> parameters;
  double width = 0;    ///< between the points
  double degrees = 0;  ///< angle at the vertex, inside the face, 0 to 180
};

/// Empty if the corner is reflex or an edge ends before that distance.
std::optional<CornerOpening> open_corner(const Model& model, const FaceCorner& corner, double distance);

}  // namespace aeroloom::cad
