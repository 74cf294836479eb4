#include "pipeline/commands/help.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace aeroloom::pipeline {
namespace {

const char* meaning_of(report::ExitCode code) {
  switch (code) {
    case report::ExitCode::ok:
      return "ok";
    case report::ExitCode::usage:
      return "command line or configuration";
    case report::ExitCode::cad:
      return "CAD";
    case report::ExitCode::surface:
      return "surface stage";
    case report::ExitCode::volume:
      return "volume stage";
    case report::ExitCode::quality_gate:
      return "a limit on quality is missed";
    case report::ExitCode::files:
      return "a file cannot be read or written";
    case report::ExitCode::resources:
      return "out of memory";
    case report::ExitCode::bug:
      return "a bug of this program";
  }
  return "";
}

}  // namespace

void add_help_footer(CLI::App& command, std::initializer_list<Example> examples,
                     std::initializer_list<report::ExitCode> codes) {
  std::string text = "Examples:\n";
  for (const Example& example : examples) text += fmt::format("  {}\n      {}\n", example.line, example.what);
  text += "\nExit codes:\n";
  for (const report::ExitCode code : codes)
    text += fmt::format("  {:>2}  {}\n", static_cast<int>(code), meaning_of(code));
  text.pop_back();
  command.footer(text);
}

}  // namespace aeroloom::pipeline
