#include "io/openfoam/sharp_edges.hpp"

#include "io/openfoam/openfoam_writer.hpp"
#include "tests/io/mixed_mesh.hpp"
#include "tests/io/scratch_folder.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::io {
namespace {

namespace fs = std::filesystem;
using examples::MixedMesh;
using examples::WholeFace;
using parallel::Communicator;

/// The faces of one cell alone: walls where all corners are among the first six points.
void add_boundary(MixedMesh& whole) {
  std::map<std::vector<int>, std::vector<WholeFace>> met;
  for (std::size_t c = 0; c < whole.cells.size(); ++c) {
    for (const CellFace& face : faces_of(whole.cells[c].shape)) {
      WholeFace found{{}, MixedMesh::far, c};
      for (const std::int8_t k : face) {
        if (k >= 0) found.corners.push_back(whole.cells[c].corners[k]);
      }
      std::vector<int> key = found.corners;
      std::sort(key.begin(), key.end());
      if (key.back() < 6) found.patch = MixedMesh::wall;
      met[key].push_back(found);
    }
  }
  for (const auto& [key, sides] : met) {
    if (sides.size() == 1) whole.faces.push_back(sides[0]);
  }
}

/// Two layers at an edge from (0, 0, 0) to (0, 1, 0): over the wall on its right, z = 0, over that on its
/// left, x = 0, and in a sector between; and one farther on the right. The cells, of each place the first
/// layer's before the second's, are dealt to pieces in turn.
FileMesh layers_at_an_edge(const Communicator& communicator, int pieces) {
  MixedMesh whole(1, mesh::examples::SquareColumns{0, 0});
  whole.points = {{0, 0, 0}, {0, 1, 0}, {1, 0.5, 0}, {0, 0.5, -1}, {2, 0, 0}, {2, 1, 0}};
  // Over both ends of the edge, in both layers, on the right and on the left.
  const std::array r1 = {6, 7}, r2 = {8, 9}, l1 = {10, 11}, l2 = {12, 13};
  for (const geometry::Vec3 up : {geometry::Vec3{0, 0, 0.1}, {0, 0, 0.3}, {-0.1, 0, 0}, {-0.3, 0, 0}}) {
    for (const int v : {0, 1}) whole.points.push_back(whole.points[v] + up);
  }
  for (const double up : {0.1, 0.3}) whole.points.push_back({1, 0.5, up});    // 14, 15
  for (const double up : {0.1, 0.3}) whole.points.push_back({-up, 0.5, -1});  // 16, 17
  for (const double y : {0.0, 1.0}) whole.points.push_back({2, y, 0.1});      // 18, 19
  using enum mesh::CellShape;
  whole.cells = {{prism, {0, 2, 1, r1[0], 14, r1[1]}, 0, 0},
                 {prism, {r1[0], 14, r1[1], r2[0], 15, r2[1]}, 0, 0},
                 {prism, {0, 1, 3, l1[0], l1[1], 16}, 0, 0},
                 {prism, {l1[0], l1[1], 16, l2[0], l2[1], 17}, 0, 0},
                 {prism, {0, r1[0], l1[0], 1, r1[1], l1[1]}, 0, 0},
                 {hexahedron, {r1[0], l1[0], l1[1], r1[1], r2[0], l2[0], l2[1], r2[1]}, 0, 0},
                 {prism, {2, 4, 5, 14, 18, 19}, 0, 0}};
  for (std::size_t c = 0; c < whole.cells.size(); ++c)
    whole.cells[c].piece = static_cast<std::int32_t>(c) % pieces;
  add_boundary(whole);
  return examples::distribute(communicator, whole, pieces);
}

TEST(SharpEdges, AreThoseOfSectorsAndThatTouchThem) {
  const auto world = Communicator::world();
  // By piece: prisms in their order, then hexahedra.
  const std::vector<std::vector<std::uint8_t>> in_one = {{1, 1, 1, 1, 1, 0, 1}},
                                               in_three = {{1, 1, 0}, {1, 1}, {1, 1}};
  for (const auto& expected : {in_one, in_three}) {
    const FileMesh mesh = layers_at_an_edge(world, static_cast<int>(expected.size()));
    const auto found = find_sharp_edge_cells(mesh);
    ASSERT_TRUE(found);
    ASSERT_EQ(found->size(), mesh.parts.size());
    for (std::size_t p = 0; p < found->size(); ++p)
      EXPECT_EQ((*found)[p], expected[static_cast<std::size_t>(mesh.parts[p].id)]);
  }
}

TEST(SharpEdges, AreNoneInMeshesWithOtherHexahedra) {
  EXPECT_FALSE(find_sharp_edge_cells(examples::mixed_mesh(Communicator::world())));
}

class SharpEdgesInFiles : public examples::ScratchFolder {
protected:
  std::string read(const char* file) const { return examples::bytes_of(path(file)); }
};

TEST_F(SharpEdgesInFiles, HaveSchemesOfTheirOwn) {
  write_openfoam(layers_at_an_edge(world, 1), path("case"));
  EXPECT_NE(read("case/constant/sharpEdges").find("nonuniform List<scalar> 7\n(\n0\n0\n0\n0\n0\n1\n0\n);"),
            std::string::npos);
  EXPECT_NE(read("case/system/fvSchemes.second").find("localBlended upwind linearUpwind convected"),
            std::string::npos);
  EXPECT_NE(read("case/system/controlDict").find("faceWeight      sharpEdges;"), std::string::npos);
  world.barrier();
  // By part; the settings of before stay where they are as they were written.
  write_openfoam(layers_at_an_edge(world, 3), path("case"));
  EXPECT_NE(read("case/processor0/constant/sharpEdges").find("nonuniform List<scalar> 3\n(\n0\n0\n1\n);"),
            std::string::npos);
  EXPECT_FALSE(fs::exists(path("case/constant/sharpEdges")));
  world.barrier();
  write_openfoam(examples::mixed_mesh(world, 4, 2), path("case"));
  EXPECT_FALSE(fs::exists(path("case/processor1/constant/sharpEdges")));
  EXPECT_FALSE(fs::exists(path("case/processor2")));
  for (const char* file : {"case/system/fvSchemes.second", "case/system/controlDict"})
    EXPECT_EQ(read(file).find("harpEdges"), std::string::npos) << file;
}

TEST_F(SharpEdgesInFiles, AreNoneWhereSettingsOfUsersAskForThem) {
  if (world.is_root()) fs::create_directories(folder / "case" / "system");
  examples::put_bytes(world, path("case/system/controlDict"), "my sharpEdges");
  write_openfoam(examples::mixed_mesh(world, 4, 2), path("case"));
  EXPECT_EQ(read("case/system/controlDict"), "my sharpEdges");
  const std::string none = read("case/processor1/constant/sharpEdges");
  EXPECT_NE(none.find("class       volScalarField;"), std::string::npos) << none;
  EXPECT_NE(none.find("internalField   uniform 1;"), std::string::npos) << none;
}

}  // namespace
}  // namespace aeroloom::io
