// The search for triangles that cross others, against a search of all pairs.
#include "cad/faceted/facet_contacts.hpp"

#include "tests/cad/faceted_shapes.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace aeroloom::cad {
namespace {

using geometry::Vec3;

FacetSoup part_of(const FacetSoup& soup, std::int32_t a, std::int32_t b) {
  FacetSoup pair = soup;
  pair.triangles = {soup.triangles[a], soup.triangles[b]};
  pair.group_of = {0, 0};
  return pair;
}

std::size_t contacts_in(const FacetSoup& soup) {
  return list_facet_contacts(soup).size();
}

std::size_t contacts_by_pairs(const FacetSoup& soup) {
  std::size_t pairs = 0;
  for (std::int32_t a = 0; a < static_cast<std::int32_t>(soup.triangles.size()); ++a) {
    for (std::int32_t b = 0; b < a; ++b) pairs += contacts_in(part_of(soup, a, b));
  }
  return pairs;
}

/// Triangles around one point, as long as they like, and others between them.
FacetSoup random_star(int around, int others, double flatness, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  FacetSoup soup = faceted::empty_soup();
  soup.points.emplace_back();
  const auto add_point = [&] {
    soup.points.push_back({normal(random), normal(random), flatness * normal(random)});
    return static_cast<std::int32_t>(soup.points.size()) - 1;
  };
  for (int i = 0; i < around; ++i) {
    const std::int32_t first = add_point();
    const Vec3 near = soup.points[first];
    soup.points.push_back(near + Vec3{0.1 * normal(random), 0.1 * normal(random), 0.1 * normal(random)});
    faceted::add_triangle(soup, 0, first, first + 1);
  }
  for (int i = 0; i < others; ++i) {
    const std::int32_t first = add_point();
    add_point(), add_point();
    faceted::add_triangle(soup, first, first + 1, first + 2);
  }
  return soup;
}

TEST(FacetContactSearch, FindsThePairsThatASearchOfAllFinds) {
  std::mt19937_64 random(7);
  for (const double flatness : {1.0, 0.01, 0.0}) {
    const FacetSoup soup = random_star(90, 20, flatness, random);
    const std::size_t expected = contacts_by_pairs(soup);
    EXPECT_GT(expected, 0U);
    EXPECT_EQ(contacts_in(soup), expected) << flatness;
  }
}

/// Needles that run alike across the axes: boxes are turned there.
TEST(FacetContactSearch, FindsThePairsOfNeedles) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  FacetSoup soup = faceted::empty_soup();
  for (std::int32_t i = 0; i < 100; ++i) {
    const Vec3 place{unit(random), unit(random), unit(random)};
    soup.points.push_back(place);
    soup.points.push_back(place + Vec3{20, 30, 25});
    soup.points.push_back(place + Vec3{unit(random), 0.5 * unit(random), unit(random)});
    faceted::add_triangle(soup, 3 * i, 3 * i + 1, 3 * i + 2);
  }
  const std::size_t expected = contacts_by_pairs(soup);
  EXPECT_GT(expected, 0U);
  EXPECT_EQ(contacts_in(soup), expected);
}

TEST(FacetContactSearch, AFanOfNeedlesTouchesNothing) {
  FacetSoup soup = faceted::cylinder_soup(500, 1, 50);
  for (Vec3& p : soup.points) p = {0.6 * p.x - 0.8 * p.z, p.y, 0.8 * p.x + 0.6 * p.z};
  EXPECT_EQ(contacts_in(soup), 0U);
  // One corner pulled through the cap's neighbours.
  soup.points[0] = soup.points[3] + 0.5 * (soup.points[2] - soup.points[3]);
  EXPECT_GT(contacts_in(soup), 0U);
}

}  // namespace
}  // namespace aeroloom::cad
