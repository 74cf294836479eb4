#include "pipeline/case/case_reference.hpp"
#include "pipeline/case/case_schema.hpp"
#include "pipeline/commands/commands.hpp"
#include "pipeline/commands/help.hpp"
#include "pipeline/report/text_file.hpp"

#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace aeroloom::pipeline {
namespace {

struct SchemaArguments {
  std::string output;
  bool markdown = false;
};

namespace fs = std::filesystem;

/// The page with its keys renewed, a new one where there is none.
std::string renewed(const fs::path& file, const cases::ReferencePage& page) {
  if (!fs::exists(file)) return cases::new_page(page);
  try {
    return cases::with_reference(report::read_text(file.string()), page.keys);
  } catch (const std::invalid_argument& error) {
    throw cases::CaseError(file.string() + ": " + error.what());
  }
}

/// All pages are made before the first is written.
void write_reference(const std::vector<cases::ReferencePage>& pages, const std::string& folder) {
  if (fs::exists(folder) && !fs::is_directory(folder))
    throw cases::CaseError(folder + " is a file. Remedy: name a folder, which gets a page for each section");
  std::vector<std::string> texts;
  texts.reserve(pages.size());
  for (const cases::ReferencePage& page : pages) texts.push_back(renewed(fs::path(folder) / page.file, page));
  for (std::size_t i = 0; i < pages.size(); ++i)
    report::write_text((fs::path(folder) / pages[i].file).string(), texts[i]);
}

void print_reference(const std::vector<cases::ReferencePage>& pages) {
  std::string text;
  for (const cases::ReferencePage& page : pages) text += (text.empty() ? "" : "\n") + cases::new_page(page);
  report::print_text(text);
}

void write_or_print(const SchemaArguments& arguments) {
  if (arguments.markdown) {
    const std::vector<cases::ReferencePage> pages = cases::case_reference(cases::case_keys());
    return arguments.output.empty() ? print_reference(pages) : write_reference(pages, arguments.output);
  }
  const std::string text = cases::case_schema(cases::case_keys());
  if (arguments.output.empty()) return report::print_text(text);
  report::write_text(arguments.output, text);
}

}  // namespace

Command add_schema(CLI::App& program) {
  CLI::App* app =
      program.add_subcommand("schema", "print the keys of a case as a JSON Schema, for editors of YAML");
  const auto arguments = std::make_shared<SchemaArguments>();
  app->add_option("--output", arguments->output,
                  "write to this file instead; with --markdown, to this folder")
      ->type_name(file_kind::any)
      ->group(option_group::output);
  app->add_flag(
         "--markdown", arguments->markdown,
         "the reference in Markdown, a page for each section; in pages that exist, only the keys are renewed")
      ->group(option_group::output);
  add_help_footer(
      *app,
      {{"aeroloom schema --output aeroloom.schema.json", "for editors (docs/usage.md)"},
       {"aeroloom schema --markdown --output keys", "pages of the keys, with texts, ranges and defaults"}},
      {report::ExitCode::ok, report::ExitCode::usage, report::ExitCode::files, report::ExitCode::bug});
  return {app, [arguments](const parallel::Communicator& communicator, const Loudness& loudness) {
            parallel::configure_log(communicator, loudness.level());
            return guarded(communicator, report::ExitCode::usage, [&] {
              parallel::on_root(communicator, [&] { write_or_print(*arguments); });
              if (!arguments->output.empty()) parallel::log_info("wrote " + arguments->output);
              return report::ExitCode::ok;
            });
          }};
}

}  // namespace aeroloom::pipeline
