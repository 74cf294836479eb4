#include "pipeline/case/case_reference.hpp"
#include "pipeline/case/case_schema.hpp"
#include "pipeline/commands/commands.hpp"
#include "pipeline/commands/help.hpp"
#include "pipeline/report/text_file.hpp"

#include <filesystem>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace aeroloom::pipeline {
namespace {

struct SchemaArguments {
  std::string output;
  bool markdown = false;
};

/// The text to be written: the schema, or the page of the reference with its tables renewed.
std::string schema_text(const SchemaArguments& arguments) {
  if (!arguments.markdown) return cases::case_schema(cases::case_keys());
  std::string reference = cases::case_reference(cases::case_keys());
  if (arguments.output.empty() || !std::filesystem::exists(arguments.output)) return reference;
  try {
    return cases::with_reference(report::read_text(arguments.output), reference);
  } catch (const std::invalid_argument& error) {
    throw cases::CaseError(arguments.output + ": " + error.what());
  }
}

}  // namespace

Command add_schema(CLI::App& program) {
  CLI::App* app =
      program.add_subcommand("schema", "print the keys of a case as a JSON Schema, for editors of YAML");
  const auto arguments = std::make_shared<SchemaArguments>();
  app->add_option("--output", arguments->output, "write to this file instead")
      ->type_name(file_kind::any)
      ->group(option_group::output);
  app->add_flag("--markdown", arguments->markdown,
                "the reference in Markdown; in a file that has the marks of its place, that alone is renewed")
      ->group(option_group::output);
  add_help_footer(
      *app,
      {{"aeroloom schema --output aeroloom.schema.json", "for editors (docs/usage.md)"},
       {"aeroloom schema --markdown", "the keys with their texts, ranges and defaults"}},
      {report::ExitCode::ok, report::ExitCode::usage, report::ExitCode::files, report::ExitCode::bug});
  return {app, [arguments](const parallel::Communicator& communicator, const Loudness& loudness) {
            parallel::configure_log(communicator, loudness.level());
            return guarded(communicator, report::ExitCode::usage, [&] {
              parallel::agree(communicator, [&] {
                if (!communicator.is_root()) return;
                const std::string text = schema_text(*arguments);
                if (!arguments->output.empty()) report::write_text(arguments->output, text);
                if (arguments->output.empty()) report::print_text(text);
              });
              if (!arguments->output.empty()) parallel::log_info("wrote " + arguments->output);
              return report::ExitCode::ok;
            });
          }};
}

}  // namespace aeroloom::pipeline
