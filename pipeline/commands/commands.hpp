/// The commands of the program. Each function adds its command to the command line.
#pragma once

#include "pipeline/commands/command.hpp"

namespace aeroloom::pipeline {

Command add_run(CLI::App& program);
Command add_check(CLI::App& program);
Command add_info(CLI::App& program);
Command add_improve(CLI::App& program);
Command add_quality(CLI::App& program);
Command add_convert(CLI::App& program);
Command add_export_cad(CLI::App& program);
/// Completes the commands that the program has when the command runs.
Command add_completion(CLI::App& program);
Command add_init(CLI::App& program);
Command add_schema(CLI::App& program);
Command add_scaling(CLI::App& program);

}  // namespace aeroloom::pipeline
