#include "surface/moved_faces.hpp"

#include "cad/model/evaluation/point_locator.hpp"
#include "geometry/place_text.hpp"
#include "geometry/sort_unique.hpp"
#include "mesh/exchange/shared_vertices.hpp"
#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/timers.hpp"
#include "surface/joined_pieces.hpp"
#include "surface/remesh/remesh.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::surface {
namespace {

using geometry::Vec2;
using geometry::Vec3;
using mesh::CadDimension;
using mesh::LocalIndex;

/// Vertices are farther than this fraction of the model from their CAD only where gaps were sewn.
constexpr double on_cad = 1e-6;

class MovedFaceRemesher {
public:
  MovedFaceRemesher(const cad::Model& model, const sizing::SizeField& field, const FollowingFaces& faces,
                    const SurfaceOptions& options)
      : _model(model),
        _field(field),
        _faces(faces),
        _sweeps(options.smoothing_sweeps),
        _locator(model),
        _tolerance(on_cad * model.bounds().diagonal() + model.sewn_gap()) {}

  PlaneConflicts run(const mesh::DistributedMesh& before, mesh::DistributedMesh& surface) {
    const auto displacements = find_displacements(before, surface, _faces);
    std::vector<std::uint8_t> has_moved;
    parallel::collectively(surface.communicator, parallel::ScopedCpu::As::task, [&] {
      for (std::size_t p = 0; p < surface.pieces.size(); ++p) {
        move(before.pieces[p], displacements[p], surface.pieces[p]);
        has_moved.push_back(std::any_of(displacements[p].begin(), displacements[p].end(),
                                        [](const Displacement& each) { return !(each.by == Vec3{}); }));
      }
    });
    const std::vector<mesh::PieceId> to_remesh = join_moved_pieces(_faces, has_moved, surface);
    const mesh::SharedVertices shared(surface);
    parallel::collectively(surface.communicator, parallel::ScopedCpu::As::task, [&] {
      for (std::size_t p = 0; p < surface.pieces.size(); ++p) {
        mesh::Piece& piece = surface.pieces[p];
        if (!std::binary_search(to_remesh.begin(), to_remesh.end(), piece.id)) continue;
        std::vector<std::uint8_t> stays(piece.vertex_count(), 0);
        for (std::size_t copy = shared.first(p); copy < shared.first(p + 1); ++copy)
          stays[shared.vertex(copy)] = shared.is_shared(copy) ? 1 : 0;
        remesh(std::move(stays), piece);
        find_turned(piece);
      }
    });
    return gather_conflicts(surface.communicator);
  }

private:
  /// Vertices that are given have moved already.
  void move(const mesh::Piece& before, const std::vector<Displacement>& displacements, mesh::Piece& piece) {
    for (LocalIndex v = 0; v < std::min(before.vertex_count(), piece.vertex_count()); ++v) {
      const Displacement& found = displacements[v];
      if (found.is_given != 0 || found.by == Vec3{}) continue;
      const std::int32_t entity = piece.vertex_entity[v];
      if (piece.vertex_dimension[v] == CadDimension::edge) {
        piece.set_point(v, along_edge(entity, before.point(v), before.point(v) + found.by));
      } else if (const auto uv = _locator.on_face(entity, before.point(v), _tolerance)) {
        piece.set_point(v, _model.project(entity, before.point(v) + found.by, *uv).point);
      }
    }
  }

  Vec3 along_edge(cad::EdgeId edge, Vec3 from, Vec3 to) {
    const std::optional<double> at = _locator.on_edge(edge, from, _tolerance);
    if (!at) return from;
    Vec3 point = _model.edge_point(edge, cad::project_on_edge(_model, edge, to, *at));
    for (const cad::FaceId face : _model.edge(edge).faces) point = cad::onto_exact_plane(_model, face, point);
    return point;
  }

  /// The parameters of all vertices of a piece on its face.
  std::vector<Vec2> parameters(const mesh::Piece& piece) {
    const cad::FaceId face = piece.common_face();
    std::vector<Vec2> uv;
    for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      const std::optional<Vec2> at = _locator.on_face(face, piece.point(v), _tolerance);
      if (at) {
        uv.push_back(*at);
      } else {
        uv.push_back(_model.project(face, piece.point(v), uv.empty() ? Vec2{} : uv.back()).uv);
      }
    }
    return uv;
  }

  void find_turned(const mesh::Piece& piece) {
    const cad::FaceId face = piece.common_face();
    const std::vector<Vec2> uv = parameters(piece);
    for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const LocalIndex* v = piece.cell(t);
      const Vec3 a = piece.point(v[0]), b = piece.point(v[1]), c = piece.point(v[2]);
      Vec3 normal;
      for (int i = 0; i < 3; ++i) normal += _model.face_frame(face, uv[v[i]]).normal;
      if (dot(cross(b - a, c - a), normal) > 0) continue;
      for (const Vec3 corner : {a, b, c}) blame_nearest(corner, piece);
      if (_mine.message.empty()) {
        _mine.message =
            fmt::format("face '{}' is turned over near {}", _model.face(face).name, geometry::place_text(a));
      }
    }
  }

  /// The vertex on a curve that is nearest.
  void blame_nearest(Vec3 point, const mesh::Piece& piece) {
    double least = std::numeric_limits<double>::infinity();
    mesh::SharedVertexKey nearest = 0;
    for (std::size_t s = 0; s < piece.shared_vertices.size(); ++s) {
      const LocalIndex v = piece.shared_vertices[s];
      const double away = distance(piece.point(v), point);
      if (piece.vertex_dimension[v] == CadDimension::face || away >= least) continue;
      least = away;
      nearest = piece.shared_keys[s];
    }
    if (least < std::numeric_limits<double>::infinity()) _mine.vertices.push_back(nearest);
  }

  PlaneConflicts gather_conflicts(const parallel::Communicator& communicator) const {
    PlaneConflicts all;
    all.vertices = communicator.all_gather_items<mesh::SharedVertexKey>(_mine.vertices);
    geometry::sort_unique(all.vertices);
    for (const std::string& message : communicator.all_gather_values(_mine.message)) {
      if (all.message.empty()) all.message = message;
    }
    return all;
  }

  /// `stays`: 1 for vertices that other pieces know; those on curves stay too.
  void remesh(std::vector<std::uint8_t> stays, mesh::Piece& piece) {
    for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      if (piece.vertex_dimension[v] != CadDimension::face) stays[v] = 1;
    }
    std::vector<LocalIndex> order, number(piece.vertex_count());
    for (const int wanted : {1, 0}) {
      for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
        if (stays[v] != wanted) continue;
        number[v] = static_cast<LocalIndex>(order.size());
        order.push_back(v);
      }
    }
    FaceMesh mesh;
    mesh.face = piece.common_face();
    mesh.fixed = static_cast<std::int32_t>(std::count(stays.begin(), stays.end(), 1));
    const std::vector<Vec2> uv = parameters(piece);
    for (const LocalIndex v : order) {
      mesh.points.push_back(piece.point(v));
      mesh.uv.push_back(uv[v]);
    }
    for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const LocalIndex* v = piece.cell(t);
      mesh.triangles.push_back({number[v[0]], number[v[1]], number[v[2]]});
    }
    mesh.slits = edges_between_fixed(mesh);
    remesh_interior(_model, _field, {.sweeps = _sweeps}, mesh);
    replace(order, number, mesh, piece);
  }

  /// Edges inside that join vertices that stay: parts of curves, most of them.
  static std::vector<std::array<std::int32_t, 2>> edges_between_fixed(const FaceMesh& mesh) {
    std::vector<std::array<std::int32_t, 2>> edges;
    const std::vector<geometry::HalfEdge> twins = geometry::match_half_edges(mesh.triangles);
    for (geometry::HalfEdge h = 0; h < static_cast<geometry::HalfEdge>(twins.size()); ++h) {
      const auto& triangle = mesh.triangles[h / 3];
      const std::int32_t a = triangle[h % 3], b = triangle[geometry::next_half_edge(h) % 3];
      if (twins[h] >= 0 && a < b && b < mesh.fixed) edges.push_back({a, b});
    }
    geometry::sort_unique(edges);
    return edges;
  }

  static void replace(const std::vector<LocalIndex>& order, const std::vector<LocalIndex>& number,
                      const FaceMesh& mesh, mesh::Piece& piece) {
    const mesh::Piece old = std::move(piece);
    piece = {};
    piece.id = old.id, piece.kind = old.kind, piece.region = old.region;
    for (const Vec3 p : mesh.points) piece.coordinates.insert(piece.coordinates.end(), {p.x, p.y, p.z});
    for (const auto& t : mesh.triangles) piece.cells.insert(piece.cells.end(), t.begin(), t.end());
    for (std::int32_t v = 0; v < mesh.fixed; ++v) {
      piece.vertex_dimension.push_back(old.vertex_dimension[order[v]]);
      piece.vertex_entity.push_back(old.vertex_entity[order[v]]);
    }
    piece.vertex_dimension.resize(mesh.points.size(), CadDimension::face);
    piece.vertex_entity.resize(mesh.points.size(), mesh.face);
    std::vector<std::pair<LocalIndex, mesh::SharedVertexKey>> keys;
    for (std::size_t s = 0; s < old.shared_vertices.size(); ++s) {
      const LocalIndex now = number[old.shared_vertices[s]];
      if (now < mesh.fixed) keys.emplace_back(now, old.shared_keys[s]);
    }
    std::sort(keys.begin(), keys.end());
    for (const auto& [vertex, key] : keys) {
      piece.shared_vertices.push_back(vertex);
      piece.shared_keys.push_back(key);
    }
    piece.triangle_face.assign(mesh.triangles.size(), mesh.face);
    piece.triangle_patch.assign(mesh.triangles.size(), old.triangle_patch.front());
  }

  const cad::Model& _model;
  const sizing::SizeField& _field;
  const FollowingFaces& _faces;
  int _sweeps;
  cad::PointLocator _locator;
  double _tolerance;
  PlaneConflicts _mine;  // of this rank
};

}  // namespace

PlaneConflicts remesh_moved_faces(const cad::Model& model, const sizing::SizeField& field,
                                  const FollowingFaces& faces, const SurfaceOptions& options,
                                  const mesh::DistributedMesh& before, mesh::DistributedMesh& surface) {
  if (faces.follow.empty()) return {};
  return MovedFaceRemesher(model, field, faces, options).run(before, surface);
}

}  // namespace aeroloom::surface
