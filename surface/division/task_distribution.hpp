/// Divides heavy piece problems and distributes all of them over the ranks by load.
#pragma once

#include "surface/division/face_division.hpp"
#include "surface/division/imposed_cuts.hpp"
#include "surface/surface_report.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <vector>

namespace aeroloom::surface {

/// Identifies a piece: its face, its index among the parts that the face was cut into, and its index among
/// the parts that this part was cut into.
using PieceKey = std::array<std::int32_t, 3>;
using PieceProblems = std::map<PieceKey, PieceProblem>;

/// The piece problems after distribution.
struct TaskDistribution {
  PieceProblems problems;                            ///< that this rank is to mesh
  std::map<PieceKey, std::int32_t> places;           ///< of all pieces, on every rank: index within its face
  std::map<PieceKey, std::vector<CutAngle>> angles;  ///< of the divisions on this rank
};

/// The estimated cost of meshing a piece with so many triangles and facets, in triangles. No result depends
/// on it.
double load_of_piece(double triangles, double facets);

class TaskDistributor {
public:
  TaskDistributor(const parallel::Communicator& communicator, const cad::Model& model,
                  const CutOptions& options);

  /// From now on, these faces are one piece each. Must be called alike on every rank.
  void leave_whole(const std::vector<cad::FaceId>& faces);
  /// `whole`: problems of whole faces, each on any one rank. `costs`: what this rank spent on making them, in
  /// triangles to mesh. Collective.
  TaskDistribution distribute(PieceProblems whole, const std::map<PieceKey, double>& costs,
                              const sizing::SizeField& field);

private:
  struct Row;
  bool is_to_divide(const Row& row, int level) const;
  std::vector<Row> tabulate(const PieceProblems& problems, const std::map<PieceKey, double>& costs) const;
  PieceProblems send_to_owners(PieceProblems problems, const std::vector<Row>& rows,
                               const std::vector<parallel::Rank>& owners) const;
  PieceProblems divide_heavy(PieceProblems problems, const std::vector<Row>& rows, int level,
                             CoarseSizes& sizes);
  void divide(PieceProblems::value_type& entry, int level, CoarseSizes& sizes, PieceProblems& divided);

  parallel::Communicator _communicator;
  const cad::Model& _model;
  const CutOptions& _options;
  std::vector<char> _whole;    // per face: 1 where it must not be divided
  std::vector<double> _loads;  // per rank: work so far in this distribution, in triangles to mesh
  std::map<PieceKey, std::vector<CutAngle>> _angles;  // of the divisions on this rank
};

}  // namespace aeroloom::surface
