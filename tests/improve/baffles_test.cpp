// Triangles with cells of one region on both sides: no operation removes, moves or crosses them.
#include "improve/improver.hpp"
#include "tests/improve/shaken.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::improve {
namespace {

using geometry::Vec3;
using mesh::DistributedMesh;
using mesh::LocalIndex;
using mesh::Piece;

/// Every `stride`th inner face of the cells is a triangle of a baffle, a face and patch of its own.
void add_baffles(mesh::examples::WholeMesh& whole, int stride) {
  const auto face = static_cast<std::int32_t>(whole.face_names.size());
  const auto patch = static_cast<std::int32_t>(whole.patch_names.size());
  whole.face_names.emplace_back("baffle");
  whole.patch_names.emplace_back("baffle");
  int count = 0;
  for (const auto& [corners, sides] : examples::find_face_sides(whole)) {
    if (sides.size() != 2 || ++count % stride != 0) continue;
    const std::vector<int>& cell = whole.cells[sides[count % 2].cell];
    for (const auto& local : mesh::tetrahedron_faces) {
      const std::array<int, 3> seen{cell[local[0]], cell[local[1]], cell[local[2]]};
      std::array<int, 3> key = seen;
      std::sort(key.begin(), key.end());
      if (key == corners) whole.boundary.push_back(seen);
    }
    whole.piece_of_triangle.push_back(whole.piece_of_cell[sides[count % 2].cell]);
    whole.faces.push_back(face);
    whole.patches.push_back(patch);
    for (const int v : corners) {
      if (is_on_boundary(whole.dimensions[v])) continue;
      whole.dimensions[v] = mesh::CadDimension::face;
      whole.entities[v] = face;
    }
  }
}

DistributedMesh mesh_with_baffles(int pieces, std::uint32_t seed) {
  mesh::examples::WholeMesh whole = examples::shaken_cube(5, pieces, 25, seed);
  add_baffles(whole, 12);
  DistributedMesh mesh = mesh::examples::distribute(parallel::Communicator::self(), whole, pieces);
  mesh.sides.resize(mesh.faces.size());
  mesh.sides.back() = {0, 0};
  return mesh;
}

/// The corners of the baffles' triangles, each from the lowest on, in their direction.
std::multiset<std::vector<double>> baffles_of(const DistributedMesh& mesh) {
  std::multiset<std::vector<double>> triangles;
  for (const Piece& piece : mesh.pieces) {
    for (LocalIndex t = 0; t < piece.boundary_count(); ++t) {
      if (!mesh.sides_of(piece.triangle_face[t]).is_inner()) continue;
      std::array<std::array<double, 3>, 3> corners;
      for (int k = 0; k < 3; ++k) {
        const Vec3 p = piece.point(piece.boundary_triangle(t)[k]);
        corners[k] = {p.x, p.y, p.z};
      }
      std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
      std::vector<double> row;
      for (const auto& p : corners) row.insert(row.end(), p.begin(), p.end());
      triangles.insert(std::move(row));
    }
  }
  return triangles;
}

class MeshWithBaffles : public testing::TestWithParam<std::uint32_t> {};

TEST_P(MeshWithBaffles, GetsBetterAndKeepsBothSides) {
  for (const bool boundary_may_change : {false, true}) {
    const int pieces = 1 + static_cast<int>(GetParam() % 3);
    DistributedMesh mesh = mesh_with_baffles(pieces, GetParam());
    examples::expect_valid(mesh);
    const auto before = baffles_of(mesh);
    EXPECT_GT(before.size(), 40u);
    ImproveOptions options;
    options.boundary_may_change = boundary_may_change;
    const auto bad = examples::examine(mesh.pieces, options.target_angle);
    improve_mesh(mesh, options);
    const auto after = examples::examine(mesh.pieces, options.target_angle);
    examples::expect_valid(mesh);
    EXPECT_EQ(baffles_of(mesh), before);
    EXPECT_GE(after.quality, bad.quality);
    EXPECT_LT(after.bad, bad.bad);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, MeshWithBaffles, testing::Range(400U, 403U));

}  // namespace
}  // namespace aeroloom::improve
