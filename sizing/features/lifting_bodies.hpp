/// Lifting bodies of a model: wings, tails, flaps, slats, nacelles. Found by find_lifting_bodies()
/// (lifting.hpp).
#pragma once

#include "cad/model/model.hpp"

#include <array>
#include <set>
#include <vector>

namespace aeroloom::sizing {

/// A place along the span.
struct LiftingStation {
  geometry::Vec3 trailing, leading;
  double chord = 0;      ///< the local chord
  double thickness = 0;  ///< about that of the section
};

/// A line along an edge, with the local chord at each of its points.
struct EdgeLine {
  std::vector<geometry::Vec3> points;
  std::vector<double> chords;
};

/// The part of a lifting body ahead of one trailing edge.
struct LiftingElement {
  cad::FaceId blunt_face = cad::no_entity;  ///< the narrow face of a blunt trailing edge
  cad::EdgeId edge = cad::no_entity;        ///< a sharp trailing edge
  std::vector<LiftingStation> stations;     ///< from one end to the other, two at least
  std::vector<EdgeLine>
      leading;        ///< in several lines where sections change abruptly; may reach beyond stations
  EdgeLine trailing;  ///< along the sharp edge, or one side of the narrow face
  std::vector<geometry::Vec3>
      opposite;  ///< of a narrow face: for each point of `trailing`, the nearest on the other side
  std::set<cad::EdgeId> ends;                           ///< where the skin meets other faces: roots and tips
  std::array<std::set<cad::VertexId>, 2> end_vertices;  ///< of the trailing edge
};

struct LiftingBodies {
  std::vector<LiftingElement> elements;  ///< blunt trailing edges by face, then sharp ones
  double reference_chord = 0;  ///< mean aerodynamic chord of the largest body, integral of c^2 over that of c
  double semispan = 0;         ///< half the extent of the model along the span; all of it for one side alone
};

}  // namespace aeroloom::sizing
