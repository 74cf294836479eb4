#include "geometry/sort_unique.hpp"
#include "parallel/communication/termination.hpp"
#include "parallel/storage/digest.hpp"
#include "pipeline/commands/commands.hpp"
#include "pipeline/commands/help.hpp"
#include "pipeline/commands/scaling_prediction.hpp"
#include "pipeline/output_lock.hpp"
#include "pipeline/report/library_versions.hpp"
#include "pipeline/report/page/html_text.hpp"
#include "pipeline/report/text_file.hpp"
#include "pipeline/run_identity.hpp"
#include "pipeline/study/comparison.hpp"
#include "pipeline/study/jobs.hpp"
#include "pipeline/study/page.hpp"
#include "pipeline/study/prediction_files.hpp"
#include "pipeline/study/results.hpp"
#include "pipeline/study/series.hpp"
#include "pipeline/study/table.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace aeroloom::pipeline {

namespace {

namespace fs = std::filesystem;

struct ScalingArguments : CaseArguments {
  std::vector<int> ranks;  ///< empty: the usual ones
  std::vector<std::string> series{"strong"};
  int repeats = 3, ranks_per_node = 0;
  std::string launcher, jobs, header, collected;
  std::vector<std::string> compared;
  bool keep = false, without_serial = false;
  PredictionArguments prediction;
};

/// Where the program itself is.
std::string own_path() {
  return fs::read_symlink("/proc/self/exe").string();
}

std::string versions_line() {
  std::string line = "aeroloom " + report::program_version();
  for (const auto& [name, version] : report::library_versions())
    line += fmt::format(", {} {}", name, version);
  return line;
}

/// The case without what says where its results go.
std::string subject_of(const cases::Case& input) {
  std::istringstream lines(cases::resolved_yaml(input));
  std::string text;
  bool is_output = false;
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty() && line.front() != ' ') is_output = line.starts_with("output:");
    if (!is_output) text += line + '\n';
  }
  return text;
}

study::CaseSize size_of(const cases::SizingRequest& request) {
  study::CaseSize size;
  if (!request.minimum || !request.maximum || request.target_tetrahedra) {
    size.target = request.target_tetrahedra.value_or(cases::default_target);
    return size;
  }
  const auto add = [&](const char* key, const std::optional<double>& length) {
    if (length && *length > 0) size.lengths.emplace_back(fmt::format("sizing.{}", key), *length);
  };
  add("minimum", request.minimum);
  add("feature_minimum", request.feature_minimum);
  add("maximum", request.maximum);
  add("surface_maximum", request.surface_maximum);
  add("chordal_deviation", request.chordal_deviation);
  return size;
}

void log_progress(const std::string& text) {
  parallel::log_info("scaling: " + text);
}

/// What a file of the study holds; no hash if it cannot be read, which its reader reports.
study::StudyInput file_by_content(const std::string& file) {
  study::StudyInput known{file, {}};
  if (file.empty() || !fs::is_regular_file(file)) return known;
  parallel::Digester digester;
  known.hash = digester.text(report::read_text(file)).result().text();
  return known;
}

study::StudyRecord make_record(const Invocation& invocation, const ScalingArguments& arguments,
                               const cases::Case& input) {
  study::StudyRecord record;
  study::StudyOptions& options = record.options;
  options.program = own_path();
  options.case_file = fs::absolute(arguments.file).string();
  options.overrides = arguments.overrides;
  options.directory = fs::absolute(input.output.directory).lexically_normal();
  options.ranks = arguments.ranks.empty() ? std::vector<int>{1, 2} : arguments.ranks;
  geometry::sort_unique(options.ranks);
  const auto wants = [&](const char* name) {
    return std::find(arguments.series.begin(), arguments.series.end(), name) != arguments.series.end();
  };
  options.strong = wants("strong");
  options.weak = wants("weak");
  options.serial = options.strong && !arguments.without_serial;
  options.repeats = arguments.repeats;
  options.ranks_per_node = arguments.ranks_per_node;
  record.subject = page::as_utf8(subject_of(input));
  record.versions = versions_line();
  const RunIdentity identity = identify_run(invocation.communicator, input);
  record.geometry = {input.domain.file.empty() ? identity.input : input.domain.file,
                     identity.is_known ? identity.digest.text() : std::string()};
  record.network = file_by_content(arguments.prediction.network);
  return record;
}

/// Runs of an earlier call that this one does not ask for stay in the study.
void add_earlier_runs(study::StudyRecord& record) {
  if (!study::holds_study(record.options.directory)) return;
  const study::StudyRecord earlier = study::load_study(record.options.directory);
  study::require_same_subject(earlier, record);
  if (earlier.network.hash != record.network.hash)
    log_progress("the network is described by another file than before: predictions are made anew");
  for (const study::RunSpec& run : earlier.runs) {
    const auto same = [&](const study::RunSpec& other) { return other.name() == run.name(); };
    if (std::none_of(record.runs.begin(), record.runs.end(), same)) record.runs.push_back(run);
  }
}

/// Adds the prediction of the other runs, and of some on more ranks, from that on the smallest number of
/// ranks.
void add_prediction(study::Json& study, const study::StudyRecord& record,
                    const std::vector<study::RunResult>& runs, const study::Network& network) {
  const study::RunResult* from = study::recorded_run(runs);
  if (from == nullptr) return;
  try {
    const std::vector<int> ranks = study::ranks_to_predict(runs);
    const fs::path folder = study::folder_of(record.options.directory, from->spec);
    study["prediction"] = study::prediction_json(
        study::forecast_ranks(study::read_costs(folder), from->spec.name(), ranks, network));
  } catch (const std::runtime_error& error) {
    log_progress(fmt::format("other numbers of ranks are not predicted: {}", error.what()));
  }
}

/// A run's own code, if the program ends with such. What a launcher or a queue made of it is none: the file
/// that the run should have left is missing.
report::ExitCode code_of_failed(const study::RunResult& run) {
  constexpr std::array documented{2, 3, 4, 5, 6, 7, 8, 70, 129, 130, 138, 143};
  for (const int code : {run.marks.code, run.reported_code})
    if (std::find(documented.begin(), documented.end(), code) != documented.end())
      return static_cast<report::ExitCode>(code);
  return report::ExitCode::files;
}

/// Tables, page, and the exit code: that of the first run that failed.
report::ExitCode write_study(const study::StudyRecord& record, const std::vector<study::RunResult>& runs,
                             const study::Network& network) {
  study::require_geometry(record, runs);
  study::require_equal_meshes(runs);
  const study::Machine machine = study::this_machine();
  const std::vector<study::SeriesRow> rows = study::make_rows(record, runs, machine);
  study::Json study = study::study_json(record, runs, rows, machine);
  add_prediction(study, record, runs, network);
  const std::string json = study.dump(1, ' ', false, study::Json::error_handler_t::replace) + "\n";
  const fs::path& folder = record.options.directory;
  report::replace_text((folder / "scaling.json").string(), json);
  report::replace_text((folder / "scaling.csv").string(), study::study_csv(runs));
  report::replace_text((folder / "scaling.html").string(), study::study_page(json));
  report::print_text(study::study_text(rows));
  log_progress((folder / "scaling.html").string());
  report::ExitCode code = report::ExitCode::ok;
  for (const study::RunResult& run : runs) {
    if (run.marks.state != study::RunState::failed) continue;
    if (code == report::ExitCode::ok) code = code_of_failed(run);
    log_progress(fmt::format("{} failed with code {}: {}", run.spec.name(), run.marks.code, run.failure));
  }
  return code;
}

report::ExitCode carry_out_study(const Invocation& invocation, const ScalingArguments& arguments,
                                 const cases::Case& input) {
  const parallel::LastWords last_words([](int) { study::end_lines(); });
  study::StudyRecord record = make_record(invocation, arguments, input);
  const study::Launcher launcher = study::make_launcher(arguments.launcher);
  std::vector<study::WeakScale> weak;
  if (record.options.weak) weak = study::scale_weakly(record.options, size_of(input.sizing), log_progress);
  record.runs = study::plan_runs(record.options, weak);
  add_earlier_runs(record);
  study::save(record);
  study::carry_out(record, launcher, arguments.keep, log_progress);
  return write_study(record, study::collect_runs(record), network_of(arguments.prediction));
}

report::ExitCode write_study_jobs(const Invocation& invocation, const ScalingArguments& arguments,
                                  const cases::Case& input) {
  const parallel::LastWords last_words([](int) { study::end_lines(); });
  study::StudyRecord record = make_record(invocation, arguments, input);
  std::vector<study::WeakScale> weak;
  if (record.options.weak) weak = study::scale_weakly(record.options, size_of(input.sizing), log_progress);
  record.runs = study::plan_runs(record.options, weak);
  add_earlier_runs(record);
  study::save(record);
  study::JobOptions jobs{fs::absolute(arguments.jobs).lexically_normal(), {}, arguments.launcher};
  if (!arguments.header.empty()) jobs.header = report::read_text(arguments.header);
  if (!jobs.header.empty() && !jobs.header.ends_with('\n')) jobs.header += '\n';
  study::write_jobs(record, jobs, [&](const std::vector<std::string>& settings) {
    return study::forecast_case(record.options, settings);
  });
  log_progress(fmt::format("{} jobs are in {}: submit.sh there submits them", record.runs.size(),
                           jobs.folder.string()));
  return report::ExitCode::ok;
}

report::ExitCode collect_study(const ScalingArguments& arguments) {
  const fs::path jobs = fs::absolute(arguments.collected).lexically_normal();
  study::StudyRecord record = study::load_study(study::results_of_jobs(jobs));
  record.network = file_by_content(arguments.prediction.network);
  const std::vector<study::RunResult> runs = study::collect_runs(record, study::query_queue(jobs));
  for (const study::RunResult& run : runs)
    if (run.figures && !arguments.keep)
      study::remove_meshes(study::folder_of(record.options.directory, run.spec));
  return write_study(record, runs, network_of(arguments.prediction));
}

report::ExitCode compare_studies(const ScalingArguments& arguments) {
  const auto study_in = [](const fs::path& place) {
    return study::read_study(fs::is_directory(place) ? place / "scaling.json" : place);
  };
  const study::Json before = study_in(arguments.compared[0]), after = study_in(arguments.compared[1]);
  report::print_text(study::compare_text(before, after));
  return report::ExitCode::ok;
}

void add_options(CLI::App& app, ScalingArguments& arguments) {
  app.add_option("case", arguments.file, "the case, a YAML file (docs/configuration)")
      ->type_name(file_kind::of_case);
  add_overrides(app, arguments);
  app.add_option("--ranks", arguments.ranks, "numbers of ranks, as 1,2,4,8; 1,2 by default")
      ->delimiter(',')
      ->check(CLI::Range(1, 1000000))
      ->type_name("N,...");
  app.add_option("--series", arguments.series,
                 "strong: one mesh by more ranks; weak: a mesh that grows with them; or both")
      ->delimiter(',')
      ->check(CLI::IsMember({"strong", "weak"}))
      ->type_name("{strong,weak}");
  app.add_option("--repeats", arguments.repeats, "runs of each kind; medians count")
      ->check(CLI::Range(1, 1000))
      ->type_name("N");
  app.add_option("--launcher", arguments.launcher,
                 "how runs are started: a shell line with {ranks}, {nodes}, {command}")
      ->type_name("LINE");
  app.add_option("--ranks-per-node", arguments.ranks_per_node, "ranks on one node; all on one by default")
      ->check(CLI::Range(1, 1000000))
      ->type_name("N");
  app.add_flag("--no-serial", arguments.without_serial,
               "leave out one rank in one piece, where one node does not hold the mesh");
  app.add_flag("--keep", arguments.keep, "keep the meshes; by default a mesh goes once its hash is known");
  CLI::Option* jobs =
      app.add_option("--write-jobs", arguments.jobs, "write job scripts into a folder instead of running")
          ->type_name("DIR");
  app.add_option("--job-header", arguments.header, "lines for every job script: account, partition, modules")
      ->needs(jobs)
      ->type_name(file_kind::any);
  CLI::Option* collect =
      app.add_option("--collect", arguments.collected, "read what jobs of that folder have left")
          ->type_name("DIR");
  CLI::Option* compare = app.add_option("--compare", arguments.compared, "two studies side by side")
                             ->expected(2)
                             ->type_name("OLD NEW");
  jobs->excludes(collect);
  compare->excludes(jobs)->excludes(collect);
  for (CLI::Option* other : add_prediction_options(app, arguments.prediction))
    other->excludes(jobs)->excludes(collect)->excludes(compare);
}

int run_scaling(const Invocation& invocation, const ScalingArguments& arguments) {
  const bool measures = !arguments.prediction.measured.empty();
  if (invocation.communicator.size() > 1 && !measures)
    return fail(invocation, report::ExitCode::usage,
                "scaling starts the ranks of its runs itself. Remedy: call it without a launcher");
  const auto guard = [&](const std::function<report::ExitCode()>& work) {
    return guarded(invocation, report::ExitCode::files, [&] {
      try {
        return work();
      } catch (const parallel::CollectiveError&) {
        throw;
      } catch (const std::runtime_error& error) {
        throw parallel::CollectiveError(parallel::FailureKind::files, error.what());
      }
    });
  };
  invocation.configure_log();
  if (measures) return guard([&] { return measure_network(invocation, arguments.prediction.measured); });
  if (!arguments.prediction.run.empty())
    return guard([&] { return predict_run(arguments.prediction, arguments.ranks); });
  if (!arguments.compared.empty()) return guard([&] { return compare_studies(arguments); });
  if (!arguments.collected.empty()) return guard([&] { return collect_study(arguments); });
  if (arguments.file.empty())
    return fail(invocation, report::ExitCode::usage, "scaling needs a case: aeroloom scaling case.yaml");
  return with_case(invocation, arguments, [&](const cases::Case& input) {
    return guard([&] {
      fs::create_directories(input.output.directory);
      const OutputLock lock(invocation.communicator, input.output.directory);
      return arguments.jobs.empty() ? carry_out_study(invocation, arguments, input)
                                    : write_study_jobs(invocation, arguments, input);
    });
  });
}

}  // namespace

Command add_scaling(CLI::App& program) {
  CLI::App* app =
      program.add_subcommand("scaling", "how a case scales: a series of runs, its tables and its page");
  const auto arguments = std::make_shared<ScalingArguments>();
  add_options(*app, *arguments);
  add_help_footer(
      *app,
      {{"aeroloom scaling case.yaml --ranks 1,2,4", "three runs of each; the page is out/scaling.html"},
       {"aeroloom scaling case.yaml --ranks 1,2 --series strong,weak --repeats 1",
        "two series, each line once"},
       {"aeroloom scaling case.yaml --ranks 64,128,256 --write-jobs jobs --job-header account.txt",
        "scripts for a queue; sh jobs/submit.sh submits them"},
       {"aeroloom scaling --collect jobs", "what they have left so far"},
       {"aeroloom scaling --compare before/out after/out", "two studies side by side"},
       {"aeroloom scaling --predict out --ranks 1,16,256,4096", "what that run would take on more ranks"},
       {"mpirun -n 2 aeroloom scaling --measure-network network.json",
        "latency and bandwidth, for --predict out --network network.json"}},
      {report::ExitCode::ok, report::ExitCode::usage, report::ExitCode::files, report::ExitCode::resources,
       report::ExitCode::bug});
  return {app, [arguments](const Invocation& invocation) { return run_scaling(invocation, *arguments); }};
}

}  // namespace aeroloom::pipeline
