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
