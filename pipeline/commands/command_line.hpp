/// The command line: what the user types, and how the program ends.
#pragma once

#include "parallel/communication/communicator.hpp"

namespace aeroloom::pipeline {

/// Parses the arguments and runs the command. Returns the exit code, the same on every rank; messages are
/// printed by rank 0. Collective.
int run_command_line(const parallel::Communicator& communicator, int argc, char** argv);

}  // namespace aeroloom::pipeline
