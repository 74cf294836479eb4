/// The steps of the decomposition, taken one by one so that tests can look at each.
#pragma once

#include "tests/volume/surfaces.hpp"
#include "volume/lattice/block_points.hpp"
#include "volume/lattice/block_regions.hpp"
#include "volume/lattice/near_surface.hpp"
#include "volume/lattice/neighbourhood.hpp"
#include "volume/volume_mesher.hpp"
#include "volume/zones/zones.hpp"

#include <numeric>
#include <random>
#include <span>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::volume {

/// Tests that would do the same on every rank: run on one alone.
class OnOneRank : public testing::Test {
protected:
  void SetUp() override {
    if (parallel::Communicator::world().size() > 1) GTEST_SKIP();
  }
};

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
        surface(surfaces::spread(ranks, of)),
        numbering(mesh::number_mesh(surface)),
        field(std::move(sizes)),
        options(claims) {}

  VolumeInput input() const { return {surface, numbering, field, options}; }

  parallel::Communicator communicator;
  mesh::DistributedMesh surface;
  mesh::Numbering numbering;
  sizing::SizeField field;
  VolumeOptions options;
};

/// The box of all points of a surface.
inline geometry::Box box_of(const surfaces::Surface& surface) {
  geometry::Box box;
  for (const geometry::Vec3& p : surface.points) box.add(p);
  return box;
}

/// Frame, tree and table of a problem: what a rank knows of the lattice.
struct Lattice {
  Lattice(const Problem& problem, const geometry::Box& box)
      : frame(problem.field, box),
        tree(problem.communicator, frame, problem.field, box),
        own_triangles(deliver_surface(frame, tree, problem.surface, problem.numbering)),
        table(tabulate_surface(frame, tree, own_triangles)) {
    learn_what_touches(problem.communicator, known(), own_triangles);
    changes.resize(tree.block_count());
    learn_what_is_far_finer(problem.communicator, known(), source(problem, {}));
    changes.resize(tree.block_count());
  }
  Lattice(const Lattice&) = delete;
  Lattice& operator=(const Lattice&) = delete;

  KnownLattice known() { return {frame, tree, table}; }
  /// What points are made from. `regions` are those of this rank's blocks.
  LatticeSource source(const Problem& problem, std::span<const mesh::RegionId> regions) const {
    return {frame,  tree,    problem.field,
            table,  regions, {problem.options.lattice_clearance, problem.options.perturbation},
            changes};
  }

  LatticeFrame frame;
  LatticeTree tree;
  std::vector<SurfaceTriangle> own_triangles;
  SurfaceTable table;
  std::vector<BlockChange> changes;
};

/// The triangles near a rank's blocks, and the regions of these.
struct Surroundings {
  Surroundings(const Problem& problem, Lattice& lattice)
      : radii(radii_of(problem, lattice)),
        triangles(deliver(problem, lattice)),
        surface(triangles),
        found(find_block_regions(problem.communicator, lattice.known(), {triangles, surface, radii})),
        regions(found.of_block) {}

  static SearchRadii radii_of(const Problem& problem, Lattice& lattice) {
    return search_radii_of_blocks(lattice.source(problem, {}), lattice.tree.first(), lattice.tree.last());
  }
  static std::vector<SurfaceTriangle> deliver(const Problem& problem, Lattice& lattice) {
    return add_those_near(problem.communicator, lattice.frame, lattice.tree, radii_of(problem, lattice),
                          lattice.own_triangles);
  }

  SearchRadii radii;
  std::vector<SurfaceTriangle> triangles;
  NearSurface surface;
  BlockRegions found;
  std::span<const mesh::RegionId> regions;
};

/// Zones of a lattice on one rank, of equal load.
inline Zones cut_into_zones(const LatticeTree& tree, std::span<const Load> loads, ZoneIndex count) {
  const Load all = std::accumulate(loads.begin(), loads.end(), Load{0});
  const std::vector<CoarseCell> cells =
      coarsen(parallel::Communicator::self(), tree, loads, all / (ZoneCuts::cells_per_zone * count));
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
