/// The steps of the decomposition, taken one by one so that tests can look at each.
#pragma once

#include "tests/meshes/surfaces.hpp"
#include "volume/lattice/block_points.hpp"
#include "volume/lattice/block_regions.hpp"
#include "volume/lattice/fetch_ghosts.hpp"
#include "volume/lattice/local_surface.hpp"
#include "volume/volume_mesher.hpp"
#include "volume/zones/zones.hpp"

#include <numeric>
#include <random>
#include <span>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::volume {

/// Numbers by chance, the same each time.
class Random {
public:
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(_engine);
  }
  geometry::Vec3 in(const geometry::Box& box) {
    return {between(box.low.x, box.high.x), between(box.low.y, box.high.y), between(box.low.z, box.high.z)};
  }

private:
  std::mt19937_64 _engine{7};
};

/// A surface on its ranks, with sizes: what the stage starts from.
struct Problem {
  Problem(const parallel::Communicator& ranks, const surfaces::Surface& of, sizing::SizeField sizes,
          VolumeOptions claims = {})
      : communicator(ranks),
        surface{mesh::number_mesh(surfaces::spread(ranks, of)), std::move(sizes)},
        options(claims) {}

  VolumeInput input() const { return {surface, options}; }

  parallel::Communicator communicator;
  sizing::SizedSurface surface;
  VolumeOptions options;
};

/// The box of all points of a surface.
inline geometry::Box box_of(const surfaces::Surface& surface) {
  geometry::Box box;
  for (const geometry::Vec3& p : surface.points) box.add(p);
  return box;
}

/// The lattice of a problem, and what changes of its blocks a test may make.
struct GrownLattice : Lattice {
  GrownLattice(const Problem& problem, const geometry::Box& box)
      : Lattice(grow_lattice(problem.input(), box)), changes(tree.block_count()) {}
  GrownLattice(const GrownLattice&) = delete;
  GrownLattice& operator=(const GrownLattice&) = delete;

  std::vector<BlockChange> changes;
};

/// The triangles near a rank's blocks, and the regions of these, which the lattice gets.
struct Surroundings {
  explicit Surroundings(GrownLattice& lattice)
      : triangles(deliver(lattice)),
        surface(triangles),
        found(find_block_regions(lattice, triangles, surface)) {
    lattice.regions = found.of_block;
  }

  static std::vector<SurfaceTriangle> deliver(GrownLattice& lattice) {
    lattice.radii = search_radii_of_blocks(lattice, lattice.tree.first(), lattice.tree.last());
    return add_ghost_triangles(lattice.frame, lattice.tree, lattice.radii, lattice.triangles);
  }

  std::vector<SurfaceTriangle> triangles;
  LocalSurface surface;
  BlockRegions found;
};

/// Zones of a lattice on one rank, of equal load.
inline Zones cut_into_zones(const LatticeTree& tree, std::span<const Load> loads, ZoneIndex count) {
  const Load all = std::accumulate(loads.begin(), loads.end(), Load{0});
  const std::vector<CoarseCell> cells = coarsen(tree, loads, all / (ZoneCuts::cells_per_zone * count));
  return {tree, ZoneCuts(cells, count)};
}

/// A leaf of the lattice, for searches by brute force.
struct LeafOfBlock {
  BlockIndex block;
  int child;
  GridCube cell;
};
inline std::vector<LeafOfBlock> all_leaves(const LatticeTree& tree) {
  std::vector<LeafOfBlock> leaves;
  for (BlockIndex b = 0; b < tree.block_count(); ++b) {
    for (int child = 0; child < tree.leaf_count(b); ++child)
      leaves.push_back({b, child, tree.leaf(b, child)});
  }
  return leaves;
}

}  // namespace aeroloom::volume
