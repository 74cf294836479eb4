#include "pipeline/report/report.hpp"

#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/log.hpp"
#include "pipeline/report/html.hpp"
#include "pipeline/report/task_table.hpp"
#include "pipeline/report/text_file.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>

#include <fmt/chrono.h>
#include <fmt/format.h>

namespace aeroloom::report {
namespace {

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

/// What remains to be acted on, where a long log may have hidden it.
std::string summary_of(const parallel::Warnings& warnings) {
  constexpr std::size_t most_shown = 10;  // lines; the report has all
  if (warnings.kept.empty()) return {};
  std::string text =
      fmt::format("warnings: {}\n", static_cast<std::int64_t>(warnings.kept.size()) + warnings.left_out);
  for (std::size_t i = 0; i < std::min(most_shown, warnings.kept.size()); ++i)
    text += fmt::format("  {}\n", warnings.kept[i].message);
  if (warnings.kept.size() > most_shown) text += "  and more, see report.html\n";
  return text;
}

}  // namespace

std::string write_report(const parallel::Communicator& communicator, const cases::Case& input,
                         const RunRecord& record, const RunOutcome& outcome, const ReportSubject& subject) {
  ReportFacts facts{outcome, subject, communicator.size(), record.clock.summarise(communicator), {}, {}};
  facts.warnings = parallel::take_warnings(communicator);
  facts.date = utc_now();
  facts.tasks = task_table(communicator, record.clock);
  parallel::on_root(communicator, [&] {
    const std::string& folder = input.output.directory;
    std::error_code ignored;  // what an earlier run has left and cannot go stays
    if (input.output.tasks)
      replace_text(folder + "/tasks.csv", facts.tasks);
    else
      std::filesystem::remove(folder + "/tasks.csv", ignored);
    const std::string json = report_json(input, record, facts);
    replace_text(folder + "/report.json", json);
    const std::string page = page_of(json, record);
    if (page.empty())
      std::filesystem::remove(folder + "/report.html", ignored);
    else
      replace_text(folder + "/report.html", page);
  });
  if (!communicator.is_root()) return {};
  return report_table(record, facts.stages, communicator.size()) + summary_of(facts.warnings);
}

void write_last_report(const cases::Case& input, const RunOutcome& outcome, const ReportSubject& subject,
                       int ranks) {
  const std::string& folder = input.output.directory;
  replace_text(folder + "/report.json", report_json(input, {}, {outcome, subject, ranks, {}, {}, utc_now()}));
  std::error_code ignored;  // a page of an earlier run that cannot go stays
  std::filesystem::remove(folder + "/report.html", ignored);
}

}  // namespace aeroloom::report
