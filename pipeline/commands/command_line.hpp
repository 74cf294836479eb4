/// The command line of the program.
#pragma once

#include "parallel/communication/communicator.hpp"

namespace aeroloom::pipeline {

/// Parses the arguments and runs the command. Rank 0 prints messages. Returns the exit code, equal on every
/// rank. Collective.
int run_command_line(const parallel::Communicator& communicator, int argc, char** argv);

}  // namespace aeroloom::pipeline
