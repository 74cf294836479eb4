/// What is inside of a Decomposition. Used by the two halves of the stage's driver.
#pragma once

#include "volume/block_points.hpp"
#include "volume/block_regions.hpp"
#include "volume/halo.hpp"
#include "volume/near_surface.hpp"
#include "volume/volume_mesher.hpp"
#include "volume/zone_plan.hpp"
#include "volume/zone_supply.hpp"

#include <memory>
#include <vector>

namespace aeroloom::volume {

struct Decomposition::Data {
  // The same on every rank.
  std::unique_ptr<const LatticeFrame> frame;
  std::unique_ptr<const LatticeTree> tree;
  SurfaceTable table;
  std::vector<mesh::RegionId> regions;  ///< per block, of those of this rank
  std::vector<BlockChange> changes;     ///< per block
  std::vector<BlockIndex> shares;       ///< see share_blocks
  std::vector<std::uint8_t> counts;     ///< points per block
  std::unique_ptr<Zones> zones;
  std::vector<double> expected;  ///< tetrahedra per zone
  DecompositionReport report;

  // Of this rank's blocks.
  SurfaceReach reach;                          ///< as triangles were gathered; nothing on one rank
  std::vector<SurfaceTriangle> triangles;      ///< that meet them
  std::unique_ptr<const NearSurface> surface;  ///< while points are made
  std::unique_ptr<const TrianglesOfBlocks> of_blocks;
  BlockPoints points;
  ZonePlan plan;  ///< of all zones

  BlockTables tables() const { return {*frame, *tree, table, counts, *zones}; }
  LatticeSource source(const VolumeInput& input) const {
    return {*frame, *tree,   input.field,
            table,  regions, {input.options.lattice_clearance, input.options.perturbation},
            changes};
  }
};

/// Makes the points of this rank's blocks (anew) and counts those of all; the surface they were made with is
/// let go. Collective.
void make_all_points(const parallel::Communicator& communicator, const VolumeInput& input,
                     Decomposition::Data& data, parallel::StageClock& clock);

}  // namespace aeroloom::volume
