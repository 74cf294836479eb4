/// Who fills which zone, and what each gets to know.
#include "tests/several_ranks.hpp"
#include "tests/volume/fields.hpp"
#include "tests/volume/steps.hpp"
#include "volume/filling/decomposition_data.hpp"
#include "volume/zones/halo.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

#include <gtest/gtest.h>

namespace aeroloom::volume {
namespace {

using geometry::Vec3;
using parallel::Communicator;

VolumeOptions in_zones_of(std::int64_t tets) {
  VolumeOptions options;
  options.piece_tets = tets;
  return options;
}

/// A leaf that is reassigned.
struct Away {
  BlockNumber block;
  std::int32_t child;
  GridBox box;
  static constexpr auto fields() { return std::tuple(&Away::block, &Away::child, &Away::box); }
};

/// Two nested regions, divided into a dozen zones, some leaves of which were reassigned to one.
struct Divided {
  explicit Divided(const Communicator& communicator)
      : surface(surfaces::nested_cubes(8)),
        problem(communicator, surface, fields::around_unit_sphere(0.1, 0.4), in_zones_of(1500)),
        decomposition(decompose(problem.input())),
        data(decomposition.data()),
        lattice(*data.lattice),
        shell(data.shell) {
    const LatticeTree& tree = lattice.tree;
    std::vector<Away> rows;  // every rank is told
    for (BlockIndex b = tree.first(); b < tree.last(); ++b) {
      if (tree.number(b) % 50 == 10)
        rows.push_back(
            {tree.number(b), tree.leaf_count(b) / 2, GridBox::of(tree.leaf(b, tree.leaf_count(b) / 2))});
    }
    for (const Away& row : communicator.all_gather_items<Away>(rows))
      shell.zones.reassign({row.block, row.child, row.box, 3});
    all.resize(shell.zones.count());
    std::iota(all.begin(), all.end(), 0);
    widths.assign(all.size(), problem.options.halo);
    plan = plan_zones(lattice, shell, all, widths);
  }

  std::vector<ZoneInput> gather_all() {
    std::vector<ZoneInput> inputs;
    for (const SendPlan& batch : plan.batches) {
      for (ZoneInput& input : gather_zone_inputs(lattice, shell, batch)) inputs.push_back(std::move(input));
    }
    return inputs;
  }

  surfaces::Surface surface;
  Problem problem;
  Decomposition decomposition;
  Decomposition::Data& data;
  const Lattice& lattice;
  Shell& shell;
  std::vector<ZoneIndex> all;
  std::vector<double> widths;
  ZonePlan plan;
};

/// What is near a zone, by looking at each of its leaves.
class Nearness {
public:
  Nearness(const Divided& divided, ZoneIndex zone) : _divided(divided) {
    for (const LeafOfBlock& leaf : all_leaves(divided.lattice.tree)) {
      if (divided.shell.zones.of(leaf.block, leaf.child) == zone) _leaves.push_back(GridBox::of(leaf.cell));
    }
  }
  /// Whether a box that lies in a block, or has its middle there, is as near to the zone as is asked for.
  bool holds(const GridBox& box, BlockIndex b) {
    if (b != _block) {
      _block = b;
      _radius = _divided.lattice.frame.grid_distance(_divided.problem.options.halo *
                                                     largest_size_around(_divided.lattice, b));
    }
    return std::any_of(_leaves.begin(), _leaves.end(),
                       [&](const GridBox& leaf) { return leaf.gap_to(box) <= _radius; });
  }

private:
  const Divided& _divided;
  std::vector<GridBox> _leaves;
  BlockIndex _block = -1;
  double _radius = 0;  ///< of that block
};

TEST(PlanZones, is_the_same_on_every_rank_and_looks_at_each_zone_once) {
  const Communicator world = Communicator::world();
  const Divided divided(world), alone(Communicator::self());
  ASSERT_EQ(divided.plan.loads.size(), divided.all.size());
  EXPECT_GT(divided.all.size(), 6u);
  for (std::size_t i = 0; i < divided.all.size(); ++i) {
    const ZoneLoad &a = divided.plan.loads[i], &b = alone.plan.loads[i];
    EXPECT_EQ(a.zone, divided.all[i]);
    EXPECT_EQ(a.points, b.points);
    EXPECT_EQ(a.triangles, b.triangles);
    EXPECT_GT(a.points, 0);
    EXPECT_EQ(a.work(), static_cast<double>(a.points) + 1.2 * static_cast<double>(a.triangles));
  }
  const auto batches = static_cast<std::int64_t>(divided.plan.batches.size());
  EXPECT_EQ(world.minimum(batches), world.maximum(batches));
}

TEST(PlanZones, deals_zones_out_evenly_in_small_batches) {
  const Communicator world = Communicator::world();
  const Divided divided(world);
  struct Row {
    std::int64_t batch;
    ZoneIndex zone;
    parallel::Rank rank;

    static constexpr auto fields() { return std::tuple(&Row::batch, &Row::zone, &Row::rank); }
  };
  std::vector<Row> mine;
  for (std::size_t batch = 0; batch < divided.plan.batches.size(); ++batch) {
    for (const auto& want : divided.plan.batches[batch].blocks)
      mine.push_back(
          {static_cast<std::int64_t>(batch), want.zone, divided.plan.batches[batch].ranks[want.zone]});
  }
  std::map<ZoneIndex, std::set<parallel::Rank>> ranks;
  std::map<std::pair<std::int64_t, parallel::Rank>, std::set<ZoneIndex>> zones;
  for (const Row& row : world.all_gather_items<Row>(mine)) {
    ranks[row.zone].insert(row.rank);
    zones[{row.batch, row.rank}].insert(row.zone);
  }
  EXPECT_EQ(ranks.size(), divided.all.size());
  for (const auto& [zone, at] : ranks) EXPECT_EQ(at.size(), 1u);
  for (const auto& [turn, at] : zones) EXPECT_LE(at.size(), 4u);
  std::vector<double> work(world.size(), 0);
  double heaviest = 0;
  for (const ZoneLoad& load : divided.plan.loads) {
    work[*ranks[load.zone].begin()] += load.work();
    heaviest = std::max(heaviest, load.work());
  }
  const auto [least, most] = std::minmax_element(work.begin(), work.end());
  EXPECT_LE(*most - *least, heaviest);
}

TEST(PlanZones, plans_what_it_is_asked_for) {
  const Communicator world = Communicator::world();
  Divided divided(world);
  const std::vector<ZoneIndex> some{2, 5};
  std::vector<double> widths = divided.widths;
  widths[5] *= 1.5;
  const ZonePlan plan = plan_zones(divided.lattice, divided.shell, some, widths);
  ASSERT_EQ(plan.loads.size(), 2u);
  EXPECT_EQ(plan.loads[0].zone, 2);
  EXPECT_EQ(plan.loads[1].zone, 5);
  EXPECT_EQ(plan.loads[0].points, divided.plan.loads[2].points);
  EXPECT_GT(plan.loads[1].points, divided.plan.loads[5].points);
}

TEST(GatherZoneInputs, brings_the_points_of_a_zone_and_those_near_it) {
  const Communicator world = Communicator::world();
  Divided divided(world), alone(Communicator::self());
  struct Row {
    std::int64_t number;
    Vec3 point;
    mesh::RegionId region;

    static constexpr auto fields() { return std::tuple(&Row::number, &Row::point, &Row::region); }
  };
  std::vector<Row> mine;
  const BlockPoints& points = divided.shell.local.points;
  for (BlockIndex b = points.first; b < points.last(); ++b) {
    for (std::int64_t i = points.starts[b - points.first]; i < points.starts[b - points.first + 1]; ++i)
      mine.push_back(
          {lattice_number(divided.lattice.tree, b, points.slots[i]), points.points[i], points.regions[i]});
  }
  const std::vector<Row> all = world.all_gather_items<Row>(mine);
  std::int64_t zones = 0;
  for (const ZoneInput& input : divided.gather_all()) {
    ++zones;
    Nearness nearness(alone, input.zone);
    std::size_t at = input.problem.surface_points();
    const std::size_t first = at;
    for (const Row& row : all) {
      const Leaf leaf = leaf_of_lattice(alone.lattice.tree, row.number);
      const Vec3 place = divided.lattice.frame.to_grid(row.point);
      if (!nearness.holds({place, place}, leaf.block)) continue;
      ASSERT_LT(at, input.vertex_keys.size());
      EXPECT_EQ(input.vertex_keys[at], static_cast<mesh::SharedVertexKey>(
                                           divided.problem.surface.numbering.vertex_count + row.number));
      EXPECT_EQ(input.problem.points[at], row.point);
      EXPECT_EQ(input.problem.regions[at - first], row.region);
      ++at;
    }
    EXPECT_EQ(at, input.vertex_keys.size());
    EXPECT_EQ(input.problem.points.size(), input.vertex_keys.size());
    EXPECT_EQ(divided.plan.loads[input.zone].points, static_cast<std::int64_t>(at - first));
  }
  EXPECT_EQ(world.sum(zones), static_cast<std::int64_t>(divided.all.size()));
}

TEST(GatherZoneInputs, brings_each_triangle_of_a_zone_or_near_it_once) {
  const Communicator world = Communicator::world();
  Divided divided(world), alone(Communicator::self());
  const LatticeFrame& frame = divided.lattice.frame;
  std::set<mesh::GlobalIndex> numbers;
  std::vector<SurfaceTriangle> all;
  for (const SurfaceTriangle& t : world.all_gather_items<SurfaceTriangle>(divided.lattice.triangles)) {
    if (numbers.insert(t.number).second) all.push_back(t);
  }
  ASSERT_EQ(all.size(), divided.surface.triangles.size());
  std::sort(all.begin(), all.end(),
            [](const SurfaceTriangle& a, const SurfaceTriangle& b) { return a.number < b.number; });
  for (const ZoneInput& input : divided.gather_all()) {
    std::size_t at = 0;
    std::set<mesh::GlobalIndex> vertices;
    Nearness nearness(alone, input.zone);
    for (const SurfaceTriangle& t : all) {
      const GridBox box = grid_box(frame, t.points);
      const Vec3 middle = (1.0 / 3.0) * (t.points[0] + t.points[1] + t.points[2]);
      if (!nearness.holds(box, alone.lattice.leaf_at(middle).block)) continue;
      ASSERT_LT(at, input.problem.triangles.size());
      for (int k = 0; k < 3; ++k) {
        const auto v = input.problem.triangles[at][k];
        vertices.insert(t.vertices[k]);
        EXPECT_EQ(input.vertex_keys[v], static_cast<mesh::SharedVertexKey>(t.vertices[k]));
        EXPECT_EQ(input.problem.points[v], t.points[k]);
        EXPECT_EQ(input.dimension[v], t.dimension[k]);
        EXPECT_EQ(input.entity[v], t.entity[k]);
      }
      EXPECT_EQ(input.problem.inside[at], t.inside);
      EXPECT_EQ(input.problem.outside[at], t.outside);
      EXPECT_EQ(input.face[at], t.face);
      EXPECT_EQ(input.patch[at], t.patch);
      ++at;
    }
    EXPECT_EQ(at, input.problem.triangles.size());
    EXPECT_EQ(vertices.size(), input.problem.surface_points());
  }
}

TEST(GatherZoneInputs, tells_whose_each_vertex_is) {
  Divided divided(Communicator::world()), alone(Communicator::self());
  for (const ZoneInput& input : divided.gather_all()) {
    const auto& vertex_keys = input.vertex_keys;
    EXPECT_EQ(std::adjacent_find(vertex_keys.begin(), vertex_keys.end(), std::greater_equal<>()),
              vertex_keys.end());
    std::array<int, 3> count{};
    for (std::size_t v = 0; v < input.vertex_keys.size(); ++v) {
      const bool is_surface = v < input.problem.surface_points();
      EXPECT_EQ(input.vertex_keys[v] < mesh::running_key(divided.problem.surface.numbering.vertex_count),
                is_surface);
      Leaf leaf{};
      if (is_surface) {  // by brute force
        const Vec3 g = divided.lattice.frame.to_grid(input.problem.points[v]);
        for (const LeafOfBlock& other : all_leaves(alone.lattice.tree)) {
          const GridBox box = GridBox::of(other.cell);
          const auto within = [&](int axis) { return g[axis] >= box.low[axis] && g[axis] < box.high[axis]; };
          if (within(0) && within(1) && within(2)) leaf = {other.block, other.child};
        }
      } else {
        leaf = leaf_of_lattice(alone.lattice.tree, static_cast<std::int64_t>(input.vertex_keys[v]) -
                                                       divided.problem.surface.numbering.vertex_count);
      }
      const ZoneIndex zone = alone.shell.zones.of(leaf.block, leaf.child);
      const Owner expected = zone == input.zone  ? Owner::mine
                             : zone < input.zone ? Owner::lower
                                                 : Owner::higher;
      EXPECT_EQ(input.problem.owners[v], expected);
      ++count[static_cast<int>(expected)];
    }
    EXPECT_GT(count[0], 0);
    EXPECT_GT(count[1] + count[2], 0);
  }
}

TEST(GatherZoneInputs, brings_the_same_on_any_number_of_ranks) {
  NEEDS_SEVERAL_RANKS();
  Divided divided(Communicator::world()), alone(Communicator::self());
  std::map<ZoneIndex, ZoneInput> expected;
  for (ZoneInput& input : alone.gather_all()) expected.emplace(input.zone, input);
  for (const ZoneInput& input : divided.gather_all()) {
    const ZoneInput& same = expected.at(input.zone);
    EXPECT_EQ(input.vertex_keys, same.vertex_keys);
    EXPECT_EQ(input.problem.points, same.problem.points);
    EXPECT_EQ(input.problem.owners, same.problem.owners);
    EXPECT_EQ(input.problem.triangles, same.problem.triangles);
    EXPECT_EQ(input.problem.regions, same.problem.regions);
    EXPECT_EQ(input.problem.inside, same.problem.inside);
    EXPECT_EQ(input.dimension, same.dimension);
    EXPECT_EQ(input.entity, same.entity);
    EXPECT_EQ(input.face, same.face);
  }
}

}  // namespace
}  // namespace aeroloom::volume
