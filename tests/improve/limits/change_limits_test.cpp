#include "improve/limits/change_limits.hpp"

#include "tests/improve/pieces.hpp"

#include <gtest/gtest.h>

namespace aeroloom::improve {
namespace {

const mesh::TetQuality measure(28);

sizing::SizeField uniform(double size) {
  sizing::SizingOptions options;
  options.minimum = options.maximum = size;
  geometry::Box box;
  box.add(Vec3{-10, -10, -10});
  box.add(Vec3{10, 10, 10});
  return sizing::SizeField::build(box, {}, options);
}

/// A tetrahedron with edges of 1 to 1.5, and vertex 4 to make another one with.
mesh::Piece make_example(Vec3 other) {
  return examples::make_piece({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, other}, {0, 1, 2, 3});
}

bool allows(const ChangeLimits& limits, Vec3 other) {
  mesh::Piece piece = make_example(other);
  const TetMesh mesh(piece, measure);
  CavityReplacement cavity;
  cavity.old_tets = {0};
  cavity.new_tets = {{0, 1, 2, 4}};
  return limits.allow(mesh, cavity);
}

TEST(ChangeLimits, KeepNewEdgesToTheField) {
  const sizing::SizeField one = uniform(1);
  const ChangeLimits limits(&one);
  EXPECT_TRUE(allows(limits, {0, 0, 1.2})) << "no longer than what was there";
  EXPECT_TRUE(allows(limits, {0, 0, 2.5})) << "longer, within three sizes";
  EXPECT_FALSE(allows(limits, {0, 0, 4})) << "four sizes long";
  EXPECT_TRUE(allows(limits, {0, 0, 0.5}));
  EXPECT_FALSE(allows(limits, {0, 0, 0.2})) << "a fifth of a size";
}

TEST(ChangeLimits, KeepToShortEdgesWhereTheCadHasThem) {
  const sizing::SizeField ten = uniform(10);
  const ChangeLimits limits(&ten);
  EXPECT_TRUE(allows(limits, {0, 0, 0.5})) << "short beside the size, not beside the other edges";
  EXPECT_FALSE(allows(limits, {0, 0, 0.2}));
}

TEST(ChangeLimits, AllowAllSizesWithoutAField) {
  const sizing::SizeField small = uniform(0.1);
  EXPECT_TRUE(allows(ChangeLimits(), {0, 0, 1.8}));
  EXPECT_FALSE(allows(ChangeLimits(&small), {0, 0, 1.8}));
}

TEST(ChangeLimits, KeepShapesDecent) {
  EXPECT_FALSE(allows(ChangeLimits(), {0, 0, 1000}));
  EXPECT_FALSE(allows(ChangeLimits(), {0, 0, 1e-6}));
}

TEST(ChangeLimits, LookAtMovedVertices) {
  const sizing::SizeField one = uniform(1);
  const ChangeLimits limits(&one);
  mesh::Piece piece = make_example({0, 0, 0.5});
  TetMesh mesh(piece, measure);
  const std::vector<LocalIndex> star{0};
  const Vec3 origin = mesh.point(3);
  mesh.move_vertex(3, {0, 0, 2}, star);
  EXPECT_TRUE(limits.allow_move(mesh, 3, star, origin));
  mesh.move_vertex(3, {0, 0, 5}, star);
  EXPECT_FALSE(limits.allow_move(mesh, 3, star, origin));
  mesh.move_vertex(3, {0, 0, 0.1}, star);
  EXPECT_FALSE(limits.allow_move(mesh, 3, star, origin));
}

}  // namespace
}  // namespace aeroloom::improve
