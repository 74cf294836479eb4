/// New vertices in voids: where the sphere around a tetrahedron is empty and large, its centre is a good
/// place for a vertex that is missing.
#pragma once

#include "improve/tet_mesh.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace aeroloom::improve {

/// Inserts the centres of circumscribed spheres (Bowyer, Comput. J. 24, 1981, doi:10.1093/comjnl/24.2.162;
/// Watson, ibid., doi:10.1093/comjnl/24.2.167) where the mean ratio of the cavity rises on average, its worst
/// TetQuality does not fall, and no edge becomes short.
class VoidFilling {
public:
  /// Tries every tetrahedron there is at the start, in their order. Returns the number of vertices inserted.
  std::int64_t run(TetMesh& mesh);

private:
  struct Wall {
    std::array<LocalIndex, 3> corners;  ///< counter-clockwise seen from inside
  };
  bool is_candidate(const TetMesh& mesh, LocalIndex t);
  bool collect_cavity(const TetMesh& mesh, LocalIndex t);
  bool gains(const TetMesh& mesh);
  bool keeps_vertices(const TetMesh& mesh);

  Vec3 _center;
  double _squared_radius = 0;  ///< of the sphere
  double _least_edge = 0;      ///< nothing may be nearer to the centre
  Replacement _cavity;
  std::vector<Wall> _walls;
  /// Per slot: in which cavity it was last found inside or outside, and whether a larger sphere around its
  /// place was tried already.
  struct State {
    std::int32_t inside = 0, outside = 0;
    bool in_vain = false;
  };
  std::vector<State> _state;
  std::int32_t _now = 0;  ///< the number of the cavity
  std::vector<LocalIndex> _inside, _placed;
};

}  // namespace aeroloom::improve
