/// What the surface stage tells about its work.
#pragma once

#include "cad/model/model.hpp"
#include "geometry/vec.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::surface {

/// An angle of a piece where cuts end.
struct CutAngle {
  cad::FaceId face = cad::no_entity;
  geometry::Vec3 point;
  double degrees = 0;
};

/// A corner of a CAD face below 30 degrees: the one triangle that fills it is as sharp.
struct ListedCorner {
  cad::FaceId face = cad::no_entity;
  geometry::Vec3 point;
  double degrees = 0;
};

/// A tip of a CAD face between two curves tangent to each other that was closed (cusp_tips.hpp).
struct ClosedTip {
  cad::FaceId face = cad::no_entity;
  geometry::Vec3 point;  ///< the CAD vertex it ends in
  double length = 0;     ///< from there to the last vertices that became one
  double moved = 0;      ///< how far a vertex on its curves moved, at most
};

struct SurfaceReport {
  std::int64_t curve_vertices = 0;
  std::int64_t pieces = 0;
  std::int64_t divided_faces = 0;           ///< CAD faces of more than one piece
  std::vector<CutAngle> cut_angles;         ///< where cuts end, by face and angle, the same on every rank
  std::vector<ListedCorner> sharp_corners;  ///< by face, the same on every rank
  std::vector<ClosedTip> closed_tips;       ///< by face, the same on every rank
  std::int64_t triangles = 0;
  int mending_rounds = 0;    ///< rounds in which sizes had to fall
  double load_error_90 = 0;  ///< the relative error that 90 % of the predicted loads stay below
};

}  // namespace aeroloom::surface
