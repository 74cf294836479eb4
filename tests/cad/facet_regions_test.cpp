// Regions of triangles: solids that touch share their faces, solids in others are regions or voids.
#include "cad/faceted/facet_complex.hpp"
#include "cad/faceted/facet_links.hpp"
#include "cad/faceted/make_facet_complex.hpp"
#include "geometry/angle.hpp"
#include "tests/cad/cad_shapes.hpp"
#include "tests/cad/faceted_shapes.hpp"
#include "tests/cad/model_checks.hpp"
#include "tests/cad/real_files.hpp"

#include <algorithm>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <BRepPrimAPI_MakeBox.hxx>
#include <gtest/gtest.h>

namespace aeroloom::cad {
namespace {

using faceted::add_box;
using faceted::box_soup;

constexpr double edge_angle = 40 * geometry::degree;

/// A box as a group of its own.
void add_solid(FacetSoup& soup, const std::string& name, Vec3 low, Vec3 high, bool inwards = false) {
  if (soup.triangles.empty()) soup.groups.clear();
  soup.groups.push_back({name, {}});
  add_box(soup, low, high, inwards);
}

/// The other diagonal in every side of a box that was added last.
void turn_diagonals(FacetSoup& soup) {
  for (std::size_t t = soup.triangles.size() - 12; t < soup.triangles.size(); t += 2) {
    const auto [a, b, c] = soup.triangles[t];
    const std::int32_t d = soup.triangles[t + 1][2];
    soup.triangles[t] = {b, c, d}, soup.triangles[t + 1] = {b, d, a};
  }
}

FacetSoup halves(bool named = true) {
  FacetSoup soup = faceted::empty_soup();
  if (named) {
    add_solid(soup, "left", {0, 0, 0}, {1, 1, 1});
    add_solid(soup, "right", {1, 0, 0}, {3, 1, 1});
  } else {
    add_box(soup, {0, 0, 0}, {1, 1, 1});
    add_box(soup, {1, 0, 0}, {3, 1, 1});
  }
  turn_diagonals(soup);
  return soup;
}

FacetComplex joined(FacetSoup soup, Changes& changes, const std::vector<std::string>& voids = {}) {
  return make_facet_complex(std::move(soup), edge_angle, changes, CrossingFacets::join, voids);
}
FacetComplex joined(FacetSoup soup, const std::vector<std::string>& voids = {}) {
  Changes changes;
  return joined(std::move(soup), changes, voids);
}

std::string refusal(FacetSoup soup, const std::vector<std::string>& voids = {}) {
  try {
    joined(std::move(soup), voids);
  } catch (const CadError& error) {
    return error.what();
  }
  return "made";
}

std::vector<double> volumes_of(const FacetComplex& complex) {
  std::vector<double> volumes(complex.regions.size(), 0);
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(complex.triangles.size()); ++t) {
    const auto [a, b, c] = corners_of(complex, t);
    const double volume = dot(a, cross(b, c)) / 6;
    const FacetComplex::Face& face = complex.faces[complex.face_of[t]];
    volumes.at(face.front) += volume;
    if (face.back != no_entity) volumes.at(face.back) -= volume;
  }
  return volumes;
}

void expect_volumes(const FacetComplex& complex, std::vector<double> expected) {
  std::vector<double> found = volumes_of(complex);
  std::sort(found.begin(), found.end()), std::sort(expected.begin(), expected.end());
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-12);
}

double area_between(const FacetComplex& complex) {
  double area = 0;
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(complex.triangles.size()); ++t) {
    const auto [a, b, c] = corners_of(complex, t);
    if (complex.faces[complex.face_of[t]].back != no_entity) area += 0.5 * norm(cross(b - a, c - a));
  }
  return area;
}

TEST(FacetRegions, SolidsThatTouchShareAFaceWhateverItsTriangles) {
  for (const bool named : {true, false}) {
    const FacetComplex complex = joined(halves(named));
    expect_volumes(complex, {1, 2});
    EXPECT_NEAR(area_between(complex), 1, 1e-15);
    EXPECT_EQ(complex.faces.size(), 11u);
    if (named) {
      EXPECT_EQ(complex.regions, (std::vector<std::string>{"left", "right"}));
    }
  }
}

TEST(FacetRegions, PatchesBetweenRegionsHaveTheNamesOfBoth) {
  DomainOptions options;
  options.kind = DomainKind::fluid;
  const real::TemporaryFile stl("halves.stl",
                                faceted::ascii_stl(box_soup({0, 0, 0}, {1, 1, 1}), "left") +
                                    faceted::ascii_stl(box_soup({1, 0, 0}, {3, 1, 1}), "right"));
  options.file = stl.path();
  const Domain domain = prepare_domain(options);
  EXPECT_EQ(domain.model.region_count(), 2);
  const std::vector<std::string>& patches = domain.model.patches();
  EXPECT_NE(std::find(patches.begin(), patches.end(), "interface_left_right"), patches.end());
  EXPECT_NE(std::find(patches.begin(), patches.end(), "left"), patches.end());
}

TEST(FacetRegions, ASmallSolidOnALargeFaceIsImprintedThere) {
  FacetSoup soup = faceted::empty_soup();
  add_solid(soup, "board", {0, 0, 0}, {8, 8, 1});
  add_solid(soup, "chip", {1, 2, 1}, {4, 3, 2});
  add_solid(soup, "beyond", {7, 7, 1}, {10, 10, 2});  // its corner on a corner of the board
  const FacetComplex complex = joined(std::move(soup));
  expect_volumes(complex, {64, 3, 9});
  EXPECT_NEAR(area_between(complex), 3 + 1, 1e-14);
}

TEST(FacetRegions, ASolidTurnedAsTheOneAroundItIsARegion) {
  for (const bool inwards : {false, true}) {
    FacetSoup soup = faceted::empty_soup();
    add_solid(soup, "skull", {0, 0, 0}, {4, 4, 4}, inwards);
    add_solid(soup, "brain", {1, 1, 1}, {2, 2, 2}, inwards);
    Changes changes;
    const FacetComplex complex = joined(soup, changes);
    expect_volumes(complex, {63, 1});
    EXPECT_EQ(complex.nested, 1);
    EXPECT_EQ(complex.regions, (std::vector<std::string>{"skull", "brain"}));
    EXPECT_EQ(shapes::changes_about(changes, "solid 'brain' lies in 'skull': a region").size(), 1u);
    expect_volumes(joined(soup, {"br*"}), {63});
  }
}

TEST(FacetRegions, ASolidTurnedTheOtherWayIsAVoidAndOneInTheVoidARegion) {
  for (const bool inwards : {false, true}) {
    FacetSoup soup = faceted::empty_soup();
    add_solid(soup, "shell", {0, 0, 0}, {6, 6, 6}, inwards);
    add_solid(soup, "cavity", {1, 1, 1}, {5, 5, 5}, !inwards);
    add_solid(soup, "core", {2, 2, 2}, {3, 3, 3});
    Changes changes;
    const FacetComplex complex = joined(soup, changes);
    expect_volumes(complex, {216 - 64, 1});
    EXPECT_EQ(shapes::changes_about(changes, "'cavity' lies in 'shell': a void").size(), 1u);
  }
}

TEST(FacetRegions, ASolidThatFillsACavityIsARegion) {
  for (const bool core_first : {false, true}) {
    FacetSoup soup = faceted::empty_soup();
    if (core_first) add_solid(soup, "core", {1, 1, 1}, {2, 2, 2});
    add_solid(soup, "shell", {0, 0, 0}, {3, 3, 3});
    add_solid(soup, "cavity", {1, 1, 1}, {2, 2, 2}, true);
    if (!core_first) add_solid(soup, "core", {1, 1, 1}, {2, 2, 2});
    expect_volumes(joined(soup), {26, 1});
  }
}

TEST(FacetRegions, ASolidThatTouchesTheOneAroundItFromWithinIsARegion) {
  FacetSoup soup = faceted::empty_soup();
  add_solid(soup, "outer", {0, 0, 0}, {4, 4, 4});
  add_solid(soup, "inner", {1, 1, 0}, {2, 2, 1});
  const FacetComplex complex = joined(soup);
  expect_volumes(complex, {63, 1});
  EXPECT_NEAR(area_between(complex), 5, 1e-14);
}

TEST(FacetRegions, SolidsThatOverlapAreRefusedByName) {
  for (const Vec3 low : {Vec3{1, 0, 0}, Vec3{1, 0.5, 0.5}}) {  // with common planes, and without
    FacetSoup soup = faceted::empty_soup();
    add_solid(soup, "first", {0, 0, 0}, {2, 2, 2});
    add_solid(soup, "second", low, low + Vec3{2, 2, 2});
    const std::string message = refusal(std::move(soup));
    for (const char* const word : {"'first'", "'second'", "overlap at (", "Remedy", "test.stl"})
      EXPECT_NE(message.find(word), std::string::npos) << message;
  }
}

TEST(FacetRegions, APatternWithoutASolidIsRefused) {
  const std::string message = refusal(halves(), {"rigth"});
  for (const char* const word : {"'rigth'", "'left', 'right'", "DomainOptions::voids"})
    EXPECT_NE(message.find(word), std::string::npos) << message;
}

TEST(FacetRegions, ABodyTwiceInAFileIsOneBody) {
  FacetSoup soup = faceted::empty_soup();
  add_solid(soup, "body", {0, 0, 0}, {1, 1, 1});
  add_solid(soup, "copy", {0, 0, 0}, {1, 1, 1});
  const FacetComplex complex = joined(std::move(soup));
  expect_volumes(complex, {1});
  EXPECT_EQ(complex.nested, 0);
}

/// The kind of a file of triangles, in which nothing is asked for.
Domain undecided(const std::string& text, std::optional<DomainKind> kind = {}) {
  const real::TemporaryFile file("regions.stl", text);
  DomainOptions options;
  options.file = file.path();
  if (kind) options.kind = *kind;
  return prepare_domain(options);
}

TEST(FacetRegions, NestedSolidsAreTheFluidUnlessBodiesAreAskedFor) {
  const std::string text = faceted::ascii_stl(box_soup({0, 0, 0}, {4, 4, 4}), "skull") +
                           faceted::ascii_stl(box_soup({1, 1, 1}, {2, 2, 2}), "brain");
  const Domain regions = undecided(text);
  EXPECT_EQ(regions.report.kind, DomainKind::fluid);
  EXPECT_EQ(regions.model.region_count(), 2);
  const Domain body = undecided(text, DomainKind::body);
  EXPECT_EQ(body.model.region_count(), 1);
  EXPECT_EQ(body.model.face_count(), 7);  // with the far field
}

TEST(FacetRegions, BodiesThatTouchInUnequalTrianglesAreOneBody) {
  const real::TemporaryFile file("store.stl", faceted::ascii_stl(box_soup({2, 0.5, 0.5}, {3, 1.5, 1.5})));
  DomainOptions options;
  options.parts.push_back({"store", file.path(), 1});
  const Domain domain =
      shapes::prepare(BRepPrimAPI_MakeBox(gp_Pnt(0, 0, 0), gp_Pnt(2, 2, 2)).Shape(), options);
  const double radius = 0.5 * domain.model.bounds().size().x;
  EXPECT_NEAR(4.0 / 3 * std::numbers::pi * radius * radius * radius - domain.model.region_volume(0), 9, 1e-6);
}

TEST(FacetRegions, ACadBoxAndAStoreWithACommonFaceAreUnited) {
  const real::TemporaryFile file("store.stl", faceted::ascii_stl(box_soup({2, 0, 0}, {4, 2, 2})));
  DomainOptions options;
  options.parts.push_back({"store", file.path(), 1});
  const Domain domain =
      shapes::prepare(BRepPrimAPI_MakeBox(gp_Pnt(0, 0, 0), gp_Pnt(2, 2, 2)).Shape(), options);
  const double radius = 0.5 * domain.model.bounds().size().x;
  EXPECT_NEAR(4.0 / 3 * std::numbers::pi * radius * radius * radius - domain.model.region_volume(0), 16,
              1e-6);
}

}  // namespace
}  // namespace aeroloom::cad
