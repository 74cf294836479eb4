#include "io/file_formats.hpp"

#include "io/read_mesh.hpp"
#include "io/write_mesh.hpp"
#include "parallel/communication/collective_error.hpp"
#include "tests/io/mixed_mesh.hpp"
#include "tests/io/scratch_folder.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace aeroloom::io {
namespace {

using FileFormats = examples::ScratchFolder;

TEST_F(FileFormats, WhatIsReadIsTheMeshThatWasWritten) {
  const FileMesh mesh = examples::mixed_mesh(world, 4, 3);
  for (const FormatRow& format : file_formats()) {
    const std::string file = path("some" + std::string(format.ends.front()));
    write_mesh(mesh, format.format, file, {});
    if (format.read == nullptr) {
      EXPECT_THROW(read_mesh({world, file}, 1), parallel::CollectiveError);
      continue;
    }
    const Assembled read = read_mesh({world, file}, 2);
    EXPECT_EQ(read.mesh.vertex_count, mesh.vertex_count) << format.name;
    EXPECT_EQ(read.turned_cells + read.dropped_points + read.unnamed_faces + read.left_out_faces, 0)
        << format.name;
    for (const CellShape shape : cell_shapes)
      EXPECT_EQ(read.mesh.cell_count(shape), mesh.cell_count(shape)) << format.name;
    for (const FaceShape shape : face_shapes)
      EXPECT_EQ(read.mesh.boundary_count(shape), mesh.boundary_count(shape)) << format.name;
  }
}

/// Faces by patch, the last patch first.
void turn_patches_round(mesh::Piece& piece) {
  const auto sort = [](int corners, std::vector<mesh::LocalIndex>& faces, std::vector<std::int32_t>& of_cad,
                       std::vector<std::int32_t>& patches) {
    std::vector<std::size_t> order(patches.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return patches[a] > patches[b]; });
    const auto old = faces;
    const auto old_of_cad = of_cad, old_patches = patches;
    for (std::size_t i = 0; i < order.size(); ++i) {
      std::copy_n(old.begin() + static_cast<std::ptrdiff_t>(order[i]) * corners, corners,
                  faces.begin() + static_cast<std::ptrdiff_t>(i) * corners);
      of_cad[i] = old_of_cad[order[i]];
      patches[i] = old_patches[order[i]];
    }
  };
  sort(3, piece.boundary, piece.triangle_face, piece.triangle_patch);
  sort(4, piece.quads, piece.quad_face, piece.quad_patch);
}

TEST_F(FileFormats, PatchesOfAPieceStandInAnyOrder) {
  const mesh::DistributedMesh straight = mesh::examples::mixed_mesh(world, 4, 3);
  mesh::DistributedMesh turned = straight;
  for (mesh::Piece& piece : turned.pieces) turn_patches_round(piece);
  const mesh::Numbering numbering = mesh::number_mesh(straight).numbering;
  for (const auto& [name, mesh] : {std::pair("straight", &straight), {"turned", &turned}}) {
    const FileMesh layout = file_mesh_of({*mesh, numbering});
    for (const FormatRow& format : file_formats()) {
      const std::filesystem::path to = folder / name / std::string(format.name);
      if (world.is_root()) std::filesystem::create_directories(to);
      world.barrier();
      write_mesh(layout, format.format, (to / ("mesh" + std::string(format.ends.front()))).string(),
                 {.surface = true});
    }
  }
  world.barrier();
  const auto files = examples::files_below(folder / "straight"),
             others = examples::files_below(folder / "turned");
  EXPECT_GT(files.size(), 30U);
  ASSERT_EQ(files.size(), others.size());
  for (const auto& [file, bytes] : files) EXPECT_TRUE(others.at(file) == bytes) << file;
}

TEST_F(FileFormats, FilesHaveTheNameThatIsSaid) {
  const FileMesh mesh = examples::mixed_mesh(world, 4, 3);
  for (const FormatRow& format : file_formats()) {
    const std::string file = path("asked_" + std::string(format.name));
    if (format.ends.back() != std::string_view()) continue;  // their names say more than the format
    write_mesh(mesh, format.format, file, {});
    EXPECT_TRUE(std::filesystem::is_regular_file(written_path(format.format, file))) << format.name;
  }
  EXPECT_EQ(written_path(FileFormat::vtu, "a/b.vtu"), "a/b.pvtu");
  EXPECT_EQ(written_path(FileFormat::vtu, "a/b.pvtu"), "a/b.pvtu");
  EXPECT_EQ(written_path(FileFormat::msh_parts, "b.msh"), "b_1.msh");
  EXPECT_EQ(written_path(FileFormat::msh_parts, "b_1.msh"), "b_1.msh");
  EXPECT_EQ(written_path(FileFormat::cgns, "b.hdf"), "b.hdf");
}

TEST_F(FileFormats, SurfacesStandBesideVtuWhereTheyAreWanted) {
  const FileMesh mesh = examples::mixed_mesh(world, 4, 3);
  write_mesh(mesh, FileFormat::vtu, path("plain.pvtu"), {});
  write_mesh(mesh, FileFormat::vtu, path("shown.pvtu"), {.surface = true});
  world.barrier();
  EXPECT_FALSE(std::filesystem::exists(path("plain_surface.pvtp")));
  EXPECT_TRUE(std::filesystem::exists(path("shown_surface.pvtp")));
  EXPECT_TRUE(std::filesystem::exists(path("shown_interfaces.pvtp")));
}

TEST_F(FileFormats, RunsOfAFileAreCutAnewIntoParts) {
  write_mesh(examples::mixed_mesh(world, 4, 3), FileFormat::su2b, path("whole.su2b"), {});
  const Assembled file = read_mesh({world, path("whole.su2b")}, 3);
  write_mesh(file.mesh, FileFormat::msh_parts, path("asked.msh"), {.parts = 3, .recut = true});
  write_mesh(file.mesh, FileFormat::msh_parts, path("kept.msh"), {.parts = 3});
  write_mesh(repartition(file.mesh, 3), FileFormat::msh_parts, path("cut.msh"), {});
  for (const char* part : {"_1.msh", "_2.msh", "_3.msh"}) {
    const std::string cut = examples::bytes_of(path(std::string("cut") + part));
    EXPECT_FALSE(cut.empty());
    EXPECT_EQ(examples::bytes_of(path(std::string("asked") + part)), cut);
    EXPECT_NE(examples::bytes_of(path(std::string("kept") + part)), cut);
  }
}

TEST_F(FileFormats, AnEndThatNobodyKnowsIsRefusedWithTheKnownOnes) {
  try {
    read_mesh({world, path("mesh.stl")}, 1);
    ADD_FAILURE() << "read";
  } catch (const parallel::CollectiveError& error) {
    EXPECT_NE(std::string(error.what()).find(".vtkhdf"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace aeroloom::io
