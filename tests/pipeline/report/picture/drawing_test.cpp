#include "pipeline/report/picture/drawing.hpp"

#include "pipeline/report/picture/image.hpp"
#include "tests/pipeline/report/picture/surfaces.hpp"
#include "tests/several_ranks.hpp"

#include <algorithm>

#include <gtest/gtest.h>

namespace aeroloom::picture {
namespace {

using parallel::Communicator;

constexpr Window window{0, 0, 60, 40};

Image drawn_wing(const Communicator& communicator, double edge_opacity) {
  const mesh::DistributedMesh surface = examples::wing_in_box(communicator);
  const Scene scene = find_scene(surface, {});
  const EdgeNeighbours neighbours = find_edge_neighbours(mesh::number_mesh(surface), scene.shown);
  const Viewpoint view = look_from({-1, -1, 1}, {0, 0, 1});
  Canvas canvas(window.width, window.height);
  draw_surface(canvas, close_up(view, {0, 0, 0}, 3, window), surface, neighbours, scene,
               {{name_colours[0], name_colours[1]}, edge_opacity, 1.0});
  return composite(communicator, std::move(canvas), white);
}

TEST(Drawing, OfASurfaceIsThatOfOneRank) {
  NEEDS_SEVERAL_RANKS();
  for (const double edge_opacity : {0.0, 0.8}) {
    const Image together = drawn_wing(Communicator::world(), edge_opacity),
                alone = drawn_wing(Communicator::self(), edge_opacity);
    if (!Communicator::world().is_root()) continue;
    EXPECT_EQ(together.pixels, alone.pixels);
    EXPECT_NE(together.pixels[20 * 60 + 30], white) << "the wing is in the middle";
    EXPECT_EQ(together.pixels.front(), white) << "the far field is not shown";
  }
}

Image drawn_cut(const Communicator& communicator, double offset) {
  const mesh::DistributedMesh volume = mesh::examples::cube(communicator, 4, 6);
  const Viewpoint view = look_from({0, 0, 1}, {0, 1, 0});
  Canvas canvas(window.width, window.height);
  draw_cut(canvas, close_up(view, {0.5, 0.5, 0}, 3, window), volume, {{0, 0, 1}, offset}, 0);
  return composite(communicator, std::move(canvas), white);
}

/// Pixels that are not white.
std::ptrdiff_t covered(const Image& image) {
  return static_cast<std::ptrdiff_t>(image.pixels.size()) -
         std::count(image.pixels.begin(), image.pixels.end(), white);
}

TEST(Drawing, ACutCoversTheSectionOfTheMesh) {
  const Communicator world = Communicator::world();
  for (const double offset : {0.37, 0.5, 1e-7, 0.0}) {  // across cells, along their faces, at the border
    const Image image = drawn_cut(world, offset);
    EXPECT_EQ(covered(image), world.is_root() ? 20 * 20 : 0) << offset;
  }
  const Image beyond = drawn_cut(world, 1.0);
  EXPECT_EQ(covered(beyond), 0) << "what touches from below does not count";
}

/// A prism over the unit triangle as two layers, the upper one a pyramid and a tetrahedron.
TEST(Drawing, ACutOfLayersHasTheirColour) {
  mesh::DistributedMesh volume(parallel::Communicator::world());
  volume.piece_count = 1;
  mesh::Piece& piece = volume.pieces.emplace_back();
  for (const double z : {0.0, 0.5, 1.0}) {
    for (const auto& [x, y] : {std::pair{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}})
      piece.coordinates.insert(piece.coordinates.end(), {x, y, z});
  }
  piece.cells = {3, 4, 5, 6};
  piece.pyramids = {4, 5, 8, 7, 6};
  piece.prisms = {0, 1, 2, 3, 4, 5};
  piece.layers = {2, 2, 1};
  const Viewpoint view = look_from({0, 0, 1}, {0, 1, 0});
  for (const double height : {0.25, 0.75}) {
    Canvas canvas(window.width, window.height);
    draw_cut(canvas, close_up(view, {0.5, 0.5, 0}, 3, window), volume, {{0, 0, 1}, height}, 0);
    const Image image = composite(Communicator::self(), std::move(canvas), white);
    EXPECT_NEAR(static_cast<double>(covered(image)), 0.5 * 20 * 20, 25) << height;
    EXPECT_EQ(std::count(image.pixels.begin(), image.pixels.end(), layer_green) > 150, true) << height;
  }
}

TEST(Drawing, CutsHaveTheColoursOfTheirAngles) {
  const Image image = drawn_cut(Communicator::world(), 0.37);
  if (!Communicator::world().is_root()) return;
  EXPECT_EQ(image.pixels[20 * 60 + 30], angle_classes[angle_class(45)].colour) << "of cubes in six";
}

TEST(ColoursLocal, OfAnglesHaveTheirLimits) {
  EXPECT_EQ(angle_class(0), 0U);
  EXPECT_EQ(angle_class(4.99), 0U);
  EXPECT_EQ(angle_class(5), 1U);
  EXPECT_EQ(angle_class(70.5), angle_classes.size() - 1);
  EXPECT_EQ(html_name({255, 0, 10}), "#ff000a");
}

}  // namespace
}  // namespace aeroloom::picture
