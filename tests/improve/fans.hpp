/// A small piece on a face of a CAD model.
#pragma once

#include "cad/model/model.hpp"
#include "tests/improve/pieces.hpp"

namespace aeroloom::improve::examples {

/// Four tetrahedra over a square of points on a face, around vertex 0 beside its middle.
inline mesh::Piece make_fan(const cad::Model& model, cad::FaceId face, geometry::Vec2 middle,
                            geometry::Vec2 half, double depth) {
  const auto at = [&](double u, double v) {
    return model.face_point(face, {middle.x + u * half.x, middle.y + v * half.y});
  };
  const cad::SurfaceFrame frame = model.face_frame(face, middle);
  mesh::Piece piece = make_piece(
      {at(0.5, 0.4), at(-1, -1), at(1, -1), at(1, 1), at(-1, 1), frame.point - depth * frame.normal},
      {0, 1, 2, 5, 0, 2, 3, 5, 0, 3, 4, 5, 0, 4, 1, 5});
  close_boundary(piece);
  for (LocalIndex v = 0; v < 5; ++v) piece.vertex_entity[v] = face;
  return piece;
}

}  // namespace aeroloom::improve::examples
