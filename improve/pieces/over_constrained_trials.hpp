/// Over-constrained tetrahedra that go only at the cost of angles around them: changes are tried on a copy of
/// what is around, and kept where the angles can be made good again.
#pragma once

#include "improve/improve_options.hpp"
#include "improve/tets/tet_mesh.hpp"
#include "mesh/data/piece.hpp"
#include "sizing/field/size_field.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::improve {

/// For each tetrahedron with several faces on the boundary, by slot: what is within two edges is copied, the
/// best few changes that remove it (over_constrained_removal.hpp) are done there one after the other, each on
/// a copy of its own, the copy is improved like a piece whose boundary stays, and takes the place of the
/// original as soon as no tetrahedron is below the target and below the worst of before, no more are below
/// the target, and fewer have several faces on the boundary. Nothing is tried where some around it miss the
/// target.
class OverConstrainedTrials {
public:
  /// At most so many changes for each.
  OverConstrainedTrials(const sizing::SizeField* field, int most, Effort effort)
      : _field(field), _most(most), _effort(effort) {}

  /// Returns how many copies took the place of the original.
  std::int64_t run(TetMesh& mesh);

private:
  /// The state around one, compared before and after a trial.
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
  /// The copy's tetrahedra take the place of those they differ from; `origin`: of its vertices, the number
  /// before it was improved.
  void put_back(TetMesh& mesh, const mesh::Piece& piece, const std::vector<LocalIndex>& origin);

  const sizing::SizeField* _field;
  int _most;
  Effort _effort;
  std::vector<LocalIndex> _tets, _star;  ///< copied
  std::vector<LocalIndex> _vertices;     ///< of those, by number in the copy
  std::vector<char> _inside;             ///< per vertex of the copy: whether it may move
  std::vector<LocalIndex> _number;       ///< per vertex of the mesh: its number in the copy, -1
  std::vector<LocalIndex> _placed;
};

}  // namespace aeroloom::improve
