/// The step that the CAD library is in, so that a message about a crash can name it. Seen by this folder and
/// by who contains it.
#pragma once

#include <string>

namespace aeroloom::cad {

/// Receives one line per step, e.g. "sewing 22 faces"; null: nobody does. Not thread-safe.
using StepListener = void (*)(const std::string& step);
void listen_to_steps(StepListener listener);

/// Tells the listener, if any.
void report_step(const std::string& step);

}  // namespace aeroloom::cad
