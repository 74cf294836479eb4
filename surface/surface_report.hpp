/// Results of the surface stage for the report.
#pragma once

#include "cad/model/model.hpp"
#include "geometry/vec.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::surface {

/// An angle of a piece at the end of a cut.
struct CutAngle {
  cad::FaceId face = cad::no_entity;
  geometry::Vec3 point;
  double degrees = 0;
};

/// A corner of a CAD face below 30 degrees. The one triangle that fills it has the same angle.
struct ListedCorner {
  cad::FaceId face = cad::no_entity;
  geometry::Vec3 point;
  double degrees = 0;
};

/// A cusp of a CAD face, between two tangent curves, that was closed (cusps.hpp).
struct ClosedCusp {
  cad::FaceId face = cad::no_entity;
  geometry::Vec3 point;  ///< the CAD vertex it ends in
  double length = 0;     ///< from there to the last vertices that were merged
  double moved = 0;      ///< largest distance by which a vertex on its curves moved
};

/// A triangle is a needle when its smallest angle is below this; degrees.
inline constexpr double needle_degrees = 10;

/// The cause of a needle.
enum class NeedleCause : std::int32_t {
  corner,  ///< forced: two curves that meet at a CAD vertex enclose the smallest angle
  strip,   ///< forced: one side lies on a curve, the third vertex on another curve close to it
  mesh     ///< not forced by the CAD
};

/// "corner", "strip" or "mesh".
const char* name_of(NeedleCause cause);

/// The needles of one CAD face with one cause.
struct NeedleGroup {
  cad::FaceId face = cad::no_entity;
  NeedleCause cause = NeedleCause::mesh;
  std::int64_t needles = 0;     ///< triangles below needle_degrees
  std::int64_t below_half = 0;  ///< of these, below half of needle_degrees
  double degrees = 0;           ///< the smallest angle
  geometry::Vec3 at;            ///< centre of the triangle with that angle
};

/// Rows along a CAD edge that are asked for. Lengths are in the model's unit.
struct RowsMade {
  cad::EdgeId edge = cad::no_entity;
  double height = 0;     ///< of the first row
  double length = 0;     ///< of the edge
  double with_rows = 0;  ///< of the segments that have rows
  double stretched = 0;  ///< of those that are at least four times as long as the first row is high
  double longest = 0;    ///< segment with rows
  int most = 0;          ///< rows
};

struct SurfaceReport {
  std::int64_t curve_vertices = 0;
  std::int64_t pieces = 0;
  std::int64_t divided_faces = 0;           ///< CAD faces of more than one piece
  std::vector<CutAngle> cut_angles;         ///< where cuts end, by face and angle, the same on every rank
  std::vector<ListedCorner> sharp_corners;  ///< by face, the same on every rank
  std::vector<ClosedCusp> closed_cusps;     ///< by face, the same on every rank
  std::vector<NeedleGroup> needles;         ///< by face and cause, the same on every rank
  std::vector<RowsMade> rows;               ///< by edge, the same on every rank
  std::int64_t triangles = 0;
  int mending_rounds = 0;    ///< rounds of local refinement before the accepted one
  double load_error_90 = 0;  ///< the relative error that 90 % of the predicted loads do not exceed
};

}  // namespace aeroloom::surface
