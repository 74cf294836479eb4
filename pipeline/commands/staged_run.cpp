#include "pipeline/commands/staged_run.hpp"

#include "io/file_formats.hpp"
#include "parallel/communication/termination.hpp"
#include "parallel/observation/log.hpp"
#include "parallel/observation/memory_limit.hpp"
#include "pipeline/commands/plain_words.hpp"
#include "pipeline/output_lock.hpp"
#include "pipeline/stage.hpp"
#include "pipeline/write_outputs.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

namespace aeroloom::pipeline {

namespace {

/// By rank 0, unless facts are not wanted.
void print_facts(std::string text) {
  while (text.ends_with('\n')) text.pop_back();
  parallel::log_info(text);
}

void warn_of_older(const std::vector<std::string>& files, const std::string& folder) {
  if (files.empty()) return;
  parallel::log_warning(fmt::format("in '{}', not of this run: {}", folder, fmt::join(files, ", ")));
}

/// Hours of meshing are not lost on a folder that was mistyped.
void require_writable_folder(const Invocation& invocation, const std::string& folder) {
  parallel::on_root(invocation.communicator, [&] {
    std::filesystem::create_directories(folder);
    if (::access(folder.c_str(), W_OK | X_OK) != 0)
      throw std::filesystem::filesystem_error("cannot write into", folder,
                                              std::error_code(errno, std::generic_category()));
  });
}

}  // namespace

int run_stages(const Invocation& invocation, const cases::Case& input, const report::ReportSubject& subject,
               const std::function<void(report::RunRecord&)>& stages) {
  const parallel::Communicator& communicator = invocation.communicator;
  std::optional<OutputLock> lock;
  try {
    require_writable_folder(invocation, input.output.directory);
    lock.emplace(communicator, input.output.directory);
    parallel::on_root(communicator, [&] { require_free_places(input.output); });
  } catch (const parallel::CollectiveError& error) {
    return fail(invocation, report::ExitCode::files, fmt::format("output.directory: {}", error.what()));
  }
  std::optional<EarlierFiles> earlier;  // rank 0 looks at the folder
  if (communicator.is_root()) earlier.emplace(input.output);
  const parallel::LastWords last_words([&, ranks = communicator.size()](int signal) {
    const bool keeps = input.output.checkpoints != cases::CheckpointUse::none;
    report::RunOutcome ended{
        static_cast<report::ExitCode>(128 + signal), current_stage(),
        fmt::format("ended by SIG{}; {}", sigabbrev_np(signal),
                    keeps ? "what checkpoints have kept is found by --resume"
                          : "nothing is kept for another run (--checkpoints does that)")};
    try {
      if (earlier) warn_of_older(ended.older_files = earlier->left(), input.output.directory);
      report::write_last_report(input, ended, subject, ranks);
    } catch (const std::exception& error) {
      parallel::log_error(fmt::format("the report cannot be written: {}", error.what()));
    }
  });
  report::RunRecord record;
  report::RunOutcome outcome;
  const double age = parallel::process_age_seconds(), begin = parallel::wall_seconds();
  record.clock.note("start", age);
  try {
    stages(record);
  } catch (const report::StageFailure& failure) {
    outcome = {failure.code(), failure.stage(), plain_words(failure.what())};
  }
  record.wall_seconds = age + parallel::wall_seconds() - begin;
  if (earlier) warn_of_older(outcome.older_files = earlier->left(record.hash), input.output.directory);
  try {
    const std::string table = report::write_report(communicator, input, record, outcome, subject);
    if (outcome.code == report::ExitCode::ok) print_facts(table);
  } catch (const parallel::CollectiveError& error) {
    if (outcome.code == report::ExitCode::ok)
      outcome = {code_of(error, report::ExitCode::files), "output", plain_words(error.what())};
    else
      outcome.message += fmt::format("\n  the report cannot be written: {}", error.what());
  } catch (const std::bad_alloc&) {
    parallel::give_up_without_memory();
    if (outcome.code == report::ExitCode::ok)
      outcome = {report::ExitCode::resources, "output", parallel::out_of_memory_text()};
  }
  if (outcome.code != report::ExitCode::ok) {
    return fail(invocation, outcome.code, fmt::format("stage {} failed: {}", outcome.stage, outcome.message));
  }
  for (const io::FileFormat format : input.output.formats) {
    const std::string path = std::filesystem::absolute(path_of(input.output, format)).string();
    print_facts(fmt::format("{}: {}", io::row_of(format).announcement, path));
  }
  const std::filesystem::path page = std::filesystem::absolute(input.output.directory) / "report.html";
  std::error_code ignored;  // what cannot be looked at is not there
  if (std::filesystem::exists(page, ignored)) print_facts("report: " + page.string());
  return 0;
}

}  // namespace aeroloom::pipeline
