#include "geometry/box_tree.hpp"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

namespace aeroloom::geometry {
namespace {

std::vector<Box> random_boxes(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(0, 1), size(0, 0.1);
  std::vector<Box> boxes(count);
  for (Box& box : boxes) {
    const Vec3 low{place(random), place(random), place(random)};
    box.add(low);
    box.add(low + Vec3{size(random), size(random), size(random)});
  }
  return boxes;
}

TEST(BoxTree, FindsTheBoxesThatOverlap) {
  const std::vector<Box> boxes = random_boxes(500, 7);
  const BoxTree tree(boxes, 4);
  for (const Box& box : random_boxes(50, 8)) {
    std::vector<std::int32_t> found, expected;
    for_each_overlap(tree, boxes, box, [&](std::int32_t i) { found.push_back(i); });
    for (std::int32_t i = 0; i < 500; ++i) {
      if (boxes[i].overlaps(box)) expected.push_back(i);
    }
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, expected);
  }
}

TEST(BoxTree, FindsTheNearestBoxWithoutLookingAtMost) {
  const std::vector<Box> boxes = random_boxes(2000, 5);
  const BoxTree tree(boxes, 4);
  const auto away_from = [](Vec3 p, const Box& box) {
    Vec3 apart;
    for (int axis = 0; axis < 3; ++axis)
      apart[axis] = std::max({box.low[axis] - p[axis], p[axis] - box.high[axis], 0.0});
    return norm(apart);
  };
  for (const Box& at : random_boxes(50, 6)) {
    const Vec3 p = 3 * at.low - Vec3{1, 1, 1};
    double expected = 0.5, bound = 0.5;
    for (const Box& box : boxes) expected = std::min(expected, away_from(p, box));
    int visited = 0;
    tree.search_nearest([&](const Box& box) { return away_from(p, box); }, bound,
                        [&](std::int32_t place) {
                          ++visited;
                          bound = std::min(bound, away_from(p, boxes[tree.order()[place]]));
                        });
    EXPECT_EQ(bound, expected);
    EXPECT_LT(visited, 200);
  }
}

TEST(BoxTree, LeavesHoldEveryBoxOnceAndAreSmall) {
  const std::vector<Box> boxes = random_boxes(333, 9);
  const BoxTree tree(boxes, 5);
  std::vector<int> seen(boxes.size(), 0);
  for (const auto leaf : tree.leaves()) {
    EXPECT_LE(leaf.size(), 5u);
    EXPECT_TRUE(std::is_sorted(leaf.begin(), leaf.end()));
    for (const std::int32_t i : leaf) ++seen[i];
  }
  EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](int times) { return times == 1; }));
}

TEST(BoxTree, LeavesAreCompact) {
  std::vector<Box> line(64);
  for (int i = 0; i < 64; ++i) line[(i * 37) % 64].add(Vec3{static_cast<double>(i), 0, 0});
  const BoxTree tree(line, 4);
  for (const auto leaf : tree.leaves()) {
    Box box;
    for (const std::int32_t i : leaf) box.add(line[i]);
    EXPECT_LE(box.size().x, 3) << "neighbours on the line";
  }
}

TEST(BoxTree, ASearchEntersNothingBelowWhatItDoesNotEnter) {
  const std::vector<Box> boxes = random_boxes(200, 10);
  const BoxTree tree(boxes, 4);
  int entered = 0, visited = 0;
  tree.search(
      [&](const Box&) {
        ++entered;
        return false;
      },
      [&](std::int32_t) { ++visited; });
  EXPECT_EQ(entered, 1);
  EXPECT_EQ(visited, 0);
}

TEST(BoxTree, ManyEqualBoxesAndNone) {
  const std::vector<Box> same(100, random_boxes(1, 11).front());
  int found = 0;
  for_each_overlap(BoxTree(same, 4), same, same.front(), [&](std::int32_t) { ++found; });
  EXPECT_EQ(found, 100);
  const BoxTree empty(std::span<const Box>{}, 4);
  EXPECT_TRUE(empty.nodes().empty());
  for_each_overlap(empty, {}, same.front(), [&](std::int32_t) { FAIL(); });
}

}  // namespace
}  // namespace aeroloom::geometry
