#include "tests/pipeline/case/case_fixture.hpp"

#include <gtest/gtest.h>

namespace aeroloom::cases {
namespace {

const std::string groups =
    "groups:\n"
    "  strict: true\n"
    "  wing: {faces: 're:^Wing.*', size: 0.2, type: slip}\n"
    "  inlet: {box: [[0, 0, 0], [1, 1, 1]], normal: [1, 0, 0], within: 5, ids: [3, 17-20]}\n"
    "  tip: {adjacent_to: wing, area: [0, 0.1], optional: true}\n"
    "  rest: {any: [{color: '#ff0000'}, {layer: [a, b], part: p}], except: [{faces: x}]}\n";

TEST_F(CaseTest, GroupsHaveConditionsSizesAndTypes) {
  const Case input = read(transport + groups, {"groups.wing.size=0.1"});
  ASSERT_TRUE(input.groups.strict);
  ASSERT_EQ(input.groups.rules.size(), 4U);
  const GroupRule &wing = input.groups.rules[0], &inlet = input.groups.rules[1], &tip = input.groups.rules[2],
                  &rest = input.groups.rules[3];
  EXPECT_EQ(wing.all.faces, std::vector<std::string>{"re:^Wing.*"});
  EXPECT_EQ(wing.type, mesh::PatchType::slip);
  ASSERT_EQ(input.sizing.patch_sizes.size(), 1U);
  EXPECT_EQ(input.sizing.patch_sizes[0].patch, "wing");
  EXPECT_EQ(input.sizing.patch_sizes[0].size, 0.1);
  ASSERT_TRUE(inlet.all.box && inlet.all.normal);
  EXPECT_EQ(inlet.all.box->second, (geometry::Vec3{1, 1, 1}));
  EXPECT_EQ(inlet.all.within, 5);
  EXPECT_EQ(inlet.all.ids, (std::vector<std::string>{"3", "17-20"}));
  EXPECT_NE(inlet.where.find("case.yaml:5:3"), std::string::npos) << inlet.where;
  EXPECT_EQ(tip.all.adjacent_to, std::vector<std::string>{"wing"});
  EXPECT_EQ(tip.all.area->second, 0.1);
  EXPECT_TRUE(tip.optional);
  ASSERT_EQ(rest.any.size(), 2U);
  EXPECT_EQ(rest.any[1].layers, (std::vector<std::string>{"a", "b"}));
  ASSERT_EQ(rest.except.size(), 1U);
}

TEST_F(CaseTest, GroupsAreWrittenAsTheyAreRead) {
  const Case input = read(transport + groups);
  const Case again = read(resolved_yaml(input));
  EXPECT_EQ(resolved_yaml(again), resolved_yaml(input));
  ASSERT_EQ(again.groups.rules.size(), 4U);
  EXPECT_EQ(again.groups.rules[3].any[1].parts, std::vector<std::string>{"p"});
  EXPECT_EQ(again.groups.rules[1].all.box->second, (geometry::Vec3{1, 1, 1}));
  // A list that is given again takes the place of the other.
  const Case other = read(transport + groups, {"groups.rest.any=[{ids: 4}]"});
  ASSERT_EQ(other.groups.rules[3].any.size(), 1U);
  EXPECT_TRUE(other.groups.rules[3].any[0].colors.empty());
}

TEST_F(CaseTest, FaultsOfGroupsAreTold) {
  const auto told = [&](const std::string& of_group) {
    return error_of(transport + "groups:\n  g: " + of_group + "\n");
  };
  EXPECT_EQ(told("{colour: red}"),
            "case.yaml:3:7: unknown key 'colour' in 'groups.g'; did you mean 'color'?");
  EXPECT_EQ(told("{color: crimson}"),
            "case.yaml:3:3: 'groups.g.color': expected a colour such as '#ff0000', got 'crimson'");
  EXPECT_EQ(told("{ids: [3, 9-4]}"),
            "case.yaml:3:3: 'groups.g.ids': expected a number or a range such as 17-20, got '9-4'");
  EXPECT_NE(told("{faces: 're:wing('}").find("case.yaml:3:3: 'groups.g.faces': 're:wing(' is no regular"),
            std::string::npos);
  EXPECT_EQ(told("{normal: [0, 0, 0]}"), "case.yaml:3:3: 'groups.g.normal': is zero and has no direction");
  EXPECT_EQ(told("{within: 5}"), "case.yaml:3:3: 'groups.g.within': needs 'normal'");
  EXPECT_NE(told("{any: {faces: a}}").find("'groups.g.any': expected a list of keys in braces"),
            std::string::npos);
  EXPECT_NE(
      told("{any: [{fases: a}]}").find("unknown key 'fases' in 'groups.g.any[0]'; did you mean 'faces'"),
      std::string::npos);
  EXPECT_NE(error_of(transport, {"patches.g.faces=re:["}).find("'patches.g.faces': 're:[' is no regular"),
            std::string::npos);
  EXPECT_NE(told("{area: [2, 1]}").find("the smaller one first"), std::string::npos);
  EXPECT_NE(told("{faces: a}\npatches: {g: {type: slip}}").find("makes a patch of this name"),
            std::string::npos);
}

}  // namespace
}  // namespace aeroloom::cases
