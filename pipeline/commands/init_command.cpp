#include "pipeline/case/case_schema.hpp"
#include "pipeline/case/case_template.hpp"
#include "pipeline/commands/commands.hpp"
#include "pipeline/commands/help.hpp"
#include "pipeline/report/text_file.hpp"

#include <cctype>
#include <filesystem>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace aeroloom::pipeline {
namespace {

namespace fs = std::filesystem;

constexpr const char* schema_name = "aeroloom.schema.json";

struct InitArguments {
  std::string file = "case.yaml";
  std::string geometry;
  bool full = false, force = false, no_schema = false;
};

/// A file of this name that is no schema of ours is somebody else's.
void require_ours(const std::string& schema_file) {
  if (!fs::exists(schema_file) ||
      report::read_text(schema_file).find(cases::schema_title) != std::string::npos)
    return;
  throw cases::CaseError(schema_file +
                         " is there already and is no schema of Aeroloom; --force replaces it, "
                         "--no-schema does without");
}

/// Files of triangles in formats that are not read.
void require_readable(const std::string& geometry) {
  std::string extension = fs::path(geometry).extension().string();
  for (char& letter : extension) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  for (const char* faceted : {".vtp", ".3mf"}) {
    if (extension == faceted)
      throw cases::CaseError(fmt::format(
          "{}: {} files are not read. Remedy: STEP, IGES or BREP from the program that made it, or its "
          "triangles as STL, OBJ, OFF, PLY, .poly or .smesh",
          geometry, extension));
  }
}

void write_template(const InitArguments& arguments) {
  require_readable(arguments.geometry);
  if (fs::is_directory(arguments.file))
    throw cases::CaseError(arguments.file + " is a folder; give the case a name, such as " +
                           (fs::path(arguments.file) / "case.yaml").string());
  if (fs::exists(arguments.file) && !arguments.force)
    throw cases::CaseError(arguments.file + " is there already; --force replaces it");
  const std::string schema_file = (fs::path(arguments.file).parent_path() / schema_name).string();
  cases::TemplateRequest request{arguments.geometry, arguments.full, arguments.no_schema ? "" : schema_name};
  if (!arguments.no_schema) {
    if (!arguments.force) require_ours(schema_file);
    report::write_text(schema_file, cases::case_schema(cases::case_keys()));
  }
  report::write_text(arguments.file, cases::case_template(cases::case_keys(), request));
  parallel::log_info("wrote " + arguments.file +
                     (arguments.no_schema ? "" : ", and " + schema_file + " for editors"));
  if (!arguments.geometry.empty() && !fs::exists(arguments.geometry) &&
      !fs::exists(fs::path(arguments.file).parent_path() / arguments.geometry))
    parallel::log_warning("the geometry " + arguments.geometry + " is not there yet");
  parallel::log_info(fmt::format("next: {}aeroloom check {}",
                                 arguments.geometry.empty() ? "set geometry.file in it, then " : "",
                                 arguments.file));
}

}  // namespace

Command add_init(CLI::App& program) {
  CLI::App* app = program.add_subcommand("init", "write a commented case to start from");
  const auto arguments = std::make_shared<InitArguments>();
  app->add_option("file", arguments->file, "the case to write; left out: " + arguments->file)
      ->type_name(file_kind::of_case);
  app->add_option("--geometry", arguments->geometry,
                  "the CAD file: STEP, IGES or BREP; or triangles: STL, OBJ, OFF, PLY, .poly, .smesh")
      ->type_name(file_kind::any)
      ->group(option_group::of_case);
  app->add_flag("--full", arguments->full, "every key, not only those that are often touched")
      ->group(option_group::of_case);
  app->add_flag("--force", arguments->force, "replace what is there")->group(option_group::output);
  app->add_flag("--no-schema", arguments->no_schema,
                std::string("do not write ") + schema_name + " beside it, for editors")
      ->group(option_group::output);
  add_help_footer(
      *app,
      {{"aeroloom init case.yaml --geometry wing.step", "a case of all defaults"},
       {"aeroloom init every.yaml --full", "with every key"}},
      {report::ExitCode::ok, report::ExitCode::usage, report::ExitCode::files, report::ExitCode::bug});
  return {app, [arguments](const parallel::Communicator& communicator, const Loudness& loudness) {
            parallel::configure_log(communicator, loudness.level());
            return guarded(communicator, report::ExitCode::usage, [&] {
              parallel::on_root(communicator, [&] { write_template(*arguments); });
              return report::ExitCode::ok;
            });
          }};
}

}  // namespace aeroloom::pipeline
