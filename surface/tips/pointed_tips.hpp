/// Pointed tips of CAD faces: the apex of a cone, the nose of a pointed body of revolution.
///
/// A face that runs to a point inside of itself (a pole) has less than 360 degrees of surface around it, a
/// slender cone a tenth of that. Equilateral triangles of one size do not fit around such a point: the front,
/// which does not know of it, cuts it off, and beside a slender one triangles lie on each other. So the point
/// becomes a vertex, and the triangles near it give way to a fan: those up to the distance from which on some
/// sizes fit around.
#pragma once

#include "surface/charts/support.hpp"
#include "surface/remesh/remesh.hpp"

#include <vector>

namespace aeroloom::surface {

struct PointedTip {
  cad::VertexId vertex = cad::no_entity;  ///< of the CAD model; none in faces of facets
  geometry::Vec3 point;
  geometry::Vec2 uv;  ///< one valid pair of parameters
  double angle = 0;   ///< radians of surface around it
};

/// Those inside of a support: poles with less than 340 degrees, vertices of facets with less than 180.
std::vector<PointedTip> find_pointed_tips(const cad::Model& model, const Support& support);

/// Puts a fan around each tip into a finished mesh of its face; after it no edge may change. Sizes of the
/// field are taken at the tip. A tip stays as it is where what gives way reaches the border of the face or
/// another tip, or is no disk.
void cap_pointed_tips(const sizing::SizeField& field, const std::vector<PointedTip>& tips, FaceMesh& mesh);

/// Where two CAD faces alone meet in a tip, the halves of a cone or the shells of a lens, a single triangle
/// of each would fill it, the same one twice. Such triangles are split, as is the one behind each, by a
/// vertex on the face between the two curves. After it no edge may change.
void split_tips_of_two_faces(const cad::Model& model, const FaceVertices& vertices, FaceMesh& mesh);

}  // namespace aeroloom::surface
