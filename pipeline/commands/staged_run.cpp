#include "pipeline/commands/staged_run.hpp"

#include "pipeline/report.hpp"
#include "pipeline/stage.hpp"
#include "pipeline/task_table.hpp"
#include "pipeline/write_outputs.hpp"

#include <filesystem>
#include <fstream>

#include <fmt/format.h>

namespace aeroloom::pipeline {
namespace {

using parallel::Communicator;

void write_text(const std::string& file, const std::string& text) {
  std::filesystem::create_directories(std::filesystem::path(file).parent_path());
  std::ofstream stream(file);
  stream << text;
  stream.close();
  if (!stream) throw std::ios_base::failure("cannot write '" + file + "'");
}

/// By rank 0, unless facts are not wanted.
void tell(std::string text) {
  while (text.ends_with("\n")) text.pop_back();
  parallel::log_info(text);
}

/// Writes report.json for a run that ended well or not. Collective; what goes wrong here replaces a good
/// outcome.
void report(const Communicator& communicator, const Case& input, const std::string& improved_file,
            const RunRecord& record, const RunOutcome& outcome) {
  const auto stages = record.clock.summarise(communicator);
  const std::string tasks = input.output.tasks ? task_table(communicator, record.clock) : "";
  parallel::agree(communicator, [&] {
    if (!communicator.is_root()) return;
    if (input.output.tasks) write_text(input.output.directory + "/tasks.csv", tasks);
    write_text(input.output.directory + "/report.json",
               improved_file.empty()
                   ? report_json(input, record, stages, outcome, communicator.size())
                   : improve_report_json(improved_file, input, record, stages, outcome, communicator.size()));
  });
  if (outcome.code == ExitCode::ok) tell(report_table(record, stages, communicator.size()));
}

}  // namespace

int run_stages(const Communicator& communicator, const Case& input, const std::string& improved_file,
               const std::function<void(RunRecord&)>& stages) {
  RunRecord record;
  RunOutcome outcome;
  const double age = parallel::process_age_seconds(), begin = parallel::wall_seconds();
  record.clock.note("start", age);
  try {
    stages(record);
  } catch (const StageFailure& failure) {
    outcome = {failure.code(), failure.stage(), failure.what()};
  }
  record.wall_seconds = age + parallel::wall_seconds() - begin;
  try {
    report(communicator, input, improved_file, record, outcome);
  } catch (const parallel::CollectiveError& error) {
    if (outcome.code == ExitCode::ok) outcome = {ExitCode::files, "output", error.what()};
  }
  if (outcome.code != ExitCode::ok) {
    return fail(communicator, outcome.code,
                fmt::format("stage {} failed: {}", outcome.stage, outcome.message));
  }
  for (const io::FileFormat format : input.output.formats) {
    const std::string path = std::filesystem::absolute(path_of(input.output, format)).string();
    tell(fmt::format("{}: {}", format == io::FileFormat::vtu ? "open in ParaView" : "mesh", path));
  }
  return 0;
}

}  // namespace aeroloom::pipeline
