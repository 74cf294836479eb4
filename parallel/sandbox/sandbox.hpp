/// Sandboxed runs: runs code that may abort, throw, hang or exhaust memory in a child process, so that it
/// cannot end the rank.
///
/// A rank must not fork once MPI runs (registered network memory, page tables). So every rank forks a small
/// worker server before MPI starts, and the server forks one child per run. Input and output go through
/// shared memory. While a child works, the rank lets MPI work on pending messages.
#pragma once

#include "parallel/communication/communicator.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

namespace aeroloom::parallel {

/// A task that runs in the child, from bytes to bytes. It may throw (the rank gets the text), abort or hang.
using SandboxTask = Bytes (*)(std::span<const std::byte> input);

/// Registers `task` under `name`. Call it before the server starts. Throws std::logic_error for a new name
/// after that, and for another task under a known name.
void register_sandbox_task(const std::string& name, SandboxTask task);

/// A task of the library, defined at namespace scope. It is registered before main() begins, in every program
/// that links the source.
class NamedTask {
public:
  NamedTask(std::string name, SandboxTask task) : _name(std::move(name)) {
    register_sandbox_task(_name, task);
  }
  const std::string& name() const { return _name; }

private:
  std::string _name;
};

/// Where sandboxed tasks run.
enum class Sandbox {
  process,  ///< in child processes
  none      ///< in the rank itself: a crash ends the program, and limits do not hold
};

/// The worker server of this process. Environment starts one. A host program that runs MPI itself may
/// construct one before it starts MPI, after all tasks are registered; without it tasks run in the rank
/// itself. At most one exists at a time: a second one throws std::logic_error.
class SandboxServer {
public:
  SandboxServer();
  /// Ends the server and waits for it.
  ~SandboxServer();
  SandboxServer(const SandboxServer&) = delete;
  SandboxServer& operator=(const SandboxServer&) = delete;
};

/// Whether there is a server, so that tasks run in child processes.
bool has_sandbox_server();

/// Whether this process is such a child. The message about a failed child quotes what it has printed.
bool is_sandbox_child();

/// Why the machine did not let Environment start a server; empty if it did, or if none was wanted.
const std::string& sandbox_refusal();

/// Ends the server, if there is one. From then on tasks run in this rank, without a warning; a crash prints a
/// message (crash_note.hpp).
void run_without_sandbox(const Communicator& communicator);

/// Limits of one run. They must follow from the input, not from the clock or the machine.
struct SandboxLimits {
  double cpu_seconds = 600;                      ///< of the child
  std::int64_t address_space_bytes = 8LL << 30;  ///< of the child, beyond those of server and input
  /// A sleeping task uses no CPU. It is ended after 10 cpu_seconds + idle_seconds of wall time.
  double idle_seconds = 60;
};

enum class SandboxStatus { ok, threw, aborted, out_of_time, out_of_memory };

struct SandboxResult {
  SandboxStatus status = SandboxStatus::ok;
  Bytes output;         ///< of the task, when ok
  std::string message;  ///< exception text, or signal name, with the tail of what the child wrote to stderr
  double cpu_seconds = 0;
  std::int64_t peak_resident_bytes = 0;
  /// The user's memory limit (memory_limit.hpp) lowered the child's limit, and the child came near it: the
  /// failure of the task may be due to that.
  bool short_of_memory = false;
};

/// A child was killed from outside (by the machine, short of memory or processes, or by a user) or did not
/// run, and its repetition too. The result of the task is unknown.
class SandboxInterrupted : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// Runs the task in a child of this rank's server and waits for it. Without a server the task runs in this
/// rank: exceptions are caught, but limits do not hold and an abort ends the program. The first such run
/// prints a warning. A child killed from outside is started once more; the result follows from the input
/// alone. Not collective. Throws std::logic_error if the name is unknown, std::runtime_error if the server
/// has died, and SandboxInterrupted. Throws std::bad_alloc if the task failed and was short_of_memory: a
/// result must not depend on the user's limit.
SandboxResult run_sandboxed(const std::string& name, std::span<const std::byte> input,
                            const SandboxLimits& limits);

}  // namespace aeroloom::parallel
