/// Which region a point near a part of the surface lies in.
#include "volume/lattice/local_surface.hpp"

#include "tests/meshes/surfaces.hpp"

#include <algorithm>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace aeroloom::volume {
namespace {

using geometry::Vec3;
using mesh::no_region;
using mesh::RegionId;

std::mt19937_64 engine(11);
double between(double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(engine);
}
Vec3 direction() {
  const double z = between(-1, 1), azimuth = between(0, 2 * std::numbers::pi), r = std::sqrt(1 - z * z);
  return {r * std::cos(azimuth), r * std::sin(azimuth), z};
}

/// What a surface says of a point, which must have an answer.
RegionId region_at(const LocalSurface& surface, Vec3 p) {
  const auto region = surface.region_at(p, surface.distance().nearest(p));
  EXPECT_TRUE(region.has_value()) << p.x << ' ' << p.y << ' ' << p.z;
  return region.value_or(-9);
}

/// Cells of a grid under an affine map, each of a region or of none: the answer is known everywhere.
struct Cells {
  std::array<int, 3> n;
  std::vector<RegionId> region;  ///< k fastest
  Vec3 columns[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  Vec3 origin{};

  RegionId at(int i, int j, int k) const {
    if (i < 0 || j < 0 || k < 0 || i >= n[0] || j >= n[1] || k >= n[2]) return no_region;
    return region[(i * n[1] + j) * n[2] + k];
  }
  Vec3 place(Vec3 grid) const {
    return origin + grid.x * columns[0] + grid.y * columns[1] + grid.z * columns[2];
  }
  bool is_straight() const {
    return columns[0] == Vec3{1, 0, 0} && columns[1] == Vec3{0, 1, 0} && columns[2] == Vec3{0, 0, 1};
  }
  RegionId region_of(Vec3 grid) const {
    return at(static_cast<int>(std::floor(grid.x)), static_cast<int>(std::floor(grid.y)),
              static_cast<int>(std::floor(grid.z)));
  }
  surfaces::Surface surface() const {
    return surfaces::voxels(
        n, [this](int i, int j, int k) { return at(i, j, k); }, [this](Vec3 g) { return place(g); });
  }
};

Cells make_cells(std::array<int, 3> n, const std::function<RegionId(int, int, int)>& region_of) {
  Cells cells{n, {}};
  for (int i = 0; i < n[0]; ++i) {
    for (int j = 0; j < n[1]; ++j) {
      for (int k = 0; k < n[2]; ++k) cells.region.push_back(region_of(i, j, k));
    }
  }
  return cells;
}

/// Asks at many places: anywhere, close to corners and edges, and level with the planes of the grid.
void expect_right_everywhere(const Cells& cells, int count) {
  const auto triangles = surfaces::numbered_triangles(cells.surface());
  const LocalSurface surface(triangles);
  int wrong = 0, asked = 0;
  std::array<int, 3> answers{};
  for (int i = 0; i < count; ++i) {
    Vec3 grid{between(-0.8, cells.n[0] + 0.8), between(-0.8, cells.n[1] + 0.8),
              between(-0.8, cells.n[2] + 0.8)};
    const int kind = i % 6;
    if (kind == 1 || kind == 2) {  // close to a corner
      const double close = kind == 1 ? 1e-2 : 1e-6;
      for (int k = 0; k < 3; ++k) grid[k] = std::round(grid[k]) + close * between(-1, 1);
    } else if (kind == 3) {  // close to an edge
      for (int k = 0; k < 3; ++k) {
        if (k != i / 6 % 3) grid[k] = std::round(grid[k]) + 1e-3 * between(-1, 1);
      }
    } else if (kind == 4) {  // in the middle of a cell
      for (int k = 0; k < 3; ++k) grid[k] = std::floor(grid[k]) + 0.5;
    } else if (kind == 5) {  // level with a plane of the grid where that is inside of a region
      const int k = i / 6 % 3;
      grid[k] = std::round(grid[k]);
      Vec3 low = grid, high = grid;
      low[k] -= 0.5, high[k] += 0.5;
      if (cells.region_of(low) != cells.region_of(high)) continue;
      if (!cells.is_straight()) grid[k] += 1e-9 * between(-1, 1);  // its place in space is rounded
    }
    const RegionId expected = cells.region_of(grid);
    const RegionId found = region_at(surface, cells.place(grid));
    wrong += found != expected;
    ++asked;
    if (expected < 2) ++answers[expected + 1];
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(asked, count * 2 / 3);
  EXPECT_GT(answers[0], 0);
  EXPECT_GT(answers[1], 0);
}

TEST(RegionAt, is_right_around_a_cube) {
  expect_right_everywhere(make_cells({2, 2, 2}, [](int, int, int) { return 0; }), 3000);
}

TEST(RegionAt, is_right_at_reentrant_edges) {
  const auto notch = [](int i, int j, int) { return i == 1 && j == 1 ? no_region : 0; };
  expect_right_everywhere(make_cells({2, 2, 2}, notch), 3000);
  const auto corner = [](int i, int j, int k) { return i + j + k == 3 ? no_region : 0; };
  expect_right_everywhere(make_cells({2, 2, 2}, corner), 3000);
}

TEST(RegionAt, is_right_at_sharp_edges) {
  Cells cells = make_cells({2, 2, 2}, [](int i, int j, int) { return i == 1 && j == 1 ? no_region : 0; });
  cells.columns[1] = {0.999, 0.03, 0};  // two degrees between the walls
  expect_right_everywhere(cells, 3000);
  cells.columns[2] = {0.7, 0.01, 0.02};
  expect_right_everywhere(cells, 3000);
}

TEST(RegionAt, is_right_where_three_sheets_meet_in_an_edge) {
  expect_right_everywhere(make_cells({1, 2, 2}, [](int, int j, int) { return j; }), 3000);
  expect_right_everywhere(
      make_cells({2, 2, 1}, [](int i, int j, int) { return i == 1 && j == 1 ? no_region : i; }), 3000);
}

TEST(RegionAt, is_right_where_bodies_touch_in_an_edge_or_point) {
  expect_right_everywhere(make_cells({2, 2, 1}, [](int i, int j, int) { return i == j ? i : no_region; }),
                          3000);
  expect_right_everywhere(
      make_cells({2, 2, 2}, [](int i, int j, int k) { return i == j && j == k ? i : no_region; }), 3000);
}

TEST(RegionAt, is_right_in_any_pile_of_cells) {
  for (int pile = 0; pile < 12; ++pile) {
    Cells cells = make_cells({3, 3, 3}, [](int, int, int) { return static_cast<int>(between(0, 4)) - 1; });
    if (pile % 2) {
      for (Vec3& column : cells.columns) column += 0.3 * direction();
      cells.origin = {100, -20, 3};
    }
    expect_right_everywhere(cells, 1500);
  }
}

/// The tip of a cone of many needles, and the dent of the same shape.
TEST(RegionAt, is_right_at_tips_and_dents) {
  constexpr int count = 40;
  for (const double height : {3.0, -0.9}) {  // from the base at z = -1, of radius 0.2
    surfaces::Surface cone;
    cone.sides.push_back({0, no_region});
    cone.points = {{0, 0, height}, {0, 0, -1}};
    for (int i = 0; i < count; ++i) {
      const double angle = 2 * std::numbers::pi * i / count;
      cone.points.push_back({0.2 * std::cos(angle), 0.2 * std::sin(angle), -1});
    }
    for (int i = 0; i < count; ++i) {
      const int a = 2 + i, b = 2 + (i + 1) % count;
      cone.triangles.push_back({0, a, b});
      cone.triangles.push_back({1, b, a});
      cone.face.insert(cone.face.end(), 2, 0);
    }
    surfaces::Surface dented = surfaces::cube({0, 0, 1}, 4, 1);
    surfaces::append(dented, cone, surfaces::Turn::inward);
    for (const auto& [surface, within] :
         {std::pair{cone, 0}, std::pair{dented, static_cast<int>(no_region)}}) {
      const auto triangles = surfaces::numbered_triangles(surface);
      const LocalSurface near(triangles);
      const RegionId around = within == 0 ? no_region : 0;
      for (int i = 0; i < 2000; ++i) {
        const double close = std::exp2(-between(0, 20));
        const Vec3 p = Vec3{0, 0, height} + 0.2 * close * direction();
        const double below = (height - p.z) / (height + 1), r = std::hypot(p.x, p.y) / 0.2;
        if (p.z < -1 ||
            (below > 0 && r > below * std::cos(std::numbers::pi / count) * 0.999 && r < below * 1.001))
          continue;  // at the facets
        EXPECT_EQ(region_at(near, p), below > 0 && r < below ? within : around);
      }
    }
  }
}

/// Sheets that meet in one edge like the pages of a book, a region between each two: what lies behind the
/// first one that is met does not count.
TEST(RegionAt, is_right_between_the_pages_of_a_book) {
  for (int book = 0; book < 200; ++book) {
    const int pages = 2 + book % 6;
    const double spread = book % 2 ? 2 * std::numbers::pi : 1;  // open, or nearly shut
    std::vector<double> angles;
    for (int k = 0; k < pages; ++k) angles.push_back(between(0, spread));
    std::sort(angles.begin(), angles.end());
    std::vector<SurfaceTriangle> triangles;
    for (int k = 0; k < pages; ++k) {
      const Vec3 to{std::cos(angles[k]), std::sin(angles[k]), 0};
      // From page k on lies region k; seen from there the triangle turns counter-clockwise.
      SurfaceTriangle low{}, high{};
      low.vertices = {0, 1, 2 + 2 * k};
      low.points = {Vec3{0, 0, 0}, Vec3{0, 0, 1}, to};
      high.vertices = {1, 3 + 2 * k, 2 + 2 * k};
      high.points = {Vec3{0, 0, 1}, to + Vec3{0, 0, 1}, to};
      for (SurfaceTriangle t : {low, high}) {
        t.number = static_cast<mesh::GlobalIndex>(triangles.size());
        t.inside = (k + pages - 1) % pages;
        t.outside = k;
        triangles.push_back(t);
      }
    }
    std::shuffle(triangles.begin(), triangles.end(), engine);
    const LocalSurface near(triangles);
    for (int i = 0; i < 100; ++i) {
      const double angle = between(0, 2 * std::numbers::pi), r = 0.2 * between(0.01, 1);
      const auto above = std::upper_bound(angles.begin(), angles.end(), angle) - angles.begin();
      EXPECT_EQ(region_at(near, {r * std::cos(angle), r * std::sin(angle), between(0.25, 0.75)}),
                static_cast<RegionId>((above + pages - 1) % pages));
    }
  }
}

TEST(RegionAt, needs_the_triangles_nearby_alone) {
  const surfaces::Surface surface = surfaces::sphere({0, 0, 0}, 1, 12);
  std::vector<SurfaceTriangle> triangles = surfaces::numbered_triangles(surface);
  std::erase_if(triangles, [](const SurfaceTriangle& t) { return t.points[0].z < 0.6; });
  ASSERT_LT(triangles.size(), surface.triangles.size() / 3);
  const LocalSurface near(triangles);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 to = direction();
    if (to.z < 0.85) continue;
    EXPECT_EQ(region_at(near, 0.98 * to), 0);
    EXPECT_EQ(region_at(near, 1.01 * to), no_region);
  }
}

TEST(RegionAt, has_no_answer_on_the_surface) {
  const auto triangles = surfaces::numbered_triangles(surfaces::cube({0, 0, 0}, 1, 2));
  const LocalSurface near(triangles);
  for (const Vec3 p : {Vec3{1, 0.3, 0.2}, Vec3{1, 1, 0.5}, Vec3{1, 1, 1}})
    EXPECT_FALSE(near.region_at(p, near.distance().nearest(p)).has_value());
  EXPECT_TRUE(LocalSurface({}).empty());
  EXPECT_FALSE(near.empty());
}

}  // namespace
}  // namespace aeroloom::volume
