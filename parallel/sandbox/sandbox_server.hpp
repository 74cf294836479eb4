/// The worker server of sandboxed runs. Internal to parallel/; see sandbox.hpp for what it is good for.
#pragma once

#include "parallel/sandbox/sandbox.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace aeroloom::parallel {

/// A task as registered; server and rank refer to it by its position.
struct RegisteredTask {
  std::string name;
  SandboxTask run;
};
const std::vector<RegisteredTask>& sandbox_tasks();

/// The request of a rank. Two file descriptors travel with it: input (to map) and output (to write).
struct SandboxRequest {
  std::int32_t task;
  SandboxLimits limits;
};

/// The answer of the server. The output is in the rank's own shared memory.
struct SandboxReply {
  static constexpr std::size_t message_capacity = 8192;  // bytes; chosen, not measured
  SandboxStatus status;
  bool interrupted;  ///< by the machine or somebody on it: nothing is known of the task
  double cpu_seconds;
  std::int64_t peak_resident_bytes;
  std::uint32_t message_length;
  char message[message_capacity];
};

/// A server, unless the machine forbids processes: then sandbox_refusal() says so. Throws
/// std::system_error where it is short of what a process takes.
std::unique_ptr<SandboxServer> start_server_if_allowed();

/// The server's life: answers requests on `socket` until it closes. Never returns.
[[noreturn]] void serve_sandboxed_runs(int socket);

}  // namespace aeroloom::parallel
