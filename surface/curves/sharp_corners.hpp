/// Sharp corners of CAD faces, and the first segments of the curves that meet there.
#pragma once

#include "cad/model/evaluation/face_corners.hpp"
#include "cad/model/model.hpp"
#include "sizing/field/size_field.hpp"

#include <array>
#include <span>
#include <vector>

namespace aeroloom::surface {

/// A corner where two edges of a face meet below 30 degrees, measured at the distance of the local size.
/// Where two faces end in one apex (a halved cone) the limit is 100 degrees.
struct SharpCorner {
  cad::FaceId face = cad::no_entity;
  cad::VertexId vertex = cad::no_entity;
  std::array<cad::EdgeEnd, 2> ends;
  double degrees = 0;
  /// Length of the first segment on both edges. One triangle of these sides fills the corner, and elements of
  /// the local size fit between the edges behind it. 0 where the edges turn too much or are too short, and
  /// where the corner is closed instead (cusps.hpp).
  double leg = 0;
  bool closes = false;  ///< its two edges are merged near the vertex (cusps.hpp)
};

/// The face on the other side of both edges of a corner; no_entity where these differ.
cad::FaceId face_beyond_both_edges(const cad::Model& model, const cad::FaceCorner& corner);
/// Whether one other face lies beyond both edges of a corner and its corner there is not reflex either,
/// measured at `distance`. Then both faces end in one apex: halves of a cone, or shells of a lens.
bool is_apex_of_two_faces(const cad::Model& model, const cad::FaceCorner& corner, double distance);

/// All sharp corners by face, the same on every rank of the field. Collective.
std::vector<SharpCorner> find_sharp_corners(const cad::Model& model, const sizing::SizeField& field);

/// Length of a short leg over the local size. Chosen, not measured.
inline constexpr double longest_short_leg = 4;

/// Limits the legs at these CAD vertices (ascending) to `longest_short_leg`. Long legs can cause needles in
/// the face on the other side.
void shorten_legs(const cad::Model& model, const sizing::SizeField& field,
                  std::span<const cad::VertexId> vertices, std::vector<SharpCorner>& corners);

/// Per edge and end (first, last parameter): the distance from the CAD vertex to the first vertex on the
/// curve. 0 where the size field alone decides. All corners at one CAD vertex take the longest leg, since
/// they may share an edge.
std::vector<std::array<double, 2>> legs_of_edges(const cad::Model& model,
                                                 const std::vector<SharpCorner>& corners);

}  // namespace aeroloom::surface
