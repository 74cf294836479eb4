#include "surface/charts/chart_surface.hpp"

#include "geometry/place_text.hpp"
#include "surface/charts/delaunay_flips.hpp"
#include "surface/charts/open_facets.hpp"
#include "surface/charts/surface_topology.hpp"
#include "surface/surface_error.hpp"

#include <fmt/format.h>

namespace aeroloom::surface {
namespace {

using VertexPair = std::array<std::int32_t, 2>;

/// The boundary edges of the mesh as the loops of the CAD face have them.
std::vector<VertexPair> expected_loop_edges(const cad::Model& model, const CurveMesh& curves,
                                            const FaceVertices& vertices, const FaceRows& rows) {
  std::vector<VertexPair> edges;
  for (const auto& loop : model.face(rows.face).loops) {
    for (const auto& use : loop) {
      const auto chain = curves.chain(model, use.edge);
      const RowStrip* strip = rows.strip_of(use);
      const auto number = [&](std::size_t i) {
        const bool has_rows = strip != nullptr && strip->tops[i] >= 0;
        return vertices.find(has_rows ? rows.top_key(strip->tops[i]) : curves.vertex_key(model, chain[i]));
      };
      for (std::size_t i = 1; i < chain.size(); ++i) {
        VertexPair edge{number(i - 1), number(i)};
        if (use.reversed) std::swap(edge[0], edge[1]);
        edges.push_back(edge);
      }
    }
  }
  return edges;
}

/// Throws where the boundary of the chart surface is not that of the face.
void check_loop_edges(const cad::Model& model, const CurveMesh& curves, const ChartSurface& surface,
                      const FaceVertices& vertices, const FaceRows& rows) {
  std::vector<VertexPair> expected = expected_loop_edges(model, curves, vertices, rows);
  std::vector<VertexPair> found;
  for (const auto& [a, b] : surface.loop_edges)
    found.push_back({surface.mesh_vertex[a], surface.mesh_vertex[b]});
  std::sort(expected.begin(), expected.end());
  std::sort(found.begin(), found.end());
  if (expected == found) return;
  const auto [want, got] = std::mismatch(expected.begin(), expected.end(), found.begin(), found.end());
  const VertexPair odd = want != expected.end() ? *want : *got;
  throw SurfaceError(fmt::format(
      "face {} (patch {}): the boundary of its triangulation is not that of its loops near {}; repair this "
      "face in the CAD program",
      model.face(surface.face).name, model.patches()[model.face(surface.face).patch],
      geometry::place_text(vertices.points[odd[0]])));
}

}  // namespace

ChartSurface build_chart_surface(const cad::Model& model, cad::FaceId face, const CurveMesh& curves,
                                 const cad::Facets& facets, const sizing::SizeField& field,
                                 FaceVertices& vertices) {
  FaceRows none;
  none.face = face;
  return build_chart_surface(model, none, curves, facets, field, vertices);
}

ChartSurface build_chart_surface(const cad::Model& model, FaceRows& rows, const CurveMesh& curves,
                                 const cad::Facets& facets, const sizing::SizeField& field,
                                 FaceVertices& vertices) {
  OpenFacets open(model, rows.face, facets);
  open.insert_curve_vertices(curves);
  open.match_seams();
  open.cut_off(rows, curves);
  if (!rows.failures.empty()) return {};
  open.fit_to_surface(field);
  ChartSurface surface = open.close(curves, vertices);
  flip_to_delaunay(surface);
  surface.loop_edges = trace_loop_edges(surface);
  check_loop_edges(model, curves, surface, vertices, rows);
  return surface;
}

}  // namespace aeroloom::surface
