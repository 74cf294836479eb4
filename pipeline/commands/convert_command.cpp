#include "io/file_formats.hpp"
#include "pipeline/case/nearest_name.hpp"
#include "pipeline/commands/commands.hpp"
#include "pipeline/commands/help.hpp"
#include "pipeline/commands/memory_option.hpp"
#include "pipeline/convert_file.hpp"

#include <memory>
#include <optional>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace aeroloom::pipeline {
namespace {

std::vector<std::string> format_names() {
  std::vector<std::string> names;
  for (const io::FormatRow& row : io::file_formats()) names.emplace_back(row.name);
  return names;
}

/// "{cgns,meshb,...}": what completion and help show.
std::string format_choices() {
  return fmt::format("{{{}}}", fmt::join(format_names(), ","));
}

/// Throws CLI::ValidationError.
io::FileFormat format_called(const std::string& name) {
  if (const std::optional<io::FileFormat> format = io::format_called(name)) return *format;
  const std::optional<std::string> nearest = cases::nearest_name(name, format_names());
  throw CLI::ValidationError("--format", fmt::format("no format is called '{}'; {}", name,
                                                     nearest ? "did you mean '" + *nearest + "'?"
                                                             : "known are " + format_choices()));
}

}  // namespace

Command add_convert(CLI::App& program) {
  CLI::App* app = program.add_subcommand("convert", "write a mesh in another format");
  struct Arguments : Conversion {
    std::int64_t memory = 0;  // bytes; 0: no limit
  };
  const auto conversion = std::make_shared<Arguments>();
  add_mesh_file(*app, "from", conversion->from);
  app->add_option("to", conversion->to, "the file to write; its extension says the format")
      ->required()
      ->type_name(file_kind::mesh);
  app->add_option_function<std::string>(
         "--format", [to = conversion.get()](const std::string& name) { to->format = format_called(name); },
         "the format, where the extension does not say it")
      ->type_name(format_choices())
      ->group(option_group::output);
  app->add_option("--parts", conversion->options.parts, "parts of a format that comes in parts")
      ->check(CLI::Range(1, 1000000))
      ->type_name("N")
      ->group(option_group::output);
  CLI::Option* reynolds =
      app->add_option("--reynolds", conversion->reynolds,
                      "Reynolds number of the flow, for settings of a solver beside the mesh (openfoam)")
          ->check(CLI::Range(1.0, 1e12))
          ->type_name("RE")
          ->group(option_group::output);
  CLI::Option* length =
      app->add_option("--length", conversion->length, "the length of that, in the unit of the mesh")
          ->check(CLI::PositiveNumber)
          ->type_name("LENGTH")
          ->group(option_group::output);
  reynolds->needs(length);
  length->needs(reynolds);
  add_memory_option(*app, conversion->memory);
  add_help_footer(*app,
                  {{"aeroloom convert out/mesh.pvtu mesh.cgns", "for a solver (docs/formats.md)"},
                   {"mpirun -n 2 aeroloom convert out/mesh.pvtu mesh.hdf --format vtkhdf", "by two ranks"},
                   {"aeroloom convert out/mesh.pvtu wing.foam --parts 4 --reynolds 1e7 --length 2.5",
                    "OpenFOAM, for four processors"}},
                  {report::ExitCode::ok, report::ExitCode::usage, report::ExitCode::files,
                   report::ExitCode::resources, report::ExitCode::bug});
  return {app, [conversion](const Invocation& invocation) {
            invocation.configure_log();
            return within_memory(invocation, conversion->memory, [&] {
              return guarded(invocation, report::ExitCode::files, [&] {
                convert_file(invocation.communicator, *conversion);
                return report::ExitCode::ok;
              });
            });
          }};
}

}  // namespace aeroloom::pipeline
