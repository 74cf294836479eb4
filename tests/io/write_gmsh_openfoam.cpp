/// Writes the mixed mesh of tests/io for what other programs make of it:
/// write_gmsh_openfoam FOLDER gives FOLDER/mixed.msh, FOLDER/mixed_N.msh and the cases FOLDER/binary, text,
/// wide (64-bit labels), whole (one part) and regions (four parts that end at the interface).
#include "io/gmsh/gmsh_writer.hpp"
#include "io/openfoam/openfoam_writer.hpp"
#include "parallel/communication/environment.hpp"
#include "tests/io/mixed_mesh.hpp"

#include <cstdio>
#include <exception>
#include <string>

int main(int argc, char** argv) {
  using namespace aeroloom;
  const parallel::Environment environment(argc, argv);
  if (argc != 2) return 2;
  try {
    const auto world = parallel::Communicator::world();
    const std::string folder = argv[1];
    const io::FileMesh mesh = io::examples::mixed_mesh(world, 4, 3);
    io::write_msh(mesh, folder + "/mixed.msh");
    io::write_msh_parts(mesh, folder + "/mixed.msh");
    io::write_openfoam(mesh, folder + "/binary");
    io::write_openfoam(mesh, folder + "/text", {false, 0});
    io::write_openfoam(mesh, folder + "/wide", {true, 64});
    io::write_openfoam(io::examples::mixed_mesh(world, 4, 1), folder + "/whole");
    io::write_openfoam(io::repartition(mesh, 4, mesh::PieceRegions::one), folder + "/regions");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
