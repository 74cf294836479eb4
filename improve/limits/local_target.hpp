/// The quality that tetrahedra should have, lower where the surface is finer across than along: beside strips
/// between two CAD curves that are narrower than the elements along them.
#pragma once

#include "improve/tets/tet_mesh.hpp"
#include "mesh/data/piece.hpp"
#include "mesh/quality/tet_quality.hpp"

#include <algorithm>
#include <vector>

namespace aeroloom::improve {

/// A triangle between curves stays w wide and l long whatever is done. A tetrahedron over it whose apex is h
/// away has angles of about w / h at the edges to the apex, and leaves faces of height h on edges of length l
/// to its neighbours, whose angles are about h / l: the best worst of both is sqrt(w / l). What touches such
/// a triangle with fewer vertices comes in geometric steps between that and the target.
class LocalTarget {
public:
  /// The target holds everywhere.
  explicit LocalTarget(const mesh::TetQuality& measure) : _target(measure.target()) {}
  /// Reads the boundary triangles of a piece.
  LocalTarget(const mesh::Piece& piece, const mesh::TetQuality& measure);

  /// The quality, at most the target, below which a tetrahedron with these vertices is worth working on.
  /// Vertices that the piece did not have count as free ones.
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
  /// Whether that is less than the target.
  template <class Vertices>
  bool is_limited(const Vertices& corners) const {
    return (*this)(corners) < _target;
  }
  /// Whether a quality is so low that everything is worth a gain.
  bool is_severe(double quality) const { return quality < severe * _target; }
  /// Whether a change that lifts the worst is worth what it leaves. Away from strips always. Beside them what
  /// lifts one tetrahedron easily leaves ten below their targets, all worked on in vain: the sum of squares
  /// of what is missing, as fractions of the local target, must fall, or a severe case end or get far
  /// better.
  bool accepts(const TetMesh& mesh, const CavityReplacement& cavity) const;

private:
  static constexpr double severe = 0.2;  ///< of the target: about 5 degrees
  double between(double least, int count) const;

  double _target;
  std::vector<float> _least;  ///< of each vertex, over its triangles; empty where there is nothing to say
};

}  // namespace aeroloom::improve
