/// Which edges of the mesh are on CAD curves.
#pragma once

#include "mesh/data/distributed_mesh.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace aeroloom::attribution {

/// The vertices of an edge, ascending.
using EdgeEnds = std::array<mesh::GlobalIndex, 2>;

EdgeEnds ends_of(const std::vector<mesh::GlobalIndex>& names, mesh::LocalIndex a, mesh::LocalIndex b);

/// Tells of edges that were asked for whether they are on a CAD curve: triangles of two CAD faces meet there.
class CurveEdges {
public:
  /// Collective; `asked` are those that this rank will ask about.
  CurveEdges(const mesh::NumberedMesh& mesh, std::vector<EdgeEnds> asked);

  /// Of an edge that some rank asked for.
  bool has(const EdgeEnds& edge) const;

private:
  std::int64_t find(const EdgeEnds& edge) const;

  std::vector<EdgeEnds> _asked;  // on all ranks, ascending
  std::vector<std::uint8_t> _is_on_curve;
};

}  // namespace aeroloom::attribution
