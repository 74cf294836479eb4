/// For programs that check files. write_hdf5_files vtkhdf|cgns|names FOLDER [SQUARES PARTS] writes the mixed
/// mesh, `names` both files of it with names that are hard to hold;
/// write_hdf5_files read FILE... tells what the reader makes of each VTKHDF file, or why it refuses.
#include "io/cgns/cgns_writer.hpp"
#include "io/vtkhdf/vtkhdf_reader.hpp"
#include "io/vtkhdf/vtkhdf_writer.hpp"
#include "parallel/communication/collective_error.hpp"
#include "parallel/communication/environment.hpp"
#include "tests/io/mixed_mesh.hpp"

#include <array>
#include <cstdio>
#include <string>

#include <fmt/format.h>

namespace {

using namespace aeroloom;

void tell(const parallel::Communicator& world, const std::string& path) {
  if (world.is_root()) fmt::print("file {}\n", path);
  try {
    const io::Assembled read = io::assemble(io::read_vtkhdf({world, path}), 2);
    if (!world.is_root()) return;
    fmt::print("vertices {}\ncells {} {} {}\n", read.mesh.vertex_count,
               read.mesh.cell_count(io::CellShape::tetrahedron), read.mesh.cell_count(io::CellShape::pyramid),
               read.mesh.cell_count(io::CellShape::prism));
    for (std::size_t r = 0; r < read.mesh.regions.size(); ++r)
      fmt::print("region {} {}\n", read.mesh.regions[r], fmt::join(read.mesh.region_cells[r], " "));
    for (std::size_t p = 0; p < read.mesh.patches.size(); ++p) {
      fmt::print("patch {} {} {}\n", read.mesh.patches[p].name, name_of(read.mesh.patches[p].type),
                 fmt::join(read.mesh.patch_faces[p], " "));
    }
  } catch (const parallel::CollectiveError& error) {
    if (world.is_root()) fmt::print("error {}\n", error.what());
  }
}

}  // namespace

int main(int argc, char** argv) {
  parallel::Environment environment(argc, argv);
  const auto world = parallel::Communicator::world();
  if (argc < 3) {
    std::fprintf(stderr, "usage: write_hdf5_files FORMAT FOLDER [SQUARES PARTS]\n");
    return 2;
  }
  const std::string format = argv[1], folder = argv[2];
  if (format == "read") {
    for (int file = 2; file < argc; ++file) tell(world, argv[file]);
    return 0;
  }
  const int squares = argc > 3 ? std::stoi(argv[3]) : 4, parts = argc > 4 ? std::stoi(argv[4]) : 3;
  io::examples::MixedMesh whole(squares, parts);
  if (format == "names") {
    // A node of the zone, too long for CGNS, no name; of regions: a slash, a name of a patch.
    const std::array<std::string, 3> names = {"ZoneBC",
                                              "Größe einer Oberfläche, die nicht in den Knoten passt", ""};
    for (std::size_t p = 0; p < names.size(); ++p) whole.patches[p].name = names[p];
    whole.regions = {"inner/outer", "ZoneBC"};
  }
  const io::FileMesh mesh = io::examples::distribute(world, whole, parts);
  if (format != "cgns") {
    io::write_vtkhdf(mesh, folder + "/mesh.vtkhdf");
    io::write_vtkhdf_surface(mesh, folder + "/surface.vtkhdf");
  }
  if (format != "vtkhdf") io::write_cgns(mesh, folder + "/mesh.cgns");
  return 0;
}
