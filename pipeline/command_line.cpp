#include "pipeline/command_line.hpp"

#include "parallel/collective_error.hpp"
#include "parallel/log.hpp"
#include "pipeline/check.hpp"
#include "pipeline/convert_file.hpp"
#include "pipeline/improve_file.hpp"
#include "pipeline/quality_file.hpp"
#include "pipeline/report.hpp"
#include "pipeline/run.hpp"
#include "pipeline/stage.hpp"
#include "pipeline/write_outputs.hpp"

#include <filesystem>
#include <map>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace aeroloom::pipeline {
namespace {

using parallel::Communicator;

constexpr const char* description =
    "Aeroloom: from aircraft CAD to a distributed tetrahedral mesh.\n"
    "There are no boundary layers: all elements are isotropic tetrahedra.";

constexpr const char* examples =
    "Examples:\n"
    "  aeroloom run configs/transport.yaml                 mesh the built-in aircraft on one rank\n"
    "  mpirun -n 8 aeroloom run case.yaml                  the same mesh, bit for bit, by eight ranks\n"
    "  aeroloom check case.yaml                            what is wrong with the CAD, what a run will cost\n"
    "  aeroloom run case.yaml --set sizing.minimum=0.02    override a key of the case\n"
    "  aeroloom improve mesh.vtu --set output.directory=better   improve another program's mesh\n"
    "  aeroloom convert out/mesh.pvtu mesh.cgns             a mesh in the format of a solver "
    "(docs/formats.md)\n"
    "  aeroloom quality mesh.meshb --gate.largest_edge_ratio=1000   how good a mesh is (docs/quality.md)\n"
    "  aeroloom export-cad configs/transport.yaml a.step   write the case's geometry as STEP\n\n"
    "Exit codes: 0 ok, 2 usage or configuration, 3 CAD, 4 surface, 5 volume, 6 quality gate,\n"
    "7 input/output, 8 resources, 70 bug.";

/// What was typed.
struct Arguments {
  std::string case_file;
  std::vector<std::string> overrides;
  std::string cad_file, mesh_file;
  Conversion conversion;
  QualityRequest quality;
  bool verbose = false, quiet = false;
};

void print(const Communicator& communicator, const std::string& text) {
  if (communicator.is_root()) fmt::print("{}", text), std::fflush(stdout);
}

int fail(const Communicator& communicator, ExitCode code, const std::string& message) {
  if (communicator.is_root()) parallel::log_error(message);
  communicator.barrier();
  return static_cast<int>(code);
}

/// Runs a case, or improves a file where one is named, and reports; a failure is reported too, as far as the
/// output directory can be written.
int run(const Communicator& communicator, const Case& input, const ReportSubject& subject) {
  RunRecord record;
  RunOutcome outcome;
  const double age = parallel::process_age_seconds(), begin = parallel::wall_seconds();
  record.clock.note("start", age);
  try {
    if (subject.improved_file.empty()) {
      run_case(communicator, input, record);
    } else {
      improve_file(communicator, subject.improved_file, input, record);
    }
  } catch (const StageFailure& failure) {
    outcome = {failure.code(), failure.stage(), failure.what()};
  }
  record.wall_seconds = age + parallel::wall_seconds() - begin;
  try {
    const std::string table = write_report(communicator, input, record, outcome, subject);
    if (outcome.code == ExitCode::ok) print(communicator, table);
  } catch (const parallel::CollectiveError& error) {
    if (outcome.code == ExitCode::ok) outcome = {ExitCode::files, "output", error.what()};
  }
  if (outcome.code != ExitCode::ok) {
    return fail(communicator, outcome.code,
                fmt::format("stage {} failed: {}", outcome.stage, outcome.message));
  }
  for (const io::FileFormat format : input.output.formats) {
    const std::string path = std::filesystem::absolute(path_of(input.output, format)).string();
    print(communicator,
          fmt::format("{}: {}\n", format == io::FileFormat::vtu ? "open in ParaView" : "mesh", path));
  }
  print(communicator,
        fmt::format("report: {}\n",
                    std::filesystem::absolute(input.output.directory + "/report.html").string()));
  return 0;
}

int check(const Communicator& communicator, const Case& input) {
  try {
    const ExitCode code = check_case(communicator, input);
    communicator.barrier();
    return static_cast<int>(code);
  } catch (const std::invalid_argument& error) {
    return fail(communicator, ExitCode::usage, error.what());
  } catch (const parallel::CollectiveError& error) {
    const bool files = error.kind() == parallel::FailureKind::files;
    return fail(communicator, files ? ExitCode::files : ExitCode::cad, error.what());
  }
}

int convert(const Communicator& communicator, const Arguments& arguments) {
  try {
    convert_file(communicator, arguments.conversion);
    return 0;
  } catch (const std::invalid_argument& error) {
    return fail(communicator, ExitCode::usage, error.what());
  } catch (const parallel::CollectiveError& error) {
    return fail(communicator, code_of(error, ExitCode::files), error.what());
  }
}

int quality(const Communicator& communicator, const Arguments& arguments, const QualityGate& gate) {
  try {
    const std::string missed = show_quality(communicator, arguments.quality, gate);
    return missed.empty() ? 0 : fail(communicator, ExitCode::quality_gate, missed);
  } catch (const parallel::CollectiveError& error) {
    return fail(communicator, code_of(error, ExitCode::files), error.what());
  }
}

int export_cad(const Communicator& communicator, const Case& input, const std::string& file) {
  parallel::agree(communicator, [&] {
    if (communicator.is_root()) cad::export_step(input.domain, file);
  });
  print(communicator, fmt::format("wrote {}\n", file));
  return 0;
}

/// Every rank reads the case: it is small, and all learn of an error together.
Case load_case(const Communicator& communicator, const Arguments& arguments) {
  Case input;
  parallel::agree(communicator, [&] {
    input = arguments.case_file.empty() ? case_of_overrides(arguments.overrides)
                                        : read_case(arguments.case_file, arguments.overrides);
  });
  return input;
}

void add_common_options(CLI::App& command, Arguments& arguments) {
  command
      .add_option("--set", arguments.overrides,
                  "override a key of the case, as section.key=value; repeatable")
      ->allow_extra_args(false);
  command.add_flag("-v,--verbose", arguments.verbose, "say more");
  command.add_flag("-q,--quiet", arguments.quiet, "print errors and warnings only");
}

void add_case_options(CLI::App& command, Arguments& arguments) {
  command.add_option("case", arguments.case_file, "the case, a YAML file (docs/configuration.md)")
      ->required();
  add_common_options(command, arguments);
}

void add_convert_options(CLI::App& command, Arguments& arguments) {
  Conversion& conversion = arguments.conversion;
  command.add_option("from", conversion.from, "the mesh to read")->required();
  command.add_option("to", conversion.to, "the file to write; its extension says the format")->required();
  std::map<std::string, io::FileFormat> formats;
  for (const io::FormatName& format : io::format_names) formats.emplace(format.name, format.format);
  command.add_option("--format", conversion.format, "the format, where the extension does not say it")
      ->transform(CLI::CheckedTransformer(formats));
  command.add_option("--parts", conversion.options.parts, "parts of a format that comes in parts")
      ->check(CLI::Range(1, 1000000));
  command.add_flag("-v,--verbose", arguments.verbose, "say more");
  command.add_flag("-q,--quiet", arguments.quiet, "print errors and warnings only");
}

void add_quality_options(CLI::App& command, Arguments& arguments) {
  command
      .add_option("file", arguments.quality.file, "the mesh, in any format that is read (docs/formats.md)")
      ->required();
  command.add_flag("--json", arguments.quality.print_json, "print JSON (docs/quality.md)");
  command.add_option("--output", arguments.quality.json_file, "write the JSON to this file");
  for (const std::string_view key : gate_keys) {
    command.add_option_function<std::string>(
        fmt::format("--gate.{}", key),
        [&arguments, key](const std::string& value) {
          arguments.overrides.push_back(fmt::format("improve.gate.{}={}", key, value));
        },
        fmt::format("limit; as improve.gate.{} (docs/configuration.md)", key));
  }
}

}  // namespace

int run_command_line(const Communicator& communicator, int argc, char** argv) {
  Arguments arguments;
  CLI::App program(description, "aeroloom");
  program.footer(examples);
  program.set_version_flag("--version",
                           std::string("aeroloom ") + AEROLOOM_VERSION + "\n" + AEROLOOM_LIBRARIES);
  program.require_subcommand(1);
  CLI::App* run_command = program.add_subcommand("run", "mesh a case");
  CLI::App* check_command = program.add_subcommand(
      "check", "diagnose the geometry of a case and predict its mesh, without meshing");
  CLI::App* export_command = program.add_subcommand("export-cad", "write the geometry of a case as STEP");
  CLI::App* improve_command = program.add_subcommand(
      "improve", "improve a mesh of tetrahedra from a file, its boundary kept as it is");
  improve_command
      ->add_option("file", arguments.mesh_file, "the mesh, in any format that is read (docs/formats.md)")
      ->required();
  CLI::App* convert_command = program.add_subcommand("convert", "write a mesh in another format");
  add_convert_options(*convert_command, arguments);
  CLI::App* quality_command =
      program.add_subcommand("quality", "measure a mesh: angles, ratios, volumes, worst cells, defects");
  add_quality_options(*quality_command, arguments);
  add_common_options(*improve_command, arguments);
  add_case_options(*run_command, arguments);
  add_case_options(*check_command, arguments);
  add_case_options(*export_command, arguments);
  export_command->add_option("file", arguments.cad_file, "the STEP file to write")->required();
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int code = communicator.is_root() ? program.exit(error) : error.get_exit_code();
    return code == 0 ? 0 : static_cast<int>(ExitCode::usage);
  }

  parallel::configure_log(communicator, parallel::LogLevel::normal);
  Case input;
  try {
    input = load_case(communicator, arguments);
  } catch (const std::exception& error) {
    return fail(communicator, ExitCode::usage, error.what());
  }
  parallel::configure_log(communicator, arguments.quiet     ? parallel::LogLevel::quiet
                                        : arguments.verbose ? parallel::LogLevel::verbose
                                                            : input.output.log);
  if (run_command->parsed() || improve_command->parsed())
    return run(communicator, input, {arguments.case_file, arguments.mesh_file});
  if (convert_command->parsed()) return convert(communicator, arguments);
  if (quality_command->parsed()) return quality(communicator, arguments, input.gate);
  if (check_command->parsed()) return check(communicator, input);
  try {
    return export_cad(communicator, input, arguments.cad_file);
  } catch (const parallel::CollectiveError& error) {
    const bool files = error.kind() == parallel::FailureKind::files;
    return fail(communicator, files ? ExitCode::files : ExitCode::cad, error.what());
  }
}

}  // namespace aeroloom::pipeline
