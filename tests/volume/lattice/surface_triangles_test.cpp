/// Which triangles meet which block, and who gets them.
#include "mesh/data/mixing.hpp"
#include "tests/several_ranks.hpp"
#include "tests/volume/fields.hpp"
#include "tests/volume/steps.hpp"

#include <algorithm>
#include <random>
#include <set>
#include <tuple>

#include <gtest/gtest.h>

namespace aeroloom::volume {
namespace {

using geometry::Vec3;
using parallel::Communicator;

/// Triangles of very different sizes: some cover many blocks, some lie many in one.
surfaces::Surface mixed_surface() {
  surfaces::Surface surface = surfaces::cube_with_ball(3, 12);
  surfaces::append(surface, surfaces::cube({1.5, 1.5, 1.5}, 0.01, 3), surfaces::Turn::inward);
  return surface;
}

struct Shared {
  explicit Shared(const Communicator& communicator)
      : surface(mixed_surface()),
        problem(communicator, surface, fields::around_unit_sphere(0.15, 0.6)),
        lattice(problem, box_of(surface)) {}

  std::vector<SurfaceTriangle> deliver(double radius) {
    const SearchRadii radii{
        std::vector<BlockSearchRadii>(lattice.tree.last() - lattice.tree.first(), {radius, radius}), 0};
    return add_ghost_triangles(lattice.frame, lattice.tree, radii, lattice.triangles);
  }

  surfaces::Surface surface;
  Problem problem;
  GrownLattice lattice;
};

double longest_edge(const std::array<Vec3, 3>& p) {
  return std::max({distance(p[0], p[1]), distance(p[1], p[2]), distance(p[2], p[0])});
}

TEST(SurfaceTable, knows_the_longest_edge_that_meets_each_block) {
  Shared shared(Communicator::world());
  const Lattice& lattice = shared.lattice;
  const std::vector<SurfaceTriangle> triangles = surfaces::numbered_triangles(shared.surface);
  int met = 0, free = 0;
  for (BlockIndex b = 0; b < lattice.tree.block_count(); ++b) {
    if (!lattice.tree.is_local(b)) continue;
    const GridBox box = GridBox::of(lattice.tree.cube(b));
    float longest = 0;
    for (const SurfaceTriangle& t : triangles) {
      geometry::Box corners;
      for (const Vec3& p : t.points) corners.add(lattice.frame.to_grid(p));
      if (box.overlaps({corners.low, corners.high}))
        longest = std::max(longest, static_cast<float>(longest_edge(t.points)));
    }
    EXPECT_EQ(lattice.table.longest_edge[b], longest) << "block " << b;
    EXPECT_EQ(lattice.table.is_met(b), longest > 0);
    ++(longest > 0 ? met : free);
  }
  EXPECT_GT(met, 100);
  EXPECT_GT(free, 100);
}

TEST(SurfaceTable, counts_each_triangle_in_the_block_of_its_centre) {
  Shared shared(Communicator::world());
  const Lattice& lattice = shared.lattice;
  std::vector<std::int32_t> expected(lattice.tree.block_count(), 0), found = expected;
  for (const SurfaceTriangle& t : surfaces::numbered_triangles(shared.surface)) {
    const Vec3 center = lattice.frame.to_grid((1.0 / 3.0) * (t.points[0] + t.points[1] + t.points[2]));
    for (BlockIndex b = lattice.tree.first(); b < lattice.tree.last(); ++b) {
      const GridBox box = GridBox::of(lattice.tree.cube(b));
      const auto within = [&](int axis) {
        return center[axis] >= box.low[axis] && center[axis] < box.high[axis];
      };
      if (within(0) && within(1) && within(2)) ++expected[b];
    }
  }
  for (BlockIndex b = lattice.tree.first(); b < lattice.tree.last(); ++b)
    found[b] = lattice.table.triangles[b - lattice.tree.first()];
  EXPECT_EQ(found, expected);
}

TEST(SurfaceTable, is_the_same_on_any_number_of_ranks) {
  NEEDS_SEVERAL_RANKS();
  const Communicator world = Communicator::world();
  Shared shared(world), alone(Communicator::self());
  const LatticeTree& tree = shared.lattice.tree;
  for (BlockIndex b = 0; b < tree.block_count(); ++b) {
    if (!tree.is_local(b)) continue;
    const auto same = static_cast<BlockIndex>(tree.number(b));
    EXPECT_EQ(shared.lattice.table.longest_edge[b], alone.lattice.table.longest_edge[same]);
    if (!tree.is_own(b)) continue;
    EXPECT_EQ(shared.lattice.table.triangles[b - tree.first()], alone.lattice.table.triangles[same]);
    EXPECT_EQ(shared.lattice.table.nearest[b - tree.first()], alone.lattice.table.nearest[same]);
  }
}

TEST(DeliverSurface, brings_what_is_within_the_radius) {
  const Communicator world = Communicator::world();
  Shared shared(world);
  const Lattice& lattice = shared.lattice;
  constexpr double step = 0.125;
  for (const double in_space : {0.0, 0.2, 1.0}) {
    const double radius = lattice.frame.grid_distance(in_space);
    const std::vector<SurfaceTriangle> delivered = shared.deliver(radius);
    std::set<std::array<Vec3, 3>, bool (*)(const std::array<Vec3, 3>&, const std::array<Vec3, 3>&)> known(
        [](const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b) {
          const auto flat = [](const std::array<Vec3, 3>& t) {
            return std::array{t[0].x, t[0].y, t[0].z, t[1].x, t[1].y, t[1].z, t[2].x, t[2].y, t[2].z};
          };
          return flat(a) < flat(b);
        });
    for (const SurfaceTriangle& t : delivered) known.insert(t.points);
    EXPECT_EQ(known.size(), delivered.size());
    std::int64_t needed = 0;
    for (const SurfaceTriangle& t : surfaces::numbered_triangles(shared.surface)) {
      bool is_near = false;
      for (double u = 0; u <= 1 && !is_near; u += step) {
        for (double v = 0; u + v <= 1 && !is_near; v += step) {
          const Vec3 p = lattice.frame.to_grid(u * t.points[0] + v * t.points[1] + (1 - u - v) * t.points[2]);
          for (BlockIndex b = lattice.tree.first(); b < lattice.tree.last() && !is_near; ++b)
            is_near = GridBox::of(lattice.tree.cube(b)).gap_to({p, p}) <= radius;
        }
      }
      needed += is_near;
      EXPECT_TRUE(!is_near || known.count(t.points) > 0) << "triangle " << t.number;
    }
    EXPECT_GT(needed, 0);
    if (world.size() > 1 && in_space < 0.5) {
      EXPECT_LT(delivered.size(), shared.surface.triangles.size());
    }
  }
}

/// Blocks at the far field are as large as a body is far off.
TEST(DeliverSurface, leaves_a_body_to_the_ranks_around_it) {
  const Communicator world = Communicator::world();
  surfaces::Surface surface = surfaces::cube({0, 0, 0}, 20, 8);
  surfaces::append(surface, surfaces::sphere({0, 0, 0}, 1, 24), surfaces::Turn::inward);
  const Problem problem(world, surface,
                        fields::around_unit_sphere(0.06, 3, 1.3, {{-20, -20, -20}, {20, 20, 20}}));
  GrownLattice lattice(problem, box_of(surface));
  const auto delivered = static_cast<std::int64_t>(Surroundings::deliver(lattice).size());
  const auto all = static_cast<std::int64_t>(surface.triangles.size());
  EXPECT_GE(world.sum(delivered), all);
  if (world.size() > 1) {
    EXPECT_LT(world.sum(delivered), world.size() * all * 4 / 5);
  }
}

TEST(DeliverSurface, brings_all_that_is_known_of_a_triangle) {
  const Communicator world = Communicator::world();
  Shared shared(world);
  const std::vector<SurfaceTriangle> delivered = shared.deliver(0);
  // By number, on every rank: what each piece says of its cells.
  struct Row {
    SurfaceTriangle triangle;

    static constexpr auto fields() { return std::tuple(&Row::triangle); }
  };
  std::vector<Row> mine;
  for (std::size_t p = 0; p < shared.problem.surface.pieces.size(); ++p) {
    const mesh::Piece& piece = shared.problem.surface.pieces[p];
    for (mesh::LocalIndex c = 0; c < piece.cell_count(); ++c) {
      SurfaceTriangle t{};
      t.number = shared.problem.surface.numbering.first_cell[p] + c;
      for (int k = 0; k < 3; ++k) {
        const auto v = piece.cell(c)[k];
        t.vertices[k] = shared.problem.surface.numbering.vertices[p][v];
        t.points[k] = piece.point(v);
        t.entity[k] = piece.vertex_entity[v];
        t.dimension[k] = piece.vertex_dimension[v];
      }
      t.face = piece.triangle_face[c];
      t.patch = piece.triangle_patch[c];
      t.inside = shared.surface.sides[t.face].front;
      t.outside = shared.surface.sides[t.face].back;
      mine.push_back({t});
    }
  }
  std::vector<Row> all = world.all_gather_items<Row>(mine);
  std::sort(all.begin(), all.end(),
            [](const Row& a, const Row& b) { return a.triangle.number < b.triangle.number; });
  ASSERT_EQ(all.size(), shared.surface.triangles.size());
  mesh::GlobalIndex before = -1;
  for (const SurfaceTriangle& t : delivered) {
    EXPECT_GT(t.number, before);
    before = t.number;
    const SurfaceTriangle& expected = all[t.number].triangle;
    EXPECT_EQ(t.vertices, expected.vertices);
    EXPECT_EQ(t.points, expected.points);
    EXPECT_EQ(t.entity, expected.entity);
    EXPECT_EQ(t.dimension, expected.dimension);
    EXPECT_EQ(t.face, expected.face);
    EXPECT_EQ(t.patch, expected.patch);
    EXPECT_EQ(t.inside, expected.inside);
    EXPECT_EQ(t.outside, expected.outside);
  }
}

}  // namespace
}  // namespace aeroloom::volume
