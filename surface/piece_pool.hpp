/// The surface pieces of a rank through the rounds of a run: made from faces, scheduled, meshed, and kept as
/// long as nothing around them changes.
#pragma once

#include "mesh/data/distributed_mesh.hpp"
#include "parallel/storage/task_store.hpp"
#include "surface/curves/curves.hpp"
#include "surface/division/imposed_cuts.hpp"
#include "surface/division/task_distribution.hpp"
#include "surface/surface_report.hpp"

#include <map>
#include <string>
#include <vector>

namespace aeroloom::surface {

/// Findings of a round that have to be mended before the next one can succeed.
struct Conflicts {
  std::vector<sizing::SizeSource> remedies;  ///< where sizes have to fall
  std::vector<cad::FaceId> undivided;        ///< faces that had better stay whole
  std::string message;                       ///< about the first one; empty: none
  double predicted = 0;  ///< triangles; where these are more than rounds may come to, nothing was meshed
};

class PiecePool {
public:
  PiecePool(const parallel::Communicator& communicator, const cad::Model& model, const CutOptions& options,
            parallel::TaskStore* tasks = nullptr);

  /// Meshes every face whose curves or sizes are not those of the round before, unless the whole surface is
  /// predicted to have more triangles than rounds may come to (SurfaceOptions::most_growth). Collective.
  /// Conflicts are those of this rank.
  Conflicts mesh(const CurveMesh& curves, const sizing::SizeField& field);
  /// Predicted triangles of the first round.
  double first_triangles() const { return _first; }
  /// Triangles that the whole surface may have in later rounds; at least twenty thousand.
  double most_triangles() const;
  /// Whether a face is cut into pieces; known on every rank.
  bool is_divided(cad::FaceId face) const { return _parts[face] > 1; }
  /// From the next round on, these faces are one piece each. The same on every rank.
  void leave_whole(const std::vector<cad::FaceId>& faces);
  /// The pieces as a mesh; all faces must be meshed.
  mesh::DistributedMesh assemble() const;
  /// The angles where cuts end, by face; the same on every rank. Collective.
  std::vector<CutAngle> cut_angles() const;
  /// The relative error that 90 % of the predicted loads stay below. Collective.
  double load_error_90() const;
  std::int64_t divided_faces() const;

private:
  struct Meshed {
    mesh::Piece piece;
    std::vector<double> vertex_sizes;         // to see whether it has to be made again
    std::vector<std::int32_t> edge_vertices;  // on each edge use of its face
    double load;
    std::int32_t place;  // among the pieces of its face
  };
  bool is_unchanged(const CurveMesh& curves, const sizing::SizeField& field, cad::FaceId face,
                    const Meshed& meshed) const;
  std::vector<std::int32_t> edge_vertices(const CurveMesh& curves, cad::FaceId face) const;
  std::vector<cad::FaceId> changed_faces(const CurveMesh& curves, const sizing::SizeField& field) const;
  /// Triangles of the whole surface: of faces that are kept, and of these piece problems.
  double predict(const PieceProblems& problems, const sizing::SizeField& field) const;
  /// Seconds to mesh a triangle on this machine, from what curves took. Collective.
  double seconds_per_triangle() const;
  PieceProblems make_face_problems(const std::vector<cad::FaceId>& faces, const CurveMesh& curves,
                                   const sizing::SizeField& field);
  mesh::Piece mesh_or_find(const PieceProblem& problem, const sizing::SizeField& field,
                           const parallel::Digest& of_field) const;
  void mesh_problems(const TaskDistribution& distribution, const CurveMesh& curves,
                     const sizing::SizeField& field, Conflicts& conflicts);

  parallel::Communicator _communicator;
  const cad::Model& _model;
  const CutOptions& _options;
  parallel::TaskStore* _tasks;  // may be null
  TaskDistributor _distributor;
  bool _started = false;
  double _first = 0;                 // triangles predicted in the first round
  std::vector<std::int32_t> _parts;  // per face: pieces, 0 before it is divided
  std::map<PieceKey, double>
      _costs;  // of the piece problems of faces made here in this round, in triangles to mesh
  std::map<PieceKey, Meshed> _meshed;                 // on this rank
  std::map<PieceKey, std::vector<CutAngle>> _angles;  // of what was divided on this rank
};

}  // namespace aeroloom::surface
