/// Simplification of the dual graph of background tetrahedra before it is partitioned.
#pragma once

#include "partition/background_volume.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::partition {

/// The contracted dual graph.
struct VolumeClusters {
  std::vector<std::int32_t> of_tet;  ///< cluster per tetrahedron, numbered by first tetrahedron
  std::vector<double> loads;         ///< per cluster
  std::int32_t unresolved = 0;       ///< wedges left open because their clusters would grow too heavy

  std::int32_t count() const { return static_cast<std::int32_t>(loads.size()); }
};

/// Joins what closed vertices and edges hold together, then contracts arcs, the sharpest wedges first. Of the
/// two faces of a wedge that one is contracted whose clusters are lighter together. A wedge does not make a
/// cluster grow beyond `largest_load`. Deterministic.
VolumeClusters simplify(const BackgroundVolume& volume, const EdgeRings& rings, double smallest_angle,
                        double largest_load);

}  // namespace aeroloom::partition
