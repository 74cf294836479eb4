#include "pipeline/case/face_groups.hpp"

#include "cad/domain/domain.hpp"
#include "pipeline/case/patch_rules.hpp"
#include "tests/pipeline/case/aircraft.hpp"
#include "tests/source_tree.hpp"

#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::cases {
namespace {

using mesh::PatchType;
using Numbers = std::set<int>;

/// A duct along x with a branch to y = 2: face 0 at x = 0 is red, 5 at x = 4 in a layer, 9 at y = 2 blue; 1
/// at y = 0, 3 and 6 at y = 1, 7 and 8 the sides of the branch, 2 the top, 4 the bottom.
const cad::Model& duct() {
  static const cad::Model model = [] {
    cad::DomainOptions options;
    options.file = (source_tree() / "configs/geometry/duct.step").string();
    options.kind = cad::DomainKind::fluid;
    return cad::prepare_domain(options).model;
  }();
  return model;
}

GroupRule group(const std::string& name, const FaceConditions& all) {
  GroupRule rule;
  rule.name = name;
  rule.all = all;
  return rule;
}

/// The ids of the faces in one of the groups.
Numbers in_group(const std::vector<GroupRule>& rules, std::size_t which = 0) {
  const std::vector<std::int32_t> groups = find_groups(duct(), rules);
  Numbers numbers;
  for (cad::FaceId f = 0; f < duct().face_count(); ++f)
    if (groups[f] == static_cast<std::int32_t>(which)) numbers.insert(duct().face(f).number);
  return numbers;
}

Numbers selected(const FaceConditions& conditions) {
  return in_group({group("g", conditions)});
}

std::string error_of(const std::vector<GroupRule>& rules) {
  try {
    find_groups(duct(), rules);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

FaceConditions named(const std::string& pattern) {
  return {.faces = {pattern}};
}

TEST(FaceGroups, SelectByName) {
  EXPECT_EQ(selected(named("face_9")), Numbers{9});
  EXPECT_EQ(selected({.faces = {"face_1", "*_2"}}), (Numbers{1, 2}));
  EXPECT_EQ(selected(named("re:_[37]$")), (Numbers{3, 7}));
  EXPECT_EQ(selected(named("re:^face_(1|2)")), (Numbers{1, 2}));
}

TEST(FaceGroups, SelectByWhatTheFileSays) {
  EXPECT_EQ(selected({.colors = {"#FF0000"}}), Numbers{0});
  EXPECT_EQ(selected({.colors = {"00f", "ff0000"}}), (Numbers{0, 9}));
  EXPECT_EQ(selected({.layers = {"out*"}}), Numbers{5});
  EXPECT_EQ(selected({.ids = {"3", "5-6"}}), (Numbers{3, 5, 6}));
}

TEST(FaceGroups, SelectByGeometry) {
  const std::pair<geometry::Vec3, geometry::Vec3> branch{{3, 2, 1}, {1, 1, 0}};
  EXPECT_EQ(selected({.box = branch}), (Numbers{7, 8, 9}));
  EXPECT_EQ(selected({.normal = geometry::Vec3{0, 3, 0}}), (Numbers{3, 6, 9}));
  EXPECT_EQ(selected({.normal = geometry::Vec3{-1, 0, 0}}), (Numbers{0, 7}));
  EXPECT_EQ(selected({.normal = geometry::Vec3{1, 1, 0}, .within = 46.0}), (Numbers{3, 5, 6, 8, 9}));
  EXPECT_EQ(selected({.area = std::pair{1.2, 2.0}}), (Numbers{3, 6}));
}

TEST(FaceGroups, NormalsOfBodiesPointAwayFromThem) {
  const cad::Model& aircraft = transport();
  GroupRule rule = group("top", {.faces = {"wing_left_*per", "wing_left_lower"}});
  rule.all.normal = geometry::Vec3{0, 0, 1};
  rule.all.within = 45;
  const std::vector<std::int32_t> groups = find_groups(aircraft, {rule});
  for (cad::FaceId f = 0; f < aircraft.face_count(); ++f)
    EXPECT_EQ(groups[f] == 0, aircraft.face(f).name == "wing_left_upper") << aircraft.face(f).name;
}

TEST(FaceGroups, SelectNeighbours) {
  GroupRule end = group("end", {.colors = {"#0000ff"}}), sides = group("sides", {.adjacent_to = {"end"}});
  EXPECT_EQ(in_group({end, sides}, 1), (Numbers{2, 4, 7, 8}));
  EXPECT_EQ(in_group({sides, end}), (Numbers{2, 4, 7, 8}));
  sides.all.area = {0.0, 2.0};
  EXPECT_EQ(in_group({sides, end}), (Numbers{7, 8}));
  EXPECT_EQ(selected({.adjacent_to = {"face_0"}}), (Numbers{1, 2, 3, 4}));
  end.all.adjacent_to = {"sides"};
  EXPECT_NE(error_of({end, sides}).find("'groups.end': it is next to a group that is next to it"),
            std::string::npos)
      << error_of({end, sides});
}

TEST(FaceGroups, ConditionsCombine) {
  EXPECT_EQ(selected({.normal = geometry::Vec3{0, 1, 0}, .area = std::pair{0.0, 1.1}}), Numbers{9});
  GroupRule rule = group("g", {.area = std::pair{0.0, 2.0}});
  rule.any = {{.colors = {"#ff0000"}}, {.normal = geometry::Vec3{0, 1, 0}}};
  EXPECT_EQ(in_group({rule}), (Numbers{0, 3, 6, 9}));
  rule.except = {named("face_3"), {.layers = {"outlet"}}};
  EXPECT_EQ(in_group({rule}), (Numbers{0, 6, 9}));
  rule = group("g", {});
  rule.except = {{.area = std::pair{1.2, 10.0}}};
  EXPECT_EQ(in_group({rule}), (Numbers{0, 5, 7, 8, 9}));
}

TEST(FaceGroups, TheFirstGroupHasAFace) {
  const std::vector<GroupRule> rules{group("inlet", {.colors = {"#ff0000"}}), group("rest", named("*"))};
  EXPECT_EQ(in_group(rules), Numbers{0});
  EXPECT_EQ(in_group(rules, 1), (Numbers{1, 2, 3, 4, 5, 6, 7, 8, 9}));
  EXPECT_NE(error_of({rules[1], rules[0]})
                .find("'groups.inlet': all faces that it selects (1) belong to "
                      "groups before it. Remedy: put it first"),
            std::string::npos);
}

TEST(FaceGroups, AGroupThatSelectsNothingSaysWhy) {
  GroupRule rule = group("lid", {.faces = {"face_1", "fase_2"}});
  rule.where = "case.yaml:7:3";
  EXPECT_NE(
      error_of({rule}).find("case.yaml:7:3: 'groups.lid': no face has a name like 'fase_2'; the nearest "
                            "that faces have are 'face_2'"),
      std::string::npos)
      << error_of({rule});
  EXPECT_NE(error_of({group("g", {.colors = {"#fe0000"}})}).find("'#ff0000'"), std::string::npos);
  EXPECT_NE(error_of({group("g", {.parts = {"x"}})}).find("the geometry gives no face a part"),
            std::string::npos);
  EXPECT_NE(error_of({group("g", {.ids = {"17-20"}})}).find("no face has the id 17-20; the largest is 9"),
            std::string::npos);
  rule = group("g", {.normal = geometry::Vec3{1, 0, 0}, .area = std::pair{3.0, 4.0}});
  EXPECT_NE(error_of({rule}).find("of 10 faces: by normal 2, by area 1"), std::string::npos)
      << error_of({rule});
  rule.optional = true;
  EXPECT_EQ(error_of({rule}), "no error");
  EXPECT_EQ(error_of({group("face_4", {})}), "no error");
  EXPECT_NE(error_of({group("floor", {})}).find("no face has a name like 'floor'"), std::string::npos);
}

TEST(FaceGroups, BecomePatchesWithConditions) {
  FaceGroups groups;
  groups.rules = {group("inlet", {.colors = {"#ff0000"}}), group("lid", {.ids = {"2"}})};
  groups.rules[1].type = PatchType::slip;
  const std::vector<PatchRule> rules{{"floor", {"face_4"}, {}}};
  const TypedPatches patches = apply_patch_rules(duct(), rules, groups);
  std::vector<std::string> names;
  for (cad::FaceId f = 0; f < duct().face_count(); ++f)
    names.push_back(patches.model.patches()[patches.model.face(f).patch]);
  // Face 5 is of the patch that is called as its layer.
  const std::map<int, std::string> wanted{{0, "inlet"}, {2, "lid"}, {4, "floor"}, {5, "outlet"}};
  for (cad::FaceId f = 0; f < duct().face_count(); ++f) {
    const auto known = wanted.find(duct().face(f).number);
    EXPECT_EQ(names[f], known != wanted.end() ? known->second : names[f]);
  }
  for (std::size_t p = 0; p < patches.types.size(); ++p) {
    const std::string& name = patches.model.patches()[p];
    const PatchType type = name == "inlet"    ? PatchType::inlet
                           : name == "outlet" ? PatchType::outlet
                           : name == "lid"    ? PatchType::slip
                                              : PatchType::wall;
    EXPECT_EQ(patches.types[p], type) << name;
  }
}

TEST(FaceGroups, StrictGroupsLeaveNoFaceOut) {
  FaceGroups groups;
  groups.rules = {group("ends", {.area = std::pair{0.0, 2.0}}), group("lid", {.ids = {"2"}})};
  EXPECT_NO_THROW(apply_patch_rules(duct(), {}, groups));
  groups.strict = true;
  try {
    apply_patch_rules(duct(), {}, groups);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("'groups.strict': 2 of 10 faces are in no group"), std::string::npos) << text;
    EXPECT_NE(text.find("'face_1' (around 2, 0, 0.5)"), std::string::npos) << text;
  }
  EXPECT_NO_THROW(apply_patch_rules(duct(), {{"walls", {"face_*"}, {}}}, groups));
  // What the program adds needs no group.
  cad::DomainOptions options;
  options.transport = cad::TransportDimensions{};
  options.far_field = cad::FarFieldOptions{.shape = cad::FarFieldShape::hemisphere};
  const cad::Model half = cad::prepare_domain(options).model;
  groups.rules = {group("aircraft", {.parts = {"transport"}})};
  EXPECT_NO_THROW(apply_patch_rules(half, {}, groups));
  // Nor does a group get it that does not name it.
  const auto has_far_field = [&](const GroupRule& rule) {
    const std::vector<std::int32_t> found = find_groups(half, {rule});
    for (cad::FaceId f = 0; f < half.face_count(); ++f)
      if (half.is_far_field(f) && found[f] != no_group) return true;
    return false;
  };
  EXPECT_FALSE(has_far_field(group("rest", {.faces = {"*"}})));
  EXPECT_TRUE(has_far_field(group("outer", {.faces = {"farfield"}})));
  EXPECT_TRUE(has_far_field(group("symmetry", {})));
}

}  // namespace
}  // namespace aeroloom::cases
