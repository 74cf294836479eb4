#include "pipeline/case/patch_rules.hpp"

#include "cad/domain/domain.hpp"
#include "tests/pipeline/case/aircraft.hpp"
#include "tests/source_tree.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

namespace aeroloom::cases {
namespace {

using mesh::PatchType;

PatchType type_of(const TypedPatches& patches, const std::string& name) {
  const auto& names = patches.model.patches();
  const auto found = std::find(names.begin(), names.end(), name);
  EXPECT_NE(found, names.end()) << name;
  return patches.types.at(static_cast<std::size_t>(found - names.begin()));
}

TEST(PatchRules, DefaultsAreFarFieldAndWalls) {
  const TypedPatches patches = apply_patch_rules(transport(), {});
  ASSERT_EQ(patches.types.size(), patches.model.patches().size());
  EXPECT_EQ(patches.model.patches(), transport().patches());
  for (std::size_t p = 0; p < patches.types.size(); ++p) {
    const bool far = patches.model.patches()[p] == "farfield";
    EXPECT_EQ(patches.types[p], far ? PatchType::farfield : PatchType::wall) << patches.model.patches()[p];
  }
}

TEST(PatchRules, APlaneOfSymmetryIsNoFarField) {
  cad::DomainOptions options;
  options.file = (source_tree() / "configs/geometry/sphere.brep").string();
  options.far_field = cad::FarFieldOptions{.shape = cad::FarFieldShape::hemisphere};
  const TypedPatches patches = apply_patch_rules(cad::prepare_domain(options).model, {});
  EXPECT_EQ(type_of(patches, "symmetry"), PatchType::symmetry);
  EXPECT_EQ(type_of(patches, "farfield"), PatchType::farfield);
  EXPECT_EQ(type_of(patches, "body"), PatchType::wall);
}

TEST(PatchRules, SaysWhatARuleGetsBesides) {
  const TypedPatches patches = apply_patch_rules(transport(), {{"farfield", {"*wing*"}, PatchType::wall}});
  ASSERT_EQ(patches.warnings.size(), 1U);
  EXPECT_NE(patches.warnings[0].find("patches.farfield: the model has a patch of this name"),
            std::string::npos)
      << patches.warnings[0];
  EXPECT_TRUE(apply_patch_rules(transport(), {{"farfield", {}, PatchType::outlet}}).warnings.empty());
}

TEST(PatchRules, PatternsJoinFacesAndTheFirstRuleHolds) {
  const TypedPatches patches = apply_patch_rules(
      transport(), {{"lifting", {"*wing*", "*tail*"}, PatchType::slip}, {"rest", {"*"}, {}}});
  const std::vector<std::string>& names = patches.model.patches();
  EXPECT_EQ(std::count(names.begin(), names.end(), "lifting"), 1);
  EXPECT_EQ(names.size(), 2U);
  EXPECT_EQ(type_of(patches, "lifting"), PatchType::slip);
  EXPECT_EQ(type_of(patches, "rest"), PatchType::wall);
  for (cad::FaceId f = 0; f < patches.model.face_count(); ++f) {
    const bool lifting = names[patches.model.face(f).patch] == "lifting";
    const std::string& face = transport().face(f).name;
    const std::string& patch = transport().patches()[transport().face(f).patch];
    const bool named = (face + " " + patch).find("wing") != std::string::npos ||
                       (face + " " + patch).find("tail") != std::string::npos;
    EXPECT_EQ(lifting, named) << face;
  }
}

TEST(PatchRules, ARuleThatComesTooLateIsRefused) {
  EXPECT_THROW(apply_patch_rules(transport(), {{"all", {"*"}, {}}, {"farfield", {}, PatchType::inlet}}),
               std::invalid_argument);
}

TEST(PatchRules, APatchOfThisNameNeedsNoPattern) {
  const TypedPatches patches = apply_patch_rules(transport(), {{"farfield", {}, PatchType::outlet}});
  EXPECT_EQ(patches.model.patches(), transport().patches());
  EXPECT_EQ(type_of(patches, "farfield"), PatchType::outlet);
}

TEST(PatchRules, APatternWithoutFacesNamesTheNearest) {
  try {
    apply_patch_rules(transport(), {{"outer", {"farfeild"}, {}}});
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("'farfeild'; the nearest names are 'farfield'"),
              std::string::npos)
        << error.what();
  }
}

std::string refusal_of(const std::vector<PatchRule>& rules,
                       const std::vector<cad::RemovedName>& removed = {}) {
  try {
    choose_patches(transport(), {}, rules, removed);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(PatchRules, OptionalOnesMayMatchNothing) {
  PatchRule rule{"nacelle", {"nacelle_*", "*wing*"}, PatchType::slip};
  EXPECT_NE(refusal_of({rule}).find("`optional: true`"), std::string::npos) << refusal_of({rule});
  rule.optional = true;
  EXPECT_EQ(refusal_of({rule}), "");
  EXPECT_EQ(type_of(apply_patch_rules(transport(), {rule}), "nacelle"), PatchType::slip);
  rule.faces = {"nacelle_*"};
  EXPECT_EQ(apply_patch_rules(transport(), {rule}).model.patches(), transport().patches());
  const PatchRule all{"all", {"*"}, {}};
  rule.faces = {"*wing*"};
  EXPECT_EQ(refusal_of({all, rule}), "");
}

TEST(PatchRules, SayWhereTheyStandAndWhatBecameOfTheirFaces) {
  PatchRule rule{"te", {"te_left"}, {}};
  rule.where = "case.yaml:7:3";
  EXPECT_EQ(refusal_of({rule}).rfind("case.yaml:7:3: patches.te: no face", 0), 0U) << refusal_of({rule});
  const std::string removed = refusal_of({rule}, {{"te_left", "trailing edge 'te_left' was closed"}});
  EXPECT_EQ(
      removed,
      "case.yaml:7:3: patches.te: the file has 'te_left', but the domain has not: trailing edge 'te_left' "
      "was closed. Remedy: `optional: true` where the rule may match nothing");
}

TEST(PatchRules, NamesOfAFluidsBoxTellThatItIsABody) {
  for (const char* side : {"xmin", "zmax", "re:^y(min|max)$"}) {
    const std::string text = refusal_of({{"inlet", {side}, PatchType::inlet}});
    EXPECT_NE(text.find("taken as a body"), std::string::npos) << text;
    EXPECT_NE(text.find("`geometry.domain: fluid`"), std::string::npos) << text;
  }
  EXPECT_EQ(refusal_of({{"inlet", {"inflow_7"}, PatchType::inlet}}).find("taken as a body"),
            std::string::npos);
}

}  // namespace
}  // namespace aeroloom::cases
