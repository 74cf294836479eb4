/// From the blocks that ranks have to the problems that zones are.
#pragma once

#include "mesh/piece.hpp"
#include "mesh/tokens.hpp"
#include "parallel/communicator.hpp"
#include "parallel/timers.hpp"
#include "volume/block_points.hpp"
#include "volume/core_border.hpp"
#include "volume/halo.hpp"
#include "volume/owned_cells.hpp"
#include "volume/surface_share.hpp"
#include "volume/zones.hpp"

#include <span>
#include <tuple>
#include <vector>

namespace aeroloom::volume {

/// All that a zone knows: what TetGen gets, and what the mesh piece will need.
struct ZoneContent {
  ZoneIndex zone = no_zone;
  ZoneProblem problem;
  std::vector<mesh::SharedToken>
      tokens;                          ///< per point, ascending: number in the surface, then lattice points
  std::vector<std::int8_t> dimension;  ///< per surface point
  std::vector<std::int32_t> entity;    ///< per surface point
  std::vector<std::int32_t> face, patch;  ///< per triangle
  std::vector<LeafNumber> border_leaves;  ///< per triangle of the core's border: the core leaf beside it
};

/// What everyone knows of the blocks.
struct BlockTables {
  const LatticeFrame& frame;
  const LatticeTree& tree;
  const SurfaceTable& table;
  std::span<const std::uint8_t> points;   ///< of the shell, per block
  std::span<const std::uint8_t> borders;  ///< triangles of the core's border, per block
  const Zones& zones;
};

/// A zone wants leaves of a block, to be sent to the rank that fills it.
struct ZoneWant {
  ZoneIndex zone;
  BlockIndex block;
  parallel::Rank rank;
  std::int32_t leaves;  ///< a bit each

  static constexpr auto fields() {
    return std::tuple(&ZoneWant::zone, &ZoneWant::block, &ZoneWant::rank, &ZoneWant::leaves);
  }
};

/// What a rank has of the shell: the points of its blocks, the triangles that meet them, the core's border.
struct BlockStore {
  const BlockPoints& points;
  std::span<const SurfaceTriangle> triangles;
  const TrianglesOfBlocks& of_blocks;
  const BlockBorders& borders;
  const CoreLeaves& core;
};

/// Where tokens and places belong.
class ZoneFinder {
public:
  ZoneFinder(const LatticeFrame& frame, const LatticeTree& tree, const Zones& zones,
             mesh::GlobalIndex surface_vertices)
      : _frame(frame), _tree(tree), _zones(zones), _surface_vertices(surface_vertices) {}

  Leaf leaf_of_place(geometry::Vec3 p) const {
    const sizing::GridPoint cell = _frame.cell_at(_frame.to_grid(p));
    const BlockIndex b = _tree.block_at(cell);
    return {b, _tree.child_at(b, cell)};
  }
  /// The leaf of a vertex with this token at this place.
  Leaf leaf_of(mesh::SharedToken token, geometry::Vec3 p) const {
    return is_surface(token) ? leaf_of_place(p)
                             : leaf_of_lattice(static_cast<std::int64_t>(token) - _surface_vertices);
  }
  ZoneIndex zone_of(const Leaf& leaf) const { return _zones.of(leaf.block, leaf.child); }
  bool is_surface(mesh::SharedToken token) const { return token < mesh::running_token(_surface_vertices); }
  std::int64_t lattice_number_of(mesh::SharedToken token) const {
    return static_cast<std::int64_t>(token) - _surface_vertices;
  }
  mesh::SharedToken token_of(std::int64_t lattice_number) const {
    return mesh::running_token(_surface_vertices + lattice_number);
  }

private:
  const LatticeFrame& _frame;
  const LatticeTree& _tree;
  const Zones& _zones;
  mesh::GlobalIndex _surface_vertices;
};

/// Brings together what zones want, each at the rank that its wants name: of the leaves that are wanted the
/// points and triangles that are the zone's or near it, and the triangles of the core's border at its points,
/// `widths` being those of the zones' halos. By zone. Collective.
std::vector<ZoneContent> supply_zones(const parallel::Communicator& communicator, const BlockTables& blocks,
                                      const BlockStore& store, const ZoneFinder& finder,
                                      std::span<const BlockIndex> shares, std::span<const double> widths,
                                      const std::vector<ZoneWant>& wants, parallel::StageClock& clock);

}  // namespace aeroloom::volume
