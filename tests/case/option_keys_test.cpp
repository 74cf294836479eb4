#include "aeroloom/case/option_keys.hpp"

#include "aeroloom/case/case.hpp"

#include <gtest/gtest.h>

namespace aeroloom::cases {
namespace {

TEST(OptionKeys, OptionsAreNamedByTheKeysThatSetThem) {
  EXPECT_EQ(with_keys("smaller pieces (VolumeOptions::piece_tets) or SizingOptions::minimum"),
            "smaller pieces (volume.piece_tets) or sizing.minimum");
  EXPECT_EQ(with_keys("take them as bodies (DomainOptions::kind: body)"),
            "take them as bodies (geometry.domain: body)");
  EXPECT_EQ(with_keys("FarFieldOptions::symmetry and FarFieldOptions::symmetry_position"),
            "farfield.symmetry and farfield.symmetry_position");
  EXPECT_EQ(with_keys("nothing to name"), "nothing to name");
}

TEST(OptionKeys, KeysThatMessagesNameExist) {
  EXPECT_NO_THROW(
      case_of_overrides({"volume.piece_tets=1000", "sizing.minimum=0.1", "sizing.curvature_angle=10",
                         "geometry.domain=body", "farfield.symmetry=y", "farfield.symmetry_position=0"}));
}

}  // namespace
}  // namespace aeroloom::cases
