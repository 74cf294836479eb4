#include "pipeline/commands/command.hpp"

#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/memory_limit.hpp"
#include "parallel/sandbox/sandbox.hpp"
#include "pipeline/case/option_keys.hpp"
#include "pipeline/commands/help.hpp"
#include "pipeline/commands/plain_words.hpp"
#include "pipeline/mesh_case.hpp"
#include "pipeline/report/text_file.hpp"
#include "pipeline/stage.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace aeroloom::pipeline {

void Invocation::configure_log(parallel::LogLevel otherwise) const {
  const parallel::LogLevel talkative = loudness.verbose ? parallel::LogLevel::verbose : otherwise;
  parallel::configure_log(communicator, loudness.quiet ? parallel::LogLevel::quiet : talkative);
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

/// Collective: throws CollectiveError where a rank has no child processes although the case asks for a
/// sandbox.
void choose_sandbox(const Invocation& invocation, parallel::Sandbox sandbox) {
  if (sandbox == parallel::Sandbox::none) parallel::run_without_sandbox(invocation.communicator);
  parallel::agree(invocation.communicator, [&] {
    if (sandbox == parallel::Sandbox::none || parallel::sandbox_refusal().empty()) return;
    throw std::runtime_error(
        fmt::format("this machine allows no child processes ({}), which keep crashes of the CAD library and "
                    "of TetGen from "
                    "ending the run. Remedy: parallel.sandbox: none",
                    parallel::sandbox_refusal()));
  });
}

}  // namespace

int with_case(const Invocation& invocation, const CaseArguments& arguments,
              const std::function<int(const cases::Case&)>& work) {
  const parallel::Communicator& communicator = invocation.communicator;
  invocation.configure_log();
  cases::Case input;
  try {
    if (arguments.file.empty())
      parallel::agree(communicator, [&] { input = cases::case_of_overrides(arguments.overrides); });
    else
      input = read_case(communicator, arguments.file, arguments.overrides);
  } catch (const parallel::CollectiveError& error) {
    const bool memory = error.kind() == parallel::FailureKind::resources;
    return fail(invocation, memory ? report::ExitCode::resources : report::ExitCode::usage, error.what());
  }
  invocation.configure_log(input.output.log);
  try {
    choose_sandbox(invocation, input.sandbox);
  } catch (const parallel::CollectiveError& error) {
    return fail(invocation, report::ExitCode::resources, error.what());
  }
  return work(input);
}

void print(const Invocation& invocation, const std::string& text) {
  parallel::on_root(invocation.communicator, [&] { report::print_text(parallel::printable(text)); });
}

int fail(const Invocation& invocation, report::ExitCode code, const std::string& message) {
  if (invocation.communicator.is_root()) parallel::log_error(cases::with_keys(plain_words(message)));
  invocation.communicator.barrier();
  return static_cast<int>(code);
}

int guarded(const Invocation& invocation, report::ExitCode otherwise,
            const std::function<report::ExitCode()>& work) {
  try {
    const report::ExitCode code = work();
    invocation.communicator.barrier();
    return static_cast<int>(code);
  } catch (const std::invalid_argument& error) {
    return fail(invocation, report::ExitCode::usage, error.what());
  } catch (const parallel::CollectiveError& error) {
    return fail(invocation, code_of(error, otherwise), error.what());
  } catch (const parallel::SandboxInterrupted& error) {
    return fail(invocation, report::ExitCode::resources, error.what());
  } catch (const std::bad_alloc&) {
    parallel::give_up_without_memory();
    return fail(invocation, report::ExitCode::resources, parallel::out_of_memory_text());
  }
}

}  // namespace aeroloom::pipeline
