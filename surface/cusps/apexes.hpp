/// Apexes of CAD faces: the point of a cone, the nose of a pointed body of revolution.
///
/// At an apex the face has a pole inside it, with less than 360 degrees of surface around the point; a
/// slender cone has a tenth of that. Equilateral triangles of one size do not fit around such a point. The
/// advancing front does not know the point: it cuts the apex off, and at a slender one triangles overlap. So
/// the point becomes a vertex, and a fan of triangles replaces the mesh around it. The ring of the fan lies
/// where enough sizes fit around.
#pragma once

#include "surface/charts/chart_surface.hpp"
#include "surface/remesh/remesh.hpp"

#include <vector>

namespace aeroloom::surface {

struct Apex {
  cad::VertexId vertex = cad::no_entity;  ///< of the CAD model; none where the face is made of facets
  geometry::Vec3 point;
  geometry::Vec2 uv;  ///< one valid pair of parameters
  double angle = 0;   ///< of the surface around it; radians
};

/// The apexes inside a surface: poles with less than 340 degrees, vertices of facets with less than 180.
std::vector<Apex> find_apexes(const cad::Model& model, const ChartSurface& surface);

/// Replaces the mesh around each apex by a fan, in a finished mesh of its face. No edge may change
/// afterwards. The size is taken at the apex. An apex is left out where the triangles to remove reach the
/// border of the face or another apex, or are no disk.
void cap_apexes(const sizing::SizeField& field, const std::vector<Apex>& apexes, FaceMesh& mesh);

/// Splits triangles where just two CAD faces meet in an apex: the halves of a cone, or the shells of a lens.
/// A single triangle of each face would fill it there, with the same three vertices. The triangle and the one
/// behind it are split by a vertex on the face between the two curves. No edge may change afterwards.
void split_apexes_of_two_faces(const cad::Model& model, const FaceVertices& vertices, FaceMesh& mesh);

}  // namespace aeroloom::surface
