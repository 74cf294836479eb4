/// From the blocks that ranks have to the problems that zones are.
#pragma once

#include "mesh/data/piece.hpp"
#include "mesh/data/shared_vertex_keys.hpp"
#include "parallel/communication/communicator.hpp"
#include "parallel/observation/timers.hpp"
#include "volume/core/core_border.hpp"
#include "volume/filling/owned_cells.hpp"
#include "volume/lattice/block_points.hpp"
#include "volume/lattice/surface_near_blocks.hpp"
#include "volume/zones/zones.hpp"

#include <span>
#include <tuple>
#include <vector>

namespace aeroloom::volume {

/// All that a zone knows: what TetGen gets, and what the mesh piece will need.
struct ZoneContent {
  ZoneIndex zone = no_zone;
  ZoneProblem problem;
  std::vector<mesh::SharedVertexKey>
      vertex_keys;  ///< per point, ascending: number in the surface, then lattice points
  mesh::GlobalIndex surface_vertices = 0;     ///< before the first lattice point
  std::vector<LeafNumber> leaves;             ///< per point: that it belongs to
  std::vector<mesh::CadDimension> dimension;  ///< per surface point
  std::vector<std::int32_t> entity;           ///< per surface point
  std::vector<std::int32_t> face, patch;      ///< per triangle
  std::vector<LeafNumber> border_leaves;      ///< per triangle of the core's border: the core leaf beside it
};

/// Where places and points of the lattice belong. Refers to all it is made from.
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
  ZoneIndex zone_of(const Leaf& leaf) const { return _zones.of(leaf.block, leaf.child); }
  const Zones& zones() const { return _zones; }
  mesh::GlobalIndex surface_vertices() const { return _surface_vertices; }
  mesh::SharedVertexKey vertex_key_of(std::int64_t lattice_number) const {
    return mesh::running_key(_surface_vertices + lattice_number);
  }

private:
  const LatticeFrame& _frame;
  const LatticeTree& _tree;
  const Zones& _zones;
  mesh::GlobalIndex _surface_vertices;
};

/// The share of a rank in the shell: the points of its blocks, the triangles that meet them, the core's
/// border.
struct ZoneStore {
  LatticeSource lattice;
  ZoneFinder finder;
  const BlockPoints& points;
  std::span<const SurfaceTriangle> triangles;
  const BlockBorders& borders;
  const CoreLeaves& core;
};

/// The points, triangles and leaves that a rank supplies to zones.
struct ZoneShipment {
  struct OfBlock {
    ZoneIndex zone;
    BlockIndex block;
    std::uint64_t points;  ///< of the block, a bit each
    std::uint8_t leaves;   ///< whose border triangles it may know, a bit each
  };
  struct Triangle {
    ZoneIndex zone;
    std::int32_t triangle;
  };
  std::vector<OfBlock> blocks;  ///< by zone, then block
  std::vector<Triangle> triangles;
  std::vector<parallel::Rank> ranks;  ///< per zone: where to
};

/// Sends what zones know to the ranks that fill them: points, triangles, and the triangles of the core's
/// border at its points. Returns the zones of this rank, by number. Collective.
std::vector<ZoneContent> supply_zones(const parallel::Communicator& communicator, const ZoneStore& store,
                                      const ZoneShipment& shipment);

}  // namespace aeroloom::volume
