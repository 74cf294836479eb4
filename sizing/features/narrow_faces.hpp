/// Faces narrower than elements are meant to be, and which of their neighbours can take them in.
#pragma once

#include "cad/model/model.hpp"
#include "parallel/communication/communicator.hpp"
#include "parallel/observation/timers.hpp"

#include <tuple>
#include <vector>

namespace aeroloom::sizing {

/// A face that one of its neighbours takes in.
struct NarrowFace {
  cad::FaceId face = cad::no_entity, into = cad::no_entity;
  double width = 0;      ///< 2 area / perimeter
  double degrees = 0;    ///< largest turn of the surface across the edges that vanish
  double deviation = 0;  ///< width * sin(turn): how far the mesh may leave the surface there
  geometry::Vec3 place;  ///< on an edge that vanishes

  static constexpr auto fields() {
    return std::tuple(&NarrowFace::face, &NarrowFace::into, &NarrowFace::width, &NarrowFace::degrees,
                      &NarrowFace::deviation, &NarrowFace::place);
  }
};

/// Degrees the surface turns across an edge between two faces, at most; 180 where that is not known.
double turn_across(const cad::Model& model, cad::FaceId a, cad::FaceId b, cad::EdgeId id);

/// Faces narrower than `width` which have a neighbour in the same patch, between the same regions, that goes
/// on from them smoothly: across every edge between the two the surface turns by less than 20 degrees and the
/// deviation is at most `tolerance`. Of several neighbours the one with the longest common border; a blunt
/// trailing edge has none. Not on the far field; an exact plane joins its like alone. By face, the same on
/// every rank. Collective.
std::vector<NarrowFace> find_narrow_faces(const parallel::Communicator& communicator, const cad::Model& model,
                                          double width, double tolerance);

/// Groups for cad::join_faces: of those found, all that can vanish together.
std::vector<std::vector<cad::FaceId>> group_narrow_faces(const cad::Model& model,
                                                         std::vector<NarrowFace>& narrow, double tolerance);

}  // namespace aeroloom::sizing
