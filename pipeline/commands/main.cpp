/// The program aeroloom.
#include "parallel/communication/communicator.hpp"
#include "parallel/communication/environment.hpp"
#include "parallel/communication/termination.hpp"
#include "pipeline/commands/command_line.hpp"
#include "pipeline/report/exit_code.hpp"

#include <csignal>
#include <cstdio>
#include <system_error>

namespace {

using namespace aeroloom;

int run(int argc, char** argv) {
  const parallel::Environment environment(argc, argv);
  const parallel::TerminationWatch watch;
  return pipeline::run_command_line(parallel::Communicator::world(), argc, argv);
}

}  // namespace

int main(int argc, char** argv) {
  // A file that may not grow further is an error where it is written.
  std::signal(SIGXFSZ, SIG_IGN);
  parallel::hold_termination_signals();
  try {
    return run(argc, argv);
  } catch (const std::system_error& error) {
    // The system has no process or no memory for us: nothing has been started.
    std::fprintf(stderr, "error: %s\n", error.what());
    return static_cast<int>(report::ExitCode::resources);
  }
}
