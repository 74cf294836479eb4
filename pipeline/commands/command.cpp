#include "pipeline/commands/command.hpp"

#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/log.hpp"
#include "parallel/observation/memory_limit.hpp"
#include "parallel/sandbox/sandbox.hpp"
#include "pipeline/case/option_keys.hpp"
#include "pipeline/commands/help.hpp"
#include "pipeline/commands/plain_words.hpp"
#include "pipeline/report/text_file.hpp"
#include "pipeline/stage.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace aeroloom::pipeline {

using parallel::Communicator;

parallel::LogLevel Loudness::level(parallel::LogLevel otherwise) const {
  if (quiet) return parallel::LogLevel::quiet;
  return verbose ? parallel::LogLevel::verbose : otherwise;
}

namespace {

/// As an unset variable of a script gives it.
std::function<std::string(const std::string&)> is_no_empty_name() {
  return [](const std::string& name) { return name.empty() ? std::string("is empty") : std::string(); };
}

}  // namespace

void add_case_file(CLI::App& command, CaseArguments& arguments) {
  command.add_option("case", arguments.file, "the case, a YAML file (docs/configuration)")
      ->required()
      ->check(is_no_empty_name())
      ->type_name(file_kind::of_case);
}

void add_mesh_file(CLI::App& command, const std::string& name, std::string& file) {
  command.add_option(name, file, "the mesh, in any format that is read (docs/formats.md)")
      ->required()
      ->check(is_no_empty_name())
      ->type_name(file_kind::mesh);
}

void add_overrides(CLI::App& command, CaseArguments& arguments) {
  command
      .add_option("--set", arguments.overrides,
                  "override a key of the case, as section.key=value; repeatable")
      ->allow_extra_args(false)
      ->type_name(assignment)
      ->group(option_group::of_case);
}

namespace {

/// Collective: throws CollectiveError where a rank has no child processes and nobody said that it need not.
void choose_sandbox(const Communicator& communicator, parallel::Sandbox sandbox) {
  if (sandbox == parallel::Sandbox::none) parallel::run_without_sandbox(communicator);
  parallel::agree(communicator, [&] {
    if (sandbox == parallel::Sandbox::none || parallel::sandbox_refusal().empty()) return;
    throw std::runtime_error(
        fmt::format("this machine allows no child processes ({}), which keep crashes of the CAD library and "
                    "of TetGen from "
                    "ending the run. Remedy: parallel.sandbox: none",
                    parallel::sandbox_refusal()));
  });
}

}  // namespace

int with_case(const Communicator& communicator, const CaseArguments& arguments, const Loudness& loudness,
              const std::function<int(const cases::Case&)>& work) {
  parallel::configure_log(communicator, loudness.level());
  cases::Case input;
  try {
    // Rank 0 alone looks at the file; all learn of an error together.
    std::string resolved;
    parallel::agree(communicator, [&] {
      if (arguments.file.empty())
        input = cases::case_of_overrides(arguments.overrides);
      else if (communicator.is_root())
        input = cases::read_case(arguments.file, arguments.overrides);
      if (communicator.is_root() && !arguments.file.empty()) resolved = cases::resolved_yaml(input);
    });
    communicator.broadcast_value(resolved);
    parallel::agree(communicator, [&] {
      if (!communicator.is_root() && !resolved.empty()) input = cases::case_of_resolved(resolved);
    });
  } catch (const parallel::CollectiveError& error) {
    const bool memory = error.kind() == parallel::FailureKind::resources;
    return fail(communicator, memory ? report::ExitCode::resources : report::ExitCode::usage, error.what());
  }
  parallel::configure_log(communicator, loudness.level(input.output.log));
  try {
    choose_sandbox(communicator, input.sandbox);
  } catch (const parallel::CollectiveError& error) {
    return fail(communicator, report::ExitCode::resources, error.what());
  }
  return work(input);
}

void print(const Communicator& communicator, const std::string& text) {
  parallel::on_root(communicator, [&] { report::print_text(parallel::printable(text)); });
}

int fail(const Communicator& communicator, report::ExitCode code, const std::string& message) {
  if (communicator.is_root()) parallel::log_error(cases::with_keys(plain_words(message)));
  communicator.barrier();
  return static_cast<int>(code);
}

int guarded(const Communicator& communicator, report::ExitCode otherwise,
            const std::function<report::ExitCode()>& work) {
  try {
    const report::ExitCode code = work();
    communicator.barrier();
    return static_cast<int>(code);
  } catch (const std::invalid_argument& error) {
    return fail(communicator, report::ExitCode::usage, error.what());
  } catch (const parallel::CollectiveError& error) {
    return fail(communicator, code_of(error, otherwise), error.what());
  } catch (const parallel::SandboxInterrupted& error) {
    return fail(communicator, report::ExitCode::resources, error.what());
  } catch (const std::bad_alloc&) {
    parallel::give_up_without_memory();
    return fail(communicator, report::ExitCode::resources, parallel::out_of_memory_text());
  }
}

}  // namespace aeroloom::pipeline
