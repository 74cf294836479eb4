#include "io/file_mesh.hpp"

#include "io/face_links.hpp"
#include "tests/io/mesh_volumes.hpp"
#include "tests/io/mixed_mesh.hpp"
#include "tests/mesh/meshes.hpp"

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
  EXPECT_EQ(mesh.vertex_count, 25 * 3 + 10 + 4);
  EXPECT_EQ(mesh.patch_faces[examples::MixedMesh::interface][0], 32);
  GlobalIndex owned = 0;
  double volume = 0;
  for (const FilePart& part : mesh.parts) {
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
  EXPECT_NEAR(world.sum(volume), 36 * determinant, 1e-9);
}

TEST(FileMesh, LinksAreMutualAndLeaveNothingOpen) {
  const Communicator world = Communicator::world();
  const FileMesh mesh = examples::mixed_mesh(world, 3, 4);
  const FaceLinks links = link_faces(world, mesh);
  EXPECT_EQ(links.defects.crowded_faces + links.defects.stray_faces + links.defects.repeated_faces, 0);
  EXPECT_EQ(links.defects.open_faces, 0);
  GlobalIndex inner = 0, boundary = 0, both = 0;
  for (const PartLinks& part : links.parts) {
    for (std::size_t s = 0; s < part.behind.size(); ++s) {
      const bool bounded = part.boundary_face[s] >= 0, linked = part.behind[s].exists();
      EXPECT_TRUE(bounded || linked);
      inner += linked ? 1 : 0;
      boundary += bounded && !linked ? 1 : 0;
      both += bounded && linked ? 1 : 0;
    }
  }
  const GlobalIndex sides = 4 * mesh.cell_count(CellShape::tetrahedron) +
                            5 * (mesh.cell_count(CellShape::pyramid) + mesh.cell_count(CellShape::prism));
  EXPECT_EQ(world.sum(inner + boundary), sides);
  EXPECT_EQ(world.sum(boundary),
            mesh.boundary_count(FaceShape::triangle) + mesh.boundary_count(FaceShape::quadrilateral));
  EXPECT_GE(world.sum(both), mesh.patch_faces[examples::MixedMesh::interface][0]);
}

TEST(FileMesh, PiecesBecomePartsWithoutCopies) {
  const Communicator world = Communicator::world();
  const mesh::DistributedMesh pieces = mesh::examples::two_tets(world);
  const mesh::Numbering numbering = mesh::number_mesh(world, pieces);
  const FileMesh mesh = file_mesh_of(world, pieces, numbering);
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

TEST(FileMesh, BrokenArraysAreRefusedEverywhere) {
  const Communicator world = Communicator::world();
  std::vector<OwnedPart> mine;
  if (world.is_root()) {
    mine.push_back({0, std::make_unique<PartArrays>()});
    mine[0].arrays->cells[0] = {0, 1, 2, 3};
    mine[0].arrays->cell_regions[0] = {0};
  }
  EXPECT_THROW(make_file_mesh(world, 1, std::move(mine), {}, {"fluid"}), std::runtime_error);
}

/// Volumes by region and shape.
std::vector<double> volumes(const Communicator& world, const FileMesh& mesh) {
  std::vector<double> sums(3 * mesh.regions.size(), 0);
  for (const FilePart& part : mesh.parts) {
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
  for (const auto& [parts, by_region] : {std::pair(1, false), {2, false}, {7, false}, {4, true}}) {
    const FileMesh cut = repartition(world, mesh, parts, by_region);
    EXPECT_EQ(cut.part_count, parts);
    EXPECT_EQ(cut.vertex_count, mesh.vertex_count);
    EXPECT_EQ(cut.region_cells, mesh.region_cells);
    EXPECT_EQ(cut.patch_faces, mesh.patch_faces);
    const auto before = volumes(world, mesh), after = volumes(world, cut);
    for (std::size_t i = 0; i < before.size(); ++i) EXPECT_NEAR(before[i], after[i], 1e-9);
    const FaceLinks links = link_faces(world, cut);
    EXPECT_EQ(links.defects.open_faces + links.defects.stray_faces + links.defects.crowded_faces, 0);
    for (const FilePart& part : cut.parts) {
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
