#include "layers/good_columns.hpp"

#include "tests/layers/directed_wall.hpp"
#include "tests/several_ranks.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace aeroloom::layers {
namespace {

using parallel::Communicator;
constexpr double unlimited = std::numeric_limits<double>::infinity();

/// The inside of a box, whose columns meet in its corners.
struct Inside {
  Inside()
      : mesh(examples::cube_in_a_box().distribute(Communicator::world(), 5)),
        options(layers_inside()),
        base(mesh, options) {}

  static LayerOptions layers_inside() {
    LayerOptions options;
    options.patches.resize(2);
    options.patches[0].first = 0.02;
    return options;
  }

  /// Columns at a corner of the box are lower from the start by `share`.
  ColumnLimits columns(double share) const {
    ColumnLimits limits = examples::limits_of(base, options);
    std::vector<double> totals(base.wall.points.size(), unlimited);
    for (std::int32_t v = 0; v < base.wall.vertex_count(); ++v) {
      if (distance(base.wall.points[v], {-4, -4, -4}) < 4) totals[v] = share * limits.total(v);
    }
    limits.limit_totals(std::move(totals), LayerLimit::gap);
    limits.converge();
    return limits;
  }
  int shrink(ColumnLimits& limits, JudgedColumns* judged) const {
    return shrink_to_good(base.wall, base.fans, base.directions, limits, judged);
  }

  mesh::DistributedMesh mesh;
  LayerOptions options;
  examples::DirectedWall base;
};

TEST(ShrinkToGood, FindsTheSameWithWhatWasJudgedBefore) {
  const Inside inside;
  JudgedColumns judged;
  ColumnLimits first = inside.columns(1);
  EXPECT_GT(inside.shrink(first, &judged), 1);
  ColumnLimits afresh = inside.columns(0.7), again = inside.columns(0.7);
  EXPECT_EQ(inside.shrink(again, &judged), inside.shrink(afresh, nullptr));
  std::int64_t other = 0;
  for (std::int32_t v = 0; v < inside.base.wall.vertex_count(); ++v) {
    EXPECT_EQ(again.fitted(v), afresh.fitted(v));
    EXPECT_EQ(again.cause(v), afresh.cause(v));
    other += afresh.fitted(v) == first.fitted(v) ? 0 : 1;
  }
  EXPECT_GT(Communicator::world().sum(other), 0);
}

TEST(ShrinkToGood, TakesWhatIsKnownOfTheSameColumnsAlone) {
  const Inside inside;
  JudgedColumns judged;
  ColumnLimits first = inside.columns(1);
  inside.shrink(first, &judged);
  for (JudgedColumns::Verdict& verdict : judged.verdicts) verdict.height = unlimited;
  ColumnLimits same = inside.columns(1), other = inside.columns(0.7);
  EXPECT_EQ(inside.shrink(same, &judged), 0) << "all was said to be good";
  EXPECT_GT(inside.shrink(other, &judged), 0) << "columns of other heights were not judged";
}

}  // namespace
}  // namespace aeroloom::layers
