#include "surface/charts/support.hpp"

#include "geometry/place_text.hpp"
#include "surface/charts/open_facets.hpp"
#include "surface/charts/support_flips.hpp"
#include "surface/charts/support_topology.hpp"
#include "surface/surface_error.hpp"

#include <fmt/format.h>

namespace aeroloom::surface {
namespace {

using VertexPair = std::array<std::int32_t, 2>;

/// The boundary edges of the mesh as the loops of the CAD face have them.
std::vector<VertexPair> expected_loop_edges(const cad::Model& model, cad::FaceId face,
                                            const CurveMesh& curves, const FaceVertices& vertices) {
  std::vector<VertexPair> edges;
  const auto number = [&](CurveVertex v) { return vertices.find(curves.vertex_key(model, v)); };
  for (const auto& loop : model.face(face).loops) {
    for (const auto& use : loop) {
      const auto chain = curves.chain(model, use.edge);
      for (std::size_t i = 1; i < chain.size(); ++i) {
        VertexPair edge{number(chain[i - 1]), number(chain[i])};
        if (use.reversed) std::swap(edge[0], edge[1]);
        edges.push_back(edge);
      }
    }
  }
  return edges;
}

/// Throws where the boundary of the support is not that of the face.
void check_loop_edges(const cad::Model& model, const CurveMesh& curves, const Support& support,
                      const FaceVertices& vertices) {
  std::vector<VertexPair> expected = expected_loop_edges(model, support.face, curves, vertices);
  std::vector<VertexPair> found;
  for (const auto& [a, b] : support.loop_edges)
    found.push_back({support.mesh_vertex[a], support.mesh_vertex[b]});
  std::sort(expected.begin(), expected.end());
  std::sort(found.begin(), found.end());
  if (expected == found) return;
  const auto [want, got] = std::mismatch(expected.begin(), expected.end(), found.begin(), found.end());
  const VertexPair odd = want != expected.end() ? *want : *got;
  throw SurfaceError(fmt::format(
      "face {} (patch {}): the boundary of its triangulation is not that of its loops near {}; repair this "
      "face in the CAD program",
      model.face(support.face).name, model.patches()[model.face(support.face).patch],
      geometry::place_text(vertices.points[odd[0]])));
}

}  // namespace

Support build_support(const cad::Model& model, cad::FaceId face, const CurveMesh& curves,
                      const cad::Facets& facets, const sizing::SizeField& field, FaceVertices& vertices) {
  OpenFacets open(model, face, facets);
  open.insert_curve_vertices(curves);
  open.match_seams();
  open.fit_to_surface(field);
  Support support = open.close(curves, vertices);
  flip_to_delaunay(support);
  support.loop_edges = trace_loop_edges(support);
  check_loop_edges(model, curves, support, vertices);
  return support;
}

}  // namespace aeroloom::surface
