/// Examples, exit codes and headings in the output of `--help`.
#pragma once

#include "pipeline/report/exit_code.hpp"

#include <initializer_list>
#include <string>

namespace CLI {
class App;
}  // namespace CLI

namespace aeroloom::pipeline {

/// Headings for groups of options.
namespace option_group {
inline constexpr const char* of_case = "Case";
inline constexpr const char* checkpoints = "Checkpoints";
inline constexpr const char* limits = "Limits";
inline constexpr const char* output = "Output";
inline constexpr const char* resources = "Resources";
inline constexpr const char* printing = "Printing";
}  // namespace option_group

/// Kinds of files in `--help`. Completion depends on them (bash_completion.cpp).
namespace file_kind {
inline constexpr const char* of_case = "CASE.yaml";
inline constexpr const char* mesh = "MESH";
inline constexpr const char* step = "FILE.step";
inline constexpr const char* json = "FILE.json";
inline constexpr const char* any = "FILE";
}  // namespace file_kind

/// A key of the case in `--help`.
inline constexpr const char* assignment = "KEY=VALUE";

/// A command line that works as it stands, and its purpose.
struct Example {
  std::string line, what;
};

/// Adds examples and exit codes to the help of a command.
void add_help_footer(CLI::App& command, std::initializer_list<Example> examples,
                     std::initializer_list<report::ExitCode> codes);

}  // namespace aeroloom::pipeline
