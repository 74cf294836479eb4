/// Which of what TetGen made is a zone's own.
#include "volume/filling/owned_cells.hpp"

#include "geometry/predicates.hpp"
#include "tests/volume/zone_problems.hpp"

#include <algorithm>
#include <map>
#include <random>
#include <set>

#include <gtest/gtest.h>

namespace aeroloom::volume {
namespace {

// --- what is owned

TEST(SelectOwned, keeps_all_of_a_cube_for_a_single_zone) {
  const ZoneProblem problem = cube_problem();
  const TetgenMesh mesh = run_tetgen(flat(problem.points), problem.triangles);
  const OwnedCells owned = select_owned(problem, mesh, problem.points);
  EXPECT_EQ(owned.cells.size(), mesh.cells.size());
  EXPECT_TRUE(owned.crossings.empty());
  EXPECT_EQ(std::set<std::int32_t>(owned.triangles.begin(), owned.triangles.end()).size(),
            problem.triangles.size());
  EXPECT_EQ(owned.triangles.size(), problem.triangles.size());
}

TEST(SelectOwned, cuts_a_cube_into_zones_without_overlap_or_gap) {
  const ZoneProblem problem = cube_problem();
  const TetgenMesh mesh = run_tetgen(flat(problem.points), problem.triangles);
  constexpr int zones = 8;
  const auto zone_of = [](Vec3 p) {
    return (p.x > 0.1 ? 1 : 0) + (p.y > -0.2 ? 2 : 0) + (p.z > 0.3 ? 4 : 0);
  };
  std::set<LocalCell> cells;
  std::map<LocalTriangle, std::vector<int>> crossings;
  std::vector<int> covered(problem.triangles.size(), 0);
  double volume = 0;
  for (int zone = 0; zone < zones; ++zone) {
    const ZoneProblem mine = seen_from(problem, zone, zone_of);
    const OwnedCells owned = select_owned(mine, mesh, mine.points);
    ASSERT_EQ(owned.cells.size(), owned.regions.size());
    EXPECT_GT(owned.cells.size(), 20u);
    for (const LocalCell& cell : owned.cells) {
      EXPECT_TRUE(cells.insert(sorted(cell)).second);
      volume += volume_of(cell, problem.points);
      int lowest = zones;
      for (const LocalIndex v : cell) lowest = std::min(lowest, zone_of(problem.points[v]));
      EXPECT_EQ(lowest, zone);
    }
    for (const Crossing& crossing : owned.crossings)
      crossings[sorted(face_of(owned.cells[crossing.cell], crossing.face))].push_back(zone);
    for (const std::int32_t t : owned.triangles) ++covered[t];
  }
  EXPECT_EQ(cells.size(), mesh.cells.size());
  EXPECT_NEAR(volume, 8, 1e-12);
  EXPECT_GT(crossings.size(), 100u);
  for (const auto& [face, zones_at] : crossings) {
    ASSERT_EQ(zones_at.size(), 2u);
    EXPECT_NE(zones_at[0], zones_at[1]);
  }
  for (const int count : covered) EXPECT_EQ(count, 1);
}

/// Slabs so thin that every tetrahedron has its vertices on the surface: what is around a vertex tells.
TEST(SelectOwned, tells_the_regions_of_slabs_without_points_inside) {
  const std::array<int, 3> n{8, 8, 4};
  // From below: region 1, region 0, nothing, region 2.
  const RegionId of_layer[4] = {1, 0, no_region, 2};
  const surfaces::Surface surface = surfaces::voxels(
      n, [&](int, int, int k) { return of_layer[k]; }, surfaces::onto({-1, -1, 0}, {1, 1, 0.08}, n));
  const ZoneProblem problem = make_problem(surface, 0, 0, [](Vec3) { return no_region; });
  const TetgenMesh mesh = run_tetgen(flat(problem.points), problem.triangles);
  ASSERT_TRUE(mesh.added.empty());
  const auto zone_of = [](Vec3 p) { return (p.x > 0 ? 1 : 0) + (p.y > 0.3 ? 2 : 0); };
  std::array<double, 3> volume{};
  std::vector<int> covered(problem.triangles.size(), 0);
  for (int zone = 0; zone < 4; ++zone) {
    const ZoneProblem mine = seen_from(problem, zone, zone_of);
    const OwnedCells owned = select_owned(mine, mesh, mine.points);
    for (std::size_t c = 0; c < owned.cells.size(); ++c) {
      double z = 0;
      for (const LocalIndex v : owned.cells[c]) z += 0.25 * problem.points[v].z;
      EXPECT_EQ(owned.regions[c], of_layer[static_cast<int>(z / 0.02)]);
      volume[owned.regions[c]] += volume_of(owned.cells[c], problem.points);
    }
    for (const std::int32_t t : owned.triangles) ++covered[t];
  }
  for (const double v : volume) EXPECT_NEAR(v, 4 * 0.02, 1e-12);
  for (const int count : covered) EXPECT_EQ(count, 1);
}

TEST(SelectOwned, leaves_out_what_lies_outside) {
  surfaces::Surface surface = surfaces::cube({0, 0, 0}, 1, 4);
  surfaces::append(surface, surfaces::cube({0.1, 0, 0}, 0.4, 3), surfaces::Turn::inward);
  surfaces::append(surface, surfaces::between(surfaces::cube({3, 0.2, 0.1}, 0.7, 3), 1, no_region));
  const auto region_of = [](Vec3 p) {
    return p.x > 2
               ? std::max({std::abs(p.x - 3), std::abs(p.y - 0.2), std::abs(p.z - 0.1)}) < 0.7 ? 1 : no_region
           : std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) > 1         ? no_region
           : std::max({std::abs(p.x - 0.1), std::abs(p.y), std::abs(p.z)}) < 0.4 ? no_region
                                                                                 : 0;
  };
  const ZoneProblem problem = make_problem(surface, 300, 0.1, region_of);
  const TetgenMesh mesh = run_tetgen(flat(problem.points), problem.triangles);
  const OwnedCells owned = select_owned(problem, mesh, problem.points);
  std::array<double, 2> volume{};
  for (std::size_t c = 0; c < owned.cells.size(); ++c)
    volume[owned.regions[c]] += volume_of(owned.cells[c], problem.points);
  EXPECT_NEAR(volume[0], 8 - 0.512, 1e-12);
  EXPECT_NEAR(volume[1], 2.744, 1e-12);
  EXPECT_LT(owned.cells.size(), mesh.cells.size());
}

/// Where bodies touch in an edge or point, zones may meet there without a common face.
TEST(SelectOwned, tells_the_points_of_the_surface_that_zones_have_in_common) {
  const std::array<int, 3> n{4, 4, 4};
  const auto touch_in_an_edge = [](int i, int j, int) { return (i < 2) == (j < 2) ? 0 : no_region; };
  const auto touch_in_a_point = [](int i, int j, int k) {
    return (i < 2) == (j < 2) && (j < 2) == (k < 2) ? 0 : no_region;
  };
  int without_face = 0;
  for (const bool in_an_edge : {true, false}) {
    const surfaces::Surface surface = surfaces::voxels(
        n,
        [&](int i, int j, int k) {
          return in_an_edge ? touch_in_an_edge(i, j, k) : touch_in_a_point(i, j, k);
        },
        surfaces::onto({-1, -1, -1}, {1, 1, 1}, n));
    const ZoneProblem problem = make_problem(surface, 0, 0, [](Vec3) { return no_region; });
    const TetgenMesh mesh = run_tetgen(flat(problem.points), problem.triangles);
    for (const bool reversed : {false, true}) {
      const auto zone_of = [&](Vec3 p) { return (p.x < -0.1) == reversed ? 1 : 0; };
      std::map<LocalIndex, std::set<int>> users;
      std::map<int, std::set<LocalIndex>> told, on_faces;
      for (const int zone : {0, 1}) {
        const ZoneProblem mine = seen_from(problem, zone, zone_of);
        const OwnedCells owned = select_owned(mine, mesh, mine.points);
        for (const LocalCell& cell : owned.cells) {
          for (const LocalIndex v : cell) users[v].insert(zone);
        }
        for (const Crossing& crossing : owned.crossings) {
          const LocalTriangle face = face_of(owned.cells[crossing.cell], crossing.face);
          on_faces[zone].insert(face.begin(), face.end());
        }
        EXPECT_TRUE(std::is_sorted(owned.touched.begin(), owned.touched.end()));
        told[zone].insert(owned.touched.begin(), owned.touched.end());
        told[zone].insert(on_faces[zone].begin(), on_faces[zone].end());
      }
      for (const auto& [v, zones] : users) {
        if (zones.size() < 2) continue;
        for (const int zone : zones) {
          EXPECT_TRUE(told[zone].count(v));
          without_face += on_faces[zone].count(v) == 0;
        }
      }
    }
  }
  EXPECT_GT(without_face, 0);
}

/// A lattice point of another zone may be reached through triangles that are not known here.
TEST(SelectOwned, believes_lattice_points_of_the_zone_alone) {
  ZoneProblem problem;
  problem.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}, {3, 3, 4}, {3, 4, 3}, {4, 3, 3}};
  using enum Owner;
  problem.owners = {mine, mine, mine, higher, mine, higher, higher, higher};
  problem.regions = {1, 0, 1, 1, 1};  // of the last five
  TetgenMesh mesh;
  mesh.cells = {{0, 1, 2, 3}, {0, 2, 1, 4}, {3, 5, 6, 7}};
  mesh.neighbours = {{2, 2, 2, 1}, {2, 2, 2, 0}, {-1, -1, -1, -1}};
  const OwnedCells owned = select_owned(problem, mesh, problem.points);
  EXPECT_EQ(owned.regions, (std::vector<RegionId>{0, 0}));
}

/// Where a zone's knowledge ends, both sides of the surface are connected.
TEST(SelectOwned, tells_regions_beside_an_open_rim) {
  const std::array<int, 3> n{12, 12, 2};
  const surfaces::Surface surface = surfaces::voxels(
      n, [](int, int, int k) { return k; }, surfaces::onto({-1, -1, 0}, {1, 1, 0.04}, n));
  ZoneProblem problem = make_problem(surface, 0, 0, [](Vec3) { return no_region; });
  for (std::size_t t = problem.triangles.size(); t-- > 0;) {
    const auto& v = problem.triangles[t];
    if (std::all_of(v.begin(), v.end(), [&](LocalIndex w) { return problem.points[w].x < 0.4; })) continue;
    const auto at = static_cast<std::ptrdiff_t>(t);
    problem.triangles.erase(problem.triangles.begin() + at);
    problem.inside.erase(problem.inside.begin() + at);
    problem.outside.erase(problem.outside.begin() + at);
  }
  problem = seen_from(std::move(problem), 0, [](Vec3 p) { return p.x < 0.2 ? 0 : 1; });
  const TetgenMesh mesh = run_tetgen(flat(problem.points), problem.triangles);
  const OwnedCells owned = select_owned(problem, mesh, problem.points);
  std::array<double, 2> volume{};
  for (std::size_t c = 0; c < owned.cells.size(); ++c) {
    double z = 0;
    for (const LocalIndex v : owned.cells[c]) z += 0.25 * problem.points[v].z;
    EXPECT_EQ(owned.regions[c], z < 0.02 ? 0 : 1);
    volume[owned.regions[c]] += volume_of(owned.cells[c], problem.points);
  }
  for (const double v : volume) {
    EXPECT_GT(v, 0.02 * 2 * 1.1);
    EXPECT_LT(v, 0.02 * 2 * 1.4);
  }
}

// --- what is refused

std::string refusal(const ZoneProblem& problem, const TetgenMesh& mesh, const std::vector<Vec3>& points) {
  try {
    select_owned(problem, mesh, points);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

struct Filled {
  ZoneProblem problem = cube_problem();
  TetgenMesh mesh = run_tetgen(flat(problem.points), problem.triangles);

  /// The place in the mesh where a triangle is met.
  std::int32_t& mark_of(std::int32_t triangle) {
    for (auto& across : mesh.neighbours) {
      const auto at = std::find(across.begin(), across.end(), -2 - triangle);
      if (at != across.end()) return *at;
    }
    throw std::logic_error("the triangle is not there");
  }
  std::string refusal() const { return volume::refusal(problem, mesh, problem.points); }
};

TEST(SelectOwned, refuses_a_missing_triangle_at_its_own_vertices_alone) {
  Filled filled;
  EXPECT_EQ(filled.refusal(), "");
  // As if TetGen had filled the space beyond.
  const auto count = static_cast<std::int32_t>(filled.mesh.cells.size());
  filled.mark_of(7) = count;
  filled.mesh.cells.push_back({0, 1, 2, 3});
  filled.mesh.neighbours.push_back({-1, -1, -1, -1});
  EXPECT_NE(filled.refusal().find("missing"), std::string::npos) << filled.refusal();
  // Others are not this zone's business.
  for (const LocalIndex v : filled.problem.triangles[7]) filled.problem.owners[v] = Owner::lower;
  for (const LocalIndex v : {0, 1, 2, 3}) filled.problem.owners[v] = Owner::lower;
  EXPECT_EQ(filled.refusal(), "");
}

TEST(SelectOwned, refuses_a_changed_triangle) {
  Filled filled;
  std::int32_t &a = filled.mark_of(7), &b = filled.mark_of(20);
  std::swap(a, b);
  EXPECT_NE(filled.refusal().find("changed"), std::string::npos) << filled.refusal();
}

TEST(SelectOwned, refuses_to_end_in_the_open) {
  Filled filled;
  for (std::size_t c = 0; c < filled.mesh.cells.size(); ++c) {
    for (std::int32_t& next : filled.mesh.neighbours[c]) {
      if (next < 0) continue;
      next = -1;
      EXPECT_NE(filled.refusal().find("ends at a face"), std::string::npos) << filled.refusal();
      return;
    }
  }
}

TEST(SelectOwned, refuses_flat_and_inverted_cells) {
  Filled filled;
  LocalCell& cell = filled.mesh.cells[5];
  std::swap(cell[0], cell[1]);
  std::swap(filled.mesh.neighbours[5][0], filled.mesh.neighbours[5][1]);
  EXPECT_NE(filled.refusal().find("inverted"), std::string::npos) << filled.refusal();
  Filled other;
  std::vector<Vec3> points = other.problem.points;
  const LocalCell& c = other.mesh.cells[9];
  points[c[3]] = points[c[0]];
  EXPECT_NE(refusal(other.problem, other.mesh, points), "");
}

TEST(SelectOwned, refuses_regions_that_touch_without_a_triangle_between) {
  Filled filled;
  filled.problem.regions[3] = 1;
  EXPECT_NE(filled.refusal().find("two regions touch"), std::string::npos) << filled.refusal();
}

// --- points that TetGen added

/// An octahedron around a point that was not given.
struct Octahedron {
  Octahedron() {
    problem.points = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}, {0, 0, 1}};
    problem.owners.assign(6, Owner::mine);
    for (int i = 0; i < 4; ++i) {
      const int j = (i + 1) % 4;
      for (const LocalTriangle& t : {LocalTriangle{i, j, 5}, LocalTriangle{j, i, 4}}) {
        mesh.cells.push_back({t[0], t[1], t[2], 6});
        std::swap(mesh.cells.back()[0], mesh.cells.back()[1]);
        problem.triangles.push_back(t);
        problem.inside.push_back(0);
        problem.outside.push_back(no_region);
      }
    }
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
      auto& across = mesh.neighbours.emplace_back();
      for (int face = 0; face < 4; ++face) {
        across[face] = face == 3 ? -2 - static_cast<std::int32_t>(c) : -1;
        for (std::size_t d = 0; d < mesh.cells.size() && face < 3; ++d) {
          for (int other = 0; other < 3; ++other) {
            if (d != c && sorted(face_of(mesh.cells[c], face)) == sorted(face_of(mesh.cells[d], other)))
              across[face] = static_cast<std::int32_t>(d);
          }
        }
      }
    }
    points = problem.points;
    points.push_back({0, 0, 0.1});
  }

  ZoneProblem problem;
  TetgenMesh mesh;
  std::vector<Vec3> points;
};

TEST(SelectOwned, gives_an_added_point_to_the_lowest_zone_around_it) {
  const auto owned_cells = [](const std::vector<Owner>& owners) {
    Octahedron octahedron;
    octahedron.problem.owners = owners;
    octahedron.problem.regions = {0};  // as if its last corner were a point of the lattice
    return select_owned(octahedron.problem, octahedron.mesh, octahedron.points).cells.size();
  };
  using enum Owner;
  EXPECT_EQ(owned_cells({mine, mine, mine, mine, mine, mine}), 8u);
  EXPECT_EQ(owned_cells({higher, higher, mine, higher, higher, higher}), 8u);
  EXPECT_EQ(owned_cells({mine, mine, mine, lower, mine, mine}), 0u);
  EXPECT_EQ(owned_cells({higher, higher, higher, higher, higher, higher}), 0u);
}

/// A cell may be a zone's own by such a point alone, without any of the lattice around.
TEST(SelectOwned, tells_the_region_around_an_added_point) {
  Octahedron octahedron;
  octahedron.problem.owners.assign(6, Owner::higher);
  octahedron.problem.owners[2] = Owner::mine;
  EXPECT_EQ(select_owned(octahedron.problem, octahedron.mesh, octahedron.points).cells.size(), 8u);
}

}  // namespace
}  // namespace aeroloom::volume
