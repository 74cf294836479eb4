#include "pipeline/report.hpp"

#include "parallel/collective_error.hpp"
#include "parallel/log.hpp"
#include "pipeline/report/html.hpp"
#include "pipeline/task_table.hpp"

#include <chrono>
#include <filesystem>
#include <fstream>

#include <fmt/chrono.h>
#include <fmt/format.h>

namespace aeroloom::pipeline {
namespace {

/// What was there before goes only when all of the new text is on disk.
void write_text(const std::string& file, const std::string& text) {
  const std::string unfinished = file + ".unfinished";
  std::filesystem::create_directories(std::filesystem::path(file).parent_path());
  std::ofstream stream(unfinished, std::ios::binary);
  stream << text;
  stream.close();
  std::error_code error;
  if (stream) std::filesystem::rename(unfinished, file, error);
  if (stream && !error) return;
  std::filesystem::remove(unfinished, error);
  throw std::ios_base::failure("cannot write '" + file + "'");
}

std::string utc_now() {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::chrono::system_clock::now()));
}

/// A page that cannot be made is no reason to lose a mesh: the numbers are in report.json.
std::string page_of(const std::string& json, const RunRecord& record) {
  try {
    return report_html(json, record.pictures);
  } catch (const std::exception& error) {
    parallel::log_warning(fmt::format("report.html cannot be made: {}", error.what()));
    return {};
  }
}

}  // namespace

std::string write_report(const parallel::Communicator& communicator, const Case& input,
                         const RunRecord& record, const RunOutcome& outcome, const ReportSubject& subject) {
  ReportFacts facts{outcome, subject, communicator.size(), record.clock.summarise(communicator), {}, {}};
  facts.warnings = parallel::take_warnings(communicator);
  facts.date = utc_now();
  const std::string tasks = input.output.tasks ? task_table(communicator, record.clock) : "";
  parallel::agree(communicator, [&] {
    if (!communicator.is_root()) return;
    const std::string& folder = input.output.directory;
    if (input.output.tasks) write_text(folder + "/tasks.csv", tasks);
    const std::string json = report_json(input, record, facts);
    write_text(folder + "/report.json", json);
    const std::string page = page_of(json, record);
    if (!page.empty()) write_text(folder + "/report.html", page);
  });
  return communicator.is_root() ? report_table(record, facts.stages, communicator.size()) : "";
}

}  // namespace aeroloom::pipeline
