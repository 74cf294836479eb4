/// Reports which step the CAD library is in, so that a message about a crash can name it.
#pragma once

#include <string>

namespace aeroloom::cad {

/// Receives one line per step, such as "sewing 22 faces". Null removes the listener. Not thread-safe.
using StepListener = void (*)(const std::string& step);
void listen_to_steps(StepListener listener);

/// Reports a step to the listener, if there is one.
void report_step(const std::string& step);

}  // namespace aeroloom::cad
