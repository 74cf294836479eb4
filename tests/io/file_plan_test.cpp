#include "io/vtk/file_plan.hpp"

#include <algorithm>
#include <numeric>
#include <set>

#include <gtest/gtest.h>

namespace aeroloom::io {

namespace {

/// Parts of ten items, by the ranks that hold them.
std::vector<PartLocation> parts_on(const std::vector<int>& ranks) {
  std::vector<PartLocation> places;
  for (const int rank : ranks)
    places.push_back({.id = static_cast<std::int32_t>(places.size()), .rank = rank, .items = 10, .work = 40});
  return places;
}

std::vector<int> files_by_writer(const FilePlan& plan, int ranks) {
  std::vector<int> counts(static_cast<std::size_t>(ranks), 0);
  for (const PlannedFile& file : plan.files) ++counts[static_cast<std::size_t>(file.writer)];
  return counts;
}

TEST(FilePlanLocal, LeavesFilesWithTheirHolders) {
  const FilePlan plan = plan_files(parts_on({0, 0, 1, 1, 1, 1, 0, 0}), 20, 2);
  ASSERT_EQ(plan.files.size(), 4u);
  EXPECT_EQ(plan.file_of, (std::vector<std::size_t>{0, 0, 1, 1, 2, 2, 3, 3}));
  EXPECT_EQ(plan.rounds, 0u);
  const int writers[] = {0, 1, 1, 0};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(plan.files[i].writer, writers[i]);
    EXPECT_EQ(plan.files[i].round, PlannedFile::no_round);
  }
}

TEST(FilePlanLocal, GroupsPartsWhereverTheyLive) {
  const FilePlan one = plan_files(parts_on(std::vector<int>(23, 0)), 25, 1);
  std::vector<int> ranks(23);
  std::iota(ranks.begin(), ranks.end(), 0);
  EXPECT_EQ(plan_files(parts_on(ranks), 25, 23).file_of, one.file_of);
  EXPECT_EQ(one.files.size(), 8u);
}

TEST(FilePlanLocal, TakesWorkFromRanksThatHaveMore) {
  std::vector<int> ranks(40, 0);
  std::fill(ranks.begin() + 30, ranks.end(), 1);
  for (const int count : {2, 3, 5}) {
    const std::vector<int> files = files_by_writer(plan_files(parts_on(ranks), 10, count), count);
    const auto [least, most] = std::minmax_element(files.begin(), files.end());
    EXPECT_LE(*most - *least, 1) << count << " ranks";
  }
}

TEST(FilePlanLocal, BringsAFewFilesAtOnce) {
  // Every file has a part elsewhere.
  std::vector<int> ranks;
  for (int i = 0; i < 60; ++i) ranks.insert(ranks.end(), {0, 0, 1, 1, 1, 0});
  const std::vector<PartLocation> places = parts_on(ranks);
  const FilePlan plan = plan_files(places, 30, 2);
  std::vector<std::vector<mesh::GlobalIndex>> brought(plan.rounds, std::vector<mesh::GlobalIndex>(2, 0));
  for (const PartLocation& place : places) {
    const PlannedFile& file = plan.plan_of(place.id);
    ASSERT_LT(file.round, plan.rounds);
    if (file.writer != place.rank) brought[file.round][static_cast<std::size_t>(file.writer)] += place.items;
  }
  const mesh::GlobalIndex allowed = 3600 / 2 / 8;
  for (const auto& round : brought) {
    for (const mesh::GlobalIndex items : round) EXPECT_LE(items, allowed);
  }
  EXPECT_LT(plan.rounds, plan.files.size() / 4);
}

TEST(FilePlanLocal, GivesFilesOfNothingToAHolder) {
  std::vector<PartLocation> places = parts_on({1, 1, 0, 0});
  places[2].items = places[2].work = places[3].items = places[3].work = 0;
  const FilePlan plan = plan_files(places, 15, 3);
  ASSERT_EQ(plan.files.size(), 2u);
  EXPECT_EQ(plan.files[0].writer, 1);
  EXPECT_EQ(plan.files[1].writer, 0);
  EXPECT_EQ(plan.rounds, 0u);
  EXPECT_TRUE(plan_files({}, 15, 3).files.empty());
}

}  // namespace

}  // namespace aeroloom::io
