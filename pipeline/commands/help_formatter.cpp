#include "pipeline/commands/help_formatter.hpp"

#include <utility>

#include <fmt/format.h>

namespace aeroloom::pipeline {

namespace {

constexpr std::size_t first_column = 34;

}  // namespace

HelpFormatter::HelpFormatter() {
  column_width(first_column);
  label("SUBCOMMAND", "COMMAND");
  label("Positionals", "Arguments");
}

std::string HelpFormatter::make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const {
  std::string text = Formatter::make_help(app, std::move(name), mode);
  for (std::size_t gap = text.find("\n\n\n"); gap != std::string::npos; gap = text.find("\n\n\n"))
    text.erase(gap, 1);
  return text;
}

std::string HelpFormatter::make_option_opts(const CLI::Option* option) const {
  std::string text;
  if (option->get_type_size() != 0 && !option->get_type_name().empty()) text = " " + option->get_type_name();
  for (const CLI::Option* other : option->get_excludes())
    text += fmt::format(" (not with {})", other->get_name());
  return text;
}

std::string HelpFormatter::make_option_usage(const CLI::Option* option) const {
  const std::string name =
      option->get_type_name().empty() ? make_option_name(option, true) : option->get_type_name();
  return option->get_required() ? name : "[" + name + "]";
}

}  // namespace aeroloom::pipeline
