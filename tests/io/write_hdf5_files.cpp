/// Writes the mixed mesh for programs that check files: write_hdf5_files FORMAT FOLDER [SQUARES PARTS].
#include "io/cgns/cgns_writer.hpp"
#include "io/vtkhdf/vtkhdf_writer.hpp"
#include "parallel/environment.hpp"
#include "tests/io/mixed_mesh.hpp"

#include <cstdio>
#include <string>

int main(int argc, char** argv) {
  using namespace aeroloom;
  parallel::Environment environment(argc, argv);
  const auto world = parallel::Communicator::world();
  if (argc < 3) {
    std::fprintf(stderr, "usage: write_hdf5_files FORMAT FOLDER [SQUARES PARTS]\n");
    return 2;
  }
  const std::string format = argv[1], folder = argv[2];
  const io::FileMesh mesh =
      io::examples::mixed_mesh(world, argc > 3 ? std::stoi(argv[3]) : 4, argc > 4 ? std::stoi(argv[4]) : 3);
  if (format == "vtkhdf") {
    io::write_vtkhdf(world, mesh, folder + "/mesh.vtkhdf");
    io::write_vtkhdf_surface(world, mesh, folder + "/surface.vtkhdf");
  } else if (format == "cgns") {
    io::write_cgns(world, mesh, folder + "/mesh.cgns");
  }
  return 0;
}
