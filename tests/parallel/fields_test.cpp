#include "parallel/communication/communicator.hpp"

#include <array>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::parallel {
namespace {

enum class Side : std::int8_t { left = 3, right = 5 };

struct Exact {
  double at[2];
  std::int32_t first = 0, second = 0;
  static constexpr auto fields() { return std::tuple(&Exact::at, &Exact::first, &Exact::second); }
  friend bool operator==(const Exact&, const Exact&) = default;
};

struct Holed {
  Side side = Side::left;
  double length = 0;
  std::int32_t number = 0;
  friend bool operator==(const Holed&, const Holed&) = default;
};

struct Nested {
  std::array<Holed, 2> ends;
  std::int16_t kind = 0;
  friend bool operator==(const Nested&, const Nested&) = default;
};

struct Composite {
  std::string name;
  std::vector<double> lengths;
  std::vector<Holed> holed;
  std::vector<std::string> names;
  std::optional<Nested> nested;
  std::pair<std::int8_t, std::string> pair;
  std::map<std::int64_t, std::vector<std::int32_t>> map;
  std::array<std::string, 2> both;
  Side side = Side::left;
  friend bool operator==(const Composite&, const Composite&) = default;
};

/// The members of Holed and of Composite, listed.
struct ListedHoled {
  Side side = Side::left;
  double length = 0;
  std::int32_t number = 0;
  static constexpr auto fields() {
    return std::tuple(&ListedHoled::side, &ListedHoled::length, &ListedHoled::number);
  }
};
struct ListedComposite {
  std::string name;
  std::vector<double> lengths;
  std::vector<ListedHoled> holed;
  std::vector<std::string> names;
  std::optional<Nested> nested;
  std::pair<std::int8_t, std::string> pair;
  std::map<std::int64_t, std::vector<std::int32_t>> map;
  std::array<std::string, 2> both;
  Side side = Side::left;
  static constexpr auto fields() {
    using Self = ListedComposite;
    return std::tuple(&Self::name, &Self::lengths, &Self::holed, &Self::names, &Self::nested, &Self::pair,
                      &Self::map, &Self::both, &Self::side);
  }
};

/// What is counted: members of any kind, alone too.
struct Optionals {
  std::optional<double> number;
  std::optional<std::string> text;
  std::optional<Holed> holed;
  std::optional<std::optional<Side>> twice;
  std::optional<std::vector<Nested>> list;
};
struct Alone {
  std::vector<Optionals> all;
};
struct Pointing {
  double value = 0;
  const double* place = nullptr;
};
struct Empty {};

static_assert(count_members<Holed>() == 3 && count_members<Nested>() == 2 && count_members<Composite>() == 9);
static_assert(count_members<Optionals>() == 5 && count_members<Alone>() == 1 && count_members<Empty>() == 0);
static_assert(HasFields<Alone> && !HasFields<Empty> && !HasFields<std::array<int, 2>> && !HasFields<int[2]>);
static_assert(!HasFields<std::pair<int, int>> && !HasFields<std::optional<int>> && !Flat<Pointing>);
static_assert(Flat<ListedHoled> && !is_exact<ListedHoled> && wire_size<ListedHoled> == wire_size<Holed>);
static_assert(least_wire_size<Composite> == least_wire_size<ListedComposite>);
static_assert(Flat<double> && Flat<Side> && Flat<bool> && Flat<std::array<Exact, 3>>);
static_assert(Flat<Exact> && is_exact<Exact> && wire_size<Exact> == 24);
static_assert(Flat<Holed> && !is_exact<Holed> && wire_size<Holed> == 13 && sizeof(Holed) == 24);
static_assert(Flat<Nested> && wire_size<Nested> == 28 && wire_size<Nested[2]> == 56);
static_assert(!Flat<Composite> && !Flat<std::optional<int>> && !Flat<std::string> && !Flat<long double>);

/// Holed items whose holes hold the given byte.
std::vector<Holed> poisoned(int byte) {
  std::vector<Holed> items(3);
  std::memset(static_cast<void*>(items.data()), byte, items.size() * sizeof(Holed));
  for (std::size_t i = 0; i < items.size(); ++i) {
    items[i].side = i % 2 == 0 ? Side::left : Side::right;
    items[i].length = 0.5 * static_cast<double>(i);
    items[i].number = static_cast<std::int32_t>(i);
  }
  return items;
}

Composite some_composite() {
  Composite all;
  all.name = "wing";
  all.lengths = {1.5, -2.5};
  all.holed = poisoned(7);
  all.names = {"", "tip"};
  all.nested = Nested{{poisoned(1)[1], poisoned(2)[2]}, 9};
  all.pair = {std::int8_t{-1}, "pair"};
  all.map = {{-5, {1, 2}}, {7, {}}};
  all.both = {"a", "b"};
  all.side = Side::right;
  return all;
}

TEST(FieldsLocal, PaddingDoesNotTravel) {
  const std::vector<Holed> some = poisoned(0x55), same = poisoned(0xAA);
  EXPECT_NE(std::memcmp(some.data(), same.data(), some.size() * sizeof(Holed)), 0);
  const Bytes bytes = to_bytes(std::span<const Holed>(some));
  EXPECT_EQ(bytes.size(), some.size() * 13);
  EXPECT_EQ(bytes, to_bytes(std::span<const Holed>(same)));
  EXPECT_EQ(to_wire(some), to_wire(same));
  EXPECT_TRUE(same_bits(some[1], same[1]));
  EXPECT_FALSE(same_bits(some[1], same[2]));
  EXPECT_EQ(from_bytes<Holed>(bytes), some);
  EXPECT_THROW(from_bytes<Holed>(std::span(bytes).first(14)), std::logic_error);
}

TEST(FieldsLocal, ExactItemsAreTheirBytes) {
  const std::vector<Exact> items{{{0.25, 0.5}, 1, 2}, {{-1, 3}, 4, 5}};
  const Bytes bytes = to_bytes(std::span<const Exact>(items));
  ASSERT_EQ(bytes.size(), sizeof(Exact) * items.size());
  EXPECT_EQ(std::memcmp(bytes.data(), items.data(), bytes.size()), 0);
  EXPECT_EQ(from_bytes<Exact>(bytes), items);
}

TEST(FieldsLocal, CompositesComeBack) {
  const Composite all = some_composite();
  EXPECT_EQ(from_wire<Composite>(to_wire(all)), all);
  EXPECT_EQ(from_wire<Composite>(to_wire(Composite())), Composite());
  EXPECT_EQ(from_wire<std::optional<std::string>>(to_wire(std::optional<std::string>())), std::nullopt);
}

TEST(FieldsLocal, CountedMembersTravelAsListedOnes) {
  const Composite all = some_composite();
  const Bytes bytes = to_wire(all);
  const auto listed = from_wire<ListedComposite>(bytes);
  EXPECT_EQ(to_wire(listed), bytes);
  EXPECT_EQ(std::tie(listed.name, listed.lengths, listed.names, listed.nested, listed.pair, listed.map),
            std::tie(all.name, all.lengths, all.names, all.nested, all.pair, all.map));
  EXPECT_EQ(std::tie(listed.both, listed.side), std::tie(all.both, all.side));
  ASSERT_EQ(listed.holed.size(), all.holed.size());
  for (std::size_t i = 0; i < all.holed.size(); ++i) {
    EXPECT_EQ(std::tie(listed.holed[i].side, listed.holed[i].length, listed.holed[i].number),
              std::tie(all.holed[i].side, all.holed[i].length, all.holed[i].number));
  }
}

TEST(FieldsLocal, MembersTravelInTheirOrder) {
  const Holed holed{Side::right, 0.25, 7};
  Packer packer;
  packer.value(holed.side);
  packer.value(holed.length);
  packer.value(holed.number);
  EXPECT_EQ(to_wire(holed), packer.take());
  const Alone alone{{{1.5, "text", holed, std::optional(Side::left), {}}, {}}};
  Packer one_by_one;
  one_by_one.count(2);
  pack(one_by_one, std::tie(alone.all[0].number, alone.all[0].text, alone.all[0].holed));
  pack(one_by_one, std::tie(alone.all[0].twice, alone.all[0].list));
  for (int i = 0; i < 5; ++i) one_by_one.value(false);
  EXPECT_EQ(to_wire(alone), one_by_one.take());
}

TEST(FieldsLocal, HandingOverEmptiesTheArrays) {
  Composite all = some_composite();
  EXPECT_EQ(hand_over_to_wire(all), to_wire(all));
  Packer packer;
  hand_over(packer, all);
  EXPECT_EQ(packer.take(), to_wire(some_composite()));
  EXPECT_EQ(all.lengths.capacity() + all.holed.capacity(), 0U);
  EXPECT_TRUE(all.names.empty() && all.map.empty());
}

TEST(FieldsLocal, ReferencesAndSpansArePackedAsWhatTheyReferTo) {
  const std::string name = "tail";
  const std::vector<Holed> items = poisoned(3);
  const Bytes bytes = to_wire(std::tuple<const std::string&, std::span<const Holed>>(name, items));
  const auto [name_again, items_again] = from_wire<std::tuple<std::string, std::vector<Holed>>>(bytes);
  EXPECT_EQ(name_again, name);
  EXPECT_EQ(items_again, items);
  EXPECT_EQ(to_wire(std::tie(name, items)), bytes);
}

TEST(FieldsLocal, RefusesOtherLengths) {
  Bytes bytes = to_wire(some_composite());
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_THROW(from_wire<Composite>(std::span(bytes).first(size)), std::logic_error) << size;
  bytes.push_back(std::byte{});
  EXPECT_THROW(from_wire<Composite>(bytes), std::logic_error);
}

TEST(FieldsLocal, RefusesHugeCountsBeforeTakingMemory) {
  for (const std::uint64_t count : {std::uint64_t{2}, std::uint64_t{1} << 40, ~std::uint64_t{0}}) {
    const Bytes bytes = to_wire(std::pair(count, std::int64_t{0}));
    EXPECT_THROW(from_wire<std::vector<double>>(bytes), std::logic_error);
    EXPECT_THROW(from_wire<std::vector<Holed>>(bytes), std::logic_error);
    EXPECT_THROW(from_wire<std::vector<std::string>>(bytes), std::logic_error);
    EXPECT_THROW(from_wire<std::vector<Composite>>(bytes), std::logic_error);
    EXPECT_THROW((from_wire<std::map<std::int64_t, std::string>>(bytes)), std::logic_error);
    EXPECT_THROW(from_wire<std::string>(bytes), std::logic_error);
  }
}

TEST(FieldsTest, GoesThroughCollectives) {
  const Communicator world = Communicator::world();
  const std::vector<Holed> mine(static_cast<std::size_t>(world.rank()),
                                {Side::right, 0.5, std::int32_t{world.rank()}});
  std::vector<Holed> expected;
  for (int rank = 0; rank < world.size(); ++rank)
    expected.insert(expected.end(), static_cast<std::size_t>(rank), {Side::right, 0.5, std::int32_t{rank}});
  EXPECT_EQ(world.all_gather_items(std::span<const Holed>(mine)), expected);
  EXPECT_EQ(world.all_gather_values(mine).back().size(), static_cast<std::size_t>(world.size() - 1));
  EXPECT_EQ(world.gather_values(mine).size(), static_cast<std::size_t>(world.is_root() ? world.size() : 0));
  std::vector<Holed> items = world.is_root() ? poisoned(5) : mine;
  world.broadcast_items(items);
  EXPECT_EQ(items, poisoned(5));
  Composite value = world.rank() == world.size() - 1 ? some_composite() : Composite();
  world.broadcast_value(value, world.size() - 1);
  EXPECT_EQ(value, some_composite());
}

}  // namespace
}  // namespace aeroloom::parallel
