#include "pipeline/commands/usage_error.hpp"

#include "pipeline/case/nearest_name.hpp"
#include "pipeline/case/yaml_value.hpp"

#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace aeroloom::pipeline {
namespace {

/// "--name" and "-n" of all options of a command.
std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  }
  return names;
}

std::vector<std::string> command_names(const CLI::App& program) {
  std::vector<std::string> names;
  for (const CLI::App* command : program.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

std::string suggest(const std::string& word, const std::vector<std::string>& known) {
  const std::optional<std::string> nearest = cases::nearest_name(word, known);
  return nearest ? fmt::format("; did you mean '{}'?", *nearest) : "";
}

std::string unknown_in(const CLI::App& command, const std::string& word) {
  if (!word.starts_with("-")) return fmt::format("unexpected argument '{}'", word);
  const std::string name = word.substr(0, word.find('='));
  return fmt::format("unknown option '{}'{}", name, suggest(name, option_names(command)));
}

}  // namespace

std::string explain_usage_error(const CLI::App& program, const CLI::ParseError& error) {
  const std::vector<CLI::App*> parsed = program.get_subcommands();
  if (parsed.empty()) {
    const std::vector<std::string> names = command_names(program), extra = program.remaining();
    const std::string advice = fmt::format("\ncommands: {}\nsee aeroloom --help", cases::joined(names));
    if (extra.empty()) {
      const bool none = error.get_name() == "RequiredError";
      return (none ? std::string("a command is missing") : std::string(error.what())) + advice;
    }
    if (extra.front().starts_with("-")) return unknown_in(program, extra.front()) + advice;
    return fmt::format("unknown command '{}'{}", extra.front(), suggest(extra.front(), names)) + advice;
  }
  const CLI::App& command = *parsed.front();
  std::vector<std::string> extra = command.remaining();
  if (extra.empty()) extra = program.remaining();
  // An unknown word explains why something else is missing, so it is reported first.
  const std::string what = extra.empty() ? std::string(error.what()) : unknown_in(command, extra.front());
  return fmt::format("aeroloom {}: {}\nsee aeroloom {} --help", command.get_name(), what, command.get_name());
}

}  // namespace aeroloom::pipeline
