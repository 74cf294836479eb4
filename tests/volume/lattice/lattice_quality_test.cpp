/// The lattice alone: its Delaunay mesh and its density.
#include "mesh/quality/quality.hpp"
#include "tests/volume/fields.hpp"
#include "tests/volume/steps.hpp"
#include "volume/filling/tetgen_run.hpp"
#include "volume/lattice/block_points.hpp"

#include <algorithm>

#include <gtest/gtest.h>

namespace aeroloom::volume {
namespace {

using geometry::Vec3;
using mesh::RegionId;
using parallel::Communicator;

/// In all space, without any surface.
struct Endless {
  Endless(const sizing::SizeField& field, const geometry::Box& box) : frame(field, box) {
    LatticeTree tree(Communicator::self(), frame, field, box);
    const BlockIndex blocks = tree.block_count();
    const SurfaceTable table = tabulate_surface(frame, tree, {});
    const std::vector<RegionId> regions(blocks, 0);
    const Lattice lattice{field, {0.75, 0.005}, frame, std::move(tree), table, {}, 0, {}, regions};
    points = make_points(lattice, std::vector<BlockChange>(blocks), 0, blocks, LocalSurface({})).points;
  }

  LatticeFrame frame;
  std::vector<Vec3> points;
};

TEST(EndlessLatticeLocal, has_a_good_delaunay_mesh_across_all_levels) {
  for (const double growth : {1.2, 1.3}) {
    for (const Vec3 anchor : {Vec3{0, 0, 0}, Vec3{0.23, -0.11, 0.37}}) {
      const std::vector<sizing::SizeSource> sources{{{0.31, -0.2, 0.13}, 0.02}, {{-0.6, 0.5, 0.4}, 0.05}};
      const geometry::Box box{Vec3{-2, -2, -2} + anchor, Vec3{2, 2, 2} + anchor};
      const auto field = sizing::SizeField::build(box, sources, {0.02, 0.5, 12, growth});
      const Endless lattice(field, box);
      std::vector<double> coordinates;
      for (const Vec3& p : lattice.points) coordinates.insert(coordinates.end(), {p.x, p.y, p.z});
      const TetgenMesh mesh = run_tetgen(coordinates, {});
      EXPECT_TRUE(mesh.added.empty());
      double smallest = 180, largest = 0;
      int count = 0;
      for (const auto& cell : mesh.cells) {
        Vec3 p[4];
        bool is_inner = true;
        for (int k = 0; k < 4; ++k) {
          p[k] = lattice.points[cell[k]];
          const Vec3 off = p[k] - anchor;
          is_inner = is_inner && std::max({std::abs(off.x), std::abs(off.y), std::abs(off.z)}) < 1.0;
        }
        if (!is_inner) continue;
        const mesh::DihedralRange range = mesh::dihedral_range(p[0], p[1], p[2], p[3]);
        smallest = std::min(smallest, range.smallest);
        largest = std::max(largest, range.largest);
        ++count;
      }
      EXPECT_GT(count, 5000);
      EXPECT_GT(smallest, 28) << growth;
      EXPECT_LT(largest, 138) << growth;
    }
  }
}

TEST(EndlessLatticeLocal, has_the_density_asked_for) {
  for (const double size : {0.1, 0.13}) {
    const auto field = fields::uniform(size);
    const Endless lattice(field, fields::domain);
    double inside = 0;
    for (const Vec3& p : lattice.points)
      inside += std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) < 1.5;
    const double cell = size / mean_edge_of_cell;
    EXPECT_NEAR(inside * std::pow(cell / 3, 3), 2, 0.1);  // two points per cell
  }
}

}  // namespace
}  // namespace aeroloom::volume
