/// Corners of CAD faces, looked at from a distance: how far apart their two edges are there.
#pragma once

#include "cad/model/model.hpp"

#include <array>
#include <optional>
#include <tuple>
#include <vector>

namespace aeroloom::cad {

/// Where a loop of a face turns from one edge into the next.
struct FaceCorner {
  FaceId face = no_entity;
  VertexId vertex = no_entity;
  Coedge arriving, leaving;
};

/// One of the two ends of an edge, as a vertex sees it.
struct EdgeEnd {
  EdgeId edge = no_entity;
  bool first = true;  ///< at the edge's first parameter

  static constexpr auto fields() { return std::tuple(&EdgeEnd::edge, &EdgeEnd::first); }
};
inline EdgeEnd end_at_corner(const Coedge& use, bool leaving) {
  return {use.edge, leaving != use.reversed};
}

/// The corners of a face in the order of its loops; none at the ends of seams; a degenerate edge
/// is a point of its corner.
std::vector<FaceCorner> corners_of(const Model& model, FaceId face);

/// The other face along an edge of a face; no_entity where not exactly two faces pass it, the other one once.
FaceId neighbour_face(const Model& model, FaceId face, EdgeId edge);

/// The coedge of a face along an edge that it passes once. Throws std::logic_error where it does not pass it.
Coedge coedge_along(const Model& model, FaceId face, EdgeId edge);

/// The other faces along the two edges of a corner: two faces that have no further edge at its vertex in
/// common, or that meet there in one as at the section of a wedge; or anything else.
enum class CornerNeighbours { two_faces, faces_that_meet, other };
CornerNeighbours neighbours_at_corner(const Model& model, const FaceCorner& corner);

/// The parameter of the first point of the edge at a distance from the vertex at this end; nothing when there
/// is none on the near half of the edge.
std::optional<double> parameter_at(const Model& model, EdgeEnd end, double distance);

/// A corner cut off at the same distance on both edges.
struct CornerOpening {
  std::array<Vec3, 2> points;  ///< on the arriving and on the leaving edge
  std::array<double, 2> parameters;
  double width = 0;    ///< between the points
  double degrees = 0;  ///< seen from the vertex, inside the face, 0 to 180
};

/// Nothing where the corner is reflex, or an edge ends before that distance.
std::optional<CornerOpening> open_corner(const Model& model, const FaceCorner& corner, double distance);

}  // namespace aeroloom::cad
