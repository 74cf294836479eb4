/// Cells of a fine surface and the coarse surface made of their rims.
#include "partition/surface_cells.hpp"

#include "partition/coarse_surface.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

namespace aeroloom::partition {
namespace {

using geometry::Vec3;
using Triangle = std::array<std::int32_t, 3>;

struct Surface {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
  FinePatch patch() const { return {points, triangles}; }
};

/// A torus of n by 3 n squares, each halved.
Surface torus(int n) {
  Surface s;
  const int m = 3 * n;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < m; ++j) {
      const double a = 2 * std::numbers::pi * i / n, b = 2 * std::numbers::pi * j / m;
      const double r = 3 + std::cos(a);
      s.points.push_back({r * std::cos(b), r * std::sin(b), std::sin(a)});
    }
  }
  const auto v = [&](int i, int j) { return (i % n) * m + j % m; };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < m; ++j) {
      s.triangles.push_back({v(i, j), v(i, j + 1), v(i + 1, j + 1)});
      s.triangles.push_back({v(i, j), v(i + 1, j + 1), v(i + 1, j)});
    }
  }
  return s;
}

/// Vertices less edges plus triangles of one cell.
int euler(const Surface& s, const std::vector<std::int32_t>& cells, std::int32_t cell) {
  std::set<std::int32_t> vertices;
  std::set<std::array<std::int32_t, 2>> edges;
  int triangles = 0;
  for (std::size_t t = 0; t < cells.size(); ++t) {
    if (cells[t] != cell) continue;
    ++triangles;
    for (int k = 0; k < 3; ++k) {
      const std::int32_t a = s.triangles[t][k], b = s.triangles[t][(k + 1) % 3];
      vertices.insert(a);
      edges.insert({std::min(a, b), std::max(a, b)});
    }
  }
  return static_cast<int>(vertices.size()) - static_cast<int>(edges.size()) + triangles;
}

std::int32_t count(const std::vector<std::int32_t>& cells) {
  return 1 + *std::max_element(cells.begin(), cells.end());
}

TEST(SurfaceCells, AreDisksThatCoverTheSurface) {
  const Surface s = torus(24);
  const auto cells = grow_cells(s.patch(), {8, 60});
  const std::int32_t number = count(cells);
  EXPECT_GT(number, 20);
  EXPECT_LT(number, static_cast<std::int32_t>(s.triangles.size()) / 10);
  for (std::int32_t c = 0; c < number; ++c) EXPECT_EQ(euler(s, cells, c), 1) << "cell " << c;
  EXPECT_EQ(cells, grow_cells(s.patch(), {8, 60}));
}

TEST(SurfaceCells, GetNarrowerWhereTheSurfaceTurns) {
  const Surface s = torus(24);
  EXPECT_GT(count(grow_cells(s.patch(), {8, 20})), 2 * count(grow_cells(s.patch(), {8, 1000})));
}

TEST(SurfaceCells, CutUntilTheyAreTriangles) {
  const Surface s = torus(6);
  auto cells = grow_cells(s.patch(), {8, 1000});
  for (int round = 0; round < 12; ++round) {
    const auto before = count(cells);
    cells = cut_cells(s.patch(), cells, std::vector<char>(before, 1));
    EXPECT_GE(count(cells), before);
    for (std::int32_t c = 0; c < count(cells); ++c) EXPECT_EQ(euler(s, cells, c), 1);
  }
  EXPECT_EQ(count(cells), static_cast<std::int32_t>(s.triangles.size()));
}

TEST(SurfaceCells, CutLeavesTheOthersAlone) {
  const Surface s = torus(24);
  const auto cells = grow_cells(s.patch(), {8, 60});
  std::vector<char> cut(count(cells), 0);
  cut[3] = 1;
  const auto after = cut_cells(s.patch(), cells, cut);
  EXPECT_EQ(count(after), count(cells) + 1);
  std::map<std::int32_t, std::set<std::int32_t>> became;
  for (std::size_t t = 0; t < cells.size(); ++t) became[cells[t]].insert(after[t]);
  for (const auto& [old, fresh] : became) EXPECT_EQ(fresh.size(), old == 3 ? 2u : 1u);
}

/// What a rank would send of a surface in one piece.
CoarseSurface coarse_of(const Surface& s, const std::vector<std::int32_t>& cells, bool with_apexes) {
  std::map<std::array<std::int32_t, 2>, std::int32_t> cell_at;
  for (std::size_t t = 0; t < cells.size(); ++t) {
    for (int k = 0; k < 3; ++k) cell_at[{s.triangles[t][k], s.triangles[t][(k + 1) % 3]}] = cells[t];
  }
  std::vector<RimEdge> edges;
  std::vector<FineVertex> vertices;
  std::set<std::int32_t> rim;
  for (const auto& [edge, cell] : cell_at) {
    if (cell_at.at({edge[1], edge[0]}) == cell) continue;
    edges.push_back({edge[0], edge[1], cell});
    rim.insert(edge[0]);
  }
  for (const std::int32_t v : rim) vertices.push_back({v, s.points[v], 2, 0});
  std::vector<Cell> table(count(cells), {0, 0, -1, {}, {}});
  for (std::size_t t = 0; t < cells.size(); ++t) {
    Cell& cell = table[cells[t]];
    cell.id = cells[t];
    const auto& v = s.triangles[t];
    cell.area += 0.5 * cross(s.points[v[1]] - s.points[v[0]], s.points[v[2]] - s.points[v[0]]);
  }
  std::vector<Vec3> middle(table.size());
  std::vector<int> members(table.size(), 0);
  for (std::size_t t = 0; t < cells.size(); ++t) {
    for (const std::int32_t w : s.triangles[t]) middle[cells[t]] += s.points[w], ++members[cells[t]];
  }
  for (std::size_t t = 0; with_apexes && t < cells.size(); ++t) {
    Cell& cell = table[cells[t]];
    const Vec3 center = middle[cells[t]] / members[cells[t]];
    for (const std::int32_t w : s.triangles[t]) {
      if (rim.count(w)) continue;
      if (cell.apex >= 0 && distance(s.points[w], center) >= distance(cell.apex_point, center)) continue;
      cell.apex = w;
      cell.apex_point = s.points[w];
    }
  }
  std::reverse(edges.begin(), edges.end());
  return build_coarse_surface(edges, vertices, table);
}

class Coarse : public testing::TestWithParam<bool> {};

TEST_P(Coarse, IsClosedAndOriented) {
  const Surface s = torus(60);
  auto cells = grow_cells(s.patch(), {12, 90});
  CoarseSurface coarse = coarse_of(s, cells, GetParam());
  for (int round = 0; round < 20 && !coarse.unfit.empty(); ++round) {
    std::vector<char> cut(count(cells), 0);
    for (const std::int32_t c : coarse.unfit) cut[c] = 1;
    cells = cut_cells(s.patch(), cells, cut);
    coarse = coarse_of(s, cells, GetParam());
  }
  EXPECT_TRUE(coarse.unfit.empty());
  std::map<std::array<std::int32_t, 2>, int> uses;
  for (const auto& t : coarse.triangles) {
    for (int k = 0; k < 3; ++k) ++uses[{t[k], t[(k + 1) % 3]}];
  }
  for (const auto& [edge, number] : uses) {
    EXPECT_EQ(number, 1);
    EXPECT_TRUE(uses.count({edge[1], edge[0]}));
  }
  EXPECT_LT(coarse.triangles.size(), s.triangles.size() / 5);
}

TEST_P(Coarse, ChordsStandForPathsOfFineEdges) {
  const Surface s = torus(24);
  const CoarseSurface coarse = coarse_of(s, grow_cells(s.patch(), {8, 60}), GetParam());
  std::set<std::array<mesh::GlobalIndex, 2>> fine;
  for (const auto& t : s.triangles) {
    for (int k = 0; k < 3; ++k) fine.insert({t[k], t[(k + 1) % 3]});
  }
  std::set<std::array<std::int32_t, 2>> ends;
  for (const Chord& chord : coarse.chords) {
    ASSERT_GE(chord.path.size(), 2u);
    EXPECT_EQ(coarse.rim[chord.path.front()].number, coarse.vertices[chord.from].number);
    EXPECT_EQ(coarse.rim[chord.path.back()].number, coarse.vertices[chord.to].number);
    for (std::size_t i = 1; i < chord.path.size(); ++i)
      EXPECT_TRUE(fine.count({coarse.rim[chord.path[i - 1]].number, coarse.rim[chord.path[i]].number}));
    EXPECT_TRUE(ends.insert({std::min(chord.from, chord.to), std::max(chord.from, chord.to)}).second)
        << "two chords between the same corners";
  }
}

INSTANTIATE_TEST_SUITE_P(WithAndWithoutApexes, Coarse, testing::Bool());

}  // namespace
}  // namespace aeroloom::partition
