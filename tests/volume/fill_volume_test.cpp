#include "geometry/predicates.hpp"
#include "mesh/quality.hpp"
#include "tests/volume/fields.hpp"
#include "tests/volume/surfaces.hpp"
#include "volume/boundary_distance.hpp"
#include "volume/volume_mesher.hpp"

#include <algorithm>
#include <cstring>
#include <map>

#include <gtest/gtest.h>

namespace aeroloom::volume {
namespace {

using geometry::Vec3;

const bool tasks_are_known = (register_volume_tasks(), true);

Vec3 point(const FilledVolume& filled, mesh::LocalIndex v) {
  return {filled.coordinates[3 * v], filled.coordinates[3 * v + 1], filled.coordinates[3 * v + 2]};
}

/// Calls `visit(a, b, c, d)` with the corners of every tetrahedron.
template <class Visit>
void for_each_cell(const FilledVolume& filled, const Visit& visit) {
  const auto& t = filled.tetrahedra;
  for (std::size_t i = 0; i < t.size(); i += 4) {
    visit(point(filled, t[i]), point(filled, t[i + 1]), point(filled, t[i + 2]), point(filled, t[i + 3]));
  }
}

/// Rotated so that the smallest index is first.
std::array<mesh::LocalIndex, 3> canonical(std::array<mesh::LocalIndex, 3> t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

/// Faces without a partner, turned outward.
std::vector<std::array<mesh::LocalIndex, 3>> boundary_of(const FilledVolume& filled) {
  std::map<std::array<mesh::LocalIndex, 3>, int> faces;
  for (std::size_t i = 0; i < filled.tetrahedra.size(); i += 4) {
    const auto* cell = filled.tetrahedra.data() + i;
    for (const auto& [a, b, c] : mesh::tetrahedron_faces) {
      const auto opposite = faces.find(canonical({cell[a], cell[c], cell[b]}));
      if (opposite != faces.end()) {
        faces.erase(opposite);
      } else {
        ++faces[canonical({cell[a], cell[b], cell[c]})];
      }
    }
  }
  std::vector<std::array<mesh::LocalIndex, 3>> open;
  for (const auto& [face, count] : faces) open.insert(open.end(), count, face);
  return open;
}

void expect_sound(const ClosedSurface& surface, const FilledVolume& filled) {
  ASSERT_GE(filled.coordinates.size(), 3 * surface.points.size());
  EXPECT_EQ(std::memcmp(filled.coordinates.data(), surface.points.data(), 24 * surface.points.size()), 0);
  double sum = 0;
  for_each_cell(filled, [&](Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
    EXPECT_EQ(geometry::orient3d(a, b, c, d), 1);
    sum += volume6(a, b, c, d) / 6;
  });
  EXPECT_NEAR(sum, surfaces::volume(surface), 1e-10 * sum);
  std::vector<std::array<mesh::LocalIndex, 3>> expected;
  for (const auto& t : surface.triangles) expected.push_back(canonical(t));
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(boundary_of(filled), expected);
  std::vector<bool> used(filled.coordinates.size() / 3, false);
  for (const auto v : filled.tetrahedra) used[v] = true;
  EXPECT_EQ(std::count(used.begin(), used.end(), false), 0);
}

struct Quality {
  double mean_ratio = 0;  ///< average
  double near_size = 0;   ///< part of the edges within 0.7 and 1.4 sizes, each counted once per cell
  double below_ten = 0;   ///< part of the cells with a dihedral angle below 10 degrees
};

Quality quality_of(const FilledVolume& filled, const sizing::SizeField& field) {
  Quality quality;
  for_each_cell(filled, [&](Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
    quality.mean_ratio += mesh::mean_ratio(a, b, c, d);
    quality.below_ten += mesh::dihedral_range(a, b, c, d).smallest < 10;
    const Vec3 corner[4] = {a, b, c, d};
    for (const auto& [i, j] : mesh::tetrahedron_edges) {
      const double ratio = distance(corner[i], corner[j]) / field(0.5 * (corner[i] + corner[j]));
      quality.near_size += (ratio > 0.7 && ratio < 1.4) / 6.0;
    }
  });
  const double cells = static_cast<double>(filled.tetrahedra.size()) / 4;
  return {quality.mean_ratio / cells, quality.near_size / cells, quality.below_ten / cells};
}

TEST(FillVolume, fills_a_box_with_a_ball_cut_out) {
  const ClosedSurface surface = surfaces::cube_with_ball(27, 7);
  const auto field = fields::uniform(0.15);
  const FilledVolume filled = fill_volume(surface, field, {});
  expect_sound(surface, filled);
  EXPECT_EQ(filled.attempts, 1);
  EXPECT_EQ(filled.steiner_points, 0);
  EXPECT_EQ(filled.dropped_points, 0);
  EXPECT_GT(filled.cpu_seconds, 0);
  EXPECT_GT(filled.child_peak_bytes, 0);
  const Quality quality = quality_of(filled, field);
  EXPECT_GT(quality.mean_ratio, 0.90);
  EXPECT_GT(quality.near_size, 0.90);
  EXPECT_LT(quality.below_ten, 0.005);
}

TEST(FillVolume, follows_sizes_that_grow_fast) {
  const ClosedSurface surface = surfaces::cube_with_ball(14, 22);
  const auto field = fields::around_unit_sphere(0.05, 0.3);
  const FilledVolume filled = fill_volume(surface, field, {});
  expect_sound(surface, filled);
  const Quality quality = quality_of(filled, field);
  EXPECT_GT(quality.mean_ratio, 0.83);
  EXPECT_GT(quality.near_size, 0.85);
  EXPECT_LT(quality.below_ten, 0.01);
}

TEST(FillVolume, fills_between_nested_shells) {
  ClosedSurface surface = surfaces::cube_with_ball(10, 6);
  surfaces::append(surface, surfaces::sphere({0, 0, 0}, 0.6, 4));
  surfaces::append(surface, surfaces::cube({0, 0, 0}, 0.2, 2), surfaces::Turn::inward);
  expect_sound(surface, fill_volume(surface, fields::uniform(0.3), {}));
}

TEST(FillVolume, fills_disjoint_boxes) {
  ClosedSurface surface = surfaces::cube({-1, 0, 0}, 0.5, 4);
  surfaces::append(surface, surfaces::cube({1, 0.2, 0.1}, 0.5, 5));
  expect_sound(surface, fill_volume(surface, fields::uniform(0.2), {}));
}

TEST(FillVolume, fills_boxes_that_touch_in_an_edge) {
  // Two unit cubes of one square per edge with the edge x = y = 0 in common.
  ClosedSurface surface = surfaces::box({0, 0, 0}, {1, 1, 1}, 1, 1, 1);
  const ClosedSurface other = surfaces::box({-1, -1, 0}, {0, 0, 1}, 1, 1, 1);
  std::vector<mesh::LocalIndex> number;
  for (const Vec3& p : other.points) {
    const auto same = std::find(surface.points.begin(), surface.points.end(), p);
    number.push_back(static_cast<mesh::LocalIndex>(same - surface.points.begin()));
    if (same == surface.points.end()) surface.points.push_back(p);
  }
  for (const auto& [a, b, c] : other.triangles)
    surface.triangles.push_back({number[a], number[b], number[c]});
  expect_sound(surface, fill_volume(surface, fields::uniform(0.5), {}));
}

TEST(FillVolume, fills_a_slab_much_thinner_than_the_size) {
  const ClosedSurface surface = surfaces::box({-1, -1, 0}, {1, 1, 0.01}, 10, 10, 1);
  const FilledVolume filled = fill_volume(surface, fields::uniform(0.2), {});
  expect_sound(surface, filled);
}

TEST(FillVolume, fills_a_thin_gap_around_a_box) {
  ClosedSurface surface = surfaces::cube({0, 0, 0}, 1, 8);
  surfaces::append(surface, surfaces::cube({0, 0, 0}, 0.99, 7), surfaces::Turn::inward);
  expect_sound(surface, fill_volume(surface, fields::uniform(0.25), {}));
}

TEST(FillVolume, copes_with_needles_on_the_boundary) {
  ClosedSurface surface = surfaces::cube({0, 0, 0}, 1, 10);
  // Drags a point almost onto its neighbour, which leaves triangles a thousand times longer than wide.
  for (Vec3& p : surface.points) {
    if (distance(p, {0.2, 0.2, 1}) < 1e-9) p = {0.0002, 0.0001, 1};
  }
  expect_sound(surface, fill_volume(surface, fields::uniform(0.2), {}));
}

TEST(FillVolume, copes_with_a_piece_far_from_the_origin) {
  ClosedSurface surface = surfaces::cube_with_ball(8, 4);
  for (Vec3& p : surface.points) p = 1e-3 * p + Vec3{1000, -2000, 0.0005};
  const auto field = fields::uniform(0.0005, {{999, -2001, -1}, {1001, -1999, 1}});
  expect_sound(surface, fill_volume(surface, field, {}));
}

TEST(FillVolume, gives_the_same_bits_each_time) {
  const ClosedSurface surface = surfaces::cube_with_ball(12, 14);
  const auto field = fields::around_unit_sphere(0.1, 0.35);
  const FilledVolume first = fill_volume(surface, field, {}), second = fill_volume(surface, field, {});
  EXPECT_EQ(first.coordinates, second.coordinates);
  EXPECT_EQ(first.tetrahedra, second.tetrahedra);
}

TEST(FillVolume, names_the_triangles_that_intersect) {
  ClosedSurface surface = surfaces::cube({0, 0, 0}, 1, 6);
  surfaces::append(surface, surfaces::sphere({0.95, 0, 0}, 0.3, 4), surfaces::Turn::inward);
  try {
    fill_volume(surface, fields::uniform(0.3), {});
    FAIL() << "filled a surface that intersects itself";
  } catch (const VolumeError& error) {
    EXPECT_FALSE(error.triangles().empty());
    EXPECT_NE(std::string(error.what()).find("intersects"), std::string::npos);
    const std::string first = "triangle " + std::to_string(error.triangles().front()) + " at (";
    EXPECT_NE(std::string(error.what()).find(first), std::string::npos) << error.what();
  }
  EXPECT_NO_THROW(fill_volume(surfaces::cube({0, 0, 0}, 1, 6), fields::uniform(0.3), {}));
}

TEST(FillVolume, refuses_an_open_surface_and_a_piece_too_large) {
  ClosedSurface open = surfaces::cube({0, 0, 0}, 1, 6);
  open.triangles.erase(open.triangles.begin() + 11);
  EXPECT_THROW(fill_volume(open, fields::uniform(0.3), {}), VolumeError);
  VolumeOptions small;
  small.largest_piece = 10000;
  try {
    fill_volume(surfaces::cube({0, 0, 0}, 1.9, 20), fields::uniform(0.1), small);
    FAIL() << "filled a piece above the limit";
  } catch (const VolumeError& error) {
    EXPECT_NE(std::string(error.what()).find("largest_piece"), std::string::npos);
  }
}

}  // namespace
}  // namespace aeroloom::volume
