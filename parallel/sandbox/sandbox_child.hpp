/// The child process of one sandboxed run. Internal to parallel/.
#pragma once

#include "parallel/sandbox/sandbox_server.hpp"

namespace aeroloom::parallel {

/// How a child ends when it ends by itself; `refused`: the machine has no room for its input or output.
/// Values nobody passes to exit() by chance; any other code is an abort.
enum class ChildExit : int { ok = 113, threw = 114, out_of_memory = 115, refused = 116 };

/// Runs the requested task under its limits: input is mapped from one descriptor, the output goes to the
/// other (the exception's text when it threw), what it prints to `printed`. Never returns.
[[noreturn]] void run_child(const SandboxRequest& request, int input, int output, int printed);

}  // namespace aeroloom::parallel
