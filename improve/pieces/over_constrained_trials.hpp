/// Trials that remove over-constrained tetrahedra: those with several faces on the boundary. Each trial is
/// made on a copy of the surroundings and kept only if all angles are good in the end.
#pragma once

#include "improve/improve_options.hpp"
#include "improve/tets/tet_mesh.hpp"
#include "mesh/data/piece.hpp"
#include "sizing/field/size_field.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::improve {

/// Treats each over-constrained tetrahedron in the order of slots. Copies the tetrahedra within two edges and
/// makes the best few changes of OverConstrainedRemoval there, each on a copy of its own. The copy is
/// improved with its boundary fixed. It replaces the original if no tetrahedron is below both the target and
/// the former worst, no more are bad, and fewer are over-constrained. Nothing is tried if some tetrahedra
/// around already miss the target.
class OverConstrainedTrials {
public:
  /// `most`: largest number of trials for each tetrahedron.
  OverConstrainedTrials(const sizing::SizeField* field, int most, Effort effort)
      : _field(field), _most(most), _effort(effort) {}

  /// Returns how many copies replaced their originals.
  std::int64_t run(TetMesh& mesh);

private:
  /// Summary of the surroundings, compared before and after a trial.
  struct State {
    double worst = 1;
    std::int64_t bad = 0, over_constrained = 0;
    void add(const TetMesh& mesh, LocalIndex t);
  };
  static State examine(const TetMesh& mesh);
  static State examine(const TetMesh& mesh, const std::vector<LocalIndex>& tets);
  static bool is_better(const State& now, const State& before, double target);

  bool remove(TetMesh& mesh, LocalIndex t);
  void collect(TetMesh& mesh, LocalIndex t);
  mesh::Piece copy(const TetMesh& mesh) const;
  /// Replaces the original tetrahedra that differ by those of the copy. `origin`: for each vertex of the
  /// copy, its number before improvement.
  void put_back(TetMesh& mesh, const mesh::Piece& piece, const std::vector<LocalIndex>& origin);

  const sizing::SizeField* _field;
  int _most;
  Effort _effort;
  std::vector<LocalIndex> _tets, _star;  ///< tetrahedra copied
  std::vector<LocalIndex> _vertices;     ///< their vertices, by number in the copy
  std::vector<char> _inside;             ///< per vertex of the copy: whether it may move
  std::vector<LocalIndex> _number;       ///< per vertex of the mesh: its number in the copy, or -1
  std::vector<LocalIndex> _placed;
};

}  // namespace aeroloom::improve
