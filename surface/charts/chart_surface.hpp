/// The chart surface of a surface piece: a triangulation that carries charts and leads back to the CAD
/// surface.
#pragma once

#include "cad/model/model.hpp"
#include "geometry/vec.hpp"
#include "surface/curves/curves.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <tuple>
#include <vector>

namespace aeroloom::surface {

/// A triangulated part of one CAD face, or all of it. Seams are closed and poles are single points, by
/// topology: what repeats in the parameter plane occurs once here, and parameters belong to triangle corners.
struct ChartSurface {
  cad::FaceId face = cad::no_entity;
  std::vector<geometry::Vec3> points;
  std::vector<std::array<std::int32_t, 3>> triangles;  ///< counter-clockwise seen against the outward normal
  std::vector<std::array<geometry::Vec2, 3>> corner_uv;  ///< per triangle corner
  /// Vertex of the face's mesh at this chart surface point, -1 where there is none. Numbers run over the
  /// face: those of `FaceVertices` below. Where the boundary touches itself, several points share a vertex.
  std::vector<std::int32_t> mesh_vertex;
  /// Boundary edges of the mesh as directed pairs of chart surface points, the chart surface on the left:
  /// chords between consecutive mesh vertices. Empty on a closed surface.
  std::vector<std::array<std::int32_t, 2>> loop_edges;

  static constexpr auto fields() {
    return std::tuple(&ChartSurface::face, &ChartSurface::points, &ChartSurface::triangles,
                      &ChartSurface::corner_uv, &ChartSurface::mesh_vertex, &ChartSurface::loop_edges);
  }
};

/// The mesh vertices of a piece known before its interior is meshed: those on its borders first, which have
/// names and stay, then those on the cuts between its charts.
struct FaceVertices {
  std::vector<geometry::Vec3> points;
  std::vector<geometry::Vec2> uv;                  ///< one valid parameter pair on the face for each
  std::vector<mesh::SharedVertexKey> vertex_keys;  ///< of the vertices on borders, ascending

  static constexpr auto fields() {
    return std::tuple(&FaceVertices::points, &FaceVertices::uv, &FaceVertices::vertex_keys);
  }
  std::int32_t border_count() const { return static_cast<std::int32_t>(vertex_keys.size()); }
  /// The vertex on the border of that name, which must be known.
  std::int32_t find(mesh::SharedVertexKey vertex_key) const {
    return static_cast<std::int32_t>(std::lower_bound(vertex_keys.begin(), vertex_keys.end(), vertex_key) -
                                     vertex_keys.begin());
  }
};

/// Builds the chart surface of a whole face from its facets: closes seams and poles, splits boundary edges at
/// the curve vertices, and reconnects and refines it in the parameter plane until it follows the surface,
/// however coarse the facets are next to the sizes, as far as elements of these sizes can. `vertices`
/// receives the curve vertices of the face, ascending. Throws SurfaceError where the facets do not fit the
/// loops of the face.
ChartSurface build_chart_surface(const cad::Model& model, cad::FaceId face, const CurveMesh& curves,
                                 const cad::Facets& facets, const sizing::SizeField& field,
                                 FaceVertices& vertices);

}  // namespace aeroloom::surface
