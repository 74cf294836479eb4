/// Apexes of CAD faces: the apex of a cone, the nose of a pointed body of revolution.
///
/// A face that runs to a point inside of itself (a pole) has less than 360 degrees of surface around it, a
/// slender cone a tenth of that. Equilateral triangles of one size do not fit around such a point: the front,
/// which does not know of it, cuts it off, and beside a slender one triangles lie on each other. So the point
/// becomes a vertex, and the triangles near it give way to a fan: those up to the distance from which on some
/// sizes fit around.
#pragma once

#include "surface/charts/chart_surface.hpp"
#include "surface/remesh/remesh.hpp"

#include <vector>

namespace aeroloom::surface {

struct Apex {
  cad::VertexId vertex = cad::no_entity;  ///< of the CAD model; none in faces of facets
  geometry::Vec3 point;
  geometry::Vec2 uv;  ///< one valid pair of parameters
  double angle = 0;   ///< radians of surface around it
};

/// Those inside of a chart surface: poles with less than 340 degrees, vertices of facets with less than 180.
std::vector<Apex> find_apexes(const cad::Model& model, const ChartSurface& surface);

/// Puts a fan around each apex into a finished mesh of its face; after it no edge may change. Sizes of the
/// field are taken at the apex. A apex stays as it is where what gives way reaches the border of the face or
/// another apex, or is no disk.
void cap_apexes(const sizing::SizeField& field, const std::vector<Apex>& apexes, FaceMesh& mesh);

/// Where two CAD faces alone meet in a apex, the halves of a cone or the shells of a lens, a single triangle
/// of each would fill it, the same one twice. Such triangles are split, as is the one behind each, by a
/// vertex on the face between the two curves. After it no edge may change.
void split_apexes_of_two_faces(const cad::Model& model, const FaceVertices& vertices, FaceMesh& mesh);

}  // namespace aeroloom::surface
