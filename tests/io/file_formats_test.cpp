#include "io/file_formats.hpp"

#include "io/read_mesh.hpp"
#include "parallel/collective_error.hpp"
#include "tests/io/mixed_mesh.hpp"
#include "tests/io/scratch_folder.hpp"

#include <string>

namespace aeroloom::io {
namespace {

using FileFormats = examples::ScratchFolder;

TEST_F(FileFormats, EachIsKnownByItsEnd) {
  for (const FormatName& format : format_names) {
    if (format.format == FileFormat::msh_parts) continue;
    EXPECT_EQ(format_of_path("a/b" + std::string(format.extension)), format.format) << format.name;
    EXPECT_EQ(name_of(format.format), format.name);
  }
  EXPECT_EQ(format_of_path("mesh.b8l.ugrid"), FileFormat::ugrid64);
  EXPECT_EQ(format_of_path("mesh.mesh"), FileFormat::meshb);
  EXPECT_EQ(format_of_path("mesh.stl"), std::nullopt);
}

TEST_F(FileFormats, WhatIsReadIsTheMeshThatWasWritten) {
  const FileMesh mesh = examples::mixed_mesh(world, 4, 3);
  for (const FormatName& format : format_names) {
    const std::string file = path("some" + std::string(format.extension));
    write_mesh(world, mesh, format.format, file, {});
    if (format.format == FileFormat::cgns || format.format == FileFormat::openfoam) {
      EXPECT_THROW(read_mesh(world, file, 1), parallel::CollectiveError);
      continue;
    }
    const Assembled read = read_mesh(world, file, 2);
    EXPECT_EQ(read.mesh.vertex_count, mesh.vertex_count) << format.name;
    EXPECT_EQ(read.turned_cells + read.dropped_points + read.unnamed_faces + read.left_out_faces, 0)
        << format.name;
    for (const CellShape shape : cell_shapes)
      EXPECT_EQ(read.mesh.cell_count(shape), mesh.cell_count(shape)) << format.name;
    for (const FaceShape shape : face_shapes)
      EXPECT_EQ(read.mesh.boundary_count(shape), mesh.boundary_count(shape)) << format.name;
  }
}

TEST_F(FileFormats, FilesHaveTheNameThatIsSaid) {
  const FileMesh mesh = examples::mixed_mesh(world, 4, 3);
  for (const FormatName& format : format_names) {
    const std::string file = path("asked_" + std::string(format.name));
    if (format.format == FileFormat::ugrid || format.format == FileFormat::ugrid64 ||
        format.format == FileFormat::meshb)
      continue;  // their names say more than the format
    write_mesh(world, mesh, format.format, file, {});
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
  write_mesh(world, mesh, FileFormat::vtu, path("plain.pvtu"), {});
  write_mesh(world, mesh, FileFormat::vtu, path("shown.pvtu"), {.surface = true});
  world.barrier();
  EXPECT_FALSE(std::filesystem::exists(path("plain_surface.pvtp")));
  EXPECT_TRUE(std::filesystem::exists(path("shown_surface.pvtp")));
  EXPECT_TRUE(std::filesystem::exists(path("shown_interfaces.pvtp")));
}

TEST_F(FileFormats, RunsOfAFileAreCutAnewIntoParts) {
  write_mesh(world, examples::mixed_mesh(world, 4, 3), FileFormat::su2b, path("whole.su2b"), {});
  const Assembled file = read_mesh(world, path("whole.su2b"), 3);
  write_mesh(world, file.mesh, FileFormat::msh_parts, path("asked.msh"), {.parts = 3, .recut = true});
  write_mesh(world, file.mesh, FileFormat::msh_parts, path("kept.msh"), {.parts = 3});
  write_mesh(world, repartition(world, file.mesh, 3), FileFormat::msh_parts, path("cut.msh"), {});
  for (const char* part : {"_1.msh", "_2.msh", "_3.msh"}) {
    const std::string cut = examples::bytes_of(path(std::string("cut") + part));
    EXPECT_FALSE(cut.empty());
    EXPECT_EQ(examples::bytes_of(path(std::string("asked") + part)), cut);
    EXPECT_NE(examples::bytes_of(path(std::string("kept") + part)), cut);
  }
}

TEST_F(FileFormats, AnEndThatNobodyKnowsIsRefusedWithTheKnownOnes) {
  try {
    read_mesh(world, path("mesh.stl"), 1);
    ADD_FAILURE() << "read";
  } catch (const parallel::CollectiveError& error) {
    EXPECT_NE(std::string(error.what()).find(".vtkhdf"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace aeroloom::io
