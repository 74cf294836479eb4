#include "pipeline/commands/commands.hpp"
#include "pipeline/quality_file.hpp"

#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace aeroloom::pipeline {

Command add_quality(CLI::App& program) {
  struct Arguments : CaseArguments {
    QualityRequest request;
  };
  CLI::App* app =
      program.add_subcommand("quality", "measure a mesh: angles, ratios, volumes, worst cells, defects");
  const auto arguments = std::make_shared<Arguments>();
  app->add_option("mesh", arguments->request.file, "the mesh, in any format that is read (docs/formats.md)")
      ->required();
  app->add_flag("--json", arguments->request.print_json, "print JSON (docs/quality.md)");
  app->add_option("--output", arguments->request.json_file, "write the JSON to this file");
  for (const std::string_view key : gate_keys) {
    app->add_option_function<std::string>(
        fmt::format("--gate.{}", key),
        [gate = arguments.get(), key](const std::string& value) {
          gate->overrides.push_back(fmt::format("improve.gate.{}={}", key, value));
        },
        fmt::format("limit; as improve.gate.{} (docs/configuration.md)", key));
  }
  return {app, [arguments](const parallel::Communicator& communicator, const Loudness& loudness) {
            return with_case(communicator, *arguments, loudness, [&](const Case& input) {
              std::string missed;
              const int code = guarded(communicator, ExitCode::files, [&] {
                missed = show_quality(communicator, arguments->request, input.gate);
                return ExitCode::ok;
              });
              return missed.empty() ? code : fail(communicator, ExitCode::quality_gate, missed);
            });
          }};
}

}  // namespace aeroloom::pipeline
