#include "pipeline/commands/commands.hpp"
#include "pipeline/commands/help.hpp"
#include "pipeline/commands/memory_option.hpp"
#include "pipeline/commands/staged_run.hpp"
#include "pipeline/improve_file.hpp"
#include "pipeline/write_outputs.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <system_error>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace aeroloom::pipeline {

namespace {

/// Whether what is improved, or the report beside it, would be overwritten. Empty where not.
std::string what_would_be_lost(const std::string& mesh, const cases::OutputOptions& output) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  for (const io::FileFormat format : output.formats) {
    if (fs::equivalent(mesh, path_of(output, format), ignored)) return "it is what is to be improved";
  }
  const fs::path folder = fs::absolute(mesh, ignored).parent_path();
  if (fs::equivalent(folder, output.directory, ignored) && fs::exists(folder / "report.json", ignored))
    return "the report there is that of the mesh to be improved";
  return {};
}

/// The first of the settings that says nothing to this command; empty where there is none.
std::string setting_without_effect(const std::vector<std::string>& overrides) {
  for (const std::string& setting : overrides) {
    std::string key = setting.substr(0, setting.find('='));
    if (!key.starts_with("improve") && !key.starts_with("output") && key != "volume.piece_tets") return key;
  }
  return {};
}

}  // namespace

Command add_improve(CLI::App& program) {
  struct Arguments : CaseArguments {
    std::string mesh;
    std::int64_t memory = 0;  // bytes; 0: no limit
  };
  CLI::App* app = program.add_subcommand(
      "improve", "improve a mesh of tetrahedra from a file, its boundary kept as it is");
  const auto arguments = std::make_shared<Arguments>();
  add_mesh_file(*app, "mesh", arguments->mesh);
  add_overrides(*app, *arguments);
  add_memory_option(*app, arguments->memory);
  add_help_footer(*app,
                  {{"aeroloom improve out/mesh.pvtu --set output.directory=better", "what a run has made"},
                   {"mpirun -n 2 aeroloom improve mesh.meshb --set improve.target_angle=20",
                    "another program's mesh, by two ranks"}},
                  {report::ExitCode::ok, report::ExitCode::usage, report::ExitCode::volume,
                   report::ExitCode::quality_gate, report::ExitCode::files, report::ExitCode::resources,
                   report::ExitCode::bug});
  return {app, [arguments](const Invocation& invocation) {
            return with_case(invocation, *arguments, [&](const cases::Case& input) {
              const std::string idle = setting_without_effect(arguments->overrides);
              if (!idle.empty()) {
                return fail(
                    invocation, report::ExitCode::usage,
                    fmt::format("'{}' says nothing to improve, which takes a mesh as it is: improve.*, "
                                "output.* and volume.piece_tets do",
                                idle));
              }
              const std::string lost = what_would_be_lost(arguments->mesh, input.output);
              if (!lost.empty()) {
                return fail(invocation, report::ExitCode::usage,
                            fmt::format("'{}' is not overwritten: {}. Remedy: --set output.directory=FOLDER",
                                        input.output.directory, lost));
              }
              return within_memory(invocation, arguments->memory, [&] {
                return run_stages(invocation, input, {"", arguments->mesh}, [&](report::RunRecord& record) {
                  improve_file(invocation.communicator, arguments->mesh, input, record);
                });
              });
            });
          }};
}

}  // namespace aeroloom::pipeline
