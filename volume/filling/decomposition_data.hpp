/// The inside of a Decomposition, which the two halves of the stage's driver share.
#pragma once

#include "volume/core/core_border.hpp"
#include "volume/filling/zone_plan.hpp"
#include "volume/filling/zone_supply.hpp"
#include "volume/lattice/block_points.hpp"
#include "volume/lattice/block_regions.hpp"
#include "volume/lattice/near_surface.hpp"
#include "volume/volume_mesher.hpp"
#include "volume/zones/halo.hpp"

#include <memory>
#include <vector>

namespace aeroloom::volume {

struct Decomposition::Data {
  // Frame, tree and table are the same on every rank as far as it knows the blocks.
  std::unique_ptr<const LatticeFrame> frame;
  std::unique_ptr<LatticeTree> tree;
  SurfaceTable table;
  std::vector<mesh::RegionId> regions;  ///< of this rank's blocks
  std::vector<BlockChange> changes;     ///< per block
  std::unique_ptr<const CoreSquares> squares;
  std::unique_ptr<Zones> zones;
  std::vector<double> expected;      ///< tetrahedra per zone, without the core's
  std::int64_t core_piece_tets = 0;  ///< wanted tetrahedra of a piece of the core
  DecompositionReport report;

  // Of this rank's blocks.
  SearchRadii radii;                           ///< as triangles were gathered; nothing on one rank
  std::vector<SurfaceTriangle> triangles;      ///< that meet them
  std::unique_ptr<const NearSurface> surface;  ///< while points are made
  std::unique_ptr<CoreLeaves> core;
  ShellShare shell;
  ZonePlan plan;  ///< of all zones

  KnownLattice known() { return {*frame, *tree, table}; }
  ZoneFinder finder(const VolumeInput& input) const {
    return {*frame, *tree, *zones, input.numbering.vertex_count};
  }
  ZoneStore store(const VolumeInput& input) const {
    return {source(input), finder(input), shell.points, triangles, shell.borders, *core};
  }
  LatticeSource source(const VolumeInput& input) const {
    return {*frame, *tree,   input.field,
            table,  regions, {input.options.lattice_clearance, input.options.perturbation},
            changes};
  }
};

/// Makes the points of this rank's blocks (anew), tells core from shell, and counts what the shells of all
/// have; the surface they were made with is let go. Returns those of this rank's blocks whose core is another
/// than before. Collective.
std::vector<BlockIndex> make_all_points(const VolumeInput& input, Decomposition::Data& data);

}  // namespace aeroloom::volume
