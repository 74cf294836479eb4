/// Start and end of a parallel program.
#pragma once

#include <memory>

namespace aeroloom::parallel {

class SandboxServer;

/// Starts the worker server of sandboxed runs (sandbox.hpp), then MPI, and ends both. The server is forked
/// first, before MPI registers any memory. Construct exactly one, first thing in main, after every sandboxed
/// task is registered. Works with and without mpirun. Freed large arrays go back to the system at once.
/// If the host program runs MPI already, that one is used and left running, and the allocator is not changed.
/// Sandboxed tasks then run in the rank itself, unless the host has started the server before.
/// An uncaught exception, or one that leaves the scope of the environment, is printed and ends all ranks with
/// exit code 70.
class Environment {
public:
  Environment(int& argc, char**& argv);
  ~Environment();
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

private:
  int _exceptions_at_start;
  std::unique_ptr<SandboxServer> _server;
};

/// Ends all ranks at once, for failures that the ranks cannot agree on. The caller prints the reason first.
[[noreturn]] void abort_all_ranks(int exit_code);

}  // namespace aeroloom::parallel
