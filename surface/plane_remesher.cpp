#include "surface/plane_remesher.hpp"

#include "geometry/sort_unique.hpp"
#include "mesh/exchange/shared_vertices.hpp"
#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/timers.hpp"
#include "surface/charts/chart_mesher.hpp"
#include "surface/curves/face_loops.hpp"
#include "surface/curves/free_curves.hpp"
#include "surface/division/task_distribution.hpp"
#include "surface/piece_mesher.hpp"
#include "surface/plane_problem.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace aeroloom::surface {
namespace {

using cad::FaceId;
using parallel::ScopedCpu;

/// New pieces of some faces.
class PlaneRemesher {
public:
  PlaneRemesher(const cad::Model& model, const sizing::SizeField& field, const PlanesToRemesh& planes,
                mesh::DistributedMesh& surface)
      : _model(model),
        _field(field),
        _faces(planes.faces),
        _surface(surface),
        _options{planes.options},
        _distributor(surface.communicator, model, _options) {}

  /// Pieces of all faces, unless there are conflicts.
  PlaneConflicts mesh() {
    _loops = gather_loops(_surface, _faces);
    parallel::collectively(_surface.communicator, ScopedCpu::As::task, [&] {
      for (auto& [face, loops] : _loops) spread_on_free_curves(_model, _field, face, _faces, loops);
    });
    for (std::vector<FaceId> faces = _faces; !faces.empty();) {
      PieceProblems whole = make_face_problems(faces);
      if (PlaneConflicts found = gather_conflicts(); !found.empty()) return found;
      TaskDistribution distribution = _distributor.distribute(std::move(whole), _costs, _field);
      for (const FaceId face : faces) _parts[face] = 0;
      for (const auto& [key, place] : distribution.places) ++_parts[key[0]];
      parallel::agree(_surface.communicator, [&] { mesh_problems(distribution); });
      if (PlaneConflicts found = gather_conflicts(); !found.empty()) return found;
      faces = leave_whole();
    }
    return {};
  }

  /// Puts the new pieces in the place of the old ones.
  void replace() {
    const mesh::PieceId kept = drop_old();
    std::map<FaceId, mesh::PieceId> first;
    _surface.piece_count = kept;
    for (const auto& [face, parts] : _parts) {
      first[face] = _surface.piece_count;
      _surface.piece_count += parts;
    }
    for (auto& [place, piece] : _pieces) {
      piece.id = first[place.first] + place.second;
      _surface.pieces.push_back(std::move(piece));
    }
    classify_like_others(kept);
  }

private:
  /// Of faces whose loops are on this rank.
  PieceProblems make_face_problems(const std::vector<FaceId>& faces) {
    constexpr double seconds_per_triangle = 3e-6;  // about; no result depends on it
    PieceProblems problems;
    _costs.clear();
    parallel::collectively(_surface.communicator, ScopedCpu::As::task, [&] {
      for (const auto& [face, loops] : _loops) {
        if (!std::binary_search(faces.begin(), faces.end(), face)) continue;
        const double begin = parallel::cpu_seconds();
        const PieceKey key{face, 0, 0};
        try {
          problems.emplace(key, problem_of_plane(_model, face, loops, _field));
        } catch (const FaceConflict& conflict) {
          blame(conflict.vertices(), conflict.what());
        }
        _costs[key] = (parallel::cpu_seconds() - begin) / seconds_per_triangle;
      }
    });
    return problems;
  }

  void mesh_problems(const TaskDistribution& distribution) {
    for (const auto& [key, problem] : distribution.problems) {
      const ScopedCpu cpu(ScopedCpu::As::task);
      const double begin = parallel::cpu_seconds();
      const FaceId face = key[0];
      try {
        mesh::Piece piece = mesh_piece(_model, problem, _field, _options);
        parallel::note_task({parallel::TaskKind::surface_piece, face,
                             load_of_piece(problem.load, problem.facets()), parallel::cpu_seconds() - begin,
                             mesh::bytes_at_rest(piece)});
        _pieces.insert_or_assign({face, distribution.places.at(key)}, std::move(piece));
      } catch (const FaceConflict& conflict) {
        reject(face, problem, conflict.vertices(), conflict.what());
      } catch (const SurfaceError& error) {
        reject(face, problem, {}, error.what());
      }
    }
  }

  /// A face that its pieces make fail is left whole; else the vertices on its loops are to blame, all where
  /// nobody knows which.
  void reject(FaceId face, const PieceProblem& problem, const std::vector<mesh::SharedVertexKey>& vertices,
              const std::string& message) {
    if (_parts[face] > 1) {
      _undivided.push_back(face);
    } else {
      blame(vertices.empty() ? problem.vertices.vertex_keys : vertices, message);
    }
  }

  void blame(const std::vector<mesh::SharedVertexKey>& vertices, const std::string& message) {
    _mine.vertices.insert(_mine.vertices.end(), vertices.begin(), vertices.end());
    if (_mine.message.empty()) _mine.message = message;
  }

  /// Those of all ranks; the message of the lowest rank that has one.
  PlaneConflicts gather_conflicts() const {
    PlaneConflicts all;
    all.vertices = _surface.communicator.all_gather_items<mesh::SharedVertexKey>(_mine.vertices);
    geometry::sort_unique(all.vertices);
    for (const std::string& message : _surface.communicator.all_gather_values(_mine.message)) {
      if (all.message.empty()) all.message = message;
    }
    return all;
  }

  /// The faces that are to be made again in one piece each, ascending, the same on every rank.
  std::vector<FaceId> leave_whole() {
    std::vector<FaceId> faces = _surface.communicator.all_gather_items<FaceId>(_undivided);
    geometry::sort_unique(faces);
    _undivided.clear();
    _distributor.leave_whole(faces);
    std::erase_if(_pieces, [&](const auto& entry) {
      return std::binary_search(faces.begin(), faces.end(), entry.first.first);
    });
    return faces;
  }

  /// Takes the pieces of the faces away; others get the numbers from 0 on. Returns how many these are.
  mesh::PieceId drop_old() {
    const auto is_old = [&](const mesh::Piece& piece) {
      return std::binary_search(_faces.begin(), _faces.end(), piece.common_face());
    };
    std::vector<mesh::PieceId> old;
    for (const mesh::Piece& piece : _surface.pieces) {
      if (is_old(piece)) old.push_back(piece.id);
    }
    old = _surface.communicator.gather_sorted(old);
    std::erase_if(_surface.pieces, is_old);
    for (mesh::Piece& piece : _surface.pieces) {
      piece.id -=
          static_cast<mesh::PieceId>(std::lower_bound(old.begin(), old.end(), piece.id) - old.begin());
    }
    return _surface.piece_count - static_cast<mesh::PieceId>(old.size());
  }

  /// Vertices of the new pieces, from `first_new` on, that older ones know are classified as there.
  void classify_like_others(mesh::PieceId first_new) {
    struct Place {
      std::int32_t dimension, entity;
    };
    const mesh::SharedVertices shared(_surface);
    std::vector<Place> places(shared.size());
    shared.for_each([&](std::size_t p, mesh::LocalIndex v, std::size_t copy) {
      const mesh::Piece& piece = _surface.pieces[p];
      places[copy] = {static_cast<std::int32_t>(piece.vertex_dimension[v]), piece.vertex_entity[v]};
    });
    shared.scatter(places);
    shared.for_each([&](std::size_t p, mesh::LocalIndex v, std::size_t copy) {
      mesh::Piece& piece = _surface.pieces[p];
      if (piece.id < first_new) return;
      piece.vertex_dimension[v] = static_cast<mesh::CadDimension>(places[copy].dimension);
      piece.vertex_entity[v] = places[copy].entity;
    });
  }

  const cad::Model& _model;
  const sizing::SizeField& _field;
  const std::vector<FaceId>& _faces;
  mesh::DistributedMesh& _surface;
  CutOptions _options;
  TaskDistributor _distributor;
  std::map<FaceId, FaceLoops> _loops;     // on this rank
  std::map<PieceKey, double> _costs;      // of the piece problems made here, in triangles to mesh
  std::map<FaceId, std::int32_t> _parts;  // of each face: pieces
  std::map<std::pair<FaceId, std::int32_t>, mesh::Piece> _pieces;  // on this rank, by face and place there
  PlaneConflicts _mine;                                            // of this rank
  std::vector<FaceId> _undivided;                                  // of this rank: to be one piece each
};

}  // namespace

PlaneConflicts remesh_planes(const cad::Model& model, const sizing::SizeField& field,
                             const PlanesToRemesh& planes, mesh::DistributedMesh& surface) {
  if (planes.faces.empty()) return {};
  PlaneRemesher remesher(model, field, planes, surface);
  PlaneConflicts conflicts = remesher.mesh();
  if (conflicts.empty()) remesher.replace();
  return conflicts;
}

}  // namespace aeroloom::surface
