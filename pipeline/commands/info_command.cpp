#include "geometry/name_text.hpp"
#include "pipeline/commands/commands.hpp"
#include "pipeline/commands/help.hpp"
#include "pipeline/info_file.hpp"

#include <memory>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>

namespace aeroloom::pipeline {

Command add_info(CLI::App& program) {
  CLI::App* app = program.add_subcommand("info", "describe a file: a mesh, CAD, triangles, or a case");
  const auto request = std::make_shared<InfoRequest>();
  app->add_option("file", request->file,
                  "a mesh in any format that is read (docs/formats.md), CAD, triangles, or a case")
      ->required()
      ->type_name(file_kind::any);
  app->add_option("--encoding", request->encoding,
                  "of names in CAD and triangles that are not UTF-8, as `geometry.encoding` of a case")
      ->type_name("NAME")
      ->check([](const std::string& name) {
        try {
          geometry::require_encoding(name);
        } catch (const std::invalid_argument& error) {
          return std::string(error.what());
        }
        return std::string();
      });
  app->add_flag("--json", request->print_json, "print JSON (docs/usage.md)")->group(option_group::output);
  add_help_footer(*app,
                  {{"aeroloom info out/mesh.pvtu", "cells, patches, regions, box of a mesh"},
                   {"aeroloom info wing.step", "unit, box, solids, names, layers and colours of CAD"},
                   {"aeroloom info case.yaml", "a case with every value spelled out"},
                   {"aeroloom info out/mesh.pvtu --json", "for programs"}},
                  {report::ExitCode::ok, report::ExitCode::usage, report::ExitCode::cad,
                   report::ExitCode::files, report::ExitCode::resources, report::ExitCode::bug});
  return {app, [request](const Invocation& invocation) {
            invocation.configure_log();
            const bool is_case = request->file.ends_with(".yaml") || request->file.ends_with(".yml");
            return guarded(invocation, is_case ? report::ExitCode::usage : report::ExitCode::cad, [&] {
              show_info(invocation.communicator, *request);
              return report::ExitCode::ok;
            });
          }};
}

}  // namespace aeroloom::pipeline
