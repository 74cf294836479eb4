#include "surface/piece_mesher.hpp"

#include "cad/model/evaluation/face_width.hpp"
#include "surface/charts/chart_mesher.hpp"
#include "surface/curves/border_vertices.hpp"
#include "surface/cusps/apexes.hpp"

#include <algorithm>
#include <numbers>

namespace aeroloom::surface {
namespace {

/// Whether another face ends at the vertex too, as where two cones meet in their apexes.
bool is_met_by_others(const cad::Model& model, cad::VertexId vertex, cad::FaceId face) {
  for (cad::EdgeId e = 0; e < model.edge_count(); ++e) {
    const cad::Edge& edge = model.edge(e);
    if (edge.first != vertex && edge.last != vertex) continue;
    if (std::any_of(edge.faces.begin(), edge.faces.end(), [&](cad::FaceId f) { return f != face; }))
      return true;
  }
  return false;
}

/// Apexes lie inside of their face. One at which other faces end is a vertex of their pieces too.
void classify_apexes(const cad::Model& model, const FaceMesh& mesh, mesh::Piece& piece) {
  std::vector<FaceMesh::ApexVertex> shared;
  for (const FaceMesh::ApexVertex& apex : mesh.apexes) {
    if (apex.vertex == cad::no_entity) continue;
    piece.vertex_dimension[apex.at] = mesh::CadDimension::vertex;
    piece.vertex_entity[apex.at] = apex.vertex;
    if (is_met_by_others(model, apex.vertex, mesh.face)) shared.push_back(apex);
  }
  std::sort(shared.begin(), shared.end(), [](const auto& a, const auto& b) { return a.at < b.at; });
  for (const FaceMesh::ApexVertex& apex : shared) {
    piece.shared_vertices.push_back(apex.at);
    piece.shared_keys.push_back(mesh::cad_vertex_key(apex.vertex));
  }
}

mesh::Piece piece_of(const cad::Model& model, const FaceVertices& vertices, const FaceMesh& mesh) {
  mesh::Piece piece;
  piece.kind = mesh::CellKind::triangle;
  piece.coordinates.reserve(3 * mesh.points.size());
  for (const geometry::Vec3& p : mesh.points)
    piece.coordinates.insert(piece.coordinates.end(), {p.x, p.y, p.z});
  for (const auto& t : mesh.triangles) piece.cells.insert(piece.cells.end(), t.begin(), t.end());
  for (std::int32_t v = 0; v < vertices.border_count(); ++v) {
    classify_border_vertex(mesh.face, vertices.vertex_keys[v], piece);
    piece.shared_vertices.push_back(v);
  }
  piece.shared_keys = vertices.vertex_keys;
  piece.vertex_dimension.resize(mesh.points.size(), mesh::CadDimension::face);
  piece.vertex_entity.resize(mesh.points.size(), mesh.face);
  classify_apexes(model, mesh, piece);
  piece.triangle_face.assign(mesh.triangles.size(), mesh.face);
  piece.triangle_patch.assign(mesh.triangles.size(), model.face(mesh.face).patch);
  return piece;
}

}  // namespace

cad::Facets chart_facets(const cad::Model& model, cad::FaceId face, const SurfaceOptions& options) {
  // Facets may leave the surface by a small fraction of the model, and of the face's own width: a curved
  // strip must not fold over itself.
  constexpr double fraction_of_model = 1e-3, fraction_of_width = 0.03, least_fraction_of_model = 1e-6;
  const double scale = model.is_far_field(face) ? model.bounds().diagonal() : model.body_bounds().diagonal();
  const double deflection = std::clamp(fraction_of_width * cad::mean_width(model, face),
                                       least_fraction_of_model * scale, fraction_of_model * scale);
  return model.facets(face, deflection, options.facet_angle * std::numbers::pi / 180);
}

FaceProblem problem_of_face(const cad::Model& model, cad::FaceId face, const CurveMesh& curves,
                            const sizing::SizeField& field, const SurfaceOptions& options) {
  FaceProblem problem{{}, find_face_rows(model, face, curves, options.rows)};
  if (!problem.rows.failures.empty()) return problem;
  PieceProblem& rest = problem.rest;
  rest.surface = build_chart_surface(model, problem.rows, curves, chart_facets(model, face, options), field,
                                     rest.vertices);
  if (problem.rows.failures.empty()) rest.load = predict_triangles(rest.surface, field);
  return problem;
}

mesh::Piece mesh_piece(const cad::Model& model, const PieceProblem& problem, const sizing::SizeField& field,
                       const SurfaceOptions& options) {
  const ChartMeshing meshing{.chart_spread = options.chart_spread,
                             .remeshing = {.sweeps = options.smoothing_sweeps}};
  FaceMesh mesh = mesh_charts(model, field, problem.surface, problem.vertices, meshing);
  cap_apexes(field, find_apexes(model, problem.surface), mesh);
  split_apexes_of_two_faces(model, problem.vertices, mesh);
  return piece_of(model, problem.vertices, mesh);
}

}  // namespace aeroloom::surface
