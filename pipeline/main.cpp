/// The program aeroloom.
#include "parallel/communicator.hpp"
#include "parallel/environment.hpp"
#include "pipeline/command_line.hpp"
#include "pipeline/load_domain.hpp"
#include "volume/volume_mesher.hpp"

int main(int argc, char** argv) {
  aeroloom::volume::register_volume_tasks();
  aeroloom::pipeline::register_geometry_tasks();
  const aeroloom::parallel::Environment environment(argc, argv);
  return aeroloom::pipeline::run_command_line(aeroloom::parallel::Communicator::world(), argc, argv);
}
