#include "geometry/triangle_links.hpp"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

namespace aeroloom::geometry {
namespace {

using Triples = std::vector<std::array<std::int32_t, 3>>;

/// A square 0 1 2 3 with its centre 4.
TriangleLinks square() {
  TriangleLinks mesh;
  mesh.build(Triples{{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}, 5);
  return mesh;
}

/// The triangles that are left, their lowest corner first.
std::set<std::array<std::int32_t, 3>> triples(const TriangleLinks& mesh) {
  std::set<std::array<std::int32_t, 3>> found;
  for (const LinkedTriangle& triangle : mesh.triangles) {
    auto v = triangle.vertices;
    if (v[0] < 0) continue;
    std::rotate(v.begin(), std::min_element(v.begin(), v.end()), v.end());
    found.insert(v);
  }
  return found;
}

void expect_sound(const TriangleLinks& mesh) {
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh.triangles.size()); ++t) {
    if (mesh.triangles[t].vertices[0] < 0) continue;
    for (int i = 0; i < 3; ++i) {
      const LinkedEdge edge = linked_edge(t, i), twin = mesh.twin(edge);
      EXPECT_EQ(triangle_of(edge), t);
      EXPECT_EQ(corner_of(edge), i);
      if (twin == no_linked_edge) continue;
      EXPECT_EQ(mesh.twin(twin), edge);
      EXPECT_EQ(mesh.origin(twin), mesh.target(edge));
      EXPECT_EQ(mesh.target(twin), mesh.origin(edge));
    }
  }
}

TEST(TriangleLinks, NeighboursKnowEachOther) {
  const TriangleLinks mesh = square();
  expect_sound(mesh);
  EXPECT_EQ(mesh.twin(mesh.find(0, 1)), no_linked_edge);
  EXPECT_EQ(mesh.apex(mesh.find(0, 1)), 4);
  EXPECT_EQ(mesh.apex(mesh.find(4, 0)), 1);
  EXPECT_EQ(mesh.apex(mesh.find(0, 4)), 3);
  EXPECT_EQ(mesh.find(1, 0), no_linked_edge);
  EXPECT_EQ(mesh.find(0, 2), no_linked_edge);
}

TEST(TriangleLinks, FansAreOpenOnTheBorderAndClosedInside) {
  const TriangleLinks mesh = square();
  std::vector<std::int32_t> fan;
  EXPECT_TRUE(mesh.gather_fan(4, fan));
  EXPECT_EQ(fan.size(), 4u);
  EXPECT_FALSE(mesh.gather_fan(1, fan));
  EXPECT_EQ(fan, (std::vector<std::int32_t>{1, 0})) << "counter-clockwise, from border to border";
}

TEST(TriangleLinks, AFlipTurnsTheDiagonal) {
  TriangleLinks mesh;
  mesh.build(Triples{{0, 1, 2}, {0, 2, 3}}, 4);
  mesh.fix(mesh.find(1, 2));
  const LinkedEdge diagonal = mesh.flip(mesh.find(2, 0));
  EXPECT_EQ((std::set<std::int32_t>{mesh.origin(diagonal), mesh.target(diagonal)}),
            (std::set<std::int32_t>{1, 3}));
  EXPECT_EQ(triples(mesh), (std::set<std::array<std::int32_t, 3>>{{0, 1, 3}, {1, 2, 3}}));
  EXPECT_TRUE(mesh.is_fixed(mesh.find(1, 2)));
  EXPECT_FALSE(mesh.is_fixed(mesh.find(2, 3)));
  expect_sound(mesh);
}

TEST(TriangleLinks, ADivisionAndItsContractionGiveTheMeshBack) {
  TriangleLinks mesh = square();
  const auto before = triples(mesh);
  const std::int32_t v = mesh.divide(mesh.find(4, 0));
  EXPECT_EQ(v, 5);
  EXPECT_EQ(triples(mesh).size(), 6u);
  expect_sound(mesh);
  mesh.contract(mesh.find(v, 4));
  EXPECT_EQ(triples(mesh), before);
  expect_sound(mesh);
}

TEST(TriangleLinks, EdgesOfMoreThanTwoTrianglesStayUnlinked) {
  TriangleLinks mesh;
  mesh.build(Triples{{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}, 5);
  for (std::int32_t t = 0; t < 3; ++t) {
    for (int i = 0; i < 3; ++i) EXPECT_EQ(mesh.twin(linked_edge(t, i)), no_linked_edge);
  }
}

}  // namespace
}  // namespace aeroloom::geometry
