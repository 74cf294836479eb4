/// The child process of one sandboxed run. Internal to parallel/.
#pragma once

#include "parallel/sandbox/sandbox_server.hpp"

namespace aeroloom::parallel {

/// Exit codes of the child. `refused`: the machine has no memory for its input or output. Any other code is
/// an abort; the values are unlikely in calls of exit().
enum class ChildExit : int { ok = 113, threw = 114, out_of_memory = 115, refused = 116 };

/// Runs the requested task under its limits. Maps the input from the descriptor `input`. Writes the result,
/// or the exception's text, to `output`, and what the task prints to `printed`. Never returns.
[[noreturn]] void run_child(const SandboxRequest& request, int input, int output, int printed);

}  // namespace aeroloom::parallel
