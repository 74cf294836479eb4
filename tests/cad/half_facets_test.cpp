// Halves of bodies of triangles, closed by their plane of symmetry.
#include "cad/faceted/half_facets.hpp"

#include "cad/domain/domain.hpp"
#include "cad/faceted/facet_sides.hpp"
#include "cad/faceted/faceted_domain.hpp"
#include "cad/faceted/make_facet_complex.hpp"
#include "geometry/angle.hpp"
#include "tests/cad/faceted_shapes.hpp"
#include "tests/cad/model_checks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::cad {
namespace {

using faceted::add_triangle;
using std::numbers::pi;

FarFieldOptions half(std::optional<double> position = {}) {
  return {.shape = FarFieldShape::box, .extent = 3, .symmetry = Symmetry::y, .symmetry_position = position};
}

struct Half {
  Model model;
  std::string changes;
};

Half half_of(FacetSoup soup, const FarFieldOptions& far_field = half(),
             const std::vector<std::string>& close = {}) {
  DomainOptions options;
  options.file = soup.file;
  options.kind = DomainKind::body;
  options.far_field = far_field;
  Changes changes;
  OpeningRules openings(close);
  const FacetPlane plane = close_half_facets(soup, far_field, openings, changes);
  const FacetComplex complex =
      make_facet_complex(std::move(soup), 40 * geometry::degree, changes, CrossingFacets::unite);
  Domain domain = make_faceted_domain(options, complex, changes, plane);
  std::string text;
  for (const Change& change : domain.report.changes) text += change.what + "\n";
  return {std::move(domain.model), text};
}

std::string half_refusal(const FacetSoup& soup, const FarFieldOptions& far_field = half()) {
  try {
    half_of(soup, far_field);
  } catch (const CadError& error) {
    return error.what();
  }
  return "made";
}

double area_of_patch(const Model& model, const std::string& patch) {
  double area = 0;
  for (FaceId f = 0; f < model.face_count(); ++f)
    if (model.patches()[model.face(f).patch] == patch) area += model.face_area(f);
  return area;
}

/// The plane is exact in every bit, and its area and the body's are those wanted.
void expect_half(const Half& half, double on_plane, double of_body, bool round = false) {
  double far = 0;
  for (FaceId f = 0; f < half.model.face_count(); ++f) {
    if (half.model.patches()[half.model.face(f).patch] != "symmetry") continue;
    EXPECT_TRUE(half.model.is_far_field(f));
    for (const Vec3 p : half.model.facets(f, 1, 1).points) {
      EXPECT_EQ(p.y, 0);
      far = std::max(far, norm(p));
    }
  }
  EXPECT_GT(far, 0);
  EXPECT_NEAR(area_of_patch(half.model, "body"), of_body, 1e-3 * of_body);
  const Vec3 size = half.model.bounds().size();
  const double whole = size.x * size.z * (round ? pi / 4 : 1);
  EXPECT_NEAR(area_of_patch(half.model, "symmetry") + on_plane, whole, (round ? 2e-3 : 1e-9) * whole)
      << half.changes;
}

void drop_triangles(FacetSoup& soup, const std::function<bool(const std::array<Vec3, 3>&)>& dropped) {
  for (std::size_t t = soup.triangles.size(); t-- > 0;) {
    if (!dropped(corners_of(soup, t))) continue;
    soup.triangles.erase(soup.triangles.begin() + static_cast<std::ptrdiff_t>(t));
    soup.group_of.erase(soup.group_of.begin() + static_cast<std::ptrdiff_t>(t));
  }
}

bool all_at(const std::array<Vec3, 3>& corners, int axis, double value) {
  return std::ranges::all_of(corners, [&](Vec3 p) { return p[axis] == value; });
}

/// A box from the plane outward without its side there, and without others that are named by axis and value.
FacetSoup open_box(Vec3 low, Vec3 high, const std::vector<std::pair<int, double>>& open = {}) {
  FacetSoup soup = faceted::box_soup(low, high);
  drop_triangles(soup, [&](const std::array<Vec3, 3>& corners) {
    return all_at(corners, 1, low.y) || std::ranges::any_of(open, [&](const auto& side) {
             return all_at(corners, side.first, side.second);
           });
  });
  return soup;
}

FacetSoup moved(FacetSoup soup, const std::function<Vec3(Vec3)>& by) {
  for (Vec3& p : soup.points) p = by(p);
  return soup;
}

void append(FacetSoup& soup, const FacetSoup& more) {
  const auto first = static_cast<std::int32_t>(soup.points.size());
  soup.points.insert(soup.points.end(), more.points.begin(), more.points.end());
  for (const auto& [a, b, c] : more.triangles) add_triangle(soup, a + first, b + first, c + first);
}

TEST(HalfFacets, AnOpenHalfIsClosedByThePlane) {
  const Half made = half_of(open_box({0, 0, 0}, {2, 1, 1}));
  expect_half(made, 2, 2 + 2 * 2 + 2 * 1);
  EXPECT_NE(made.changes.find("closed by the plane"), std::string::npos);
  EXPECT_EQ(made.changes.find("put on"), std::string::npos);
}

TEST(HalfFacets, BordersAndFlatSidesBesideThePlaneArePutOnIt) {
  for (const double by : {1e-5, -1e-5}) {
    const auto beside = [&](Vec3 p) { return p.y == 0 ? Vec3{p.x, by * (1 + p.x), p.z} : p; };
    const Half open = half_of(moved(open_box({0, 0, 0}, {2, 1, 1}), beside));
    expect_half(open, 2, 8);
    EXPECT_NE(open.changes.find("put on the plane"), std::string::npos);
    const Half closed = half_of(moved(faceted::box_soup({0, 0, 0}, {2, 1, 1}), beside));
    expect_half(closed, 2, 8);
    EXPECT_NE(closed.changes.find("put on the plane"), std::string::npos);
  }
}

TEST(HalfFacets, WhatReachesBeyondThePlaneIsCut) {
  expect_half(half_of(faceted::box_soup({0, -1, 0}, {2, 1, 1})), 2, 8);
  expect_half(half_of(open_box({0, -0.5, 0}, {2, 1, 1}), half(0)), 2, 8);
}

TEST(HalfFacets, AFlatSideThatMissesThePlaneIsRefusedInDegreesAndLengths) {
  const FacetSoup tilted = moved(faceted::box_soup({0, 0, 0}, {2, 1, 1}), [](Vec3 p) {
    return p.y == 0 ? Vec3{p.x, 2e-3 * p.x, p.z} : p;
  });
  const std::string refusal = half_refusal(tilted);
  EXPECT_NE(refusal.find("tilted by 0.115 degrees"), std::string::npos) << refusal;
  EXPECT_NE(refusal.find("from 0 to 0.004"), std::string::npos) << refusal;
  const std::string missed = half_refusal(open_box({0, 0.1, 0}, {2, 1, 1}), half(0));
  EXPECT_NE(missed.find("misses the triangles"), std::string::npos) << missed;
}

/// A slender wing along y with a blunt base; both its base and its tip are open.
TEST(HalfFacets, ABluntBaseWithAnOpenTipIsClosedBetweenItsSides) {
  const Half made = half_of(open_box({0, 0, 0}, {1, 3, 0.05}, {{0, 1}, {1, 3}}));
  expect_half(made, 0.05, 2 * 3 + 2 * 3 * 0.05 + 0.05);
  EXPECT_NE(made.changes.find("closed between its sides"), std::string::npos) << made.changes;
}

TEST(HalfFacets, ABorderAFinLeavesOpenIsClosedDownToThePlane) {
  const Half made = half_of(open_box({0, 0, 0}, {2, 0.05, 1}, {{0, 2}, {2, 1}}));
  expect_half(made, 2, 2 + 2 * 0.05 * (2 + 1));
  EXPECT_NE(made.changes.find("closed down to the plane"), std::string::npos) << made.changes;
}

TEST(HalfFacets, WhatIsOpenAndWideIsRefusedWithItsSize) {
  FacetSoup soup = open_box({0, 0, 0}, {2, 2, 2}, {{0, 2}, {1, 2}});
  const std::string refusal = half_refusal(soup);
  EXPECT_NE(refusal.find("is too wide to be closed"), std::string::npos) << refusal;
  EXPECT_NE(refusal.find("10 long"), std::string::npos) << refusal;
}

TEST(HalfFacets, AWideOpeningThatTheCaseNamesIsClosed) {
  const FacetSoup soup = open_box({0, 0, 0}, {2, 2, 2}, {{0, 2}, {1, 2}});
  EXPECT_NE(
      half_of(soup, half(), {"1.9 -0.1 -0.1 2.1 2.1 2.1", "-1 -1 -1 3 3 3"}).changes.find("closed between"),
      std::string::npos);
  EXPECT_THROW(half_of(open_box({0, 0, 0}, {1, 3, 0.05}, {{0, 1}, {1, 3}}), half(), {"refuse"}), CadError);
}

TEST(HalfFacets, BodiesThatCrossAreClosedOneByOneAndUnited) {
  FacetSoup soup = open_box({0, 0, 0}, {4, 0.5, 1});
  append(soup, open_box({1, 0, 0.4}, {2, 3, 0.6}));
  expect_half(half_of(soup), 4, 4 + 2 * 2 + 2 * 0.5 - 0.2 + 0.2 + 2.5 * 2 * 1.2);
}

TEST(HalfFacets, ACavityThatThePlaneClosesDoesNotReachTheFluid) {
  FacetSoup soup = open_box({0, 0, 0}, {4, 2, 2});
  FacetSoup cavity = open_box({1, 0, 0.5}, {3, 1, 1.5});
  for (auto& t : cavity.triangles) std::swap(t[1], t[2]);
  append(soup, cavity);
  const Half made = half_of(soup);
  expect_half(made, 8, 8 + 16 + 8);
  EXPECT_NE(made.changes.find("a cavity inside a body"), std::string::npos) << made.changes;
}

TEST(HalfFacets, AHemisphereFindsThePlane) {
  FarFieldOptions automatic = half();
  automatic.shape = FarFieldShape::hemisphere;
  automatic.symmetry = Symmetry::automatic;
  expect_half(half_of(open_box({0, 0, 0}, {2, 1, 1}), automatic), 2, 8, true);
}

TEST(HalfFacets, AnOpenHalfWithoutTheKeyIsToldSo) {
  Changes changes;
  FacetSoup jagged = moved(open_box({0, 0, 0}, {2, 1, 1}), [](Vec3 p) {
    return p.y == 0 && p.x == 0 ? Vec3{p.x, 2e-4 * p.z, p.z} : p;
  });
  std::string text;
  try {
    make_facet_complex(jagged, 40 * geometry::degree, changes);
  } catch (const CadError& error) {
    text = error.what();
  }
  EXPECT_NE(text.find("seems to be half of a model, open on the plane y = 0"), std::string::npos) << text;
  make_facet_complex(open_box({0, 0, 0}, {2, 1, 1}), 40 * geometry::degree, changes);
  EXPECT_TRUE(std::ranges::any_of(changes, [](const Change& change) {
    return change.what.find("half of a model") != std::string::npos;
  }));
}

}  // namespace
}  // namespace aeroloom::cad
