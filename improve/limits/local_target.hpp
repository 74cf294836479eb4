/// The quality that a tetrahedron should reach. It is lower in narrow regions: where two CAD curves are
/// closer than the elements along them.
#pragma once

#include "improve/tets/tet_mesh.hpp"
#include "mesh/data/piece.hpp"
#include "mesh/quality/tet_quality.hpp"

#include <algorithm>
#include <vector>

namespace aeroloom::improve {

/// A surface triangle between two curves keeps its width w and length l. A tetrahedron on it with height h
/// has dihedral angles of about w / h, and leaves about h / l to its neighbours. So the worst quality is
/// about sqrt(w / l) at best, which is the local target. For tetrahedra with fewer vertices on the triangle,
/// it rises to the target in geometric steps.
class LocalTarget {
public:
  /// Uses the same target everywhere.
  explicit LocalTarget(const mesh::TetQuality& measure) : _target(measure.target()) {}
  /// Takes local targets from the boundary triangles of a piece.
  LocalTarget(const mesh::Piece& piece, const mesh::TetQuality& measure);

  /// The quality, at most the target, below which a tetrahedron with these vertices is worked on. Vertices
  /// added after construction count as unconstrained.
  template <class Vertices>
  double operator()(const Vertices& corners) const {
    if (_least.empty()) return _target;
    double least = _target;
    int count = 0;
    for (int k = 0; k < 4; ++k) {
      const auto v = static_cast<std::size_t>(corners[k]);
      if (v >= _least.size() || _least[v] >= _target) continue;
      least = std::min(least, static_cast<double>(_least[v]));
      ++count;
    }
    return count == 0 ? _target : between(least, count);
  }
  /// Whether it is below the target.
  template <class Vertices>
  bool is_limited(const Vertices& corners) const {
    return (*this)(corners) < _target;
  }
  /// Whether a quality is so low that any gain is worth its cost.
  bool is_severe(double quality) const { return quality < severe * _target; }
  /// Whether a change that raises the worst quality may be made. Outside narrow regions always. Inside, one
  /// tetrahedron is easily improved at the cost of ten others. There the sum of squared relative deficits
  /// must fall, or a severe case must end or improve by half.
  bool accepts(const TetMesh& mesh, const CavityReplacement& cavity) const;

private:
  static constexpr double severe = 0.2;  ///< of the target: about 5 degrees
  double between(double least, int count) const;

  double _target;
  std::vector<float> _least;  ///< per vertex, the minimum over its triangles; empty if nothing is lowered
};

}  // namespace aeroloom::improve
