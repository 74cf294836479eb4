/// Writes a hand-made mesh of cells of all shapes to a folder in the formats of solvers, for
/// programs of others to read. usage: write_solver_files FOLDER
#include "io/su2/su2_writer.hpp"
#include "io/ugrid/ugrid_writer.hpp"
#include "parallel/communication/environment.hpp"
#include "tests/io/mixed_mesh.hpp"

#include <exception>
#include <string>

#include <fmt/format.h>

namespace {

void write_all(const std::string& folder) {
  using namespace aeroloom;
  const auto world = parallel::Communicator::world();
  const io::FileMesh mesh = io::examples::mixed_mesh(world, 4, 5);
  for (const char* suffix : {"lb8.ugrid", "b8.ugrid", "lb8l.ugrid", "b8l.ugrid"})
    io::write_ugrid(mesh, fmt::format("{}/mixed.{}", folder, suffix));
  io::write_su2(mesh, folder + "/mixed.su2");
  io::write_su2b(mesh, folder + "/mixed.su2b");
}

}  // namespace

int main(int argc, char** argv) {
  const aeroloom::parallel::Environment environment(argc, argv);
  try {
    if (argc != 2) throw std::runtime_error("usage: write_solver_files FOLDER");
    write_all(argv[1]);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
