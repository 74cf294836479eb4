/// Sandboxed runs: code that may abort, throw, hang or exhaust memory runs in a child process and cannot take
/// the rank down.
///
/// A rank of a message passing program must not fork (registered network memory, page tables). So every rank
/// forks a small worker server before that library starts; the server forks one child per run. Input and
/// output travel through shared memory. While a child works, the rank keeps the library progressing.
#pragma once

#include "parallel/communication/communicator.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

namespace aeroloom::parallel {

/// A task that runs in the child: bytes in, bytes out. It may throw (the message comes back), abort or hang.
using SandboxTask = Bytes (*)(std::span<const std::byte> input);

/// Makes `task` known under `name`. Call before the server is started; afterwards a new name throws
/// std::logic_error. Registering a name twice with another task throws too.
void register_sandbox_task(const std::string& name, SandboxTask task);

/// A task of the library: defined at namespace scope of a source, it is known before main() begins in every
/// program that can ask for it, so that no program has to register any.
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
  none      ///< in the rank itself: what crashes ends the program, and limits do not hold
};

/// The worker server of this process. Environment starts one; a program that runs MPI itself constructs it
/// before it starts MPI, after every task is registered, or does without: tasks then run in the rank itself.
/// At most one at a time; a second one throws std::logic_error.
class SandboxServer {
public:
  SandboxServer();
  /// Ends the server and waits for it.
  ~SandboxServer();
  SandboxServer(const SandboxServer&) = delete;
  SandboxServer& operator=(const SandboxServer&) = delete;
};

/// Whether tasks run in children: a server is there.
bool has_sandbox_server();

/// Whether this process is such a child: what a task prints here goes to the message about its end.
bool is_sandbox_child();

/// Why this machine lets Environment start no server; empty where it has, or where none was wanted.
const std::string& sandbox_refusal();

/// Ends the server, if there is one, for good: tasks run in this rank from now on, without a warning, and a
/// crash there is told (crash_note.hpp).
void run_without_sandbox(const Communicator& communicator);

/// Limits of one run; functions of the input, never of the clock or the machine.
struct SandboxLimits {
  double cpu_seconds = 600;                      ///< of the child
  std::int64_t address_space_bytes = 8LL << 30;  ///< of the child, over what the server and the input map
  /// A task that sleeps uses no CPU: it is given up after ten times cpu_seconds plus this many wall seconds.
  double idle_seconds = 60;
};

enum class SandboxStatus { ok, threw, aborted, out_of_time, out_of_memory };

struct SandboxResult {
  SandboxStatus status = SandboxStatus::ok;
  Bytes output;         ///< of the task, when ok
  std::string message;  ///< exception text, or signal name, with the tail of what the child wrote to stderr
  double cpu_seconds = 0;
  std::int64_t peak_resident_bytes = 0;
  /// The user's limit (memory_limit.hpp) kept memory from it, and it came near what it had: what the task
  /// says went wrong may be for want of memory.
  bool short_of_memory = false;
};

/// A child was ended by the machine (short of memory, of processes) or by somebody on it, or stood still, and
/// so was the one that was to do the same again: nothing is known of the task.
class SandboxInterrupted : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// Runs the task in a child of this rank's server and waits for it. Without a server the task runs here: what
/// it throws is caught, but limits do not hold, and what aborts ends the program; the first such run warns.
/// A child that is ended from outside is
/// started once more as it was: what a task gives follows from its input alone. Not collective. Throws
/// std::logic_error when the name is unknown and std::runtime_error when the server itself is gone;
/// SandboxInterrupted; std::bad_alloc where it failed and was short of memory that the user's limit
/// (memory_limit.hpp) kept from it: a result must not depend on that one.
SandboxResult run_sandboxed(const std::string& name, std::span<const std::byte> input,
                            const SandboxLimits& limits);

}  // namespace aeroloom::parallel
