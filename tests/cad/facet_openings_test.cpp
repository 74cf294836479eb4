// Openings of triangles that are filled: small holes, narrow ones, borders beside each other.
#include "cad/faceted/fill_openings.hpp"
#include "cad/faceted/make_facet_complex.hpp"
#include "geometry/angle.hpp"
#include "tests/cad/faceted_shapes.hpp"
#include "tests/cad/model_checks.hpp"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::cad {
namespace {

using faceted::add_triangle;

constexpr double feature_angle = 40 * geometry::degree;

struct Made {
  FacetComplex complex;
  std::string changes;
};

Made made_of(const FacetSoup& soup, const std::vector<std::string>& close = {}) {
  Changes changes;
  OpeningRules openings(close);
  Made made{make_facet_complex(soup, feature_angle, changes, CrossingFacets::join, {}, &openings), {}};
  openings.require_use();
  for (const Change& change : changes) made.changes += change.what + "\n";
  return made;
}

double volume_inside(const FacetComplex& complex) {
  double volume = 0;
  for (const auto& [a, b, c] : complex.triangles)
    volume += dot(complex.points[a], cross(complex.points[b], complex.points[c])) / 6;
  return volume;
}

void take_out(FacetSoup& soup, std::size_t triangle) {
  soup.triangles.erase(soup.triangles.begin() + static_cast<std::ptrdiff_t>(triangle));
  soup.group_of.erase(soup.group_of.begin() + static_cast<std::ptrdiff_t>(triangle));
}

/// A point of the outline of a square of side 1, `at` sides along it, off its side by `off`.
Vec3 on_square(double at, double off, double z) {
  const int side = static_cast<int>(at) % 4;
  const double along = at - std::floor(at);
  const double across = along > 0 ? -off : 0;
  const Vec3 places[] = {
      {along, across, z}, {1 - across, along, z}, {1 - along, 1 - across, z}, {across, 1 - along, z}};
  return places[side];
}

/// A prism over the square whose top is a part of its own, with other points along its border than the walls.
FacetSoup prism_with_loose_top(int of_walls, int of_top, double off) {
  FacetSoup soup = faceted::empty_soup();
  const auto ring = [&](int per_side, double z, double by) {
    const auto first = static_cast<std::int32_t>(soup.points.size());
    for (int i = 0; i < 4 * per_side; ++i)
      soup.points.push_back(on_square(static_cast<double>(i) / per_side, by, z));
    return first;
  };
  const auto fan = [&](std::int32_t first, int count, double z, bool up) {
    const auto middle = static_cast<std::int32_t>(soup.points.size());
    soup.points.push_back({0.5, 0.5, z});
    for (int i = 0; i < count; ++i) {
      const std::int32_t a = first + i, b = first + (i + 1) % count;
      add_triangle(soup, middle, up ? a : b, up ? b : a);
    }
  };
  const std::int32_t low = ring(of_walls, 0, 0), high = ring(of_walls, 1, off), top = ring(of_top, 1, 0);
  for (int i = 0; i < 4 * of_walls; ++i) {
    const int j = (i + 1) % (4 * of_walls);
    add_triangle(soup, low + i, low + j, high + j);
    add_triangle(soup, low + i, high + j, high + i);
  }
  fan(low, 4 * of_walls, 0, false);
  fan(top, 4 * of_top, 1, true);
  return soup;
}

TEST(FacetOpenings, TwoHolesOfThreeSidesAreFilledAndJoinTheSurface) {
  FacetSoup ball = faceted::ball_soup({0, 0, 0}, 1, 60);
  const double whole = faceted::volume_of(ball);
  take_out(ball, 700), take_out(ball, 300);
  const Made made = made_of(ball);
  EXPECT_NEAR(volume_inside(made.complex), whole, 1e-12);
  EXPECT_EQ(made.complex.faces.size(), 1U);
  EXPECT_NE(made.changes.find("2 small hole(s) of 6 sides in all"), std::string::npos) << made.changes;
}

TEST(FacetOpenings, HolesThatTouchInAPointAreTwo) {
  FacetSoup ball = faceted::ball_soup({0, 0, 0}, 1, 24);
  const double whole = faceted::volume_of(ball);
  const auto& first = ball.triangles[300];
  std::size_t other = 0;
  for (std::size_t t = 301; other == 0; ++t) {
    int common = 0;
    for (const std::int32_t p : ball.triangles[t]) common += p == first[0] || p == first[1] || p == first[2];
    if (common == 1) other = t;
  }
  take_out(ball, other), take_out(ball, 300);
  EXPECT_NEAR(volume_inside(made_of(ball).complex), whole, 1e-12);
}

/// A lens along z whose end at the top is slanted and bent, and open.
FacetSoup bent_lens(double thickness) {
  FacetSoup soup = faceted::cylinder_soup(60, 12, 4);
  for (Vec3& p : soup.points) {
    p = {p.x, 0.5 * thickness * p.y, p.z};
    if (p.z == 4) p.z += 0.1 * std::sin(2 * p.x);
  }
  const auto top = static_cast<std::int32_t>(soup.points.size()) - 1;
  for (std::size_t t = soup.triangles.size(); t-- > 0;)
    if (soup.triangles[t][0] == top) take_out(soup, t);
  return soup;
}

TEST(FacetOpenings, ANarrowBentEndIsFilledAndAWideOneRefused) {
  const Made made = made_of(bent_lens(0.2));
  EXPECT_NE(made.changes.find("a narrow opening of 60 sides"), std::string::npos) << made.changes;
  EXPECT_GT(volume_inside(made.complex), 1);
  EXPECT_THROW(made_of(bent_lens(1.5)), CadError);
}

TEST(FacetOpenings, WideOnesThatTheCaseNamesAreClosed) {
  FacetSoup lens = bent_lens(1.5);
  for (const std::string name : {"body*", "-2 -2 3 2 2 5"}) {
    lens.groups.front().name = "body";
    const Made made = made_of(lens, {name});
    EXPECT_NE(made.changes.find("an opening that the case names of 60 sides"), std::string::npos)
        << made.changes;
    EXPECT_GT(volume_inside(made.complex), 8);
  }
  EXPECT_THROW(made_of(lens, {"other"}), CadError);
  EXPECT_THROW(made_of(lens, {"-2 -2 3 2 2 3.5"}), CadError);
  EXPECT_THROW(made_of(lens, {"1 2 3 4"}), CadError);
  EXPECT_THROW(made_of(bent_lens(0.2), {"other"}), CadError);  // it closes, and the name has no opening
  EXPECT_THROW(made_of(bent_lens(0.2), {"refuse"}), CadError);
  EXPECT_THROW(made_of(lens, {"refuse", "body"}), CadError);
}

TEST(FacetOpenings, BordersBesideEachOtherGetThePointsOfBoth) {
  const Made made = made_of(prism_with_loose_top(5, 4, 1e-6));
  EXPECT_NEAR(volume_inside(made.complex), 1, 1e-5);
  EXPECT_NE(made.changes.find("split where points of others lie"), std::string::npos) << made.changes;
  EXPECT_EQ(made.changes.find("hole"), std::string::npos) << made.changes;
}

TEST(FacetOpenings, SlitsBesideAPartThatTouchesAtCornersAreClosed) {
  const Made made = made_of(prism_with_loose_top(5, 4, 0.004));
  EXPECT_NEAR(volume_inside(made.complex), 1, 0.01);
  EXPECT_NE(made.changes.find("triangles named 'cap_4'"), std::string::npos) << made.changes;
  EXPECT_EQ(made.changes.find("turned"), std::string::npos) << made.changes;
}

TEST(FacetOpenings, AnEndThatIsNotWeldedIsClosedAllAround) {
  FacetSoup soup = faceted::cylinder_soup(40, 4, 4);
  const double whole = faceted::volume_of(soup);
  const auto top = static_cast<std::int32_t>(soup.points.size()) - 1, rim = top + 1;
  for (std::size_t t = soup.triangles.size(); t-- > 0;)
    if (soup.triangles[t][0] == top) take_out(soup, t);
  constexpr int count = 33;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count;
    soup.points.push_back({0.98 * std::cos(angle), 0.98 * std::sin(angle), i % 2 == 0 ? 4.02 : 4.03});
    add_triangle(soup, top, rim + i, rim + (i + 1) % count);
  }
  const Made made = made_of(soup);
  EXPECT_NEAR(volume_inside(made.complex), whole, 0.1);
  EXPECT_NE(made.changes.find("a narrow opening of 75 sides"), std::string::npos) << made.changes;
}

TEST(FacetOpenings, LongPolygonsAreCutBeforeTheyAreWeighed) {
  std::vector<Vec3> corners;
  constexpr int count = 600;
  for (int i = 0; i <= count; ++i) corners.push_back({0.01 * i, 0.02 * std::sin(0.01 * i), 0.02});
  for (int i = count; i >= 0; --i) corners.push_back({0.01 * i, 0.02 * std::cos(0.01 * i), 0});
  const auto triangles = span_polygon(corners, [](std::int32_t, std::int32_t) { return true; });
  EXPECT_EQ(triangles.size(), corners.size() - 2);
  double area = 0;
  for (const auto& [a, b, c] : triangles)
    area += 0.5 * norm(cross(corners[b] - corners[a], corners[c] - corners[a]));
  EXPECT_LT(area, 1.05 * 6 * 0.04);
}

}  // namespace
}  // namespace aeroloom::cad
