#include "io/file_mesh.hpp"

#include "mesh/quality/face_links.hpp"
#include "tests/io/mesh_volumes.hpp"
#include "tests/io/mixed_mesh.hpp"
#include "tests/meshes/small_meshes.hpp"

#include <algorithm>
#include <array>
#include <set>

#include <gtest/gtest.h>

namespace aeroloom::io {
namespace {

using mesh::GlobalIndex;
using mesh::LocalIndex;
using parallel::Communicator;

TEST(FileMesh, MixedMeshHasItsCountsOnAnyRanks) {
  const Communicator world = Communicator::world();
  const FileMesh mesh = examples::mixed_mesh(world, 4, 3);
  EXPECT_EQ(mesh.cell_count(CellShape::prism), 32);
  EXPECT_EQ(mesh.cell_count(CellShape::pyramid), 20);
  EXPECT_EQ(mesh.cell_count(CellShape::tetrahedron), 96 + 8);
  EXPECT_EQ(mesh.region_cells[1][0], 96);
  EXPECT_EQ(mesh.cell_count(CellShape::hexahedron), 4);
  EXPECT_EQ(mesh.vertex_count, 25 * 3 + 10 + 4 + 10);
  EXPECT_EQ(mesh.patch_faces[examples::MixedMesh::interface][0], 32);
  const ShapeCounts all = mesh.counts(CountedFaces::all), outer = mesh.counts(CountedFaces::boundary);
  EXPECT_EQ(all.vertices, mesh.vertex_count);
  EXPECT_EQ(all.cells, (std::array<GlobalIndex, 4>{96 + 8, 20, 32, 4}));  // in the order of shapes
  EXPECT_EQ(outer.cells, all.cells);
  EXPECT_EQ(outer.faces, (std::array<GlobalIndex, 2>{all.faces[0] - 32, all.faces[1]}));
  GlobalIndex owned = 0;
  double volume = 0;
  for (const MeshPart& part : mesh.parts) {
    owned += part.owned_count;
    for (const CellShape shape : cell_shapes) {
      for (LocalIndex c = 0; c < part.cells[static_cast<std::size_t>(shape)].count(); ++c) {
        const double of_cell = examples::volume_of(part, shape, c);
        EXPECT_GT(of_cell, 0);
        volume += of_cell;
      }
    }
  }
  EXPECT_EQ(world.sum(owned), mesh.vertex_count);
  const double determinant = 2 * 1.5 + 0.25 * 0.125 * 0.0625;
  EXPECT_NEAR(world.sum(volume), 40 * determinant, 1e-9);
}

TEST(FileMesh, PiecesBecomePartsWithoutCopies) {
  const Communicator world = Communicator::world();
  const mesh::NumberedMesh pieces = mesh::number_mesh(mesh::examples::two_tets(world));
  const FileMesh mesh = file_mesh_of(pieces);
  EXPECT_EQ(mesh.part_count, 2);
  EXPECT_EQ(mesh.vertex_count, 5);
  EXPECT_EQ(mesh.cell_count(), 2);
  EXPECT_EQ(mesh.boundary_count(FaceShape::triangle), 6);
  ASSERT_EQ(mesh.patches.size(), 1U);
  for (std::size_t i = 0; i < mesh.parts.size(); ++i) {
    EXPECT_EQ(mesh.parts[i].coordinates.data(), pieces.pieces[i].coordinates.data());
    EXPECT_EQ(mesh.parts[i].cells[0].before, mesh.parts[i].id);
    EXPECT_EQ(mesh.parts[i].faces[0].runs[0].before, 3 * mesh.parts[i].id);
  }
}

TEST(FileMesh, BrokenMeshesAreRefusedEverywhere) {
  const Communicator world = Communicator::world();
  const auto expect_refused = [&](const auto& spoil) {
    mesh::NumberedMesh mesh = mesh::number_mesh(mesh::examples::mixed_mesh(world, 2, 2));
    if (world.is_root()) spoil(mesh.pieces[0], mesh.numbering);
    EXPECT_THROW(file_mesh_of(mesh), std::runtime_error);
  };
  using mesh::Numbering;
  using mesh::Piece;
  expect_refused([](Piece& piece, Numbering&) { piece.prisms.pop_back(); });
  expect_refused([](Piece& piece, Numbering&) { piece.quad_patch[0] = 9; });
  expect_refused([](Piece& piece, Numbering&) { piece.runs.back().region = 7; });
  expect_refused(
      [](Piece&, Numbering& numbering) { std::swap(numbering.vertices[0][0], numbering.vertices[0][1]); });
  expect_refused([](Piece&, Numbering& numbering) { numbering.owned[0].pop_back(); });
}

TEST(FileMesh, FacesComeByPatchWhateverTheirOrder) {
  const Communicator world = Communicator::world();
  mesh::NumberedMesh pieces = mesh::number_mesh(mesh::examples::mixed_mesh(world, 3, 2));
  for (mesh::Piece& piece : pieces.pieces) {  // the first one goes last
    std::rotate(piece.quads.begin(), piece.quads.begin() + 4, piece.quads.end());
    std::rotate(piece.quad_face.begin(), piece.quad_face.begin() + 1, piece.quad_face.end());
    std::rotate(piece.quad_patch.begin(), piece.quad_patch.begin() + 1, piece.quad_patch.end());
  }
  const FileMesh mesh = file_mesh_of(pieces);
  const FileMesh plain = examples::mixed_mesh(world, 3, 2);
  EXPECT_EQ(mesh.patch_faces, plain.patch_faces);
  for (std::size_t i = 0; i < mesh.parts.size(); ++i) {
    const mesh::Piece& piece = pieces.pieces[i];
    const Block &block = mesh.parts[i].faces[1], &other = plain.parts[i].faces[1];
    ASSERT_EQ(block.runs.size(), other.runs.size());
    for (std::size_t r = 0; r < block.runs.size(); ++r) {
      EXPECT_EQ(block.runs[r].id, other.runs[r].id);
      EXPECT_EQ(block.runs[r].before, other.runs[r].before);
      for (LocalIndex f = block.runs[r].begin; f < block.runs[r].end; ++f) {
        const auto at = static_cast<std::size_t>(block.item(f) - piece.quads.data()) / 4;
        EXPECT_EQ(piece.quad_patch[at], block.runs[r].id);
      }
    }
  }
}

/// Volumes by region and shape.
std::vector<double> volumes(const FileMesh& mesh) {
  const Communicator& world = mesh.pieces->communicator;
  std::vector<double> sums(3 * mesh.regions.size(), 0);
  for (const MeshPart& part : mesh.parts) {
    for (const CellShape shape : cell_shapes) {
      for (const Run& run : part.cells[static_cast<std::size_t>(shape)].runs) {
        for (LocalIndex c = run.begin; c < run.end; ++c)
          sums[3 * static_cast<std::size_t>(run.id) + static_cast<std::size_t>(shape)] +=
              examples::volume_of(part, shape, c);
      }
    }
  }
  for (double& sum : sums) sum = world.sum(sum);
  return sums;
}

TEST(FileMesh, RepartitionedMeshIsTheSameMesh) {
  const Communicator world = Communicator::world();
  const FileMesh mesh = examples::mixed_mesh(world, 4, 3);
  constexpr auto several = mesh::PieceRegions::several;
  for (const auto& [parts, of_regions] :
       {std::pair(1, several), {2, several}, {7, several}, {4, mesh::PieceRegions::one}}) {
    const FileMesh cut = repartition(mesh, parts, of_regions);
    const bool by_region = of_regions == mesh::PieceRegions::one;
    EXPECT_EQ(cut.part_count, parts);
    EXPECT_EQ(cut.vertex_count, mesh.vertex_count);
    EXPECT_EQ(cut.region_cells, mesh.region_cells);
    EXPECT_EQ(cut.patch_faces, mesh.patch_faces);
    const auto before = volumes(mesh), after = volumes(cut);
    for (std::size_t i = 0; i < before.size(); ++i) EXPECT_NEAR(before[i], after[i], 1e-9);
    const mesh::FaceLinks links = mesh::link_faces(*cut.pieces);
    EXPECT_EQ(links.defects.open_faces + links.defects.stray_faces + links.defects.crowded_faces, 0);
    for (const MeshPart& part : cut.parts) {
      EXPECT_NEAR(static_cast<double>(part.cell_count()), static_cast<double>(mesh.cell_count()) / parts,
                  by_region ? 40 : 1.5);
      if (!by_region) continue;
      std::set<std::int32_t> regions;
      for (const Block& block : part.cells) {
        for (const auto& run : block.runs) regions.insert(run.id);
      }
      EXPECT_EQ(regions.size(), 1U);
    }
  }
}

}  // namespace
}  // namespace aeroloom::io
