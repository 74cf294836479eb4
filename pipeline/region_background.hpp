/// Background tetrahedra of one region, from the coarse surface around it.
#pragma once

#include "mesh/distributed_mesh.hpp"
#include "parallel/timers.hpp"
#include "partition/background_volume.hpp"
#include "partition/coarse_surface.hpp"
#include "sizing/size_field.hpp"
#include "volume/volume_mesher.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace aeroloom::pipeline {

/// The coarse surface around one region, turned outwards.
struct RegionSurface {
  volume::ClosedSurface surface;
  std::vector<std::int32_t> vertex;  ///< coarse vertex per point
  std::vector<std::int32_t> cell;    ///< per triangle
};

RegionSurface surface_of(const partition::CoarseSurface& coarse, const std::vector<partition::Cell>& cells,
                         const mesh::DistributedMesh& surface, mesh::RegionId region);

/// Cells whose coarse triangles are degenerate or meet others; may repeat.
std::vector<std::int32_t> cells_to_cut(const RegionSurface& region);

/// The chord between two coarse vertices.
class ChordIndex {
public:
  explicit ChordIndex(const partition::CoarseSurface& coarse);
  /// -1 without one.
  std::int32_t find(std::int32_t a, std::int32_t b) const;

private:
  std::vector<std::array<std::int32_t, 3>> _rows;  // ends ascending, chord; sorted
};

/// One boundary triangle of the background: its tetrahedron and cell.
struct BoundaryFace {
  std::int32_t tet, cell;
};

struct RegionBackground {
  partition::BackgroundVolume volume;
  std::vector<std::int32_t> coarse_vertex;  ///< per point, -1 inside
  std::vector<BoundaryFace> boundary;       ///< per triangle of the region's surface
};

/// Fills the coarse surface with tetrahedra at most `width` times as large as the sizes of the field, and
/// predicts what each of them will hold. What the contained run costs is counted as serial work. Throws
/// VolumeError.
RegionBackground fill_background(const RegionSurface& region, const partition::CoarseSurface& coarse,
                                 const ChordIndex& chords, const sizing::SizeField& field, double width,
                                 parallel::StageClock& clock);

}  // namespace aeroloom::pipeline
