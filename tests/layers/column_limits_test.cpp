#include "layers/column_limits.hpp"

#include "layers/wanted_layers.hpp"
#include "tests/layers/directed_wall.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::layers {
namespace {

using examples::cube_in_a_box;
using examples::layers_on;
using geometry::Vec3;
using parallel::Communicator;

/// The cube in a box with its columns.
struct Limited {
  explicit Limited(const Communicator& ranks, int pieces = 6)
      : communicator(ranks),
        mesh(cube_in_a_box().distribute(ranks, pieces)),
        base(mesh, options),
        columns(examples::limits_of(base, options)) {}

  template <class T>
  std::vector<T> at_corner(T there, T elsewhere) const {
    std::vector<T> values(static_cast<std::size_t>(base.wall.vertex_count()), elsewhere);
    for (std::int32_t v = 0; v < base.wall.vertex_count(); ++v)
      if (is_corner(v)) values[static_cast<std::size_t>(v)] = there;
    return values;
  }
  bool is_corner(std::int32_t v) const { return distance(base.wall.points[v], {1, 1, 1}) == 0; }

  /// Calls visit(v, u) for the ends of each edge of this rank's triangles, both ways round.
  template <class Visit>
  void for_each_edge(const Visit& visit) const {
    for (std::int32_t v = 0; v < base.wall.vertex_count(); ++v)
      base.wall.for_each_neighbour(v, [&](std::int32_t u) { visit(v, u); });
  }

  Communicator communicator;
  LayerOptions options = layers_on(2);
  mesh::DistributedMesh mesh;
  examples::DirectedWall base;
  ColumnLimits columns;
};

constexpr double unlimited = std::numeric_limits<double>::infinity();

TEST(ColumnLimits, BeginAsThePatchesAsk) {
  Limited limited(Communicator::world());
  const std::int32_t n = limited.base.wall.vertex_count();
  for (std::int32_t v = 0; v < n; ++v) {
    EXPECT_GT(limited.columns.count(v), 10);
    EXPECT_EQ(limited.columns.count(v), limited.columns.wanted_count(v));
    EXPECT_EQ(limited.columns.heights(v).growth, 1.2);
    EXPECT_EQ(limited.columns.cause(v), LayerLimit::none);
  }
  EXPECT_EQ(limited.columns.take_changed().size(), static_cast<std::size_t>(n));
  EXPECT_TRUE(limited.columns.take_changed().empty());
}

TEST(WantedLayers, SmoothEdgesDifferLessAndAreTheSameInAllPieces) {
  Limited limited(Communicator::world(), 6);
  const LocalWall& wall = limited.base.wall;
  const std::vector<VertexLayers> wanted = gather_wanted_layers(wall, limited.options);
  const std::vector<double> smooth = smooth_mean_edges(wall, wanted);
  double before = 0, after = 0, low = unlimited, high = 0;
  std::map<std::array<double, 3>, double> by_place;
  limited.for_each_edge([&](std::int32_t v, std::int32_t u) {
    before = std::max(before, std::abs(wanted[v].mean_edge() - wanted[u].mean_edge()));
    after = std::max(after, std::abs(smooth[v] - smooth[u]));
    low = std::min(low, wanted[v].mean_edge()), high = std::max(high, wanted[v].mean_edge());
    const Vec3 p = wall.points[v];
    EXPECT_EQ(by_place.emplace(std::array{p.x, p.y, p.z}, smooth[v]).first->second, smooth[v]);
  });
  const parallel::Communicator& ranks = limited.communicator;
  before = ranks.maximum(before), after = ranks.maximum(after), high = ranks.maximum(high),
  low = -ranks.maximum(-low);
  EXPECT_GT(before, 0);
  EXPECT_LT(after, 0.6 * before);
  limited.for_each_edge([&](std::int32_t v, std::int32_t) {
    EXPECT_GE(smooth[v], low * (1 - 1e-12));
    EXPECT_LE(smooth[v], high * (1 + 1e-12));
  });
}

TEST(ColumnLimits, TotalsTakeLastLayersAwayAndStretchOthers) {
  Limited limited(Communicator::world());
  ColumnLimits& columns = limited.columns;
  limited.columns.take_changed();
  columns.limit_totals(limited.at_corner(unlimited, unlimited), LayerLimit::gap);
  EXPECT_TRUE(columns.take_changed().empty()) << "no limit";

  std::vector<double> halves;
  for (std::int32_t v = 0; v < limited.base.wall.vertex_count(); ++v) halves.push_back(columns.total(v) / 2);
  columns.limit_totals(halves, LayerLimit::gap);
  for (std::int32_t v = 0; v < limited.base.wall.vertex_count(); ++v) {
    EXPECT_NEAR(columns.total(v), halves[v], 1e-12);
    EXPECT_LT(columns.count(v), columns.wanted_count(v));
    EXPECT_EQ(columns.heights(v).growth, 1.2) << "the others stay";
    EXPECT_EQ(columns.cause(v), LayerLimit::gap);
  }
  // Two layers and a half of the first height: two layers, the last higher. Where columns lean, one.
  columns.limit_totals(std::vector<double>(halves.size(), 2.5e-3), LayerLimit::crossing);
  for (std::int32_t v = 0; v < limited.base.wall.vertex_count(); ++v) {
    const double first = columns.heights(v).first;
    EXPECT_EQ(columns.count(v), first > 1.25e-3 ? 1 : 2);
    EXPECT_NEAR(columns.total(v), first > 1.25e-3 ? first : 2.5e-3, 1e-15);
  }
}

TEST(ColumnLimits, CountsFallAtOneVertexAsFarAsTheSlopeAsks) {
  Limited limited(Communicator::world());
  ColumnLimits& columns = limited.columns;
  const std::int32_t wanted = columns.count(0);
  // What one piece knows of the corner counts for all of them.
  columns.limit_counts(limited.at_corner<std::int32_t>(0, most_layers), LayerLimit::crossing);
  columns.converge();
  std::int32_t most = 0;
  for (std::int32_t v = 0; v < limited.base.wall.vertex_count(); ++v) {
    most = std::max(most, columns.count(v));
    if (limited.is_corner(v)) {
      EXPECT_EQ(columns.count(v), 0);
    } else if (columns.count(v) < columns.wanted_count(v)) {
      EXPECT_EQ(columns.cause(v), LayerLimit::slope);
    }
  }
  std::int64_t beside = 0;
  limited.for_each_edge([&](std::int32_t v, std::int32_t u) {
    const double edge = distance(limited.base.wall.points[u], limited.base.wall.points[v]);
    if (!limited.is_corner(v)) return;
    EXPECT_LE(columns.total(u), edge * (1 + 1e-12));
    EXPECT_GT(columns.count(u), 10) << "they end high at once, however few the corner has";
    ++beside;
  });
  EXPECT_GT(limited.communicator.sum(beside), 0);
  EXPECT_GE(limited.communicator.maximum(static_cast<std::int64_t>(most)), wanted) << "the box is far away";
}

TEST(ColumnLimits, TotalsRiseNoFasterThanTheSlope) {
  Limited limited(Communicator::world());
  ColumnLimits& columns = limited.columns;
  const double low = 2e-3;
  columns.limit_totals(limited.at_corner(low, unlimited), LayerLimit::gap);
  columns.converge();
  limited.for_each_edge([&](std::int32_t v, std::int32_t u) {
    if (!limited.is_corner(v)) return;
    EXPECT_LE(columns.total(v), low * (1 + 1e-12));
    // At a growth of 1.2 totals may differ by the length of the edge.
    const double edge = distance(limited.base.wall.points[u], limited.base.wall.points[v]);
    EXPECT_LE(columns.total(u), (low + edge) * (1 + 1e-12));
  });
}

TEST(ColumnLimits, AreTheSameHoweverTheWallIsCut) {
  const auto outcome = [](const Communicator& communicator, int pieces) {
    Limited limited(communicator, pieces);
    limited.columns.limit_counts(limited.at_corner<std::int32_t>(1, most_layers), LayerLimit::crossing);
    limited.columns.converge();
    std::map<std::array<double, 3>, std::tuple<std::int32_t, double, double>> by_place;
    for (std::int32_t v = 0; v < limited.base.wall.vertex_count(); ++v) {
      const Vec3 p = limited.base.wall.points[v];
      const Heights heights = limited.columns.heights(v);
      const std::tuple column{limited.columns.count(v), heights.growth, limited.columns.total(v)};
      const auto [found, is_new] = by_place.emplace(std::array{p.x, p.y, p.z}, column);
      EXPECT_TRUE(is_new || found->second == column) << "equal in all pieces";
    }
    return by_place;
  };
  const auto alone = outcome(Communicator::self(), 6);
  for (const auto& [place, column] : outcome(Communicator::world(), 6)) EXPECT_EQ(column, alone.at(place));
}

}  // namespace
}  // namespace aeroloom::layers
