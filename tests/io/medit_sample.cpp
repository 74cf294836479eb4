// Writes the mixed mesh as Medit files for programs that others wrote. usage: io_medit_sample FOLDER
#include "io/medit/medit_writer.hpp"
#include "parallel/communication/environment.hpp"
#include "tests/io/mixed_mesh.hpp"

#include <string>

int main(int argc, char** argv) {
  const aeroloom::parallel::Environment environment(argc, argv);
  if (argc != 2) return 2;
  const auto world = aeroloom::parallel::Communicator::world();
  const aeroloom::io::FileMesh mesh = aeroloom::io::examples::mixed_mesh(world);
  const std::string folder = argv[1];
  write_medit(mesh, folder + "/narrow.meshb");
  write_medit(mesh, folder + "/wide.meshb", {true});
  write_medit(mesh, folder + "/text.mesh");
  return 0;
}
