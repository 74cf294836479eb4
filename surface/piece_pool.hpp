/// The surface pieces on a rank during the rounds of the surface stage: prepared from faces, scheduled,
/// meshed. A piece is kept as long as nothing around it changes.
#pragma once

#include "mesh/data/distributed_mesh.hpp"
#include "parallel/storage/task_store.hpp"
#include "surface/curves/curves.hpp"
#include "surface/division/imposed_cuts.hpp"
#include "surface/division/task_distribution.hpp"
#include "surface/surface_report.hpp"

#include <limits>
#include <map>
#include <string>
#include <vector>

namespace aeroloom::surface {

/// What a round found that must be changed before the next round can succeed.
struct Conflicts {
  std::vector<sizing::SizeSource> remedies;  ///< where sizes have to fall
  std::vector<cad::FaceId> undivided;        ///< faces that must become one piece each
  std::string message;                       ///< about the first conflict; empty: none
  double predicted = 0;                      ///< triangles; above most_triangles() nothing was meshed
};

class PiecePool {
public:
  PiecePool(const parallel::Communicator& communicator, const cad::Model& model, const CutOptions& options,
            parallel::TaskStore* tasks = nullptr);

  /// Meshes every face whose curves or sizes have changed since the last round. Meshes nothing if the whole
  /// surface is predicted to have more than most_triangles(). Returns the conflicts of this rank. Collective.
  Conflicts mesh(const CurveMesh& curves, const sizing::SizeField& field);
  /// Triangles predicted in the first round.
  double first_triangles() const { return _first; }
  /// Triangles that the whole surface may have in later rounds: SurfaceOptions::most_growth times those of
  /// the first, but at least twenty thousand; not more than limit_to() allows.
  double most_triangles() const;
  void limit_to(double triangles) { _limit = triangles; }
  /// Whether a face is cut into pieces; known on every rank.
  bool is_divided(cad::FaceId face) const { return _parts[face] - _has_rows[face] > 1; }
  /// From the next round on, these faces are one piece each. Must be called alike on every rank.
  void leave_whole(const std::vector<cad::FaceId>& faces);
  /// The pieces as a mesh. All faces must be meshed.
  mesh::DistributedMesh assemble() const;
  /// The pieces of the mesh that are rows, ascending, the same on every rank.
  std::vector<mesh::PieceId> row_pieces() const;
  /// The angles where cuts end, by face, the same on every rank. Collective.
  std::vector<CutAngle> cut_angles() const;
  /// The relative error that 90 % of the predicted loads do not exceed. Collective.
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
  /// Triangles of the whole surface: of the faces that are kept, and predicted for these problems.
  double predict(const PieceProblems& problems, const sizing::SizeField& field) const;
  /// Seconds to mesh a triangle on this machine, estimated from the time spent on curves. Collective.
  double seconds_per_triangle() const;
  PieceProblems make_face_problems(const std::vector<cad::FaceId>& faces, const CurveMesh& curves,
                                   const sizing::SizeField& field, Conflicts& conflicts);
  void keep_rows(const FaceRows& rows, const CurveMesh& curves, const sizing::SizeField& field);
  /// Gives the pieces of rows their places behind all others of their faces. Collective.
  void place_rows(const std::vector<cad::FaceId>& faces);
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
  bool _is_complete = false;  // a round has made all faces
  double _first = 0;          // triangles predicted in the first round
  double _limit = std::numeric_limits<double>::infinity();
  std::vector<std::int32_t> _parts;     // per face: pieces, 0 before it is divided
  std::vector<std::int32_t> _has_rows;  // per face: 1 where one of them is rows
  std::map<PieceKey, double> _costs;    // of faces prepared here in this round, in triangles to mesh
  std::map<PieceKey, Meshed> _meshed;   // on this rank
  std::map<PieceKey, std::vector<CutAngle>> _angles;  // of what was divided on this rank
};

}  // namespace aeroloom::surface
