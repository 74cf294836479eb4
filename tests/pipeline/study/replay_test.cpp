#include "pipeline/study/replay.hpp"

#include "pipeline/study/prediction_files.hpp"

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace aeroloom::study {
namespace {

using parallel::TaskKind;

constexpr Network no_network{0, 1e30};

TaskGroup tasks_of(TaskKind kind, const std::vector<double>& seconds, int round = 0) {
  TaskGroup group{kind, round, {}};
  for (std::size_t i = 0; i < seconds.size(); ++i)
    group.tasks.push_back(
        {.number = static_cast<std::int64_t>(i), .predicted = seconds[i], .seconds = seconds[i]});
  return group;
}

StageCosts stage_of(const std::string& name, std::vector<TaskGroup> groups, double divisible = 0) {
  StageCosts stage;
  stage.name = name;
  stage.groups = std::move(groups);
  stage.divisible = divisible;
  return stage;
}

RunCosts run_of(std::vector<StageCosts> stages) {
  return {1, std::move(stages)};
}

void expect_losses_add_up(const Prediction& prediction) {
  EXPECT_NEAR(prediction.seconds, prediction.one_rank_seconds / prediction.ranks + prediction.losses.sum(),
              1e-9 * prediction.seconds);
}

TEST(Replay, EqualTasksAreSharedOut) {
  const RunCosts costs =
      run_of({stage_of("volume", {tasks_of(TaskKind::cavity, std::vector<double>(12, 2.0))})});
  for (const int ranks : {1, 2, 3, 4, 6, 12}) {
    const Prediction prediction = predict(costs, ranks, no_network);
    EXPECT_DOUBLE_EQ(prediction.seconds, 24.0 / ranks);
    EXPECT_DOUBLE_EQ(prediction.efficiency(), 1);
  }
  // Five ranks: two of them have three, for 12 are not a multiple.
  const Prediction five = predict(costs, 5, no_network);
  EXPECT_DOUBLE_EQ(five.seconds, 6);
  EXPECT_DOUBLE_EQ(five.losses.imbalance, 6 - 24.0 / 5);
  EXPECT_DOUBLE_EQ(five.losses.granularity, 0);
  // On 24 half of them have nothing: a task is no shorter.
  EXPECT_DOUBLE_EQ(predict(costs, 24, no_network).losses.granularity, 1);
}

TEST(Replay, TheLargestTaskBounds) {
  const RunCosts costs =
      run_of({stage_of("surface", {tasks_of(TaskKind::face, {10, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1})})});
  EXPECT_DOUBLE_EQ(predict(costs, 2, no_network).seconds, 10);
  EXPECT_DOUBLE_EQ(predict(costs, 2, no_network).efficiency(), 1);
  const Prediction ten = predict(costs, 10, no_network);
  EXPECT_DOUBLE_EQ(ten.seconds, 10);
  EXPECT_DOUBLE_EQ(ten.losses.granularity, 8);
  expect_losses_add_up(ten);
}

TEST(Replay, SerialAndRepeatedWorkStays) {
  RunCosts costs = run_of({stage_of("sizing", {}, 90)});
  costs.stages[0].serial = 6;
  costs.stages[0].repeated = 4;
  for (const int ranks : {1, 2, 9, 1000}) {
    const Prediction prediction = predict(costs, ranks, no_network);
    EXPECT_DOUBLE_EQ(prediction.seconds, 10 + 90.0 / ranks);  // Amdahl
    EXPECT_DOUBLE_EQ(prediction.losses.serial, 6 * (ranks - 1.0) / ranks);
    EXPECT_DOUBLE_EQ(prediction.losses.repeated, 4 * (ranks - 1.0) / ranks);
    expect_losses_add_up(prediction);
  }
  // 100 / (N (10 + 90 / N)) >= 0.8 up to N = 3.5.
  EXPECT_EQ(ranks_at_efficiency(costs, no_network, 0.8), 3);
  EXPECT_EQ(ranks_at_efficiency(costs, no_network, 0.5), 11);
  EXPECT_EQ(ranks_at_efficiency(run_of({stage_of("sizing", {}, 90)}), no_network, 0.8), 10'000);
}

TEST(Replay, LoadsThatWereMisjudgedAreImbalance) {
  // Scheduled as two and two; one of the four takes three times what was thought.
  RunCosts costs = run_of({stage_of("surface", {tasks_of(TaskKind::face, {1, 1, 1, 1})})});
  costs.stages[0].groups[0].tasks[0].seconds = 3;
  const Prediction prediction = predict(costs, 2, no_network);
  EXPECT_DOUBLE_EQ(prediction.seconds, 4);
  EXPECT_DOUBLE_EQ(prediction.losses.imbalance, 1);
  EXPECT_DOUBLE_EQ(prediction.losses.granularity, 0);
}

TEST(Replay, RoundsWaitForEachOther) {
  // The first round has one task, the second another: each is done by rank 0 alone.
  const RunCosts costs = run_of(
      {stage_of("improve", {tasks_of(TaskKind::cavity, {3}, 1), tasks_of(TaskKind::cavity, {1, 2}, 2)})});
  const Prediction prediction = predict(costs, 2, no_network);
  EXPECT_DOUBLE_EQ(prediction.seconds, 5);
  EXPECT_DOUBLE_EQ(prediction.busy_seconds, 5);  // rank 0 has the largest of each
  RunCosts unlike = costs;
  unlike.stages[0].groups[1].tasks[0].predicted = 9;  // now rank 0 gets the second of these two
  const Prediction other = predict(unlike, 2, no_network);
  EXPECT_DOUBLE_EQ(other.busy_seconds, 4);
  EXPECT_DOUBLE_EQ(other.seconds, 5);
  EXPECT_DOUBLE_EQ(other.losses.waiting, 1);
  expect_losses_add_up(other);
}

TEST(Replay, BurdensOfARoundCount) {
  // A face that took long leaves its rank fewer pieces.
  TaskGroup faces = tasks_of(TaskKind::face, {4, 1}, 1);
  faces.tasks[0].burden = 4;
  faces.tasks[1].burden = 1;
  const TaskGroup pieces = tasks_of(TaskKind::surface_piece, {2, 2, 1}, 1);
  const Prediction prediction = predict(run_of({stage_of("surface", {faces, pieces})}), 2, no_network);
  EXPECT_DOUBLE_EQ(prediction.busy_seconds, 5);  // 4 + 1 and 1 + 2 + 2
  EXPECT_DOUBLE_EQ(prediction.seconds, 4 + 4);   // the faces first
  EXPECT_DOUBLE_EQ(prediction.losses.waiting, 3);
  TaskGroup next = pieces;
  next.round = 2;  // of a round of their own: what was before does not count
  EXPECT_DOUBLE_EQ(predict(run_of({stage_of("surface", {faces, next})}), 2, no_network).seconds, 4 + 3);
}

TEST(Replay, ZonesComeInBatchesOfFour) {
  // Five zones for each of two ranks: after four both wait.
  TaskGroup zones = tasks_of(TaskKind::zone, std::vector<double>(10, 1));
  zones.tasks[0].seconds = 2;  // rank 0, first batch
  zones.tasks[9].seconds = 2;  // rank 1, second batch
  const Prediction prediction = predict(run_of({stage_of("volume", {zones})}), 2, no_network);
  EXPECT_DOUBLE_EQ(prediction.busy_seconds, 6);
  EXPECT_DOUBLE_EQ(prediction.seconds, 5 + 2);
  EXPECT_DOUBLE_EQ(prediction.losses.waiting, 1);
}

TEST(Replay, OutputFollowsPieces) {
  TaskGroup pieces = tasks_of(TaskKind::improved_piece, {1, 1, 1});
  for (TaskCost& piece : pieces.tasks) piece.bytes = 100;
  const RunCosts costs = run_of({stage_of("improve", {pieces}), stage_of("output", {}, 9)});
  const Prediction prediction = predict(costs, 9, no_network);
  EXPECT_DOUBLE_EQ(prediction.stages[1].seconds, 3);  // six ranks have nothing to write
  EXPECT_DOUBLE_EQ(prediction.stages[1].losses.granularity, 2);
  expect_losses_add_up(prediction);
}

TEST(Replay, MoreRanksAreNeverSlowerWithoutANetwork) {
  std::vector<double> seconds;
  for (int i = 1; i < 60; ++i) seconds.push_back(1 + i % 7);
  RunCosts costs = run_of({stage_of("volume", {tasks_of(TaskKind::cavity, seconds)}, 30)});
  costs.stages[0].serial = 1;
  double before = 1e9, efficiency = 1.01;
  for (int ranks = 1; ranks <= 4096; ranks *= 2) {
    const Prediction prediction = predict(costs, ranks, no_network);
    EXPECT_LE(prediction.seconds, before);
    EXPECT_LE(prediction.efficiency(), efficiency);
    expect_losses_add_up(prediction);
    before = prediction.seconds;
    efficiency = prediction.efficiency();
  }
  EXPECT_GE(before, 1 + 7);
}

TEST(Replay, OneRankReproducesItsRecord) {
  const RunCosts costs = run_of({stage_of("volume", {tasks_of(TaskKind::zone, {3, 4, 5, 6, 7})}, 2.5)});
  const Prediction one = predict(costs, 1, {});
  EXPECT_DOUBLE_EQ(one.seconds, 27.5);
  EXPECT_DOUBLE_EQ(one.busy_seconds, 27.5);
  EXPECT_DOUBLE_EQ(one.losses.sum(), 0);
}

TEST(Replay, MemoryIsAFloorAndAShare) {
  RunCosts costs = run_of({stage_of("geometry", {}), stage_of("sizing", {}, 1), stage_of("volume", {}, 1)});
  costs.stages[0].own_bytes = 70;
  costs.stages[1].own_bytes = 50;
  TaskGroup zones = tasks_of(TaskKind::zone, {1});
  zones.tasks[0].child_bytes = 10;
  costs.stages[2].groups = {zones};
  costs.stages[2].own_bytes = 460;
  const Prediction prediction = predict(costs, 4, no_network);
  EXPECT_DOUBLE_EQ(prediction.stages[0].bytes, 70);
  EXPECT_DOUBLE_EQ(prediction.stages[1].bytes, 50);
  EXPECT_DOUBLE_EQ(prediction.stages[2].bytes, 50 + 10 + 400 / 4.0);
  EXPECT_DOUBLE_EQ(prediction.bytes, 160);
  EXPECT_DOUBLE_EQ(predict(costs, 1, no_network).bytes, 460);
}

TEST(Replay, RefusesWhatCannotBe) {
  const RunCosts costs = run_of({stage_of("volume", {}, 1)});
  EXPECT_THROW(predict(costs, 0, no_network), std::invalid_argument);
  EXPECT_THROW(predict(costs, most_ranks_predicted + 1, no_network), std::invalid_argument);
  EXPECT_THROW(predict(costs, 2, {-1, 1e9}), std::invalid_argument);
  EXPECT_THROW(predict(costs, 2, {1e-6, 0}), std::invalid_argument);
  EXPECT_THROW(predict(costs, 2, {std::nan(""), 1e9}), std::invalid_argument);
}

TEST(Replay, FilesTellOfAllRanks) {
  RunCosts costs =
      run_of({stage_of("geometry", {}), stage_of("volume", {tasks_of(TaskKind::cavity, {1, 1, 1, 1})})});
  costs.stages[0].serial = 4;
  const Forecasts forecasts = forecast_ranks(costs, "out", {1, 2, 4}, no_network);
  EXPECT_EQ(forecasts.worthwhile.ranks, 1);
  EXPECT_EQ(forecasts.worthwhile.ranks_without_geometry, 5);
  const auto json = prediction_json(forecasts);
  ASSERT_EQ(json["rows"].size(), 3u);
  EXPECT_DOUBLE_EQ(json["rows"][2]["seconds"].get<double>(), 5);
  EXPECT_DOUBLE_EQ(json["rows"][2]["losses"]["serial"].get<double>(), 3);
  EXPECT_EQ(json["rows"][2]["stages"][1]["name"], "volume");
  const std::string csv = prediction_csv(forecasts);
  EXPECT_NE(csv.find("4,all,5,5,0,3,0,0,0,0,0\n"), std::string::npos) << csv;
  EXPECT_NE(prediction_text(forecasts).find("80 % efficiency: 1 rank(s)"), std::string::npos);
}

}  // namespace
}  // namespace aeroloom::study
