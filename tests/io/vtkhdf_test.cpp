#include "io/raw_mesh.hpp"
#include "io/vtkhdf/vtkhdf_reader.hpp"
#include "io/vtkhdf/vtkhdf_writer.hpp"
#include "parallel/communication/collective_error.hpp"
#include "tests/io/damage.hpp"
#include "tests/io/mesh_volumes.hpp"
#include "tests/io/mixed_mesh.hpp"
#include "tests/io/scratch_folder.hpp"
#include "tests/several_ranks.hpp"

#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <hdf5.h>
#include <sys/resource.h>
#include <unistd.h>

namespace aeroloom::io {
namespace {

namespace fs = std::filesystem;
using parallel::Communicator;

class Vtkhdf : public examples::ScratchFolder {
protected:
  std::string message_of_reading(const std::string& path) const {
    try {
      read_vtkhdf({world, path});
    } catch (const parallel::CollectiveError& error) {
      EXPECT_EQ(error.kind(), parallel::FailureKind::input);
      return error.what();
    }
    return "";
  }
};

/// Volumes by region and shape; each cell's must be positive.
std::array<std::array<double, cell_shape_count>, 2> volumes_of(const FileMesh& mesh) {
  const Communicator& communicator = mesh.pieces->communicator;
  std::array<std::array<double, cell_shape_count>, 2> volumes{};
  for (const MeshPart& part : mesh.parts) {
    for (const CellShape shape : cell_shapes) {
      const Block& block = part.cells[static_cast<std::size_t>(shape)];
      for (const Run& run : block.runs) {
        for (mesh::LocalIndex i = run.begin; i < run.end; ++i) {
          const double volume = examples::volume_of(part, shape, i);
          EXPECT_GT(volume, 0);
          volumes[static_cast<std::size_t>(run.id)][static_cast<std::size_t>(shape)] += volume;
        }
      }
    }
  }
  for (auto& of_region : volumes) {
    for (double& volume : of_region) volume = communicator.sum(volume);
  }
  return volumes;
}

TEST_F(Vtkhdf, ReadsBackWhatItWrote) {
  const FileMesh mesh = examples::mixed_mesh(world, 4, 5);
  write_vtkhdf(mesh, folder / "mesh.vtkhdf");
  EXPECT_FALSE(fs::exists(folder / "mesh.vtkhdf.unfinished"));
  const Assembled read = assemble(read_vtkhdf({world, folder / "mesh.vtkhdf"}), 3);
  EXPECT_EQ(read.turned_cells, 0);
  EXPECT_EQ(read.dropped_points, 0);
  EXPECT_EQ(read.unnamed_faces, 0);
  EXPECT_EQ(read.left_out_faces, 0);
  EXPECT_EQ(read.mesh.vertex_count, mesh.vertex_count);
  EXPECT_EQ(read.mesh.patches, mesh.patches);
  EXPECT_EQ(read.mesh.regions, mesh.regions);
  EXPECT_EQ(read.mesh.region_cells, mesh.region_cells);
  EXPECT_EQ(read.mesh.patch_faces, mesh.patch_faces);
  const auto expected = volumes_of(mesh), found = volumes_of(read.mesh);
  for (std::size_t r = 0; r < expected.size(); ++r) {
    for (std::size_t s = 0; s < expected[r].size(); ++s) EXPECT_NEAR(found[r][s], expected[r][s], 1e-12);
  }
}

TEST_F(Vtkhdf, WritesTheSameBytesOnAnyNumberOfRanks) {
  NEEDS_SEVERAL_RANKS();
  write_vtkhdf(examples::mixed_mesh(world, 3, 7), folder / "here");
  write_vtkhdf_surface(examples::mixed_mesh(world, 3, 7), folder / "here_too");
  if (!world.is_root()) return;
  const FileMesh mesh = examples::mixed_mesh(Communicator::self(), 3, 7);
  write_vtkhdf(mesh, folder / "alone");
  write_vtkhdf_surface(mesh, folder / "alone_too");
  EXPECT_TRUE(examples::bytes_of(folder / "here") == examples::bytes_of(folder / "alone"));
  EXPECT_TRUE(examples::bytes_of(folder / "here_too") == examples::bytes_of(folder / "alone_too"));
}

TEST_F(Vtkhdf, ReadsTheSameOnAnyNumberOfRanks) {
  NEEDS_SEVERAL_RANKS();
  write_vtkhdf(examples::mixed_mesh(world, 3, 4), folder / "mesh.vtkhdf");
  const std::string path = folder / "mesh.vtkhdf";
  write_vtkhdf(assemble(read_vtkhdf({world, path}), 2).mesh, folder / "again");
  if (!world.is_root()) return;
  const auto self = Communicator::self();
  write_vtkhdf(assemble(read_vtkhdf({self, path}), 2).mesh, folder / "alone");
  EXPECT_TRUE(examples::bytes_of(folder / "again") == examples::bytes_of(folder / "alone"));
}

TEST_F(Vtkhdf, SaysWhatItCannotRead) {
  write_vtkhdf_surface(examples::mixed_mesh(world), folder / "surface.vtkhdf");
  const RawMesh surface = read_vtkhdf({world, folder / "surface.vtkhdf"});  // faces alone: assemble refuses
  EXPECT_EQ(surface.patches, examples::MixedMesh(2, 1).patches);
  if (world.is_root()) {
    std::ofstream(folder / "text") << "no HDF5 at all, however long the text may be that stands here";
    std::ofstream(folder / "empty") << "";
  }
  world.barrier();
  EXPECT_NE(message_of_reading(folder / "text").find("text: no HDF5 file"), std::string::npos);
  EXPECT_NE(message_of_reading(folder / "empty").find("empty: no HDF5 file"), std::string::npos);
  for (const char* missing : {"nothing", ""}) {
    try {
      read_vtkhdf({world, folder / missing});
      FAIL();
    } catch (const parallel::CollectiveError& error) {
      EXPECT_EQ(error.kind(), parallel::FailureKind::files);
      EXPECT_NE(std::string(error.what()).find(folder / missing), std::string::npos) << error.what();
    }
  }
}

/// A link by its name in a file of the test, and what it leads to.
void put_link(const std::string& path, const char* name, const char* file, const char* object) {
  const hid_t opened = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  H5Ldelete(opened, name, H5P_DEFAULT);
  if (file == nullptr) {
    EXPECT_GE(H5Lcreate_soft(object, opened, name, H5P_DEFAULT, H5P_DEFAULT), 0);
  } else {
    EXPECT_GE(H5Lcreate_external(file, object, opened, name, H5P_DEFAULT, H5P_DEFAULT), 0);
  }
  H5Fclose(opened);
}

TEST_F(Vtkhdf, LinksToOtherFilesAreNotFollowed) {
  write_vtkhdf(examples::mixed_mesh(world), folder / "other.vtkhdf");
  struct Link {
    const char *name, *object;
  };
  for (const Link& link :
       {Link{"/VTKHDF/Types", "/VTKHDF/Types"}, Link{"/VTKHDF", "/VTKHDF"},
        Link{"/VTKHDF/PointData", "/VTKHDF/PointData"}, Link{"/Boundary/PatchNames", "/Boundary/PatchNames"},
        Link{"/Boundary", "/Boundary"}}) {
    write_vtkhdf(examples::mixed_mesh(world), folder / "linked.vtkhdf");
    world.barrier();
    if (world.is_root()) put_link(folder / "linked.vtkhdf", link.name, "other.vtkhdf", link.object);
    world.barrier();
    const std::string message = message_of_reading(folder / "linked.vtkhdf");
    EXPECT_NE(message.find("is a link to another file, 'other.vtkhdf'"), std::string::npos)
        << link.name << ": " << message;
    world.barrier();
  }
  // A link within the file is one of its own.
  write_vtkhdf(examples::mixed_mesh(world), folder / "soft.vtkhdf");
  if (world.is_root()) {
    const hid_t file = H5Fopen((folder / "soft.vtkhdf").c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    H5Lmove(file, "/VTKHDF/Types", file, "/kinds", H5P_DEFAULT, H5P_DEFAULT);
    H5Fclose(file);
    put_link(folder / "soft.vtkhdf", "/VTKHDF/Types", nullptr, "/kinds");
  }
  world.barrier();
  EXPECT_EQ(assemble(read_vtkhdf({world, folder / "soft.vtkhdf"}), 1).turned_cells, 0);
}

TEST_F(Vtkhdf, MoreThanTheFileSaysIsRefused) {
  write_vtkhdf(examples::mixed_mesh(world), folder / "long.vtkhdf");
  world.barrier();
  if (world.is_root()) std::ofstream(folder / "long.vtkhdf", std::ios::binary | std::ios::app) << 'x';
  world.barrier();
  EXPECT_NE(message_of_reading(folder / "long.vtkhdf").find("but 1 bytes follow"), std::string::npos);
}

TEST_F(Vtkhdf, SurvivesDamagedFiles) {
  write_vtkhdf(examples::mixed_mesh(world, 1, 2), folder / "good");
  const std::string good = examples::bytes_of(folder / "good");
  damage::Options options;
  options.truncations = world.size() > 1 ? 20 : 40;
  options.flips = world.size() > 1 ? 40 : 150;
  options.fields = world.size() > 1 ? 10 : 40;
  options.pieces = 10;
  options.every = damage::stride(11);  // each takes a dozen processes
  const damage::Outcome outcome = damage::survive(
      world, good, folder / "damaged.vtkhdf",
      [&](const std::string& path) {
        assemble(read_vtkhdf({world, path}), 0);
      },
      options);
  EXPECT_GT(outcome.refused, outcome.cases / 10);
}

TEST_F(Vtkhdf, SaysWhenAFileCannotGrow) {
  // A limit on the size of files stands for a full disk: the system refuses to write on.
  const FileMesh mesh = examples::mixed_mesh(world, 8, 4);
  rlimit before;
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{20000, before.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);
  std::string message;
  try {
    write_vtkhdf(mesh, folder / "mesh.vtkhdf");
  } catch (const parallel::CollectiveError& error) {
    message = error.what();
    EXPECT_EQ(error.kind(), parallel::FailureKind::files);
  }
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_NE(message.find("mesh.vtkhdf"), std::string::npos) << message;
  world.barrier();
  EXPECT_TRUE(fs::is_empty(folder));
  world.barrier();
  write_vtkhdf(mesh, folder / "mesh.vtkhdf");  // and nothing is left behind in the process
  EXPECT_TRUE(fs::exists(folder / "mesh.vtkhdf"));
}

}  // namespace
}  // namespace aeroloom::io
