#include "pipeline/study/results.hpp"

#include "pipeline/study/comparison.hpp"
#include "pipeline/study/launcher.hpp"
#include "pipeline/study/page.hpp"
#include "pipeline/study/processor_use.hpp"
#include "pipeline/study/table.hpp"
#include "tests/pipeline/study/studies.hpp"

#include <algorithm>

#include <gtest/gtest.h>

namespace aeroloom::study {
namespace {

Machine machine_of(int processors) {
  Machine machine;
  machine.host = "<here>";
  machine.processors = processors;
  return machine;
}

/// A strong series that halves its time twice as it should, and a weak one that loses a fifth.
void leave_all(const StudyRecord& study) {
  for (const RunSpec& run : study.runs) {
    const double noise = 0.1 * (run.repeat - 1);
    const double wall = (run.series == Series::serial   ? 8.0
                         : run.series == Series::strong ? 10.0 / run.ranks
                                                        : 10 + (run.ranks > 1 ? 2.5 : 0)) +
                        noise;
    const double tets = run.series == Series::weak ? 1e5 * run.ranks : 1e5;
    leave_report(folder_of(study.options.directory, run), wall, tets,
                 run.series == Series::serial ? "piece" : fmt::format("{}", tets), 8.0 / run.ranks);
  }
}

const SeriesRow& row_of(const std::vector<SeriesRow>& rows, Series series, int ranks) {
  return *std::find_if(rows.begin(), rows.end(),
                       [&](const SeriesRow& row) { return row.series == series && row.ranks == ranks; });
}

TEST(Results, MarksTellHowFarARunIs) {
  const StudyFolder folder("marks");
  EXPECT_EQ(read_marks(folder.path).state, RunState::planned);
  mark_begin(folder.path, 17);
  EXPECT_EQ(read_marks(folder.path).state, RunState::begun);
  EXPECT_EQ(read_marks(folder.path).process, 17);
  mark_end(folder.path, 143);
  EXPECT_EQ(read_marks(folder.path).state, RunState::failed);
  mark_begin(folder.path, 18);
  mark_end(folder.path, 0);
  const RunMarks marks = read_marks(folder.path);
  EXPECT_EQ(marks.state, RunState::ended);
  EXPECT_EQ(marks.attempts, 2);
}

TEST(Results, SpeedUpIsAgainstOneRankInOnePiece) {
  const StudyFolder folder("rows");
  const StudyRecord study = a_study(folder.path, {1, 2}, 3, {{1, {}}, {2, {}}});
  leave_all(study);
  const std::vector<RunResult> runs = collect_runs(study);
  EXPECT_NO_THROW(require_equal_meshes(runs));
  const std::vector<SeriesRow> rows = make_rows(study, runs, machine_of(2));
  ASSERT_EQ(rows.size(), 5U);
  const SeriesRow& two = row_of(rows, Series::strong, 2);
  EXPECT_EQ(two.ended, 3);
  EXPECT_FALSE(two.by_cpu);
  EXPECT_NEAR(two.median.wall, 5.1, 1e-12);  // the median of 5, 5.1, 5.2
  EXPECT_NEAR(two.speedup, 8.1 / 5.1, 1e-12);
  EXPECT_NEAR(two.speedup_of_series, 10.1 / 5.1, 1e-12);
  EXPECT_NEAR(two.efficiency, 8.1 / 5.1 / 2, 1e-12);
  EXPECT_NEAR(two.median.imbalance, 4.0 / 2.1, 1e-9);
  EXPECT_NEAR(row_of(rows, Series::weak, 2).efficiency, 10.1 / 12.6, 1e-12);
}

TEST(Results, MoreRanksThanProcessorsAreJudgedByCpu) {
  const StudyFolder folder("cpu");
  const StudyRecord study = a_study(folder.path, {1, 2}, 1);
  leave_all(study);
  const std::vector<SeriesRow> rows = make_rows(study, collect_runs(study), machine_of(1));
  const SeriesRow& two = row_of(rows, Series::strong, 2);
  EXPECT_TRUE(two.by_cpu);
  EXPECT_NEAR(two.seconds(), 4, 1e-12);
  EXPECT_NEAR(two.speedup, 2, 1e-12);
  EXPECT_NE(study_text(rows).find("* more ranks than processors"), std::string::npos);
}

TEST(Results, TwoRepeatsHaveAMedian) {
  const StudyFolder folder("two");
  const StudyRecord study = a_study(folder.path, {1, 2}, 2);
  leave_all(study);
  const std::vector<SeriesRow> rows = make_rows(study, collect_runs(study), machine_of(2));
  const SeriesRow& two = row_of(rows, Series::strong, 2);
  EXPECT_NEAR(two.seconds(), 5.05, 1e-12);  // of 5 and 5.1
  EXPECT_NEAR(two.median.stages[1].wall, 0.75 * 5.05, 1e-12);
  EXPECT_NEAR(two.speedup, 8.05 / 5.05, 1e-12);
  EXPECT_NEAR(two.least, 5, 1e-12);
}

TEST(Results, ABusyMachineIsShown) {
  const StudyFolder folder("busy");
  const StudyRecord study = a_study(folder.path, {1, 2}, 1);
  leave_all(study);
  const auto page = [&] {
    const std::vector<RunResult> runs = collect_runs(study);
    const std::vector<SeriesRow> rows = make_rows(study, runs, machine_of(2));
    return study_text(rows) + study_page(study_json(study, runs, rows, machine_of(2)).dump());
  };
  EXPECT_EQ(page().find("The machine was busy"), std::string::npos) << "nobody knows";
  for (const auto& [beside, is_busy] : {std::pair(0.2, false), std::pair(1.34, true)}) {
    const std::filesystem::path run = folder_of(folder.path, study.runs[2]);
    mark_end(run, 0, beside);
    EXPECT_EQ(
        page().find("during 1 of the runs other programs used more than half a processor, up to 1.3 of 2") !=
            std::string::npos,
        is_busy);
    EXPECT_EQ(page().find("other programs used up to 1.3 processors during a run.") != std::string::npos,
              is_busy);
  }
}

TEST(Results, OwnRanksMakeNoMachineBusy) {
  EXPECT_NEAR(*busy_beside({10, 3}, {16, 7}, 4), 0.5, 1e-12);
  EXPECT_EQ(busy_beside({10, 3}, {14, 8}, 4), 0) << "clocks of the system are coarse";
  EXPECT_FALSE(busy_beside({0, 3}, {0, 8}, 4)) << "a system that does not tell";
  const StudyFolder folder("own");
  const ProcessorUse before = processor_use();
  run_line("i=0; while [ $i -lt 100000 ]; do i=$((i + 1)); done", folder.path / "log");
  EXPECT_GT(processor_use().of_children, before.of_children);
}

TEST(Results, ChartsJoinNoCpuWithTheClock) {
  const StudyFolder folder("kinds");
  const StudyRecord study = a_study(folder.path, {1, 2, 4, 8}, 1);
  leave_all(study);
  const std::vector<RunResult> runs = collect_runs(study);
  const std::string page =
      study_page(study_json(study, runs, make_rows(study, runs, machine_of(2)), machine_of(2)).dump());
  std::size_t parted = 0;
  for (std::size_t at = page.find("<path class=\"stroke"); at != std::string::npos;
       at = page.find("<path class=\"stroke", at + 1)) {
    const std::string path = page.substr(at, page.find("/>", at) - at);
    if (std::count(path.begin(), path.end(), 'M') == 2) ++parted;
  }
  EXPECT_EQ(parted, 4U) << "both speed-ups, efficiency, rate";
  EXPECT_NE(page.find("strong, by CPU"), std::string::npos);
}

TEST(Results, DifferentMeshesAreNamed) {
  const StudyFolder folder("hashes");
  const StudyRecord study = a_study(folder.path, {1, 2}, 2);
  leave_all(study);
  leave_report(folder_of(folder.path, study.runs[2]), 5, 1e5, "other");
  try {
    require_equal_meshes(collect_runs(study));
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("'strong_1_1' and 'strong_2_1'"), std::string::npos)
        << error.what();
  }
}

TEST(Results, RunsOnOtherGeometryAreNotDone) {
  const StudyFolder folder("changed");
  StudyRecord study = a_study(folder.path, {1}, 1);
  leave_all(study);
  study.geometry = {"wing.step", "f00d"};
  EXPECT_TRUE(is_done(study, collect_runs(study)[0]));
  EXPECT_NO_THROW(require_geometry(study, collect_runs(study)));
  study.geometry.hash = "beef";
  EXPECT_FALSE(is_done(study, collect_runs(study)[0]));
  EXPECT_THROW(require_geometry(study, collect_runs(study)), std::runtime_error);
}

TEST(Results, WhatFailedIsShownAsThat) {
  const StudyFolder folder("failed");
  const StudyRecord study = a_study(folder.path, {1, 2}, 1);
  leave_all(study);
  const std::filesystem::path failed = folder_of(folder.path, study.runs[2]);
  std::filesystem::remove(failed / "report.json");
  write_file(failed / "log", "volume: 3 of 9\nerror: out of memory <here>\n\n");
  mark_begin(failed, 3);
  mark_end(failed, 8);
  const std::filesystem::path begun = folder_of(folder.path, study.runs[1]);
  std::filesystem::remove(begun / "marks");
  mark_begin(begun, 4);
  const std::vector<RunResult> runs = collect_runs(study, {{"strong_1_1", "job 7 RUNNING 0:0"}});
  EXPECT_EQ(runs[2].marks.state, RunState::failed);
  EXPECT_EQ(runs[2].failure, "error: out of memory <here>");
  EXPECT_EQ(runs[1].marks.state, RunState::begun);
  EXPECT_EQ(runs[1].failure, "queue: job 7 RUNNING 0:0");
  const std::vector<SeriesRow> rows = make_rows(study, runs, machine_of(2));
  EXPECT_EQ(row_of(rows, Series::strong, 2).failed, 1);
  const std::string page = study_page(study_json(study, runs, rows, machine_of(2)).dump());
  EXPECT_NE(page.find("out of memory &lt;here&gt;"), std::string::npos);
  EXPECT_EQ(page.find("<here>"), std::string::npos);
}

TEST(Results, TableAndPageHaveAllRuns) {
  const StudyFolder folder("page");
  const StudyRecord study = a_study(folder.path, {1, 2}, 2, {{1, {}}, {2, {}}});
  leave_all(study);
  const std::vector<RunResult> runs = collect_runs(study);
  const std::vector<SeriesRow> rows = make_rows(study, runs, machine_of(2));
  const std::string csv = study_csv(runs);
  const auto commas = [](const std::string& line) { return std::count(line.begin(), line.end(), ','); };
  std::istringstream lines(csv);
  std::string head;
  std::getline(lines, head);
  std::size_t count = 0;
  for (std::string line; std::getline(lines, line); ++count) EXPECT_EQ(commas(line), commas(head)) << line;
  EXPECT_EQ(count, study.runs.size());
  const Json json = study_json(study, runs, rows, machine_of(2));
  const std::string page = study_page(json.dump());
  for (const char* part : {"Speed-up of the strong series", "class=\"ideal\"", "Efficiency", "Time per stage",
                           "weak_2_2", "&lt;here&gt;", "minimum: 1"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
  EXPECT_EQ(page.find("://"), std::string::npos);
  EXPECT_NE(compare_text(json, json).find("1.000"), std::string::npos);
  EXPECT_NE(compare_text(json, json).find("the same"), std::string::npos);
}

/// What a study says of a file that is cut, after each of its first letters and where the whole is another.
TEST(Results, DamagedFilesOfAStudyAreNamed) {
  const StudyFolder folder("damaged");
  const StudyRecord study = a_study(folder.path, {1}, 1);
  leave_all(study);
  const std::vector<RunResult> runs = collect_runs(study);
  const std::filesystem::path file = folder.path / "scaling.json";
  const auto refusal_of = [&](const std::string& text) -> std::string {
    write_file(file, text);
    try {
      read_study(file);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  const Json whole = study_json(study, runs, make_rows(study, runs, machine_of(2)), machine_of(2));
  EXPECT_EQ(refusal_of(whole.dump()), "");
  for (const std::size_t letters : {0UL, 1UL, 20UL, whole.dump().size() - 1})
    EXPECT_NE(
        refusal_of(whole.dump().substr(0, letters)).find("scaling.json' is not whole JSON: parse error"),
        std::string::npos)
        << letters;
  for (const char* other : {"[]", "1", "null", "\"rows\""})
    EXPECT_NE(refusal_of(other).find("scaling.json' is not"), std::string::npos) << other;
  EXPECT_NE(refusal_of("{}").find("it has no list 'rows'"), std::string::npos);
  EXPECT_NE(refusal_of("{\"rows\": [7]}").find("rows[0] has no text 'series'"), std::string::npos);
  for (const char* key : {"series", "ranks", "ended", "judged_by", "wall_seconds", "efficiency", "hash"}) {
    Json part = whole;
    part["rows"][1].erase(key);
    EXPECT_NE(refusal_of(part.dump()).find(fmt::format("'{}'", key)), std::string::npos) << key;
    part["rows"][1][key] = Json::array();
    EXPECT_NE(refusal_of(part.dump()).find(fmt::format("rows[1] has no")), std::string::npos) << key;
  }
}

TEST(Results, RunsWithoutAReportHaveFailed) {
  const StudyFolder folder("reports");
  const StudyRecord study = a_study(folder.path, {1}, 1);
  const std::filesystem::path run = folder_of(folder.path, study.runs[1]);
  const auto said = [&](const std::string& report) {
    leave_report(run, 1, 1, "x");
    std::filesystem::remove(run / "report.json");
    if (!report.empty()) write_file(run / "report.json", report);
    const RunResult result = collect_runs(study)[1];
    EXPECT_EQ(result.marks.state, RunState::failed) << report;
    EXPECT_FALSE(result.figures) << report;
    return result.failure;
  };
  write_file(run / "log", "sh: mpirun: not found\n");
  EXPECT_EQ(said(""), "ended with 0 without a report; its log: sh: mpirun: not found");
  for (const char* report :
       {"{\"status\": \"ok\", \"wall_sec", "[1]", "{\"status\": \"ok\"}", "{\"status\": \"ok\", \"mesh\": 1}",
        "{\"status\": \"ok\", \"mesh\": {}, \"stages\": 7}"})
    EXPECT_NE(said(report).find("ended with 0 with a report that is not that of a finished run"),
              std::string::npos)
        << report << "\n"
        << said(report);
  EXPECT_NE(said("{\"status\": 1, \"failure\": [\"stage\"]}").find("ended with 0 with a report that tells"),
            std::string::npos);
}

TEST(Results, MeshesGoAndReportsStay) {
  const StudyFolder folder("meshes");
  leave_report(folder.path, 1, 1, "x");
  write_file(folder.path / "mesh" / "mesh_0.vtu", "much");
  write_file(folder.path / "mesh.pvtu", "little");
  remove_meshes(folder.path);
  EXPECT_TRUE(std::filesystem::exists(folder.path / "report.json"));
  EXPECT_TRUE(std::filesystem::exists(folder.path / "marks"));
  EXPECT_FALSE(std::filesystem::exists(folder.path / "mesh"));
  EXPECT_FALSE(std::filesystem::exists(folder.path / "mesh.pvtu"));
}

}  // namespace
}  // namespace aeroloom::study
