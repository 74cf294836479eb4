#include "improve/operations/sliding.hpp"

#include "mesh/data/cad_dimension.hpp"

#include <algorithm>

namespace aeroloom::improve {
namespace {

using geometry::Vec2;

/// In mean distances to the neighbours: how far from the CAD a vertex may be found to count as lying on it.
/// Chosen, not measured.
constexpr double nearness = 1e-4;
constexpr double least_sliding_gain = 0.01;  // of quality; a projection costs more than a move; chosen

/// Triangles at the free point that may change gently.
class GentleTriangles {
public:
  explicit GentleTriangles(const std::vector<TrianglePoints>& triangles) : _triangles(triangles) {}

  bool allow(Vec3 p) const {
    return std::all_of(_triangles.begin(), _triangles.end(), [&](const TrianglePoints& before) {
      const TrianglePoints after{p, before[1], before[2]};
      return is_gentle_change({&before, 1}, {&after, 1});
    });
  }

private:
  const std::vector<TrianglePoints>& _triangles;
};

/// The plane through the vertex that its triangles suggest.
class TangentPlane final : public Locus {
public:
  TangentPlane(const std::vector<TrianglePoints>& triangles, GentleTriangles gentle) : _gentle(gentle) {
    for (const auto& [a, b, c] : triangles) _normal += cross(b - a, c - a);
    _normal = normalized(_normal);
  }
  Vec3 admissible(Vec3 direction) const override { return direction - dot(direction, _normal) * _normal; }
  bool project(Vec3& p) override { return _gentle.allow(p); }

private:
  Vec3 _normal;
  GentleTriangles _gentle;
};

class FaceLocus final : public Locus {
public:
  FaceLocus(const cad::Model& model, cad::FaceId face, Vec2 uv, GentleTriangles gentle)
      : _model(model), _face(face), _uv(uv), _normal(model.face_frame(face, uv).normal), _gentle(gentle) {}

  Vec3 admissible(Vec3 direction) const override { return direction - dot(direction, _normal) * _normal; }
  bool project(Vec3& p) override {
    const cad::Projection found = _model.project(_face, p, _uv);
    p = found.point;
    return found.converged && _gentle.allow(p);
  }

private:
  const cad::Model& _model;
  cad::FaceId _face;
  Vec2 _uv;      ///< of where the vertex was
  Vec3 _normal;  ///< there
  GentleTriangles _gentle;
};

class EdgeLocus final : public Locus {
public:
  EdgeLocus(const cad::Model& model, cad::EdgeId edge, double parameter, GentleTriangles gentle)
      : _model(model),
        _edge(edge),
        _parameter(parameter),
        _tangent(normalized(model.edge_tangent(edge, parameter))),
        _gentle(gentle) {}

  Vec3 admissible(Vec3 direction) const override { return dot(direction, _tangent) * _tangent; }
  bool project(Vec3& p) override {
    p = _model.edge_point(_edge, project_on_edge(_model, _edge, p, _parameter));
    return _gentle.allow(p);
  }

private:
  const cad::Model& _model;
  cad::EdgeId _edge;
  double _parameter;  ///< of where the vertex was
  Vec3 _tangent;      ///< there
  GentleTriangles _gentle;
};

}  // namespace

bool Sliding::collect_triangles(const TetMesh& mesh, LocalIndex vertex, const std::vector<LocalIndex>& star) {
  _triangles.clear();
  for (const LocalIndex t : star) {
    for (int f = 0; f < 4; ++f) {
      const HalfFace other = mesh.twin(4 * t + f);
      if (other >= 0 || mesh.corners(t)[f] == vertex) continue;
      if (!is_triangle(other) || !mesh.is_free_triangle(triangle_of(other))) return false;
      TriangleCorners corners = mesh.triangle(triangle_of(other));
      std::rotate(corners.begin(), std::find(corners.begin(), corners.end(), vertex), corners.end());
      _triangles.push_back(points_of(mesh, corners));
    }
  }
  return !_triangles.empty();
}

double Sliding::mean_distance(const TetMesh& mesh, LocalIndex vertex) const {
  double sum = 0;
  for (const TrianglePoints& triangle : _triangles) sum += distance(mesh.point(vertex), triangle[1]);
  return sum / static_cast<double>(_triangles.size());
}

bool Sliding::slide(TetMesh& mesh, LocalIndex vertex, std::vector<LocalIndex>& star) {
  const auto dimension = mesh.dimension(vertex);
  if (mesh.is_shared(vertex) ||
      (dimension != mesh::CadDimension::face && dimension != mesh::CadDimension::edge))
    return false;
  mesh.collect_star(vertex, star);
  if (!collect_triangles(mesh, vertex, star)) return false;
  const cad::Model& model = _locator.model();
  const std::int32_t entity = mesh.entity(vertex);
  const double tolerance = nearness * mean_distance(mesh, vertex);
  const GentleTriangles gentle(_triangles);
  bool moved = false;
  if (dimension == mesh::CadDimension::face) {
    // The CAD is asked only where the tangent plane promises something.
    TangentPlane plane(_triangles, gentle);
    if (!_smoothing.promises(mesh, vertex, star, plane, Smoothing::least_gain)) return false;
    if (const auto uv = _locator.on_face(entity, mesh.point(vertex), tolerance)) {
      FaceLocus locus(model, entity, *uv, gentle);
      moved = _smoothing.smooth_on(mesh, vertex, star, locus, least_sliding_gain);
    }
  } else if (model.edge(entity).faces.size() <= 2) {  // more: other tetrahedra may stand on the other side
    if (const auto parameter = _locator.on_edge(entity, mesh.point(vertex), tolerance)) {
      EdgeLocus locus(model, entity, *parameter, gentle);
      moved = _smoothing.smooth_on(mesh, vertex, star, locus, least_sliding_gain);
    }
  }
  if (moved) mesh.note_slid_triangles(_triangles.size());
  return moved;
}

}  // namespace aeroloom::improve
