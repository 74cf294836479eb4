/// The dual graph of background tetrahedra: rings, contraction, METIS and repair.
#include "partition/decompose_volume.hpp"

#include "geometry/predicates.hpp"
#include "mesh/piece.hpp"
#include "partition/repair_volume.hpp"
#include "partition/simplify_volume.hpp"

#include <algorithm>
#include <map>
#include <random>
#include <set>

#include <gtest/gtest.h>

namespace aeroloom::partition {
namespace {

using geometry::Vec3;

/// A cube of n^3 cells, each of six tetrahedra; inner points are shaken, as far as nothing inverts.
BackgroundVolume cube(int n, double shake, std::uint32_t seed) {
  BackgroundVolume volume;
  std::mt19937 random(seed);
  const auto point = [&](int i, int j, int k) { return (i * (n + 1) + j) * (n + 1) + k; };
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      for (int k = 0; k <= n; ++k) volume.points.push_back({double(i), double(j), double(k)});
    }
  }
  const int order[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      for (int k = 0; k < n; ++k) {
        for (const auto& axes : order) {
          int at[3] = {i, j, k};
          std::array<std::int32_t, 4> tet{point(i, j, k), 0, 0, 0};
          for (int s = 0; s < 3; ++s) {
            ++at[axes[s]];
            tet[s + 1] = point(at[0], at[1], at[2]);
          }
          const auto& x = volume.points;
          if (geometry::volume6(x[tet[0]], x[tet[1]], x[tet[2]], x[tet[3]]) < 0) std::swap(tet[2], tet[3]);
          volume.tets.push_back(tet);
        }
      }
    }
  }
  for (std::size_t v = 0; v < volume.points.size(); ++v) {
    const Vec3 origin = volume.points[v];
    const auto inner = [&](double x) { return x > 0 && x < n; };
    if (!inner(origin.x) || !inner(origin.y) || !inner(origin.z)) continue;
    for (int axis = 0; axis < 3; ++axis)
      volume.points[v][axis] += shake * (static_cast<double>(random()) / 2147483648.0 - 1);
    const bool holds = std::all_of(volume.tets.begin(), volume.tets.end(), [&](const auto& t) {
      const auto& x = volume.points;
      return geometry::orient3d(x[t[0]], x[t[1]], x[t[2]], x[t[3]]) > 0;
    });
    if (!holds) volume.points[v] = origin;
  }
  volume.neighbours = link_tetrahedra(volume.tets);
  volume.loads.assign(volume.tets.size(), 1);
  volume.sizes.assign(volume.tets.size(), 0.1);
  volume.closed_vertices.assign(volume.points.size(), 0);
  return volume;
}

bool connected(const BackgroundVolume& volume, const std::vector<std::int32_t>& part, std::int32_t which) {
  std::vector<char> seen(part.size(), 0);
  std::vector<std::int32_t> stack;
  const auto first = std::find(part.begin(), part.end(), which);
  stack.push_back(static_cast<std::int32_t>(first - part.begin()));
  seen[stack.back()] = 1;
  std::ptrdiff_t reached = 0;
  while (!stack.empty()) {
    const std::int32_t t = stack.back();
    stack.pop_back();
    ++reached;
    for (const std::int32_t n : volume.neighbours[t]) {
      if (n >= 0 && !seen[n] && part[n] == which) seen[n] = 1, stack.push_back(n);
    }
  }
  return reached == std::count(part.begin(), part.end(), which);
}

/// The smallest angle between cuts, or a cut and the boundary.
double smallest_angle(const BackgroundVolume& volume, const std::vector<std::int32_t>& part) {
  const EdgeRings rings = gather_rings(volume);
  std::vector<Stretch> stretches;
  double smallest = 360;
  for (std::int32_t r = 0; r < rings.count(); ++r) {
    find_stretches(rings, r, part, stretches);
    if (stretches.size() < 2) continue;
    for (const Stretch& s : stretches) smallest = std::min(smallest, s.angle);
  }
  return smallest;
}

TEST(EdgeRings, GoAllTheWayRound) {
  const BackgroundVolume volume = cube(3, 0.25, 1);
  const EdgeRings rings = gather_rings(volume);
  std::int32_t closed = 0;
  for (std::int32_t r = 0; r < rings.count(); ++r) {
    double sum = 0;
    for (std::int32_t i = rings.first[r]; i < rings.first[r + 1]; ++i) sum += rings.angles[i];
    closed += rings.closed[r];
    const bool right = std::abs(sum - 180) < 1e-9 || std::abs(sum - 90) < 1e-9;
    EXPECT_TRUE(rings.closed[r] ? std::abs(sum - 360) < 1e-9 : right) << sum;
    for (std::int32_t i = rings.first[r] + 1; i < rings.first[r + 1]; ++i) {
      const auto& n = volume.neighbours[rings.tets[i - 1]];
      EXPECT_NE(std::find(n.begin(), n.end(), rings.tets[i]), n.end());
    }
  }
  EXPECT_GT(closed, 0);
  EXPECT_EQ(rings.tets.size(), 6 * volume.tets.size());
}

TEST(Stretches, AddUpToTheRing) {
  const BackgroundVolume volume = cube(3, 0.2, 2);
  const EdgeRings rings = gather_rings(volume);
  std::vector<std::int32_t> label(volume.tets.size());
  for (std::size_t t = 0; t < label.size(); ++t) label[t] = static_cast<std::int32_t>(t * 7 % 5);
  std::vector<Stretch> stretches;
  for (std::int32_t r = 0; r < rings.count(); ++r) {
    find_stretches(rings, r, label, stretches);
    std::int32_t entries = 0;
    for (const Stretch& s : stretches) entries += s.to - s.from;
    EXPECT_EQ(entries, rings.size(r));
    for (std::size_t i = 1; i < stretches.size(); ++i) {
      const auto at = [&](std::int32_t k) { return label[rings.tets[rings.first[r] + k % rings.size(r)]]; };
      EXPECT_NE(at(stretches[i - 1].from), at(stretches[i].from));
    }
  }
}

TEST(SimplifyVolume, LeavesNoSharpWedgeWithoutACap) {
  const BackgroundVolume volume = cube(5, 0.2, 3);
  const EdgeRings rings = gather_rings(volume);
  const VolumeClusters clusters = simplify(volume, rings, 35, 1e9);
  EXPECT_EQ(clusters.unresolved, 0);
  EXPECT_LT(clusters.count(), static_cast<std::int32_t>(volume.tets.size()));
  EXPECT_GE(smallest_angle(volume, clusters.of_tet), 35);
}

TEST(SimplifyVolume, KeepsClustersBelowTheCap) {
  const BackgroundVolume volume = cube(5, 0.2, 3);
  const VolumeClusters clusters = simplify(volume, gather_rings(volume), 50, 20);
  EXPECT_LE(*std::max_element(clusters.loads.begin(), clusters.loads.end()), 20);
  EXPECT_GT(clusters.unresolved, 0);
}

TEST(SimplifyVolume, HoldsClosedVerticesAndEdgesTogether) {
  BackgroundVolume volume = cube(4, 0, 4);
  const std::int32_t middle = (2 * 5 + 2) * 5 + 2;
  volume.closed_vertices[middle] = 1;
  volume.closed_edges.push_back({0, 1});
  const VolumeClusters clusters = simplify(volume, gather_rings(volume), 0, 0);
  std::set<std::int32_t> around, beside;
  for (std::size_t t = 0; t < volume.tets.size(); ++t) {
    const auto& v = volume.tets[t];
    const auto has = [&](std::int32_t w) { return std::find(v.begin(), v.end(), w) != v.end(); };
    if (has(middle)) around.insert(clusters.of_tet[t]);
    if (has(0) && has(1)) beside.insert(clusters.of_tet[t]);
  }
  EXPECT_EQ(around.size(), 1u);
  EXPECT_EQ(beside.size(), 1u);
}

class DecomposeVolumes : public testing::TestWithParam<std::uint32_t> {};

TEST_P(DecomposeVolumes, GivesConnectedPartsWithGoodAngles) {
  const BackgroundVolume volume = cube(7, 0.3, GetParam());
  const VolumeDecomposition plain = decompose_volume(volume, {6, 0});
  const VolumeDecomposition good = decompose_volume(volume, {6, 40});
  for (const VolumeDecomposition* d : {&plain, &good}) {
    EXPECT_GE(d->parts, 4);
    EXPECT_LE(d->parts, 6);
    for (std::int32_t p = 0; p < d->parts; ++p) EXPECT_TRUE(connected(volume, d->part, p)) << p;
    std::vector<int> sizes(d->parts, 0);
    for (const std::int32_t p : d->part) ++sizes[p];
    const double mean = static_cast<double>(volume.tets.size()) / d->parts;
    EXPECT_LT(*std::max_element(sizes.begin(), sizes.end()), 1.6 * mean);
  }
  EXPECT_LE(good.pinches, 1);  // a cluster is not moved for ever
  EXPECT_GE(smallest_angle(volume, good.part), 38);
  EXPECT_EQ(good.part, decompose_volume(volume, {6, 40}).part);
}

TEST(DecomposeVolume, BeatsPlainMetis) {
  double plain = 180, good = 180;
  for (std::uint32_t seed = 10; seed < 16; ++seed) {
    const BackgroundVolume volume = cube(7, 0.3, seed);
    plain = std::min(plain, smallest_angle(volume, decompose_volume(volume, {6, 0}).part));
    good = std::min(good, smallest_angle(volume, decompose_volume(volume, {6, 40}).part));
  }
  EXPECT_LT(plain, 30);
  EXPECT_GE(good, 38);
}

INSTANTIATE_TEST_SUITE_P(Seeds, DecomposeVolumes, testing::Range(10u, 16u));

TEST(RepairVolume, MendsPinchesAndFragments) {
  const BackgroundVolume volume = cube(6, 0, 5);
  const EdgeRings rings = gather_rings(volume);
  const VolumeClusters single = simplify(volume, rings, 0, 0);
  ASSERT_EQ(single.count(), static_cast<std::int32_t>(volume.tets.size()));
  // Opposite octants are one part: they touch themselves along edges and in the middle.
  std::vector<std::int32_t> part(volume.tets.size());
  for (std::size_t t = 0; t < part.size(); ++t) {
    Vec3 c;
    for (const std::int32_t v : volume.tets[t]) c += 0.25 * volume.points[v];
    part[t] = ((c.x > 3) ^ (c.y > 3) ^ (c.z > 3)) ? 1 : 0;
  }
  const VolumeRepair repair = repair_parts(volume, rings, single, 0, part);
  EXPECT_EQ(repair.pinches, 0);
  const std::int32_t parts = 1 + *std::max_element(part.begin(), part.end());
  for (std::int32_t p = 0; p < parts; ++p) {
    if (std::count(part.begin(), part.end(), p) == 0) continue;
    EXPECT_TRUE(connected(volume, part, p));
  }
}

}  // namespace
}  // namespace aeroloom::partition
