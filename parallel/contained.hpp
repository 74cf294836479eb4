/// Contained runs: code that may abort, throw, hang or exhaust memory runs in a child process and cannot take
/// the rank down.
///
/// A rank of a message passing program must not fork (registered network memory, page tables). So every rank
/// forks a small worker server before that library starts; the server forks one child per run. Input and
/// output travel through shared memory. While a child works, the rank keeps the library progressing.
#pragma once

#include "parallel/communicator.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <string>

namespace aeroloom::parallel {

/// A task that runs in the child: bytes in, bytes out. It may throw (the message comes back), abort or hang.
using ContainedTask = Bytes (*)(std::span<const std::byte> input);

/// Makes `task` known under `name`. Call before Environment is constructed (or at static initialisation);
/// later calls throw std::logic_error. Registering a name twice with another task throws too.
void register_contained_task(const std::string& name, ContainedTask task);

/// Limits of one run; functions of the input, never of the clock or the machine.
struct ContainedLimits {
  double cpu_seconds = 600;                      ///< of the child
  std::int64_t address_space_bytes = 8LL << 30;  ///< of the child, over what the server and the input map
  /// A task that sleeps uses no CPU: it is given up after ten times cpu_seconds plus this many wall seconds.
  double idle_seconds = 60;
};

enum class ContainedStatus { ok, threw, aborted, out_of_time, out_of_memory };

struct ContainedResult {
  ContainedStatus status = ContainedStatus::ok;
  Bytes output;         ///< of the task, when ok
  std::string message;  ///< exception text, or signal name, with the tail of what the child wrote to stderr
  double cpu_seconds = 0;
  std::int64_t peak_resident_bytes = 0;
};

/// Runs the task in a child of this rank's server and waits for it. Not collective. Throws
/// std::logic_error when the name is unknown and std::runtime_error when the server itself is gone.
ContainedResult run_contained(const std::string& name, std::span<const std::byte> input,
                              const ContainedLimits& limits);

}  // namespace aeroloom::parallel
