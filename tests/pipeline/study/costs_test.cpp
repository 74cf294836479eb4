#include "pipeline/study/costs.hpp"

#include "pipeline/study/text_files.hpp"
#include "tests/pipeline/study/studies.hpp"

#include <functional>
#include <stdexcept>

#include <gtest/gtest.h>

namespace aeroloom::study {
namespace {

const std::string head = "rank,stage,kind,number,predicted,cpu_seconds,bytes,child_bytes,round,burden\n";

Json a_report() {
  const Json counts{{"count", 2}, {"bytes", 10}}, sent{{"count", 6}, {"count_max", 4}, {"bytes", 20}};
  Json asked;
  for (const char* kind :
       {"broadcast", "all_gather", "table", "gather", "reduction", "neighbour", "rendezvous"})
    asked[kind] = counts;
  return {{"status", "ok"},
          {"ranks", 2},
          {"resumed", Json::array()},
          {"stages",
           {{{"name", "volume"},
             {"wall_seconds", 9.0},
             {"cpu_seconds_mean", 5.0},
             {"serial_seconds", 1.5},
             {"repeated_seconds", 0.5},
             {"check_seconds", 0.25},
             {"other_seconds", 0.125},
             {"peak_own_bytes_max", 1000},
             {"messages", {{"collective", sent}, {"neighbour", sent}, {"rendezvous", sent}}},
             {"exchanges", asked}}}}};
}

std::string refusal(const std::function<void()>& work) {
  try {
    work();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(Costs, WhatNoTaskHoldsIsDivisible) {
  const RunCosts costs =
      costs_of(a_report(), head +
                               "1,volume,zone,7,100,2,50,60,1,0\n0,volume,zone,3,90,1,50,80,1,0\n"
                               "0,surface,face,3,90,1,0,0,1,8\n");
  EXPECT_EQ(costs.ranks, 2);
  ASSERT_EQ(costs.stages.size(), 1u);
  const StageCosts& volume = costs.stages[0];
  EXPECT_DOUBLE_EQ(volume.serial, 1);
  EXPECT_DOUBLE_EQ(volume.repeated, 0.5);
  EXPECT_DOUBLE_EQ(volume.divisible, 2 * 5 - 1 - 2 * 0.5 - 3 + 2 * 0.25 + 2 * 0.125);
  ASSERT_EQ(volume.groups.size(), 1u);
  ASSERT_EQ(volume.groups[0].tasks.size(), 2u);
  EXPECT_EQ(volume.groups[0].tasks[0].number, 3);  // whoever had it
  EXPECT_DOUBLE_EQ(volume.groups[0].tasks[0].child_bytes, 80);
  EXPECT_EQ(volume.exchanges.asked.rendezvous, (parallel::Messages{2, 10}));
  EXPECT_EQ(volume.exchanges.sent.rendezvous, (parallel::Messages{6, 20}));
  EXPECT_DOUBLE_EQ(volume.exchanges.partners, 2);
}

TEST(Costs, EveryRankStarts) {
  Json report = a_report();
  report["stages"][0]["name"] = "start";
  EXPECT_DOUBLE_EQ(costs_of(report, head).stages[0].repeated, 0.5 + 0.125);
}

TEST(Costs, GroupsFollowEachOtherAsTheyWait) {
  const RunCosts costs = costs_of(a_report(), head +
                                                  "0,volume,surface piece,0,1,0,0,0,1,0\n"
                                                  "0,volume,another kind,0,1,0,0,0,1,0\n"
                                                  "0,volume,a third kind,0,1,0,0,0,1,0\n"
                                                  "0,volume,face,0,1,0,0,0,2,0\n"
                                                  "0,volume,face,0,1,0,0,0,1,4\n");
  std::string order;
  for (const TaskGroup& group : costs.stages[0].groups)
    order += fmt::format("{} {}, ", group.round, group.kind ? parallel::name_of(*group.kind) : "unknown");
  EXPECT_EQ(order, "1 face, 1 surface piece, 1 unknown, 1 unknown, 2 face, ");
  EXPECT_DOUBLE_EQ(costs.stages[0].groups[0].tasks[0].burden, 4);
}

TEST(Costs, RefusesWhatTellsNothing) {
  Json failed = a_report(), resumed = a_report(), old = a_report();
  failed["status"] = "failed";
  resumed["resumed"] = {"sizing"};
  old["stages"][0].erase("exchanges");
  EXPECT_NE(refusal([&] { costs_of(failed, head); }).find("failed"), std::string::npos);
  EXPECT_NE(refusal([&] { costs_of(resumed, head); }).find("'sizing' from a checkpoint"), std::string::npos);
  EXPECT_NE(refusal([&] { costs_of(old, head); }).find("exchanges"), std::string::npos);
  EXPECT_NE(refusal([&] { costs_of(Json(3), head); }).find("no report"), std::string::npos);
  EXPECT_NE(refusal([&] { costs_of(a_report(), "rank,stage,kind\n"); }).find("columns"), std::string::npos);
  EXPECT_NE(refusal([&] { costs_of(a_report(), head + "0,volume,zone\n"); }).find("line 2: 3 columns"),
            std::string::npos);
  EXPECT_NE(
      refusal([&] { costs_of(a_report(), head + "0,volume,zone,1,x,1,1,1,1,1\n"); }).find("'x' is no number"),
      std::string::npos);
  EXPECT_NE(refusal([&] { costs_of(a_report(), head + "0,volume,zone,1,1,-1,1,1,1,1\n"); }).find("negative"),
            std::string::npos);
}

TEST(Costs, ReadsTheFolderOfARun) {
  const StudyFolder folder("costs");
  EXPECT_NE(refusal([&] { read_costs(folder.path); }).find("no report.json"), std::string::npos);
  write_file(folder.path / "report.json", a_report().dump());
  EXPECT_NE(refusal([&] { read_costs(folder.path); }).find("output.tasks"), std::string::npos);
  write_file(folder.path / "tasks.csv", head);
  EXPECT_EQ(read_costs(folder.path).stages.size(), 1u);
  write_file(folder.path / "report.json", "{");
  EXPECT_NE(refusal([&] { read_costs(folder.path); }).find("is not whole JSON"), std::string::npos);
}

TEST(Costs, LeavesOutAStage) {
  RunCosts costs = costs_of(a_report(), head);
  EXPECT_EQ(without(costs, "geometry").stages.size(), 1u);
  EXPECT_TRUE(without(costs, "volume").stages.empty());
}

}  // namespace
}  // namespace aeroloom::study
