#include "geometry/place_text.hpp"

#include <gtest/gtest.h>

namespace aeroloom::geometry {
namespace {

TEST(PlaceText, has_six_digits_of_each_coordinate) {
  EXPECT_EQ(place_text({36.2125, -0.0278189, 6}), "(36.2125, -0.0278189, 6)");
  EXPECT_EQ(place_text({1234567, 1e-7, 0.12345678}), "(1.23457e+06, 1e-07, 0.123457)");
}

}  // namespace
}  // namespace aeroloom::geometry
