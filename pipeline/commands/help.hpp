/// Examples and exit codes, which `--help` tells beside the options.
#pragma once

#include "pipeline/report/exit_code.hpp"

#include <initializer_list>
#include <string>

namespace CLI {
class App;
}  // namespace CLI

namespace aeroloom::pipeline {

/// Headings under which `--help` lists options.
namespace option_group {
inline constexpr const char* of_case = "Case";
inline constexpr const char* checkpoints = "Checkpoints";
inline constexpr const char* limits = "Limits";
inline constexpr const char* output = "Output";
inline constexpr const char* resources = "Resources";
inline constexpr const char* printing = "Printing";
}  // namespace option_group

/// Kinds of files, as `--help` names them after an option; completion goes by them (bash_completion.cpp).
namespace file_kind {
inline constexpr const char* of_case = "CASE.yaml";
inline constexpr const char* mesh = "MESH";
inline constexpr const char* step = "FILE.step";
inline constexpr const char* json = "FILE.json";
inline constexpr const char* any = "FILE";
}  // namespace file_kind

/// Of a key of the case, as `--help` names it.
inline constexpr const char* assignment = "KEY=VALUE";

/// A line that can be typed as it stands, and what it does.
struct Example {
  std::string line, what;
};

/// Puts the examples and the meaning of the exit codes under the help of a command.
void add_help_footer(CLI::App& command, std::initializer_list<Example> examples,
                     std::initializer_list<report::ExitCode> codes);

}  // namespace aeroloom::pipeline
