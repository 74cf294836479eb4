// Faces that lie on one another are found before any sizes, and named with the area.
#include "sizing/choice/coincident_faces.hpp"

#include "tests/wall_bodies.hpp"

#include <cmath>

#include <gtest/gtest.h>

using namespace aeroloom;
using namespace aeroloom::sizing;
using shapes::cracked_block;
using shapes::slotted_block;

namespace {

std::vector<CoincidentFaces> coincident_in(const cad::Model& model) {
  return find_coincident_faces(SampledModel(parallel::Communicator::world(), model));
}

}  // namespace

TEST(CoincidentFaces, AreNamedWithTheirAreaAndPlace) {
  for (const double apart : {0.0, 4e-9, 4e-7, 3e-5}) {
    const cad::Model model = cracked_block(apart);
    const auto found = coincident_in(model);
    ASSERT_EQ(found.size(), 1) << apart;
    EXPECT_NEAR(found[0].area, 3, 0.01);
    EXPECT_LE(found[0].apart, apart + 1e-12);
    EXPECT_NEAR(found[0].place.y, 1, 1e-4);
    for (const cad::FaceId face : {found[0].first, found[0].second})
      EXPECT_NEAR(model.face_area(face), 3, 0.01);
    EXPECT_NE(found[0].first, found[0].second);
  }
}

TEST(CoincidentFaces, NeedNotShareAnEdge) {
  const auto found = coincident_in(slotted_block(2e-5));
  ASSERT_EQ(found.size(), 1);
  EXPECT_NEAR(found[0].area, 3, 0.01);
  EXPECT_NEAR(found[0].apart, 2e-5, 1e-9);
}

TEST(CoincidentFaces, AreFartherApartWhereNoMeshResolvesTheGap) {
  // A body with a slot so deep and wide.
  const auto slotted = [](double deep, double wide) {
    const double end = 4 - deep;
    return shapes::prism({{0, 0}, {4, 0}, {4, 1}, {end, 1}, {end, 1 + wide}, {4, 1 + wide}, {4, 2}, {0, 2}},
                         cad::DomainKind::body);
  };
  const auto found = coincident_in(slotted(3, 3e-4));
  ASSERT_EQ(found.size(), 1);
  EXPECT_NEAR(found[0].area, 3, 0.01);
  EXPECT_NEAR(found[0].apart, 3e-4, 1e-8);
  // As near, but there is little of it.
  EXPECT_TRUE(coincident_in(slotted(0.1, 7e-4)).empty());
  // Nothing is meshed between the walls.
  EXPECT_TRUE(coincident_in(slotted_block(3e-4)).empty());
}

TEST(CoincidentFaces, AreNotWallsFartherApartNorWedges) {
  EXPECT_TRUE(coincident_in(slotted_block(1e-3)).empty());
  EXPECT_TRUE(coincident_in(cracked_block(0.02)).empty());
}

TEST(CoincidentFaces, AreWiderThanTheyAreNear) {
  // A wedge that ends bluntly, with a strip of its own on either side of the end. The strips are too near
  // each other all over, but narrower than what is too near.
  const auto wedge = [](double strip) {
    const double thick = 2e-5, begin = 4 - strip;
    return shapes::prism({{0, -0.5}, {begin, -thick}, {4, -thick}, {4, thick}, {begin, thick}, {0, 0.5}},
                         cad::DomainKind::body);
  };
  EXPECT_TRUE(coincident_in(wedge(6e-5)).empty());
  const auto wide = coincident_in(wedge(2e-4));
  ASSERT_EQ(wide.size(), 1);
  EXPECT_NEAR(wide[0].area, 2e-4, 2e-5);
  EXPECT_EQ(wide[0].triangles, 0);
}

TEST(CoincidentFaces, TellOfAGapThatIsMeshed) {
  EXPECT_EQ(coincident_in(cracked_block(0))[0].triangles, 0);
  const auto found = coincident_in(shapes::prism(
      {{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 1 + 3e-4}, {4, 1 + 3e-4}, {4, 2}, {0, 2}}, cad::DomainKind::body));
  ASSERT_EQ(found.size(), 1);
  EXPECT_GT(found[0].triangles, 1e7);
}
