#include "surface/front/front.hpp"

#include "geometry/predicates.hpp"
#include "mesh/quality/quality.hpp"
#include "surface/front/edge_crossings.hpp"
#include "tests/surface/front/loops.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>

#include <gtest/gtest.h>

namespace aeroloom::front {
namespace {

FrontResult fill(const FrontInput& input, const std::function<double(Vec2)>& size) {
  return fill_front(input, [&](Vec2 p, std::int32_t&) { return size(p); });
}

double boundary_area(const FrontInput& input) {
  double area2 = 0;
  for (const auto& [a, b] : input.edges) area2 += cross(input.points[a], input.points[b]);
  return area2 / 2;
}

struct Shape {
  double area = 0, mean_quality = 0, smallest_angle = 180, expected_count = 0;
};

Shape measure(const FrontResult& result, const std::function<double(Vec2)>& size) {
  Shape shape;
  for (const auto& t : result.triangles) {
    const Vec2 p = result.points[t[0]], q = result.points[t[1]], r = result.points[t[2]];
    const geometry::Vec3 a{p.x, p.y, 0}, b{q.x, q.y, 0}, c{r.x, r.y, 0};
    const double area = cross(q - p, r - p) / 2, h = size((p + q + r) / 3.0);
    shape.area += area;
    shape.mean_quality += mesh::triangle_mean_ratio(a, b, c) / static_cast<double>(result.triangles.size());
    shape.smallest_angle = std::min(shape.smallest_angle, mesh::smallest_angle(a, b, c));
    shape.expected_count += area * 4 / (std::numbers::sqrt3 * h * h);
  }
  return shape;
}

/// Holds for every fill: a triangulation of exactly the region, with the boundary as it was given.
void expect_valid(const FrontInput& input, const FrontResult& result) {
  ASSERT_GE(result.points.size(), input.points.size());
  EXPECT_TRUE(std::equal(input.points.begin(), input.points.end(), result.points.begin()));
  std::set<std::array<std::int32_t, 2>> sides;
  std::vector<int> uses(result.points.size(), 0);
  double area = 0;
  for (const auto& t : result.triangles) {
    const Vec2 a = result.points[t[0]], b = result.points[t[1]], c = result.points[t[2]];
    ASSERT_GT(geometry::orient2d(a, b, c), 0);
    area += cross(b - a, c - a) / 2;
    for (int i = 0; i < 3; ++i) {
      ASSERT_TRUE(sides.insert({t[i], t[(i + 1) % 3]}).second) << "an edge is used twice in one direction";
      ++uses[t[i]];
    }
  }
  EXPECT_NEAR(area, boundary_area(input), 1e-11 * std::abs(boundary_area(input)));
  EXPECT_EQ(std::count(uses.begin(), uses.end(), 0), 0) << "a vertex is used by no triangle";
  const std::set<std::array<std::int32_t, 2>> boundary(input.edges.begin(), input.edges.end());
  for (const auto& edge : boundary) ASSERT_TRUE(sides.contains(edge));
  for (const auto& [a, b] : sides) ASSERT_EQ(sides.contains({b, a}), !boundary.contains({a, b}));
}

void expect_count(const FrontResult& result, const Shape& shape, double tolerance) {
  EXPECT_NEAR(static_cast<double>(result.triangles.size()), shape.expected_count,
              tolerance * shape.expected_count);
}

TEST(Front, FillsDiskWithNearlyEquilateralTriangles) {
  FrontInput input;
  add_loop(input, circle({0, 0}, 1, 200));
  const auto size = [](Vec2) { return 2 * pi / 200; };
  const FrontResult result = fill(input, size);
  expect_valid(input, result);
  const Shape shape = measure(result, size);
  EXPECT_GT(shape.mean_quality, 0.96);
  EXPECT_GT(shape.smallest_angle, 30);
  expect_count(result, shape, 0.05);
}

TEST(Front, FollowsGradedSizes) {
  FrontInput input;
  add_loop(input, circle({0, 0}, 1, 60));
  const auto size = [](Vec2 p) { return 1e-4 + 0.1 * norm(p); };
  const FrontResult result = fill(input, size);
  expect_valid(input, result);
  const Shape shape = measure(result, size);
  EXPECT_GT(shape.mean_quality, 0.95);
  EXPECT_GT(shape.smallest_angle, 28);
  expect_count(result, shape, 0.10);
}

TEST(Front, FillsAroundHolesAndSeveralComponents) {
  FrontInput input;
  add_loop(input, rectangle({0, 0}, {4, 3}, 0.1));
  add_loop(input, reversed(circle({1, 1.5}, 0.5, 30)));
  add_loop(input, reversed(circle({3, 1.5}, 0.7, 44)));
  add_loop(input, circle({3, 1.5}, 0.3, 18));  // an island in the hole
  add_loop(input, rectangle({5, 0}, {6, 1}, 0.1));
  const auto size = [](Vec2) { return 0.1; };
  const FrontResult result = fill(input, size);
  expect_valid(input, result);
  const Shape shape = measure(result, size);
  EXPECT_GT(shape.mean_quality, 0.95);
  EXPECT_GT(shape.smallest_angle, 25);
  expect_count(result, shape, 0.10);
}

TEST(Front, FillsSquareOfCocircularPoints) {
  FrontInput input;
  const int n = 16;
  add_loop(input, rectangle({0, 0}, {n, n}, 1));
  for (int i = 2; i < n - 1; i += 4) {  // holes of one cell on the same grid
    for (int j = 2; j < n - 1; j += 4) {
      add_loop(input, reversed(rectangle({double(i), double(j)}, {i + 1.0, j + 1.0}, 1)));
    }
  }
  const FrontResult result = fill(input, [](Vec2) { return 1; });
  expect_valid(input, result);
  EXPECT_GT(measure(result, [](Vec2) { return 1; }).smallest_angle, 20);
}

TEST(Front, FillsThinAnnulus) {
  FrontInput input;
  add_loop(input, circle({0, 0}, 1, 200));
  add_loop(input, reversed(circle({0, 0}, 0.999, 200)));
  expect_valid(input, fill(input, [](Vec2) { return 0.03; }));
  FrontInput fine;
  add_loop(fine, circle({0, 0}, 1, 6000));
  add_loop(fine, reversed(circle({0, 0}, 0.999, 6000)));
  const auto size = [](Vec2) { return 0.001; };
  const FrontResult result = fill(fine, size);
  expect_valid(fine, result);
  EXPECT_GT(measure(result, size).smallest_angle, 25);
}

TEST(Front, FillsNeedleCorner) {
  FrontInput input;
  const double slope = std::tan(pi / 180);
  add_loop(input, polygon({{0, 0}, {10, 0}, {10, 10 * slope}}, 0.05));
  const FrontResult result = fill(input, [](Vec2) { return 0.05; });
  expect_valid(input, result);
  EXPECT_LT(result.triangles.size(), 3 * input.edges.size());
}

class BoundaryEdgeLength : public testing::TestWithParam<double> {};

TEST_P(BoundaryEdgeLength, DoesNotSpoilTheInterior) {
  FrontInput input;
  const double h = 0.05;
  add_loop(input, rectangle({0, 0}, {2, 2}, GetParam() * h));
  const auto size = [&](Vec2) { return h; };
  const FrontResult result = fill(input, size);
  expect_valid(input, result);
  const Shape shape = measure(result, size);
  EXPECT_GT(shape.mean_quality, 0.9);
  EXPECT_GT(shape.smallest_angle, GetParam() > 1.5 ? 15 : 25);
  expect_count(result, shape, GetParam() > 1.5 ? 0.2 : 0.15);
}

INSTANTIATE_TEST_SUITE_P(HalfToDouble, BoundaryEdgeLength, testing::Values(0.5, 0.7, 1.0, 1.4, 2.0));

TEST(Front, GrowsFromShortBoundaryEdges) {
  FrontInput input;
  std::vector<Vec2> loop;
  for (int i = 0; i < 100; ++i) loop.push_back({0.01 * i, 0});
  for (const Vec2 corner : {Vec2{1, 0}, Vec2{1, 1}, Vec2{0, 1}}) loop.push_back(corner);
  add_loop(input, loop);
  const auto size = [](Vec2) { return 0.3; };
  const FrontResult result = fill(input, size);
  expect_valid(input, result);
  const Shape shape = measure(result, size);
  EXPECT_GT(shape.mean_quality, 0.75);
  EXPECT_LT(result.triangles.size(), 1000u);
}

TEST(Front, FillsSpiralOfManyEdges) {
  FrontInput input;
  std::vector<Vec2> outer, inner;
  const int turns = 12, count = 20000;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * pi * turns * i / count, radius = 1 + angle / (2 * pi);
    outer.push_back((radius + 0.6) * Vec2{std::cos(angle), std::sin(angle)});
    inner.push_back(radius * Vec2{std::cos(angle), std::sin(angle)});
  }
  outer.insert(outer.end(), inner.rbegin(), inner.rend());
  add_loop(input, outer);
  ASSERT_EQ(input.edges.size(), 40000u);
  expect_valid(input, fill(input, [](Vec2) { return 0.05; }));
}

TEST(Front, FillsLargeCoarseDiskWithAFineHole) {
  FrontInput input;
  add_loop(input, circle({0, 0}, 1, 16000));
  add_loop(input, reversed(circle({0.2, 0.1}, 1e-3, 20)));
  const auto size = [](Vec2 p) {
    return std::min(4e-4 + 0.25 * (1 - norm(p)), 3e-4 + 0.25 * distance(p, {0.2, 0.1}));
  };
  const FrontResult result = fill(input, size);
  expect_valid(input, result);
  EXPECT_GT(measure(result, size).smallest_angle, 20);
}

TEST(Front, KeepsAnEdgeWithTheRegionOnBothSides) {
  FrontInput input;
  add_loop(input, rectangle({0, 0}, {4, 4}, 1));
  input.points.insert(input.points.end(), {{1.5, 2}, {2.5, 2}});
  const auto v = static_cast<std::int32_t>(input.points.size()) - 2;
  input.edges.push_back({v, v + 1});
  input.edges.push_back({v + 1, v});
  const FrontResult result = fill(input, [](Vec2) { return 0.5; });
  int found = 0;
  for (const auto& t : result.triangles) {
    for (int i = 0; i < 3; ++i)
      found += std::min(t[i], t[(i + 1) % 3]) == v && std::max(t[i], t[(i + 1) % 3]) == v + 1;
  }
  EXPECT_EQ(found, 2);
}

TEST(Front, GivesTheSameBitsEveryTime) {
  FrontInput input;
  add_loop(input, circle({0.1, 0.2}, 1, 100));
  const auto size = [](Vec2 p) { return 0.02 + 0.1 * std::abs(p.x); };
  const FrontResult first = fill(input, size), second = fill(input, size);
  EXPECT_EQ(first.points, second.points);
  EXPECT_EQ(first.triangles, second.triangles);
}

/// Random star polygons: radii jump by up to a factor of ten between neighbouring directions.
class StarPolygon : public testing::TestWithParam<int> {};

TEST_P(StarPolygon, IsFilled) {
  std::mt19937 random(GetParam());
  std::uniform_real_distribution<double> unit(0, 1);
  FrontInput input;
  std::vector<Vec2> corners;
  const int count = 5 + static_cast<int>(unit(random) * 40);
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * pi * (i + 0.8 * unit(random)) / count, radius = 0.1 + 0.9 * unit(random);
    corners.push_back(radius * Vec2{std::cos(angle), std::sin(angle)});
  }
  const double h = std::pow(10.0, -1 - 1.3 * unit(random));
  add_loop(input, polygon(corners, h * (0.5 + 1.5 * unit(random))));
  const FrontResult result = fill(input, [&](Vec2) { return h; });
  expect_valid(input, result);
}

INSTANTIATE_TEST_SUITE_P(Seeds, StarPolygon, testing::Range(0, 60));

using Pairs = std::vector<std::array<std::int32_t, 2>>;

Pairs crossings_of(const FrontInput& input) {
  Pairs pairs;
  try {
    fill(input, [](Vec2) { return 0.1; });
    ADD_FAILURE() << "the boundary was accepted";
  } catch (const FrontError& error) {
    for (const auto& pair : error.crossings()) pairs.push_back({pair.first, pair.second});
  }
  return pairs;
}

TEST(FrontErrors, NamesCrossingEdges) {
  FrontInput input;
  add_loop(input, {{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  add_loop(input, {{0.5, -0.5}, {1.5, 0.3}, {0.5, 0.5}});
  EXPECT_EQ(crossings_of(input), (Pairs{{0, 6}, {1, 5}}));
}

TEST(FrontErrors, NamesFigureOfEight) {
  FrontInput input;
  add_loop(input, {{0, 0}, {1, 1}, {1, 0}, {0, 1}});
  EXPECT_EQ(crossings_of(input), (Pairs{{0, 2}}));
}

TEST(FrontErrors, NamesTouchingVertex) {
  FrontInput input;
  add_loop(input, {{0, 0}, {4, 0}, {4, 4}, {0, 4}});
  add_loop(input, {{2, 0}, {1, 1}, {3, 1}});  // its first vertex lies on the first edge
  EXPECT_EQ(crossings_of(input), (Pairs{{0, 4}, {0, 6}}));
}

TEST(FrontErrors, NamesEdgesAtCoincidentVertices) {
  FrontInput input;
  add_loop(input, {{0, 0}, {1, 0}, {0, 1}});
  add_loop(input, {{0, 0}, {-1, 0}, {0, -1}});
  EXPECT_EQ(crossings_of(input), (Pairs{{0, 3}, {0, 5}, {2, 3}, {2, 5}}));
}

TEST(FrontErrors, NamesOverlappingEdges) {
  FrontInput input;
  add_loop(input, {{0, 0}, {3, 0}, {3, 2}});
  add_loop(input, {{1, 0}, {1, -1}, {2, 0}});
  const Pairs pairs = crossings_of(input);
  EXPECT_EQ(pairs, (Pairs{{0, 3}, {0, 4}, {0, 5}}));
}

TEST(FrontErrors, FindsEveryCrossingOfAComb) {
  FrontInput input;
  std::vector<Vec2> comb;
  for (int i = 0; i < 10; ++i) comb.insert(comb.end(), {{double(i), 0}, {i + 0.5, 2}});
  comb.push_back({10, -1});
  comb.push_back({0, -1});
  std::reverse(comb.begin(), comb.end());
  add_loop(input, comb);
  add_loop(input, {{-1, 1}, {-1, 0.9}, {11, 1}});
  const Pairs pairs = crossings_of(input);
  EXPECT_EQ(pairs.size(), 40u);  // twenty sides of teeth, two edges each
}

/// Random polygons on a small grid, full of collinear, touching and coinciding edges: either the boundary is
/// valid and is filled, or the error says where it is not.
class GridPolygon : public testing::TestWithParam<int> {};

TEST_P(GridPolygon, IsFilledOrExplained) {
  std::mt19937 random(GetParam());
  for (int trial = 0; trial < 200; ++trial) {
    const int count = 3 + static_cast<int>(random() % 6);
    FrontInput input;
    std::vector<Vec2> loop;
    for (int i = 0; i < count; ++i) {
      loop.push_back({static_cast<double>(random() % 5), static_cast<double>(random() % 5)});
    }
    add_loop(input, loop);
    if (boundary_area(input) < 0) std::reverse(loop.begin(), loop.end());
    input = {};
    add_loop(input, loop);
    try {
      expect_valid(input, fill(input, [](Vec2) { return 0.7; }));
      EXPECT_TRUE(find_edge_crossings(input).empty());
    } catch (const FrontError& error) {
      EXPECT_FALSE(error.crossings().empty());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, GridPolygon, testing::Range(0, 20));

TEST(FrontErrors, RefusesOpenAndInconsistentLoops) {
  FrontInput open;
  open.points = {{0, 0}, {1, 0}, {0, 1}};
  open.edges = {{0, 1}, {1, 2}};
  EXPECT_EQ(crossings_of(open), Pairs{});
  FrontInput clockwise;
  add_loop(clockwise, reversed(circle({0, 0}, 1, 10)));
  EXPECT_EQ(crossings_of(clockwise), Pairs{});
  FrontInput nested;
  add_loop(nested, circle({0, 0}, 2, 20));
  add_loop(nested, circle({0, 0}, 1, 10));
  EXPECT_EQ(crossings_of(nested), Pairs{});
}

TEST(FrontErrors, RefusesSizesThatAreNone) {
  FrontInput input;
  add_loop(input, circle({0, 0}, 1, 10));
  EXPECT_THROW(fill(input, [](Vec2) { return 0; }), std::invalid_argument);
  EXPECT_THROW(fill(input, [](Vec2) { return std::nan(""); }), std::invalid_argument);
}

}  // namespace
}  // namespace aeroloom::front
