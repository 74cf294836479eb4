#include "mesh/exchange/rendezvous.hpp"

#include <map>

#include <gtest/gtest.h>

namespace aeroloom::mesh {
namespace {

using parallel::Communicator;

/// Of a face with four corners; rank r has the faces of every part p with p % ranks = r.
struct Side {
  std::array<GlobalIndex, 4> corners;
  std::int32_t part, cell;

  static constexpr auto fields() { return std::tuple(&Side::corners, &Side::part, &Side::cell); }
};

constexpr int parts = 8, cells = 30;

/// Cell c of part p has the face that the numbers c % 7 and (c + p) % 5 name.
std::vector<Side> sides_of(const Communicator& communicator) {
  std::vector<Side> sides;
  for (int part = communicator.rank(); part < parts; part += communicator.size()) {
    for (int cell = 0; cell < cells; ++cell) {
      const GlobalIndex corner = cell % 7, other = (cell + part) % 5;
      sides.push_back({{corner, corner + other, 100, -1}, part, cell});
    }
  }
  return sides;
}

const auto place_of = [](const Side& side) { return std::tie(side.part, side.cell); };

/// What all ranks together find at each key, in the order in which it is visited.
using Groups = std::map<std::array<GlobalIndex, 4>, std::vector<std::pair<int, int>>>;

Groups expected_groups() {
  Groups groups;
  for (const Side& side : sides_of(Communicator::self()))
    groups[side.corners].emplace_back(side.part, side.cell);
  return groups;
}

TEST(Rendezvous, BringsAllOfAKeyToOneRankInOrder) {
  const Communicator world = Communicator::world();
  const std::vector<Side> met = meet_by_key(world, sides_of(world), &Side::corners, place_of);
  const Groups expected = expected_groups();
  std::int64_t groups = 0;
  std::array<GlobalIndex, 4> last{-1};
  for_each_key(met, &Side::corners, [&](std::span<const Side> group) {
    ++groups;
    EXPECT_LT(last, group.front().corners);
    last = group.front().corners;
    std::vector<std::pair<int, int>> places;
    for (const Side& side : group) places.emplace_back(side.part, side.cell);
    EXPECT_EQ(places, expected.at(last));
  });
  EXPECT_EQ(world.sum(groups), static_cast<std::int64_t>(expected.size()));
}

TEST(Rendezvous, AnswersThoseWhoCame) {
  struct Next {
    std::int32_t part, cell, next_part, next_cell, count;
    static constexpr auto fields() {
      return std::tuple(&Next::part, &Next::cell, &Next::next_part, &Next::next_cell, &Next::count);
    }
  };
  const Communicator world = Communicator::world();
  const std::vector<Side> mine = sides_of(world);
  const Rendezvous meeting(world, mine, &Side::corners, place_of);
  const std::vector<Next> answers = meeting.answer<Next>([](const auto& group, const auto& reply) {
    for (std::size_t i = 0; i < group.size(); ++i) {
      const Side &side = group[i].item, &next = group[(i + 1) % group.size()].item;
      reply(group[i], {side.part, side.cell, next.part, next.cell, static_cast<std::int32_t>(group.size())});
    }
  });
  EXPECT_EQ(answers.size(), mine.size());
  const Groups expected = expected_groups();
  for (const Next& answer : answers) {
    EXPECT_EQ(answer.part % world.size(), world.rank());
    const Side& side = mine[static_cast<std::size_t>(answer.part / world.size() * cells + answer.cell)];
    const auto& group = expected.at(side.corners);
    const auto at = std::find(group.begin(), group.end(), std::pair(answer.part, answer.cell));
    ASSERT_NE(at, group.end());
    const auto next = at + 1 == group.end() ? group.begin() : at + 1;
    EXPECT_EQ(*next, std::pair(answer.next_part, answer.next_cell));
    EXPECT_EQ(answer.count, static_cast<std::int32_t>(group.size()));
  }
}

TEST(Rendezvous, MayBeOfNobody) {
  const Communicator world = Communicator::world();
  const Rendezvous meeting(world, std::vector<Side>{}, &Side::corners, place_of);
  EXPECT_TRUE(meeting.received().empty());
  const auto answers = meeting.answer<int>([](const auto&, const auto&) { FAIL() << "nobody came"; });
  EXPECT_TRUE(answers.empty());
}

TEST(Rendezvous, KeysMayBeWordsAndArraysOfThem) {
  EXPECT_EQ(mix_key(0, std::array<std::uint64_t, 2>{3, 4}), mix_in(mix_in(0, 3), 4));
  EXPECT_EQ(mix_key(0, std::array{std::array{3, 4}, std::array{5, 6}}), mix_key(0, std::array{3, 4, 5, 6}));
}

}  // namespace
}  // namespace aeroloom::mesh
