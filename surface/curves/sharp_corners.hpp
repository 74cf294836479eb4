/// How curves begin at sharp corners of CAD faces.
#pragma once

#include "cad/model/evaluation/face_corners.hpp"
#include "cad/model/model.hpp"
#include "sizing/field/size_field.hpp"

#include <array>
#include <span>
#include <tuple>
#include <vector>

namespace aeroloom::surface {

/// Where two edges of a face meet below 30 degrees, as elements see it: from the distance of the local size.
/// In a apex of two faces below 100: the sides of a cone of 50 degrees about its axis.
struct SharpCorner {
  cad::FaceId face = cad::no_entity;
  cad::VertexId vertex = cad::no_entity;
  std::array<cad::EdgeEnd, 2> ends;
  double degrees = 0;
  /// Length of the first segment on both edges, so that one triangle fills the corner and elements fit
  /// between the edges behind it; 0 where the edges bend too much or are too short for one, and where the
  /// corner is closed instead (cusps.hpp).
  double leg = 0;
  bool closes = false;  ///< its edges are one as far as they are next to each other (cusps.hpp)

  static constexpr auto fields() {
    return std::tuple(&SharpCorner::face, &SharpCorner::vertex, &SharpCorner::ends, &SharpCorner::degrees,
                      &SharpCorner::leg, &SharpCorner::closes);
  }
};

/// The other face where the same one lies beyond both edges of a corner, else no_entity.
cad::FaceId face_beyond_both_edges(const cad::Model& model, const cad::FaceCorner& corner);
/// Whether the same other face lies beyond both edges of a corner, and its corner there is not reflex either,
/// as edges are at that distance: both faces end in one apex, halves of a cone or shells of a lens.
bool is_apex_of_two_faces(const cad::Model& model, const cad::FaceCorner& corner, double distance);

/// All of them by face, the same on every rank. Collective.
std::vector<SharpCorner> find_sharp_corners(const cad::Model& model, const sizing::SizeField& field);

/// Length of a short leg, in sizes at the corner. Chosen, not measured.
inline constexpr double longest_short_leg = 4;

/// Makes the legs at the CAD vertices (ascending) no longer than that: a face on the other side of an edge
/// has to live with its leg.
void shorten_legs(const cad::Model& model, const sizing::SizeField& field,
                  std::span<const cad::VertexId> vertices, std::vector<SharpCorner>& corners);

/// Per edge and end (at its first and last parameter): how far from the CAD vertex the first vertex on the
/// curve is; 0 where the size field alone decides. Corners at one vertex take the longest leg together: they
/// may share an edge.
std::vector<std::array<double, 2>> legs_of_edges(const cad::Model& model,
                                                 const std::vector<SharpCorner>& corners);

}  // namespace aeroloom::surface
