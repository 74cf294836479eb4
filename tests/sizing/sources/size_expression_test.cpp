#include "sizing/sources/size_expression.hpp"

#include "sizing/sources/size_requests.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

namespace aeroloom::sizing {
namespace {

std::string refusal(const std::string& text) {
  try {
    const SizeExpression parsed(text);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(SizeExpression, IsAFormulaOfThePlace) {
  const SizeExpression distance("max(0.1, 0.2*sqrt(x^2 + y^2 + z^2))");
  EXPECT_DOUBLE_EQ(distance({0, 0, 0}), 0.1);
  EXPECT_DOUBLE_EQ(distance({2, 3, 6}), 1.4);
  EXPECT_DOUBLE_EQ(SizeExpression("x > 1 && y < 2 ? 0.5 : pi")({2, 1, 0}), 0.5);
  EXPECT_EQ(distance.text(), "max(0.1, 0.2*sqrt(x^2 + y^2 + z^2))");
}

TEST(SizeExpression, NamesWhatIsNoPartOfAFormula) {
  EXPECT_NE(refusal("0.1*foo").find("\"foo\""), std::string::npos);
  EXPECT_NE(refusal("sqrt(x").find("parenthesis"), std::string::npos);
  EXPECT_NE(refusal("1, 2").find("one value"), std::string::npos);
  for (const char* assignment : {"x = 1", "y = x", "x > 1 ? (y = 2) : 3"})
    EXPECT_NE(refusal(assignment).find("assigned"), std::string::npos) << assignment;
  EXPECT_EQ(refusal("x == 1 ? 2 : x >= 1 ? 3 : 4"), "");
}

TEST(SizeExpression, NamesThePlaceWhereItIsNoSize) {
  for (const char* text : {"1 - x", "1/(x - 2)", "sqrt(1 - x)"}) {
    try {
      SizeExpression parsed(text);
      parsed({2, 3, 4});
      FAIL() << text;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find("(2, 3, 4)"), std::string::npos) << error.what();
    }
  }
}

const geometry::Box domain{{-10, -10, -10}, {10, 10, 6}};

std::vector<SizeSource> sources(const std::string& text, double minimum, int rank, int ranks) {
  return sources_of_formula(RootCube(domain), {SizeExpression(text), minimum},
                            {domain, {{-1, -1, -1}, {1, 1, 1}}, 1, 4, std::log(1.3)}, rank, ranks);
}

TEST(SizeExpression, IsFollowedByTheField) {
  SizingOptions options;
  options.minimum = 0.01;
  options.maximum = 4;
  const std::string text = "0.2 + 0.15*abs(z - 1) + 0.05*x/10";
  const SizeExpression wanted(text);
  const SizeField field = SizeField::build(domain, sources(text, 0, 0, 1), options);
  double worst = 0;
  for (double x = -9; x < 10; x += 1.37) {
    for (double y = -9; y < 10; y += 2.11) {
      for (double z = -9; z < 6; z += 0.73)
        worst = std::max(worst, std::abs(field({x, y, z}) / wanted({x, y, z}) - 1));
    }
  }
  EXPECT_LT(worst, 0.15);
}

TEST(SizeExpression, ADentAtTheBodyIsSeen) {
  // A fortieth of the domain wide, between the first cells' middles.
  const std::vector<SizeSource> found =
      sources("4 - 3.9*exp(-((x-0.3)^2+(y-0.4)^2+(z-0.3)^2)/0.01)", 0, 0, 1);
  const auto smallest = std::min_element(found.begin(), found.end(),
                                         [](const auto& a, const auto& b) { return a.size < b.size; });
  ASSERT_NE(smallest, found.end());
  EXPECT_LT(smallest->size, 0.15);
  EXPECT_LT(distance(smallest->point, {0.3, 0.4, 0.3}), 0.1);
}

TEST(SizeExpression, AsksWhateverTheRanksAndNeverBelowItsMinimum) {
  const std::string text = "0.1*sqrt(x^2 + y^2 + z^2) + 1e-6";
  std::vector<SizeSource> one = sources(text, 0.3, 0, 1), three;
  for (int rank = 0; rank < 3; ++rank) {
    const auto part = sources(text, 0.3, rank, 3);
    three.insert(three.end(), part.begin(), part.end());
  }
  const auto comes_before = [](const SizeSource& a, const SizeSource& b) {
    return std::tie(a.point.x, a.point.y, a.point.z) < std::tie(b.point.x, b.point.y, b.point.z);
  };
  std::sort(one.begin(), one.end(), comes_before);
  std::sort(three.begin(), three.end(), comes_before);
  ASSERT_EQ(one.size(), three.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(distance(one[i].point, three[i].point), 0);
    EXPECT_EQ(one[i].size, three[i].size);
    EXPECT_GE(one[i].size, 0.3);
  }
  EXPECT_EQ(sources_of_formula(RootCube(domain), {SizeExpression(text), 0.001}, {domain, domain, 1, 4, 0.2},
                               0, 1, 1000)
                .size(),
            1001u);
}

}  // namespace
}  // namespace aeroloom::sizing
