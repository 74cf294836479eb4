#include "layers/vertex_stars.hpp"

#include "tests/layers/directed_wall.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::layers {
namespace {

using examples::cube_in_a_box;
using examples::Fluid;
using examples::layers_on;
using examples::Shapes;
using geometry::Vec3;
using parallel::Communicator;

using Place = std::array<double, 3>;
Place place_of(Vec3 p) {
  return {p.x, p.y, p.z};
}

/// What is known around each vertex of this rank, by place.
struct Known {
  StarKind kind;
  std::vector<Place> normals;  ///< sorted: their order is that of pieces
  bool operator==(const Known&) const = default;
};
std::map<Place, Known> fans_by_place(const mesh::DistributedMesh& mesh, const LayerOptions& options) {
  const LocalWall wall(mesh, options);
  const VertexStars stars = gather_stars(wall);
  std::map<Place, Known> known;
  for (std::int32_t v = 0; v < wall.vertex_count(); ++v) {
    Known here{stars.kinds[v], {}};
    for (const Vec3 normal : stars.normals_at(v)) here.normals.push_back(place_of(normal));
    std::sort(here.normals.begin(), here.normals.end());
    const auto [found, is_new] = known.emplace(place_of(wall.points[v]), here);
    EXPECT_TRUE(is_new || found->second == here) << "the same in all pieces";
  }
  return known;
}

/// Two cubes that touch in a corner, in a box.
Shapes touching_cubes() {
  Shapes shapes = Shapes()
                      .add_box({-4, -4, -4}, {6, 6, 6}, {3, 3, 3}, Fluid::inside)
                      .add_box({0, 0, 0}, {1, 1, 1}, {2, 2, 2}, Fluid::outside)
                      .add_box({1, 1, 1}, {2, 2, 2}, {2, 2, 2}, Fluid::outside);
  shapes.merge_points();
  return shapes;
}

TEST(VertexStars, HaveTheTrianglesOfAllPieces) {
  const auto world = Communicator::world(), self = Communicator::self();
  const mesh::DistributedMesh mesh = cube_in_a_box().distribute(world, 7),
                              whole = cube_in_a_box().distribute(self, 1);
  const auto alone = fans_by_place(whole, layers_on(2));
  for (const auto& [place, known] : fans_by_place(mesh, layers_on(2))) {
    EXPECT_EQ(known.kind, StarKind::plain);
    EXPECT_TRUE(known == alone.at(place));
    EXPECT_GE(known.normals.size(), 3u);
  }
}

TEST(VertexStars, AreBrokenWhereTwoFansMeet) {
  const auto world = Communicator::world();
  const mesh::DistributedMesh mesh = touching_cubes().distribute(world, 5);
  const Place corner{1, 1, 1};
  for (const auto& [place, known] : fans_by_place(mesh, layers_on(3)))
    EXPECT_EQ(known.kind, place == corner ? StarKind::broken : StarKind::plain);
}

TEST(VertexStars, EndWhereATriangleBearsNoLayers) {
  const auto world = Communicator::world();
  // The upper side of the cube is a patch without layers.
  Shapes shapes = cube_in_a_box();
  shapes.label([](Vec3 p) {
    return p.x < -1 || p.x > 2 || p.y < -1 || p.y > 2 || p.z < -1 || p.z > 2 ? 0 : p.z == 1 ? 2 : 1;
  });
  const mesh::DistributedMesh mesh = shapes.distribute(world, 6);
  LayerOptions options = layers_on(3);
  options.patches[2].first = 0;
  for (const auto& [place, known] : fans_by_place(mesh, options)) {
    const auto inside = [](double x) { return x > 0 && x < 1; };
    const bool is_above = place[2] == 1 && place[0] >= 0 && place[0] <= 1 && place[1] >= 0 && place[1] <= 1;
    const StarKind expected = !is_above                              ? StarKind::plain
                              : inside(place[0]) && inside(place[1]) ? StarKind::off_wall
                                                                     : StarKind::ending;
    EXPECT_EQ(known.kind, expected) << place[0] << ' ' << place[1] << ' ' << place[2];
    EXPECT_EQ(known.normals.empty(), expected == StarKind::off_wall);
  }
}

}  // namespace
}  // namespace aeroloom::layers
