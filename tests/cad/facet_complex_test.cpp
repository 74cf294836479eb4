// From triangles to regions, faces, curves and vertices; what is repaired, and what is refused.
#include "cad/faceted/facet_complex.hpp"

#include "cad/faceted/facet_facts.hpp"
#include "cad/faceted/make_facet_complex.hpp"
#include "geometry/angle.hpp"
#include "tests/cad/faceted_shapes.hpp"
#include "tests/cad/real_files.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::cad {
namespace {

using faceted::add_box;
using faceted::add_triangle;
using faceted::box_soup;

constexpr double limit = 40 * geometry::degree;

std::vector<double> region_volumes(const FacetComplex& complex) {
  std::vector<double> volumes(complex.regions.size(), 0);
  for (std::size_t t = 0; t < complex.triangles.size(); ++t) {
    const auto& [a, b, c] = complex.triangles[t];
    const double volume =
        volume6(complex.points[0], complex.points[a], complex.points[b], complex.points[c]) / 6;
    const FacetComplex::Face& face = complex.faces[complex.face_of[t]];
    volumes.at(face.front) += volume;
    if (face.back != no_entity) volumes.at(face.back) -= volume;
  }
  return volumes;
}

/// What every complex holds to, whatever it was made of.
void expect_sound(const FacetComplex& complex) {
  using Side = std::pair<std::int32_t, std::int32_t>;
  std::map<Side, std::vector<FaceId>> faces_at;
  std::map<Side, int> curves_at;
  std::vector<int> used(complex.points.size(), 0);
  for (std::size_t t = 0; t < complex.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const std::int32_t a = complex.triangles[t][i], b = complex.triangles[t][(i + 1) % 3];
      faces_at[std::minmax(a, b)].push_back(complex.face_of[t]);
      used[a] = 1;
    }
  }
  EXPECT_EQ(std::count(used.begin(), used.end(), 0), 0);
  EXPECT_TRUE(std::is_sorted(complex.vertices.begin(), complex.vertices.end()));
  const auto is_vertex = [&](std::int32_t p) {
    return std::binary_search(complex.vertices.begin(), complex.vertices.end(), p);
  };
  for (const FacetComplex::Curve& curve : complex.curves) {
    ASSERT_GE(curve.points.size(), 2U);
    EXPECT_TRUE(is_vertex(curve.points.front()) && is_vertex(curve.points.back()));
    for (std::size_t i = 0; i + 1 < curve.points.size(); ++i) {
      EXPECT_EQ(++curves_at[std::minmax(curve.points[i], curve.points[i + 1])], 1);
      EXPECT_TRUE(i == 0 || !is_vertex(curve.points[i]));
    }
  }
  for (const auto& [side, faces] : faces_at) {
    EXPECT_GE(faces.size(), 2U);
    if (faces.size() != 2 || faces[0] != faces[1]) {
      EXPECT_EQ(curves_at.count(side), 1U);
    }
  }
  for (const auto& [side, count] : curves_at) EXPECT_EQ(faces_at.count(side), 1U);
  for (const FacetComplex::Face& face : complex.faces) {
    EXPECT_NE(face.front, no_entity);
    EXPECT_NE(face.front, face.back);
  }
  for (const double volume : region_volumes(complex)) EXPECT_GT(volume, 0);
}

FacetComplex make(const FacetSoup& soup, Changes& changes) {
  FacetComplex complex = make_facet_complex(soup, limit, changes);
  expect_sound(complex);
  return complex;
}
FacetComplex make(const FacetSoup& soup) {
  Changes changes;
  return make(soup, changes);
}

std::string refusal_of(const FacetSoup& soup) {
  Changes changes;
  try {
    make_facet_complex(soup, limit, changes);
  } catch (const CadError& error) {
    EXPECT_NE(std::string(error.what()).find(soup.file), std::string::npos);
    return error.what();
  }
  return "made";
}

bool mentions(const Changes& changes, const std::string& what) {
  return std::any_of(changes.begin(), changes.end(),
                     [&](const Change& change) { return change.what.find(what) != std::string::npos; });
}

TEST(FacetComplexes, ABoxHasSixFacesTwelveCurvesEightVertices) {
  const FacetComplex complex = make(box_soup({0, 0, 0}, {1, 2, 3}));
  EXPECT_EQ(complex.faces.size(), 6U);
  EXPECT_EQ(complex.curves.size(), 12U);
  EXPECT_EQ(complex.vertices.size(), 8U);
  ASSERT_EQ(complex.regions.size(), 1U);
  EXPECT_NEAR(region_volumes(complex)[0], 6, 1e-12);
  EXPECT_FALSE(complex.faces[0].cavity);
}

TEST(FacetComplexes, ACylinderHasThreeFacesAndClosedCurvesWithOneVertex) {
  const FacetComplex complex = make(faceted::cylinder_soup(24, 5, 4));
  EXPECT_EQ(complex.faces.size(), 3U);
  ASSERT_EQ(complex.curves.size(), 2U);
  EXPECT_EQ(complex.vertices.size(), 2U);
  EXPECT_EQ(complex.curves[0].points.size(), 25U);
  EXPECT_EQ(complex.curves[0].points.front(), complex.curves[0].points.back());
}

TEST(FacetComplexes, StripsOfACoarseCylinderAreOneFace) {
  EXPECT_EQ(make(faceted::cylinder_soup(8, 1, 2)).faces.size(), 3U);
  EXPECT_EQ(make(faceted::cylinder_soup(6, 1, 2)).faces.size(), 8U);  // a hexagon is one
}

TEST(FacetComplexes, NormalsOfTheFileDoNotMatter) {
  FacetSoup soup = box_soup({0, 0, 0}, {1, 1, 1});
  for (std::size_t t = 0; t < soup.triangles.size(); t += 3)
    std::swap(soup.triangles[t][0], soup.triangles[t][1]);
  Changes changes;
  EXPECT_NEAR(region_volumes(make(soup, changes))[0], 1, 1e-12);
  EXPECT_TRUE(mentions(changes, "4 triangles are turned round"));
  FacetSoup inwards = faceted::empty_soup();
  add_box(inwards, {0, 0, 0}, {1, 1, 1}, true);
  EXPECT_NEAR(region_volumes(make(inwards))[0], 1, 1e-12);
}

TEST(FacetComplexes, ABoxTurnedInwardIsEmptyAndOneWithinItIsNot) {
  FacetSoup soup = box_soup({0, 0, 0}, {6, 6, 6});
  add_box(soup, {1, 1, 1}, {5, 5, 5}, true);
  add_box(soup, {2, 2, 2}, {3, 3, 3}, true);
  add_box(soup, {9, 0, 0}, {10, 1, 1});
  const FacetComplex complex = make(soup);
  const std::vector<double> volumes = region_volumes(complex);
  ASSERT_EQ(volumes.size(), 3U);
  EXPECT_NEAR(volumes[0], 216 - 64, 1e-9);
  EXPECT_NEAR(volumes[1], 1, 1e-9);
  EXPECT_NEAR(volumes[2], 1, 1e-9);
  int cavities = 0;
  for (const FacetComplex::Face& face : complex.faces) cavities += face.cavity;
  EXPECT_EQ(cavities, 12);  // of the second box, and of the third, which lies in the void
}

TEST(FacetComplexes, BoxesThatShareASideAreTwoRegions) {
  FacetSoup soup = box_soup({0, 0, 0}, {1, 1, 1});
  add_box(soup, {1, 0, 0}, {3, 1, 1});
  const FacetComplex complex = make(soup);
  const std::vector<double> volumes = region_volumes(complex);
  ASSERT_EQ(volumes.size(), 2U);
  EXPECT_NEAR(volumes[0], 1, 1e-12);
  EXPECT_NEAR(volumes[1], 2, 1e-12);
  EXPECT_EQ(complex.faces.size(), 11U);
  int between = 0;
  for (const FacetComplex::Face& face : complex.faces) between += face.back != no_entity;
  EXPECT_EQ(between, 1);
}

TEST(FacetComplexes, HolesAndRegionsOfPoly) {
  const real::TemporaryFile file("cube.poly", faceted::poly_text());
  FacetSoup soup = read_facets(file.path());
  const FacetComplex complex = make(soup);
  EXPECT_EQ(complex.regions, (std::vector<std::string>{"region_10", "region_20"}));
  EXPECT_NEAR(region_volumes(complex)[0], 4, 1e-12);
  EXPECT_NEAR(region_volumes(complex)[1], 4, 1e-12);
  soup.holes.push_back({1, 1, 1.5});
  Changes changes;
  const FacetComplex lower = make(soup, changes);
  ASSERT_EQ(lower.regions.size(), 1U);
  EXPECT_NEAR(region_volumes(lower)[0], 4, 1e-12);
  EXPECT_EQ(lower.faces.size(), 6U);
  EXPECT_FALSE(lower.faces[1].cavity);  // the void is open to the outside: its facets are left out
  EXPECT_TRUE(mentions(changes, "between two empty spaces"));
}

TEST(FacetComplexes, GroupsAreFaces) {
  FacetSoup soup = box_soup({0, 0, 0}, {1, 1, 1});
  soup.groups = {{"walls", "part"}, {"corner", "part"}};
  soup.group_of[3] = 1;
  const FacetComplex complex = make(soup);
  EXPECT_EQ(complex.faces.size(), 7U);
  EXPECT_EQ(complex.faces[complex.face_of[3]].name, "corner");
  EXPECT_EQ(complex.faces[complex.face_of[3]].part, "part");
}

/// The unit box whose sides with y = 0 meet the bottom in a point that the bottom does not have.
FacetSoup box_with_loose_point(Vec3 loose) {
  FacetSoup soup = box_soup({0, 0, 0}, {1, 1, 1});
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    const auto corners = soup.triangles[t];
    for (int i = 0; i < 3; ++i) {
      const std::int32_t a = corners[i], b = corners[(i + 1) % 3], c = corners[(i + 2) % 3];
      if (a != 0 || b != 1) continue;
      const auto p = static_cast<std::int32_t>(soup.points.size());
      soup.points.push_back(loose);
      soup.triangles[t] = {a, p, c};
      add_triangle(soup, p, b, c);
      return soup;
    }
  }
  return soup;
}

TEST(FacetComplexes, PointsOnSidesOfOthersSplitThem) {
  Changes changes;
  const FacetComplex exact = make(box_with_loose_point({0.25, 0, 0}), changes);
  EXPECT_EQ(exact.triangles.size(), 14U);
  EXPECT_EQ(exact.faces.size(), 6U);
  EXPECT_TRUE(mentions(changes, "split"));
  Changes near;
  EXPECT_EQ(make(box_with_loose_point({0.3, -2e-7, 1e-7}), near).triangles.size(), 14U);
  ASSERT_TRUE(mentions(near, "split"));
  EXPECT_GT(near.front().how_much, 1e-7);
  EXPECT_LT(near.front().how_much, 3e-7);
  Changes far;
  EXPECT_EQ(make(box_with_loose_point({0.3, -0.003, 0}), far).triangles.size(), 14U);
  EXPECT_TRUE(mentions(far, "a narrow opening of 3 sides"));
  EXPECT_FALSE(mentions(far, "split"));
}

TEST(FacetComplexes, TrianglesWithoutAreaAndRepeatedOnesGo) {
  FacetSoup soup = box_with_loose_point({0.25, 0, 0});
  add_triangle(soup, 0, 1, 8);
  add_triangle(soup, 3, 3, 2);
  add_triangle(soup, soup.triangles[4][1], soup.triangles[4][0], soup.triangles[4][2]);
  Changes changes;
  const FacetComplex complex = make(soup, changes);
  EXPECT_EQ(complex.triangles.size(), 14U);
  EXPECT_NEAR(region_volumes(complex)[0], 1, 1e-12);
  EXPECT_TRUE(mentions(changes, "2 triangles without area"));
  EXPECT_TRUE(mentions(changes, "1 triangles that others repeat"));
}

TEST(FacetComplexes, PointsThatNearlyMeetAreWelded) {
  FacetSoup soup = box_soup({0, 0, 0}, {1, 1, 1});
  for (int t = 0; t < 2; ++t) {  // the bottom has points of its own
    for (std::int32_t& corner : soup.triangles[t]) {
      soup.points.push_back(soup.points[corner] + Vec3{1e-7, -2e-7, 0});
      corner = static_cast<std::int32_t>(soup.points.size()) - 1;
    }
  }
  Changes changes;
  const FacetComplex complex = make(soup, changes);
  EXPECT_EQ(complex.points.size(), 8U);
  ASSERT_TRUE(mentions(changes, "4 points are made one"));
  EXPECT_NEAR(changes.front().how_much, std::sqrt(5) * 1e-7, 1e-12);
}

TEST(FacetComplexes, PlanarOpeningsAreClosed) {
  FacetSoup soup = faceted::cylinder_soup(24, 2, 6);
  std::vector<std::array<std::int32_t, 3>> walls;
  for (const auto& t : soup.triangles) {
    const bool cap = std::max({t[0], t[1], t[2]}) >= static_cast<std::int32_t>(soup.points.size()) - 2;
    if (!cap) walls.push_back(t);
  }
  soup.triangles = walls;
  soup.group_of.resize(walls.size());
  Changes changes;
  const FacetComplex complex = make(soup, changes);
  EXPECT_EQ(complex.faces.size(), 3U);
  EXPECT_EQ(complex.faces.back().name, "cap_2");
  EXPECT_TRUE(mentions(changes, "'cap_1'"));
  EXPECT_FALSE(mentions(changes, "turned"));
  FacetSoup sheet = box_soup({0, 0, 0}, {1, 1, 1});
  sheet.triangles.resize(4), sheet.group_of.resize(4);
  EXPECT_NE(refusal_of(sheet).find("not closed"), std::string::npos);
}

TEST(FacetComplexes, WhatCrossesOrOverlapsIsRefused) {
  FacetSoup soup = box_soup({0, 0, 0}, {1, 1, 1});
  soup.groups = {{"fuselage", {}}, {"wing", {}}};
  add_box(soup, {0.5, 0.2, 0.2}, {2, 0.7, 0.7});
  const std::string message = refusal_of(soup);
  EXPECT_NE(message.find("'fuselage' and 'wing' overlap"), std::string::npos) << message;
  FacetSoup folded = box_soup({0, 0, 0}, {1, 1, 1});
  folded.points[7] = {-1, -1, 0.5};
  EXPECT_NE(refusal_of(folded).find("crosses or touches itself"), std::string::npos);
}

TEST(FacetComplexes, AFlapWithinARegionIsNotClosed) {
  FacetSoup soup = box_soup({0, 0, 0}, {3, 3, 3});
  add_box(soup, {1, 1, 1}, {2, 2, 2});
  soup.filling = Filling::all;
  const auto a = static_cast<std::int32_t>(soup.points.size());
  soup.points.push_back({1.5, 1.5, 2.5});
  for (const auto& [from, to] : {std::pair(12, 13), std::pair(13, 12)}) add_triangle(soup, from, to, a);
  // One triangle twice is one, whose other sides are open.
  EXPECT_NE(refusal_of(soup).find("not closed"), std::string::npos);
}

TEST(FacetComplexes, SolidsThatTouchInAPointShareAVertex) {
  FacetSoup soup = box_soup({0, 0, 0}, {1, 1, 1});
  add_box(soup, {1, 1, 1}, {2, 2, 2});
  const FacetComplex complex = make(soup);
  EXPECT_EQ(complex.regions.size(), 2U);
  EXPECT_EQ(complex.vertices.size(), 15U);
}

TEST(FacetComplexes, AShortSharpScratchIsNoFeature) {
  FacetSoup soup = faceted::empty_soup();
  constexpr int cells = 12;
  const auto at = [](int i, int j) { return j * (cells + 1) + i; };
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i) {
      const bool bump = i == 6 && j == 6;
      soup.points.push_back({static_cast<double>(i), static_cast<double>(j), bump ? 0.47 : 0.0});
    }
  }
  for (int j = 0; j < cells; ++j) {
    for (int i = 0; i < cells; ++i) {
      add_triangle(soup, at(i, j), at(i + 1, j), at(i + 1, j + 1));
      add_triangle(soup, at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
  const auto base = static_cast<std::int32_t>(soup.points.size());
  soup.points.push_back({cells / 2.0, cells / 2.0, -8});
  for (int k = 0; k < cells; ++k) {
    add_triangle(soup, at(k + 1, 0), at(k, 0), base);
    add_triangle(soup, at(k, cells), at(k + 1, cells), base);
    add_triangle(soup, at(0, k), at(0, k + 1), base);
    add_triangle(soup, at(cells, k + 1), at(cells, k), base);
  }
  const FacetComplex complex = make(soup);
  EXPECT_EQ(complex.faces.size(), 5U);
  EXPECT_EQ(complex.curves.size(), 8U);
}

/// The top of the box has a fold along its diagonal, whose middle layer is one thin triangle: it joins a
/// half.
TEST(FacetComplexes, AThinFoldIsNoFace) {
  FacetSoup soup = box_soup({0, 0, 0}, {1, 1, 1});
  constexpr std::int32_t begin = 4, end = 7, beside = 6;
  const auto folded = static_cast<std::int32_t>(soup.points.size());
  soup.points.push_back({0.515, 0.485, 1.01});
  const auto top = std::find_if(soup.triangles.begin(), soup.triangles.end(), [&](const auto& triangle) {
    return std::is_permutation(triangle.begin(), triangle.end(), std::array{begin, end, beside}.begin());
  });
  ASSERT_NE(top, soup.triangles.end());
  *top = {begin, folded, beside};
  add_triangle(soup, folded, end, beside);
  add_triangle(soup, begin, end, folded);
  const FacetComplex complex = make(soup);
  EXPECT_EQ(complex.faces.size(), 7U);
  EXPECT_EQ(complex.curves.size(), 13U);
}

/// Files of the shared set that close: regions add up to what the divergence theorem gives for the file.
TEST(FacetComplexes, RealFiles) {
  const std::vector<std::string> files = {
      "netgen_plane.stl",           "netgen_hinge.stl",  "cgal_fandisk.off",     "cgal_rotor.off",
      "queso_cube_with_cavity.stl", "axom_aatbase3.stl", "cgal_anchor_dense.off"};
  for (const std::string& name : files) {
    if (!real::has("faceted/" + name)) GTEST_SKIP() << "no " << name;
    SCOPED_TRACE(name);
    const FacetSoup soup = read_facets(real::file("faceted/" + name));
    const FacetFacts facts = look_at_facets(soup);
    const std::vector<double> volumes = region_volumes(make(soup));
    ASSERT_EQ(volumes.size(), 1U);
    EXPECT_NEAR(volumes[0], facts.volume, 1e-9 * facts.volume);
  }
}

TEST(FacetComplexes, DamagedRealFilesAreRefused) {
  const std::vector<std::pair<std::string, std::string>> files = {
      {"attene_bust.off", "not closed"},
      {"firefish_martlet2_rocket.stl", "overlap"},
      {"manifold_self_intersectA.obj", "crosses"}};
  for (const auto& [name, why] : files) {
    if (!real::has("faceted/" + name)) GTEST_SKIP() << "no " << name;
    const std::string message = refusal_of(read_facets(real::file("faceted/" + name)));
    EXPECT_NE(message.find(why), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace aeroloom::cad
