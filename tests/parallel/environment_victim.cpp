/// A program that ends badly on its last rank, for environment_test.sh: environment_victim WAY, where WAY is
/// none, before (the communicator is used without an environment), throws (nobody catches), leaves (the
/// exception passes the environment), aborts (abort_all_ranks) or dies (killed while its sandboxed run
/// works).
#include "parallel/communication/communicator.hpp"
#include "parallel/communication/environment.hpp"
#include "parallel/sandbox/sandbox.hpp"

#include <csignal>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>
#include <thread>

#include <unistd.h>

namespace {

using namespace aeroloom::parallel;

Bytes sleep_long(std::span<const std::byte>) {
  sleep(600);
  return {};
}

int use_before_start() {
  try {
    Communicator::world();
  } catch (const std::logic_error&) {
    return 0;
  }
  return 1;
}

void end_badly(const std::string& way) {
  if (way == "throws" || way == "leaves") throw std::runtime_error("an exception that " + way);
  if (way == "aborts") abort_all_ranks(5);
  if (way == "dies") {
    // The alarm strikes while the child sleeps.
    std::thread([] {
      sleep(1);
      std::raise(SIGKILL);
    }).detach();
    run_sandboxed("sleep_long", {}, {});
  }
}

void run(int argc, char** argv, const std::string& way) {
  Environment environment(argc, argv);
  const Communicator world = Communicator::world();
  if (world.rank() == world.size() - 1) end_badly(way);
  world.barrier();
}

}  // namespace

// NOLINTNEXTLINE(bugprone-exception-escape): that is what is tried here
int main(int argc, char** argv) {
  const std::string way = argc > 1 ? argv[1] : "none";
  if (way == "before") return use_before_start();
  register_sandbox_task("sleep_long", sleep_long);
  if (way != "leaves") {
    run(argc, argv, way);
    return 0;
  }
  try {
    run(argc, argv, way);
  } catch (const std::exception&) {
    return 1;  // the environment has ended all ranks before this
  }
}
