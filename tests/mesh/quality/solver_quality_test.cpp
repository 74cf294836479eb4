#include "mesh/quality/solver_quality.hpp"

#include "tests/meshes/mixed_mesh.hpp"
#include "tests/several_ranks.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace aeroloom::mesh {
namespace {

using geometry::Vec3;
using parallel::Communicator;

SolverQuality quality_of(const DistributedMesh& mesh) {
  const NumberedMesh numbered = number_mesh(mesh);
  return measure_as_solvers(numbered, link_faces(numbered));
}

struct HandMadeCell {
  CellShape shape;
  std::vector<int> corners;
};
constexpr CellShape tet = CellShape::tetrahedron, pyramid = CellShape::pyramid, prism = CellShape::prism;

/// Each cell is a piece of its own; `layers` are theirs, if given.
DistributedMesh hand_made(const Communicator& communicator, const std::vector<Vec3>& points,
                          const std::vector<HandMadeCell>& cells, const std::vector<int>& layers = {}) {
  examples::MixedMesh whole(1, examples::SquareColumns{});
  whole.points = points;
  std::int32_t piece = 0;
  for (const HandMadeCell& cell : cells) whole.cells.push_back({cell.shape, cell.corners, 0, piece++});
  DistributedMesh mesh = examples::distribute(communicator, whole, piece);
  for (Piece& each : mesh.pieces) {
    if (!layers.empty() && layers[static_cast<std::size_t>(each.id)] > 0)
      each.layers = {static_cast<std::int16_t>(layers[static_cast<std::size_t>(each.id)])};
  }
  return mesh;
}

/// Prisms one on the other over the triangle (0, 0), (1, 0), (0, 1), with these triangles' heights and
/// shifts.
struct Level {
  double z, x = 0;
};
DistributedMesh column(const std::vector<Level>& levels, const std::vector<int>& layers = {}) {
  std::vector<Vec3> points;
  std::vector<HandMadeCell> cells;
  for (const auto& [z, x] : levels) {
    const int at = static_cast<int>(points.size());
    if (at > 0) cells.push_back({prism, {at - 3, at - 2, at - 1, at, at + 1, at + 2}});
    points.insert(points.end(), {{x, 0, z}, {x + 1, 0, z}, {x, 1, z}});
  }
  return hand_made(Communicator::world(), points, cells, layers);
}

const WorstCellOfShape& worst(const SolverQuality& quality, SolverMeasure measure) {
  static const WorstCellOfShape none{-1, -1, tet, {}};
  return quality.worst_of(measure).empty() ? none : quality.worst_of(measure).front();
}

void expect_at(const WorstCellOfShape& place, GlobalIndex cell, CellShape shape, Vec3 center) {
  EXPECT_EQ(place.cell, cell);
  EXPECT_EQ(place.shape, shape);
  EXPECT_NEAR(distance(place.center, center), 0, 1e-12);
}

/// The tetrahedron over (0, 0), (1, 0), (0, 1) with this top, and one below with this bottom.
DistributedMesh two_tetrahedra(Vec3 top, Vec3 bottom) {
  return hand_made(Communicator::world(), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, top, bottom},
                   {{tet, {0, 1, 2, 3}}, {tet, {0, 2, 1, 4}}});
}
constexpr Vec3 middle{1.0 / 3, 1.0 / 3, 0};

TEST(SolverQuality, TheHalvesOfACubeAreGood) {
  const Communicator world = Communicator::world();
  const SolverQuality quality = quality_of(hand_made(
      world, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}},
      {{prism, {0, 1, 2, 4, 5, 6}}, {prism, {0, 2, 3, 4, 6, 7}}}));
  EXPECT_EQ(quality.cells, 2);
  EXPECT_EQ(quality.inner_faces, 1);
  EXPECT_EQ(quality.boundary_faces, 8);
  EXPECT_NEAR(quality.largest_non_orthogonality, 0, 1e-5);
  EXPECT_NEAR(quality.average_non_orthogonality, 0, 1e-5);
  EXPECT_EQ(quality.non_orthogonal_faces + quality.skewed_faces + quality.stretched_cells, 0);
  EXPECT_NEAR(quality.largest_aspect_ratio, 2, 1e-12) << "(2, 2, 1) along the axes";
  EXPECT_NEAR(quality.smallest_volume_ratio, 1, 1e-12);
  EXPECT_NEAR(quality.mean_volume_ratio, 1, 1e-12);
  EXPECT_EQ(quality.underdetermined_cells, 2) << "one inner face each";
  EXPECT_EQ(quality.faces_of(FaceClass::within_layers).faces, 1) << "prisms, and nobody knows of layers";
  expect_at(worst(quality, SolverMeasure::volume_ratio), 0, prism, {0.5, 0.5, 0.5});
}

// Ten meshes with one fault each.

TEST(SolverQuality, NamesANonOrthogonalPair) {
  const double lean = std::tan(80 * std::numbers::pi / 180);
  const SolverQuality quality = quality_of(column({{0}, {1, lean}, {2, 2 * lean}}));
  EXPECT_NEAR(quality.largest_non_orthogonality, 80, 1e-9);
  EXPECT_NEAR(quality.average_non_orthogonality, 80, 1e-9);
  EXPECT_EQ(quality.non_orthogonal_faces, 1);
  expect_at(worst(quality, SolverMeasure::non_orthogonality), 0, prism, {lean + 1.0 / 3, 1.0 / 3, 1});
  EXPECT_NEAR(quality.smallest_volume_ratio, 1, 1e-12);
}

TEST(SolverQuality, NamesASkewedPair) {
  // Both tops are 20 beside the face: the line between the centres is upright and misses it by 5.
  const SolverQuality quality =
      quality_of(two_tetrahedra({1.0 / 3 + 20, 1.0 / 3, 1}, {1.0 / 3 + 20, 1.0 / 3, -1}));
  EXPECT_NEAR(quality.largest_skewness, 7.5, 1e-12);
  EXPECT_EQ(quality.skewed_faces, 1);
  expect_at(worst(quality, SolverMeasure::skewness), 0, tet, middle);
  EXPECT_NEAR(quality.largest_non_orthogonality, 0, 1e-5);
}

TEST(SolverQuality, NamesASkewedBoundaryFace) {
  const SolverQuality quality = quality_of(
      hand_made(Communicator::world(), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1.0 / 3 + 20, 1.0 / 3, 1}},
                {{tet, {0, 1, 2, 3}}}));
  EXPECT_EQ(quality.inner_faces, 0);
  EXPECT_NEAR(quality.largest_skewness, 7.5, 1e-12);
  expect_at(worst(quality, SolverMeasure::skewness), 0, tet, middle);
  EXPECT_TRUE(quality.worst_of(SolverMeasure::non_orthogonality).empty());
  EXPECT_TRUE(quality.worst_of(SolverMeasure::volume_ratio).empty());
  EXPECT_EQ(quality.average_non_orthogonality, 0);
}

TEST(SolverQuality, NamesAJumpOfVolumes) {
  const SolverQuality quality = quality_of(column({{0}, {1}, {2}, {52}}));
  EXPECT_NEAR(quality.smallest_volume_ratio, 0.02, 1e-14);
  EXPECT_NEAR(quality.mean_volume_ratio, 0.51, 1e-14);
  expect_at(worst(quality, SolverMeasure::volume_ratio), 1, prism, middle + Vec3{0, 0, 2});
  const FacesOfClass& faces = quality.faces_of(FaceClass::within_layers);
  EXPECT_NEAR(faces.largest_volume_ratio, 50, 1e-10);
  EXPECT_EQ(faces.high_volume_ratios, 1);
  EXPECT_EQ(faces.severe_volume_ratios, 1);
}

TEST(SolverQuality, NamesAFlatCell) {
  // On one upright tetrahedron lies another one, 1e-4 high.
  const SolverQuality quality = quality_of(two_tetrahedra({0.25, 0.25, 1}, {0.25, 0.25, -1e-4}));
  EXPECT_EQ(quality.stretched_cells, 1);
  // Sums of components: 1e-4 / 2 times a few along the wall, 1 across.
  EXPECT_GT(quality.largest_aspect_ratio, 5000);
  expect_at(worst(quality, SolverMeasure::aspect_ratio), 1, tet, {0.3125, 0.3125, -0.25e-4});
}

TEST(SolverQuality, NamesAStretchedCell) {
  const SolverQuality quality = quality_of(column({{0}, {1}, {2001}}));
  EXPECT_NEAR(quality.largest_aspect_ratio, 4000, 1e-9);
  EXPECT_EQ(quality.stretched_cells, 1);
  expect_at(worst(quality, SolverMeasure::aspect_ratio), 1, prism, middle + Vec3{0, 0, 1001});
}

TEST(SolverQuality, NamesASliver) {
  // The corners of a tilted square, two of them 1e-3 up: its components are alike, but it has no volume.
  const Vec3 a{1, -1, 0}, b = Vec3{1, 1, -2} / std::sqrt(3.0), up = Vec3{1, 1, 1} * 1e-3;
  const SolverQuality quality =
      quality_of(hand_made(Communicator::world(), {a, b + up, Vec3{} - a, Vec3{} - b + up, {2, 2, 2}},
                           {{tet, {0, 1, 3, 4}}, {tet, {0, 1, 2, 3}}}));
  EXPECT_EQ(quality.inner_faces, 1);
  expect_at(worst(quality, SolverMeasure::aspect_ratio), 1, tet, 0.5 * up);
  EXPECT_GT(quality.largest_aspect_ratio, 10);
  EXPECT_LT(quality.smallest_volume_ratio, 0.01);
}

/// A tetrahedron with a neighbour on each face; its top is this high.
SolverQuality surrounded(double height) {
  const double side = 5;
  return quality_of(hand_made(Communicator::world(),
                              {{0, 0, 0},
                               {1, 0, 0},
                               {0, 1, 0},
                               {0.25, 0.25, height},
                               {0.25, 0.25, -side},
                               {-side, 0.25, height},
                               {0.25, -side, height},
                               {side, side, height}},
                              {{tet, {0, 1, 2, 3}},
                               {tet, {0, 2, 1, 4}},
                               {tet, {0, 3, 2, 5}},
                               {tet, {0, 1, 3, 6}},
                               {tet, {1, 2, 3, 7}}}));
}

TEST(SolverQuality, NamesACellWithASmallDeterminant) {
  const SolverQuality good = surrounded(1);
  EXPECT_EQ(good.inner_faces, 4);
  EXPECT_EQ(good.underdetermined_cells, 4) << "those around, with one inner face each";
  const SolverQuality flat = surrounded(1e-3);
  EXPECT_EQ(flat.underdetermined_cells, 5);
  EXPECT_LT(flat.mean_determinant, 1e-3 * good.mean_determinant);
  const auto& list = flat.worst_of(SolverMeasure::determinant);
  ASSERT_EQ(list.size(), 5u);
  // Those around have 0 each; the one in the middle comes last.
  EXPECT_EQ(list.back().cell, 0);
  EXPECT_NEAR(list.back().value, 5 * flat.mean_determinant, 1e-15);
}

TEST(SolverQuality, NamesACellInsideOut) {
  // The second tetrahedron lies over the first, on the wrong side of their face.
  const SolverQuality quality = quality_of(two_tetrahedra({1.0 / 3, 1.0 / 3, 1}, {1.0 / 3, 1.0 / 3, 2}));
  EXPECT_NEAR(quality.largest_non_orthogonality, 180, 1e-5);
  EXPECT_EQ(quality.non_orthogonal_faces, 1);
  expect_at(worst(quality, SolverMeasure::non_orthogonality), 0, tet, middle);
  EXPECT_LT(quality.smallest_volume_ratio, 0);
  EXPECT_EQ(quality.faces_of(FaceClass::off_layers).largest_volume_ratio, largest_ratio);
  expect_at(worst(quality, SolverMeasure::volume_ratio), 0, tet, middle);
}

TEST(SolverQuality, NamesTheFrontOfLayers) {
  // Two layers, and what stands on them leans.
  const double lean = std::tan(75 * std::numbers::pi / 180);
  const std::vector<Level> levels = {{0}, {1}, {2}, {4, 3 * lean}, {6, 6 * lean}};
  const SolverQuality quality = quality_of(column(levels, {1, 2, 0, 0}));
  const FacesOfClass &within = quality.faces_of(FaceClass::within_layers),
                     &front = quality.faces_of(FaceClass::at_front),
                     &off = quality.faces_of(FaceClass::off_layers);
  EXPECT_EQ(within.faces, 1);
  EXPECT_EQ(front.faces, 1);
  EXPECT_EQ(off.faces, 1);
  EXPECT_NEAR(within.largest_non_orthogonality, 0, 1e-5);
  // From the middle of the second layer, (0, 1.5), to that of the third, (3/2 lean, 3).
  EXPECT_NEAR(front.largest_non_orthogonality, 75, 1e-9);
  EXPECT_EQ(front.non_orthogonal_faces, 1);
  EXPECT_NEAR(front.largest_volume_ratio, 2, 1e-12);
  EXPECT_NEAR(off.largest_non_orthogonality, std::atan(1.5 * lean) * 180 / std::numbers::pi, 1e-9);
  EXPECT_EQ(quality.inner_faces, 3);
  EXPECT_EQ(quality.non_orthogonal_faces, 2);
}

TEST(SolverQuality, DegenerateCellsHaveFiniteFigures) {
  const SolverQuality quality = quality_of(two_tetrahedra({0.25, 0.25, 0}, {}));
  for (const double value :
       {quality.largest_non_orthogonality, quality.average_non_orthogonality, quality.largest_skewness,
        quality.largest_aspect_ratio, quality.mean_determinant, quality.smallest_volume_ratio})
    EXPECT_TRUE(std::isfinite(value));
  EXPECT_EQ(quality.stretched_cells, 2);
}

TEST(SolverQuality, CountsEachFaceOnce) {
  const Communicator world = Communicator::world();
  const examples::MixedMesh whole(4, 3);
  const SolverQuality quality = quality_of(examples::distribute(world, whole, 3));
  GlobalIndex sides = 0, boundary = 0, of_classes = 0;
  for (const auto& cell : whole.cells) sides += static_cast<GlobalIndex>(faces_of(cell.shape).size());
  for (const auto& face : whole.faces) boundary += face.patch != examples::MixedMesh::interface ? 1 : 0;
  EXPECT_EQ(quality.boundary_faces, boundary);
  EXPECT_EQ(2 * quality.inner_faces + boundary, sides);
  for (const FacesOfClass& faces : quality.of_class) of_classes += faces.faces;
  EXPECT_EQ(of_classes, quality.inner_faces);
  EXPECT_GT(quality.faces_of(FaceClass::at_front).faces, 0);
  for (const SolverMeasure measure : all_solver_measures) {
    const std::vector<WorstCellOfShape>& list = quality.worst_of(measure);
    ASSERT_EQ(list.size(), 10u) << name_of(measure);
    EXPECT_TRUE(
        std::is_sorted(list.begin(), list.end(), [&](const WorstCellOfShape& a, const WorstCellOfShape& b) {
          return larger_is_worse(measure) ? a.value > b.value : a.value < b.value;
        }));
  }
  EXPECT_EQ(worst(quality, SolverMeasure::skewness).value, quality.largest_skewness);
  EXPECT_EQ(worst(quality, SolverMeasure::non_orthogonality).value, quality.largest_non_orthogonality);
}

void expect_same(const SolverQuality& a, const SolverQuality& b) {
  EXPECT_EQ(a.average_non_orthogonality, b.average_non_orthogonality);
  EXPECT_EQ(a.mean_determinant, b.mean_determinant);
  EXPECT_EQ(a.mean_volume_ratio, b.mean_volume_ratio);
  EXPECT_EQ(a.inner_faces, b.inner_faces);
  EXPECT_EQ(a.boundary_faces, b.boundary_faces);
  EXPECT_EQ(a.underdetermined_cells, b.underdetermined_cells);
  for (std::size_t c = 0; c < face_class_count; ++c) {
    EXPECT_EQ(a.of_class[c].faces, b.of_class[c].faces);
    EXPECT_EQ(a.of_class[c].average_non_orthogonality, b.of_class[c].average_non_orthogonality);
    EXPECT_EQ(a.of_class[c].largest_non_orthogonality, b.of_class[c].largest_non_orthogonality);
    EXPECT_EQ(a.of_class[c].largest_volume_ratio, b.of_class[c].largest_volume_ratio);
  }
  for (const SolverMeasure measure : all_solver_measures) {
    const std::vector<WorstCellOfShape>&x = a.worst_of(measure), &y = b.worst_of(measure);
    ASSERT_EQ(x.size(), y.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      EXPECT_EQ(x[i].value, y[i].value);
      EXPECT_EQ(x[i].cell, y[i].cell);
      EXPECT_EQ(x[i].shape, y[i].shape);
      EXPECT_EQ(x[i].center, y[i].center);
    }
  }
}

TEST(SolverQuality, TheSameForAnyNumberOfRanks) {
  NEEDS_SEVERAL_RANKS();
  const Communicator world = Communicator::world(), self = Communicator::self();
  expect_same(quality_of(examples::mixed_mesh(world, 4, 5)), quality_of(examples::mixed_mesh(self, 4, 5)));
}

TEST(SolverQuality, FlawsOfFacesAreAmongTheWorstPlaces) {
  const double lean = std::tan(88 * std::numbers::pi / 180);
  const SolverQuality quality = quality_of(column({{0}, {1, lean}, {2, 2 * lean}}));
  WorstPlaces places;
  places.of[0] = {{10, severity_of(Flaw::small_angle, 10), 0, tet, Flaw::small_angle, {}},
                  {10, severity_of(Flaw::small_angle, 10), 7, tet, Flaw::small_angle, {}}};
  add_faces(quality, places);
  ASSERT_EQ(places.all.size(), 3u) << "two cells have faces, and one has an angle alone";
  EXPECT_EQ(places.all.front().flaw, Flaw::non_orthogonality);
  EXPECT_EQ(places.all.front().cell, 0);
  EXPECT_EQ(verdict_of(places.all.front().severity), Verdict::poor);
  EXPECT_EQ(verdict_of(severity_of(Flaw::non_orthogonality, 70)), Verdict::good);
  EXPECT_EQ(verdict_of(severity_of(Flaw::non_orthogonality, 80)), Verdict::fair);
  EXPECT_EQ(verdict_of(severity_of(Flaw::skewness, 3.9)), Verdict::good);
  EXPECT_EQ(verdict_of(severity_of(Flaw::skewness, 20.1)), Verdict::poor);
}

}  // namespace
}  // namespace aeroloom::mesh
