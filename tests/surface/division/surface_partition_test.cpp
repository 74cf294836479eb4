/// The dual graph of a background surface: fans, contraction, METIS and repair.
#include "surface/division/graph_partition.hpp"
#include "surface/division/partition_clusters.hpp"
#include "surface/division/repair_parts.hpp"
#include "surface/division/simplify_dual_graph.hpp"
#include "surface/division/wedges.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <gtest/gtest.h>

namespace aeroloom::partition {
namespace {

void link(BackgroundSurface& surface) {
  std::map<std::array<std::int32_t, 2>, geometry::HalfEdge> by_ends;
  const auto count = static_cast<geometry::HalfEdge>(3 * surface.triangles.size());
  for (geometry::HalfEdge h = 0; h < count; ++h) by_ends[{surface.start(h), surface.end(h)}] = h;
  surface.twins.assign(count, -1);
  for (geometry::HalfEdge h = 0; h < count; ++h) {
    const auto twin = by_ends.find({surface.end(h), surface.start(h)});
    if (twin != by_ends.end()) surface.twins[h] = twin->second;
  }
}

/// A plate of squares, each halved along a diagonal, `stretch` times as long as wide, with points moved about
/// by a part of the spacing.
BackgroundSurface plate(int columns, int rows, double stretch, double shake) {
  BackgroundSurface surface;
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) {
      const bool inside = i > 0 && i < columns && j > 0 && j < rows;
      const double dx = inside ? shake * std::sin(12.9898 * i + 78.233 * j) : 0;
      const double dy = inside ? shake * std::sin(39.425 * i + 11.135 * j) : 0;
      surface.points.push_back({stretch * (i + dx), j + dy, 0});
    }
  }
  const auto at = [&](int i, int j) { return j * (columns + 1) + i; };
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      surface.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      surface.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  surface.loads.assign(surface.triangles.size(), 10);
  link(surface);
  return surface;
}

/// An octahedron divided so often and blown up to a sphere: closed, without any feature curve.
BackgroundSurface sphere(int divisions) {
  BackgroundSurface surface;
  surface.points = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  surface.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                       {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int k = 0; k < divisions; ++k) {
    std::map<std::array<std::int32_t, 2>, std::int32_t> middles;
    const auto middle = [&](std::int32_t a, std::int32_t b) {
      const auto [at, fresh] = middles.try_emplace({std::min(a, b), std::max(a, b)},
                                                   static_cast<std::int32_t>(surface.points.size()));
      if (fresh) surface.points.push_back(normalized(surface.points[a] + surface.points[b]));
      return at->second;
    };
    std::vector<std::array<std::int32_t, 3>> finer;
    for (const auto& [a, b, c] : surface.triangles) {
      const std::int32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    surface.triangles = std::move(finer);
  }
  surface.loads.assign(surface.triangles.size(), 10);
  link(surface);
  return surface;
}

/// Simplified, partitioned, repaired; 0 degrees: METIS alone.
struct SurfaceDecomposition {
  std::vector<PartIndex> part;
  PartIndex parts;
};

SurfaceDecomposition decompose(const BackgroundSurface& surface, PartIndex parts,
                               double smallest_angle = 40) {
  const double total = std::accumulate(surface.loads.begin(), surface.loads.end(), 0.0);
  const VertexFans fans = gather_fans(surface);
  const Clusters clusters = simplify_dual_graph(surface, fans, {smallest_angle, 0.15 * total / parts});
  SurfaceDecomposition result{partition_clusters(surface, clusters, parts), 0};
  result.parts = repair_parts(surface, fans, {smallest_angle}, result.part);
  return result;
}

std::vector<double> part_loads(const BackgroundSurface& surface, const SurfaceDecomposition& result) {
  std::vector<double> loads(result.parts, 0.0);
  for (std::size_t t = 0; t < result.part.size(); ++t) loads[result.part[t]] += surface.loads[t];
  return loads;
}

double imbalance(const std::vector<double>& loads) {
  const double sum = std::accumulate(loads.begin(), loads.end(), 0.0);
  return *std::max_element(loads.begin(), loads.end()) * static_cast<double>(loads.size()) / sum;
}

/// Parts reached from their first triangles without leaving them.
std::size_t reachable(const BackgroundSurface& surface, const std::vector<std::int32_t>& part) {
  std::vector<char> seen(part.size(), 0), started(part.size(), 0);
  std::size_t count = 0;
  std::vector<std::int32_t> stack;
  for (std::size_t seed = 0; seed < part.size(); ++seed) {
    if (started[part[seed]]) continue;
    started[part[seed]] = seen[seed] = 1;
    stack.push_back(static_cast<std::int32_t>(seed));
    while (!stack.empty()) {
      const std::int32_t t = stack.back();
      stack.pop_back();
      ++count;
      for (int i = 0; i < 3; ++i) {
        const geometry::HalfEdge twin = surface.twins[3 * t + i];
        if (twin < 0 || seen[twin / 3] || part[twin / 3] != part[t]) continue;
        seen[twin / 3] = 1;
        stack.push_back(twin / 3);
      }
    }
  }
  return count;
}

double sharpest(const BackgroundSurface& surface, const std::vector<std::int32_t>& part) {
  double least = 360;
  const VertexFans fans = gather_fans(surface);
  for (FanIndex fan = 0; fan < fans.count(); ++fan) {
    visit_wedges(surface, fans, part, fan,
                 [&](const FanWedge& wedge) { least = std::min(least, wedge.angle); });
  }
  return least;
}

TEST(VertexFans, GoRoundEveryVertexOnce) {
  const BackgroundSurface open = plate(5, 4, 1, 0.2), closed = sphere(2);
  const VertexFans of_open = gather_fans(open), of_closed = gather_fans(closed);
  EXPECT_EQ(of_open.count(), 6 * 5);
  EXPECT_EQ(of_open.corners.size(), 3 * open.triangles.size());
  EXPECT_EQ(std::count(of_open.closed.begin(), of_open.closed.end(), 1), 4 * 3);
  EXPECT_EQ(of_closed.count(), static_cast<std::int32_t>(closed.points.size()));
  for (std::int32_t fan = 0; fan < of_open.count(); ++fan) {
    double sum = 0;
    for (std::int32_t i = of_open.first[fan]; i < of_open.first[fan + 1]; ++i) sum += of_open.angles[i];
    if (of_open.closed[fan]) {
      EXPECT_NEAR(sum, 360, 1e-9);
    }
    for (std::int32_t i = 0; i + 1 < of_open.size(fan); ++i) {
      // The edge after corner i is that before corner i + 1.
      const geometry::HalfEdge after = geometry::previous_half_edge(of_open.corners[of_open.first[fan] + i]);
      EXPECT_EQ(open.twins[after], of_open.edge(fan, i + 1));
    }
  }
}

/// What simplification is for: whatever cuts are made along permitted edges, no angle is small.
TEST(Simplify, NoTwoPermittedCutsMeetSharply) {
  for (const double stretch : {1.0, 2.5}) {
    const BackgroundSurface surface = plate(20, 20, stretch, 0.25);
    const VertexFans fans = gather_fans(surface);
    const Clusters clusters = simplify_dual_graph(surface, fans, {.smallest_angle = 40, .largest_load = 0});
    EXPECT_EQ(clusters.unresolved, 0);
    EXPECT_GT(clusters.forbidden_edges, 0);
    const auto permitted = [&](geometry::HalfEdge h) {
      return surface.twins[h] < 0 ||
             clusters.of_triangle[h / 3] != clusters.of_triangle[surface.twins[h] / 3];
    };
    for (std::int32_t fan = 0; fan < fans.count(); ++fan) {
      const std::int32_t size = fans.size(fan), most = fans.closed[fan] ? size - 1 : size;
      for (std::int32_t from = 0; from < size; ++from) {
        double angle = 0;
        for (std::int32_t k = 0; k < most && (fans.closed[fan] || from + k < size); ++k) {
          angle += fans.angles[fans.first[fan] + (from + k) % size];
          const geometry::HalfEdge first = fans.edge(fan, from);
          const geometry::HalfEdge second =
              fans.edge(fan, fans.closed[fan] ? (from + k + 1) % size : from + k + 1);
          const bool corner = surface.twins[first] < 0 && surface.twins[second] < 0;
          if (corner || !permitted(first) || !permitted(second)) continue;
          EXPECT_GE(angle, 40) << "fan " << fan;
        }
      }
    }
  }
}

TEST(Simplify, ClustersKeepTheLoadAndObeyItsLimit) {
  const BackgroundSurface surface = plate(20, 20, 3, 0.25);
  const Clusters clusters =
      simplify_dual_graph(surface, gather_fans(surface), {.smallest_angle = 60, .largest_load = 95});
  EXPECT_NEAR(std::accumulate(clusters.loads.begin(), clusters.loads.end(), 0.0), 8000, 1e-9);
  EXPECT_LE(*std::max_element(clusters.loads.begin(), clusters.loads.end()), 95);
  EXPECT_GT(clusters.unresolved, 0);
}

TEST(GraphPartition, HalvesAPath) {
  WeightedGraph path;
  const int nodes = 40;
  path.first.push_back(0);
  for (int i = 0; i < nodes; ++i) {
    for (const int j : {i - 1, i + 1}) {
      if (j < 0 || j >= nodes) continue;
      path.neighbours.push_back(j);
      path.arc_weights.push_back(1);
    }
    path.first.push_back(static_cast<std::int32_t>(path.neighbours.size()));
    path.node_weights.push_back(10);
  }
  const auto part = partition_graph(path, 2);
  int cuts = 0;
  for (int i = 1; i < nodes; ++i) cuts += part[i] != part[i - 1];
  EXPECT_EQ(cuts, 1);
  EXPECT_EQ(std::count(part.begin(), part.end(), 0), nodes / 2);
  EXPECT_EQ(partition_graph(path, 1), std::vector<std::int32_t>(nodes, 0));
}

TEST(RepairParts, StrayTrianglesJoinANeighbour) {
  const BackgroundSurface surface = plate(10, 10, 1, 0.1);
  std::vector<std::int32_t> part(surface.triangles.size());
  for (std::size_t t = 0; t < part.size(); ++t) part[t] = (t / 2) % 10 < 5 ? 0 : 1;
  const std::vector<std::int32_t> wanted = part;
  part[2 * 12] = 1;  // an island of part 1 amid part 0
  part[2 * 77] = 7;  // a part of one triangle is a part
  connect_parts(surface, part);
  EXPECT_EQ(part[2 * 12], 0);
  EXPECT_EQ(part[2 * 77], 7);
  part[2 * 77] = wanted[2 * 77];
  EXPECT_EQ(part, wanted);
}

TEST(RepairParts, LeavesPartsAsunderWhenAskedTo) {
  const BackgroundSurface surface = plate(10, 10, 1, 0);
  std::vector<PartIndex> part(surface.triangles.size());
  for (std::size_t t = 0; t < part.size(); ++t) part[t] = t / 20 < 5 ? 0 : 1;
  part[2 * 12] = part[2 * 12 + 1] = 1;  // a square on its own
  const std::vector<PartIndex> wanted = part;
  EXPECT_EQ(repair_parts(surface, gather_fans(surface), {0, false}, part), 2);
  EXPECT_EQ(part, wanted);
  EXPECT_EQ(repair_parts(surface, gather_fans(surface), {0}, part), 2);
  EXPECT_EQ(part[2 * 12], 0);
}

TEST(RepairParts, ASpikeIsTakenBack) {
  const BackgroundSurface surface = plate(10, 10, 2.5, 0);
  std::vector<std::int32_t> part(surface.triangles.size());
  for (std::size_t t = 0; t < part.size(); ++t) part[t] = t / 20 < 5 ? 0 : 1;
  const std::vector<std::int32_t> wanted = part;
  const double straight = sharpest(surface, part);
  part[2 * 45] = 1;  // its corner of 22 degrees reaches into part 0
  ASSERT_LT(sharpest(surface, part), 25);
  EXPECT_GT(widen_wedges(surface, gather_fans(surface), 40, part), 0);
  EXPECT_EQ(part, wanted);
  EXPECT_GE(sharpest(surface, part), straight);
}

/// Widening one wedge makes others: repair goes on until none is left that it can widen.
TEST(RepairParts, GoesOnUntilNothingMoves) {
  int in_need_of_more = 0;
  for (int seed = 1; seed <= 20; ++seed) {
    const BackgroundSurface surface = plate(24, 24, 1.5, 0.25);
    const VertexFans fans = gather_fans(surface);
    std::vector<PartIndex> part(surface.triangles.size());
    // Stripes whose borders are torn.
    for (std::size_t t = 0; t < part.size(); ++t) {
      const double tear = 5 * std::sin(seed + 7.3 * static_cast<double>(t));
      part[t] = std::clamp(static_cast<int>((static_cast<double>(t / 2 % 24) + tear) / 6), 0, 3);
    }
    std::vector<PartIndex> once = part;
    connect_parts(surface, once);
    widen_wedges(surface, fans, 40, once);
    connect_parts(surface, once);
    in_need_of_more += widen_wedges(surface, fans, 40, once) > 0;
    repair_parts(surface, fans, {40}, part);
    EXPECT_EQ(widen_wedges(surface, fans, 40, part), 0);
  }
  EXPECT_GT(in_need_of_more, 0);
}

TEST(DecomposeSurface, PartsAreConnectedBalancedAndMeetAtGoodAngles) {
  for (const BackgroundSurface& surface : {plate(40, 40, 1, 0.25), sphere(4)}) {
    const SurfaceDecomposition result = decompose(surface, 16);
    EXPECT_EQ(result.parts, 16);
    EXPECT_EQ(reachable(surface, result.part), surface.triangles.size());
    EXPECT_LT(imbalance(part_loads(surface, result)), 1.25);
    EXPECT_GE(sharpest(surface, result.part), 40);
    const SurfaceDecomposition again = decompose(surface, 16);
    EXPECT_EQ(result.part, again.part);
  }
}

/// Where background triangles are stretched, METIS alone leaves the angles that simplification avoids.
TEST(DecomposeSurface, PlainMetisIsWorse) {
  const BackgroundSurface surface = plate(40, 60, 2.5, 0.3);
  const auto good = decompose(surface, 20);
  const auto plain = decompose(surface, 20, 0);
  EXPECT_LT(sharpest(surface, plain.part), 38);
  EXPECT_GE(sharpest(surface, good.part), 40);
  EXPECT_LT(imbalance(part_loads(surface, good)), 1.2);
}

TEST(DecomposeSurface, OnePartIsTheWhole) {
  const BackgroundSurface surface = plate(4, 4, 1, 0);
  const auto result = decompose(surface, 1);
  EXPECT_EQ(result.parts, 1);
  EXPECT_EQ(result.part, std::vector<PartIndex>(surface.triangles.size(), 0));
}

}  // namespace
}  // namespace aeroloom::partition
