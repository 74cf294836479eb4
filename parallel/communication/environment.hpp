/// Start and end of a parallel program.
#pragma once

#include <memory>

namespace aeroloom::parallel {

class SandboxServer;

/// Starts, in this order: the worker server of sandboxed runs (a small process forked before the message
/// passing library registers any memory, see sandbox.hpp), then the message passing library. Ends both.
/// Construct exactly one, first thing in main, after every sandboxed task is registered. Works under mpirun
/// and without. Large arrays that are freed go back to the system at once. Where the host program runs MPI
/// already that is used and left running, the allocator left alone, and sandboxed runs take place in the rank
/// itself unless the host has started the server before (sandbox.hpp). From then on an uncaught exception
/// is printed and ends all ranks with exit code 70, and so does an exception that leaves the scope of the
/// environment.
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

/// Ends all ranks at once. For what cannot be agreed on collectively; the caller has printed why.
[[noreturn]] void abort_all_ranks(int exit_code);

}  // namespace aeroloom::parallel
