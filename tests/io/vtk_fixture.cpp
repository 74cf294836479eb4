/// For programs that nobody here wrote: `vtk_fixture write FOLDER SQUARES` writes the hand-made mesh,
/// `vtk_fixture read FILE` tells what it makes of theirs.
#include "io/raw_mesh.hpp"
#include "io/vtk/vtk_reader.hpp"
#include "io/vtk/vtk_writer.hpp"
#include "parallel/communication/environment.hpp"
#include "tests/io/mixed_mesh.hpp"

#include <cstdio>
#include <cstdlib>
#include <string>

namespace {

using namespace aeroloom;

void write(const parallel::Communicator& world, const std::string& folder, int squares) {
  const io::FileMesh mesh = io::examples::mixed_mesh(world, squares, 5);
  io::write_volume(mesh, folder, "mesh");
  io::write_volume(mesh, folder, "packed", io::Compression::zlib);
  io::write_surface(mesh, folder, "surface");
}

void read(const parallel::Communicator& world, const std::string& file) {
  const io::Assembled read = io::assemble(io::read_vtk({world, file}), 2);
  if (!world.is_root()) return;
  std::printf("points %lld turned %lld unnamed %lld\n", static_cast<long long>(read.mesh.vertex_count),
              static_cast<long long>(read.turned_cells), static_cast<long long>(read.unnamed_faces));
  for (std::size_t r = 0; r < read.mesh.regions.size(); ++r) {
    const auto& cells = read.mesh.region_cells[r];
    std::printf("region %s: %lld %lld %lld %lld\n", read.mesh.regions[r].c_str(),
                static_cast<long long>(cells[0]), static_cast<long long>(cells[1]),
                static_cast<long long>(cells[2]), static_cast<long long>(cells[3]));
  }
  for (std::size_t p = 0; p < read.mesh.patches.size(); ++p) {
    const auto& faces = read.mesh.patch_faces[p];
    std::printf("patch %s: %lld %lld\n", read.mesh.patches[p].name.c_str(), static_cast<long long>(faces[0]),
                static_cast<long long>(faces[1]));
  }
}

}  // namespace

int main(int argc, char** argv) {
  const parallel::Environment environment(argc, argv);
  const std::string task = argc > 2 ? argv[1] : "";
  try {
    if (task == "write" && argc == 4) {
      write(parallel::Communicator::world(), argv[2], std::atoi(argv[3]));
    } else if (task == "read") {
      read(parallel::Communicator::world(), argv[2]);
    } else {
      std::fprintf(stderr, "usage: vtk_fixture write FOLDER SQUARES | read FILE\n");
      return 2;
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
