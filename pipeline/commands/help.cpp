#include "pipeline/commands/help.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace aeroloom::pipeline {
namespace {

const char* meaning_of(ExitCode code) {
  switch (code) {
    case ExitCode::ok:
      return "ok";
    case ExitCode::usage:
      return "command line or configuration";
    case ExitCode::cad:
      return "CAD";
    case ExitCode::surface:
      return "surface stage";
    case ExitCode::volume:
      return "volume stage";
    case ExitCode::quality_gate:
      return "a limit on quality is missed";
    case ExitCode::files:
      return "a file cannot be read or written";
    case ExitCode::resources:
      return "out of memory";
    case ExitCode::bug:
      return "a bug of this program";
  }
  return "";
}

}  // namespace

void add_help_footer(CLI::App& command, std::initializer_list<Example> examples,
                     std::initializer_list<ExitCode> codes) {
  std::string text = "Examples:\n";
  for (const Example& example : examples) text += fmt::format("  {}\n      {}\n", example.line, example.what);
  text += "\nExit codes:\n";
  for (const ExitCode code : codes)
    text += fmt::format("  {:>2}  {}\n", static_cast<int>(code), meaning_of(code));
  text.pop_back();
  command.footer(text);
}

}  // namespace aeroloom::pipeline
