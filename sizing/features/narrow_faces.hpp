/// Faces narrower than elements, and the neighbours that such a face can be joined with.
#pragma once

#include "cad/model/model.hpp"
#include "parallel/communication/communicator.hpp"
#include "parallel/observation/timers.hpp"

#include <vector>

namespace aeroloom::sizing {

/// A narrow face, and the neighbour that it is joined with.
struct NarrowFace {
  cad::FaceId face = cad::no_entity, into = cad::no_entity;
  double width = 0;      ///< 2 area / perimeter
  double degrees = 0;    ///< the largest turn of the surface across the edges that vanish
  double deviation = 0;  ///< width * sin(turn): how far the mesh may leave the surface there
  geometry::Vec3 place;  ///< on an edge that vanishes
};

/// The largest angle in degrees by which the surface turns across an edge between two faces; 180 if it is not
/// known.
double turn_across(const cad::Model& model, cad::FaceId a, cad::FaceId b, cad::EdgeId id);

/// Finds faces narrower than `width` that a smooth neighbour can take in. The neighbour is in the same patch
/// and between the same regions. Across every edge between the two, the surface turns by less than 20
/// degrees, and the deviation is at most `tolerance`. Of several neighbours the one with the longest common
/// border is taken. Far field faces are not joined; an exact plane is joined with its like only. In the order
/// of faces, the same on every rank. Collective.
std::vector<NarrowFace> find_narrow_faces(const parallel::Communicator& communicator, const cad::Model& model,
                                          double width, double tolerance);

/// Groups of faces to join. Drops from `narrow` those that would erase a crease or join nothing new.
std::vector<std::vector<cad::FaceId>> group_narrow_faces(const cad::Model& model,
                                                         std::vector<NarrowFace>& narrow, double tolerance);

}  // namespace aeroloom::sizing
