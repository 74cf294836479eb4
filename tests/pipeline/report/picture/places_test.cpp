#include "pipeline/report/picture/places.hpp"

#include "tests/pipeline/report/picture/surfaces.hpp"
#include "tests/several_ranks.hpp"

#include <gtest/gtest.h>

namespace aeroloom::picture {
namespace {

using parallel::Communicator;

struct Places {
  std::optional<Place> leading_edge, junction;
};
Places places_of(const mesh::DistributedMesh& surface) {
  const mesh::NumberedMesh numbered = mesh::number_mesh(surface);
  const Scene scene = find_scene(surface, {});
  const EdgeNeighbours neighbours = find_edge_neighbours(numbered, scene.shown);
  return {find_leading_edge(numbered, neighbours, scene), find_junction(numbered, neighbours, scene)};
}

TEST(Places, TheLeadingEdgeOfAWing) {
  const Communicator world = Communicator::world();
  const Places places = places_of(examples::wing_in_box(world));
  ASSERT_TRUE(places.leading_edge.has_value());
  const Place& edge = *places.leading_edge;
  EXPECT_TRUE(edge.upstream);
  EXPECT_NEAR(edge.point.x, -1, 0.02);
  EXPECT_NEAR(edge.point.y, 0, 0.1);
  EXPECT_LT(edge.normal.x, -0.95);
  EXPECT_GT(std::abs(edge.along.y), 0.95);
  EXPECT_NEAR(edge.size, 0.06, 0.03);
  EXPECT_FALSE(places.junction.has_value());
}

TEST(Places, TheJunctionOfAStepAndItsSharpestEdge) {
  const Communicator world = Communicator::world();
  const Places places = places_of(examples::step_in_box(world));
  ASSERT_TRUE(places.junction.has_value());
  EXPECT_NEAR(places.junction->point.x, 2, 1e-9);
  EXPECT_NEAR(places.junction->point.z, 1, 1e-9);
  EXPECT_NEAR(dot(places.junction->normal, normalized(geometry::Vec3{1, 0, 1})), 1, 1e-9);
  EXPECT_NEAR(std::abs(places.junction->along.y), 1, 1e-9);
  // The flow meets a flat wall: its edges are sharp, but no leading edges.
  ASSERT_TRUE(places.leading_edge.has_value());
  EXPECT_FALSE(places.leading_edge->upstream);
}

TEST(Places, ABoxHasNone) {
  const Communicator world = Communicator::world();
  const Places places = places_of(examples::plain_box(world));
  EXPECT_FALSE(places.leading_edge.has_value());
  EXPECT_FALSE(places.junction.has_value());
}

TEST(Places, AreTheSameOnOneRank) {
  NEEDS_SEVERAL_RANKS();
  const Communicator world = Communicator::world();
  const auto self = Communicator::self();
  const Places wing = places_of(examples::wing_in_box(world)), alone = places_of(examples::wing_in_box(self));
  EXPECT_EQ(wing.leading_edge->point, alone.leading_edge->point);
  EXPECT_EQ(wing.leading_edge->along, alone.leading_edge->along);
  const Places step = places_of(examples::step_in_box(world)),
               step_alone = places_of(examples::step_in_box(self));
  EXPECT_EQ(step.junction->point, step_alone.junction->point);
  EXPECT_EQ(step.leading_edge->point, step_alone.leading_edge->point);
}

}  // namespace
}  // namespace aeroloom::picture
