#include "mesh/data/boundary_mesh.hpp"

#include "mesh/checks/validity.hpp"
#include "tests/meshes/small_meshes.hpp"

#include <map>
#include <tuple>

#include <gtest/gtest.h>

namespace aeroloom::mesh {
namespace {

using parallel::Communicator;

constexpr int cubes = 3;

/// Triangles and area by CAD face, all ranks together.
struct FaceSum {
  std::int64_t triangles = 0;
  double area = 0;
};
std::map<std::int32_t, FaceSum> sums_by_face(const DistributedMesh& surface) {
  const Communicator& communicator = surface.communicator;
  std::map<std::int32_t, FaceSum> sums;
  for (std::int32_t face = 0; face < 6; ++face) {
    FaceSum mine;
    for (const Piece& piece : surface.pieces) {
      for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
        if (piece.triangle_face[t] != face) continue;
        const LocalIndex* v = piece.cell(t);
        const geometry::Vec3 normal =
            cross(piece.point(v[1]) - piece.point(v[0]), piece.point(v[2]) - piece.point(v[0]));
        ++mine.triangles;
        mine.area += 0.5 * (face % 2 == 0 ? -1 : 1) * normal[face / 2];
      }
    }
    sums[face] = {communicator.sum(mine.triangles), communicator.sum(mine.area)};
  }
  return sums;
}

class BoundaryOfCube : public testing::TestWithParam<int> {};

TEST_P(BoundaryOfCube, HasAllTrianglesOfEveryFaceAndIsClosed) {
  const Communicator world = Communicator::world();
  const DistributedMesh volume = examples::cube(world, cubes, GetParam());
  const DistributedMesh surface = boundary_mesh(number_mesh(volume));
  EXPECT_EQ(surface.kind, CellKind::triangle);
  for (const auto& [face, sum] : sums_by_face(surface)) {
    EXPECT_EQ(sum.triangles, 2 * cubes * cubes) << "face " << face;
    EXPECT_NEAR(sum.area, 1, 1e-12) << "face " << face << ", outward";
  }
  const NumberedMesh numbered = number_mesh(surface);
  constexpr int row = cubes + 1, inside = cubes - 1;
  EXPECT_EQ(numbered.numbering.vertex_count, row * row * row - inside * inside * inside);
  const ValidityReport report = check_surface_mesh(numbered);
  EXPECT_TRUE(report.valid()) << report.violations.front();
}

TEST_P(BoundaryOfCube, HasOnePieceForEachPieceAndFaceInTheirOrder) {
  const Communicator world = Communicator::world();
  const DistributedMesh volume = examples::cube(world, cubes, GetParam());
  const DistributedMesh surface = boundary_mesh(number_mesh(volume));
  struct Row {
    PieceId id;
    std::int32_t face;

    static constexpr auto fields() { return std::tuple(&Row::id, &Row::face); }
  };
  std::vector<Row> rows;
  for (const Piece& piece : surface.pieces) {
    ASSERT_GT(piece.cell_count(), 0);
    for (const std::int32_t face : piece.triangle_face) EXPECT_EQ(face, piece.common_face());
    rows.push_back({piece.id, piece.common_face()});
  }
  rows = world.all_gather_items(std::span<const Row>(rows));
  std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.id < b.id; });
  ASSERT_EQ(static_cast<PieceId>(rows.size()), surface.piece_count);
  int falls = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].id, static_cast<PieceId>(i));
    falls += i > 0 && rows[i].face <= rows[i - 1].face;
  }
  // Faces ascend in each piece of the volume.
  EXPECT_EQ(falls, GetParam() - 1);
}

INSTANTIATE_TEST_SUITE_P(Pieces, BoundaryOfCube, testing::Values(1, 2, 5));

TEST(PartOfSurface, TellsFacesBetweenRegionsFromTheOthers) {
  const Communicator world = Communicator::world();
  const DistributedMesh volume = examples::cube(world, cubes, 2);
  DistributedMesh surface = boundary_mesh(number_mesh(volume));
  surface.sides.assign(6, FaceSides{0, no_region});
  surface.sides[3] = {0, 1};
  const auto outside = sums_by_face(part_of_surface(surface, SurfacePart::outside));
  const auto between = sums_by_face(part_of_surface(surface, SurfacePart::between_regions));
  for (std::int32_t face = 0; face < 6; ++face) {
    const std::int64_t all = 2 * cubes * cubes;
    EXPECT_EQ(outside.at(face).triangles, face == 3 ? 0 : all);
    EXPECT_EQ(between.at(face).triangles, face == 3 ? all : 0);
  }
  EXPECT_EQ(part_of_surface(surface, SurfacePart::outside).pieces.size(), surface.pieces.size());
}

}  // namespace
}  // namespace aeroloom::mesh
