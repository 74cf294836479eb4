/// The worker server of sandboxed runs; sandbox.hpp says why there is one. Internal to parallel/.
#pragma once

#include "parallel/sandbox/sandbox.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace aeroloom::parallel {

/// A registered task. Server and rank refer to it by its position in the list.
struct RegisteredTask {
  std::string name;
  SandboxTask run;
};
const std::vector<RegisteredTask>& sandbox_tasks();

/// The request of a rank. Two file descriptors travel with it: input, to be mapped, and output, to be
/// written.
struct SandboxRequest {
  std::int32_t task;
  SandboxLimits limits;
};

/// The answer of the server. The output lies in memory that the rank shares.
struct SandboxReply {
  static constexpr std::size_t message_capacity = 8192;  // bytes; chosen, not measured
  SandboxStatus status;
  bool interrupted;  ///< killed from outside: the result of the task is unknown
  double cpu_seconds;
  std::int64_t peak_resident_bytes;
  std::uint32_t message_length;
  char message[message_capacity];
};

/// Starts a server, unless the machine forbids child processes; then sandbox_refusal() has the reason. Throws
/// std::system_error if the machine is short of memory or processes.
std::unique_ptr<SandboxServer> start_server_if_allowed();

/// The main loop of the server: answers requests on `socket` until it closes. Never returns.
[[noreturn]] void serve_sandboxed_runs(int socket);

}  // namespace aeroloom::parallel
