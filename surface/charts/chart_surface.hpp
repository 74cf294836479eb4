/// The triangulation that a surface piece is meshed from. It carries the parameters of the CAD face.
#pragma once

#include "cad/model/model.hpp"
#include "geometry/vec.hpp"
#include "surface/curves/curves.hpp"
#include "surface/rows/face_rows.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace aeroloom::surface {

/// A parametric triangulation of a CAD face or of a part of one: each triangle corner has parameters (u, v).
/// Seams are closed and each pole is one point. Points on a seam have other parameters in each triangle.
struct ChartSurface {
  cad::FaceId face = cad::no_entity;
  std::vector<geometry::Vec3> points;
  std::vector<std::array<std::int32_t, 3>> triangles;  ///< counter-clockwise seen against the outward normal
  std::vector<std::array<geometry::Vec2, 3>> corner_uv;  ///< per triangle corner
  /// Per point, the mesh vertex there as an index into FaceVertices; -1: none. Where the boundary touches
  /// itself, several points have the same vertex.
  std::vector<std::int32_t> mesh_vertex;
  /// Boundary edges of the future mesh, as directed pairs of points: chords between consecutive mesh vertices
  /// on the boundary. The surface lies on their left. Empty on a closed surface.
  std::vector<std::array<std::int32_t, 2>> loop_edges;
};

/// Mesh vertices of a piece that are known before its interior is meshed. Vertices on its borders come first;
/// they have keys and stay in place. Vertices on cuts between its charts follow.
struct FaceVertices {
  std::vector<geometry::Vec3> points;
  std::vector<geometry::Vec2> uv;                  ///< one valid parameter pair on the face for each
  std::vector<mesh::SharedVertexKey> vertex_keys;  ///< of the vertices on borders, ascending
  std::int32_t border_count() const { return static_cast<std::int32_t>(vertex_keys.size()); }
  /// The border vertex with this key, which must exist.
  std::int32_t find(mesh::SharedVertexKey vertex_key) const {
    return static_cast<std::int32_t>(std::lower_bound(vertex_keys.begin(), vertex_keys.end(), vertex_key) -
                                     vertex_keys.begin());
  }
};

/// Builds the triangulation of a whole face from its facets. Closes seams and poles, and splits boundary
/// edges at the curve vertices. Then flips and refines triangles in the parameter plane until they follow the
/// surface, however coarse the facets were. Edges far shorter than the local size are not refined further.
/// `vertices` receives the curve vertices of the face, ascending. Throws SurfaceError where the facets do not
/// fit the loops of the face.
ChartSurface build_chart_surface(const cad::Model& model, cad::FaceId face, const CurveMesh& curves,
                                 const cad::Facets& facets, const sizing::SizeField& field,
                                 FaceVertices& vertices);

/// The same of a face without its rows: tops stand for the curve vertices below them. Where rows meet the
/// boundary or each other that is added to their failures, and the result is of no use.
ChartSurface build_chart_surface(const cad::Model& model, FaceRows& rows, const CurveMesh& curves,
                                 const cad::Facets& facets, const sizing::SizeField& field,
                                 FaceVertices& vertices);

}  // namespace aeroloom::surface
