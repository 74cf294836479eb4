#include "mesh/data/patch.hpp"

#include <gtest/gtest.h>

namespace aeroloom::mesh {
namespace {

TEST(PatchLocal, NamesTellTypes) {
  EXPECT_EQ(patch_type_by_name("Symmetry plane"), PatchType::symmetry);
  EXPECT_EQ(patch_type_by_name("far_field"), PatchType::farfield);
  EXPECT_EQ(patch_type_by_name("Inlet 2"), PatchType::inlet);
  EXPECT_EQ(patch_type_by_name("OUTFLOW"), PatchType::outlet);
  EXPECT_EQ(patch_type_by_name("Slip"), PatchType::slip);
  EXPECT_EQ(patch_type_by_name("interior"), std::nullopt);
  EXPECT_EQ(patch_type_by_name("inlet_lip"), std::nullopt);
  EXPECT_EQ(patch_type_by_name("asymmetry"), std::nullopt);
}

}  // namespace
}  // namespace aeroloom::mesh
