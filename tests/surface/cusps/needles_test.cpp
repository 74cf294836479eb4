/// Triangles below ten degrees stay where the CAD forces them, and nowhere else.
#include "surface/cusps/needles.hpp"

#include "mesh/checks/validity.hpp"
#include "mesh/quality/quality.hpp"
#include "surface/surface_mesher.hpp"
#include "tests/cad/cad_shapes.hpp"
#include "tests/cad/prisms.hpp"
#include "tests/references.hpp"
#include "tests/surface/face_fixture.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>

#include <gtest/gtest.h>

namespace aeroloom::surface {
namespace {

using cad::Model;
using parallel::Communicator;

Model prism_of(const std::vector<std::pair<double, double>>& outline) {
  return cad::shapes::prepare_fluid(cad::shapes::prism(outline, 1)).model;
}

/// A right triangle whose corner at the origin has so many degrees.
Model sharp_prism(double degrees) {
  return prism_of({{0, 0}, {3, 0}, {3, 3 * std::tan(degrees * std::numbers::pi / 180)}});
}

SurfaceMesh mesh_of(const Model& model, double size, int needle_rounds,
                    const Communicator& communicator = Communicator::world()) {
  SurfaceMesh surface = mesh_surface(model, testing::uniform_field(model, size, communicator),
                                     {.needle_rounds = needle_rounds});
  EXPECT_TRUE(mesh::check_surface_mesh(surface).valid());
  return surface;
}

std::int64_t count(const SurfaceMesh& surface, NeedleCause cause) {
  std::int64_t needles = 0;
  for (const NeedleGroup& group : surface.report.needles) needles += group.cause == cause ? group.needles : 0;
  return needles;
}

TEST(NeedlesLocal, OnShortEdgesAreMended) {
  // One corner of a square is cut off by an edge a hundredth of the size.
  const Model model = prism_of({{0, 0}, {3, 0}, {3, 3}, {0.0035, 3}, {0, 2.9965}});
  const SurfaceMesh raw = mesh_of(model, 0.5, 0);
  EXPECT_GT(count(raw, NeedleCause::mesh), 0);
  // The face along the short edge is a strip; the edges that the short one joins enclose none.
  EXPECT_EQ(std::ranges::count(raw.report.needles, NeedleCause::strip, &NeedleGroup::cause), 1);
  const SurfaceMesh mended = mesh_of(model, 0.5, 2);
  EXPECT_EQ(count(mended, NeedleCause::mesh), 0);
  EXPECT_GT(mended.report.mending_rounds, 0);
  EXPECT_LT(mended.report.triangles, 8 * raw.report.triangles);
}

TEST(Needles, AreMendedAlikeOnAnyNumberOfRanks) {
  const Model model = prism_of({{0, 0}, {3, 0}, {3, 3}, {0.0035, 3}, {0, 2.9965}});
  references::expect_as_on_one_rank([&](const Communicator& communicator) {
    const SurfaceMesh surface = mesh_of(model, 0.5, 2, communicator);
    return mesh::hash_mesh(mesh::number_mesh(surface));
  });
}

TEST(NeedlesLocal, InSharpCornersAreForced) {
  const SurfaceMesh surface = mesh_of(sharp_prism(8), 0.2, 0);
  std::vector<NeedleGroup> corners = surface.report.needles;
  std::erase_if(corners, [](const NeedleGroup& group) { return group.cause != NeedleCause::corner; });
  ASSERT_EQ(corners.size(), 2u);
  for (const NeedleGroup& group : corners) {
    EXPECT_EQ(group.needles, 1);
    EXPECT_EQ(group.below_half, 0);
    EXPECT_NEAR(group.degrees, 8, 1e-6);
    EXPECT_LT(std::hypot(group.at.x, group.at.z), 1.0);
  }
  EXPECT_EQ(count(surface, NeedleCause::strip), 0);
}

// What a face beyond a sharp corner's long first segments gets where it has needles beside them.
TEST(NeedlesLocal, LegsAreShortWhereAskedFor) {
  constexpr double size = 0.05;
  const Model model = sharp_prism(6);
  const sizing::SizeField field = testing::uniform_field(model, size);
  const auto longest_leg = [&](std::span<const cad::VertexId> short_legs) {
    const CurveMesh curves = discretise_curves(model, field, short_legs);
    double longest = 0;
    for (const SharpCorner& corner : curves.sharp_corners) {
      for (const cad::EdgeEnd& end : corner.ends) {
        const auto chain = curves.chain(model, end.edge);
        const CurveVertex next = end.first ? chain[1] : chain[chain.size() - 2];
        longest = std::max(longest, distance(curves.points[next], model.vertex(corner.vertex)));
      }
    }
    return longest;
  };
  EXPECT_GT(longest_leg({}), 1.5 * longest_short_leg * size);
  std::vector<cad::VertexId> all(model.vertex_count());
  std::iota(all.begin(), all.end(), 0);
  EXPECT_LE(longest_leg(all), 1.01 * longest_short_leg * size);
  EXPECT_GT(longest_leg(all), 0.9 * longest_short_leg * size);
}

TEST(NeedlesLocal, InStripsAreForced) {
  const SurfaceMesh surface = mesh_of(prism_of({{0, 0}, {3, 0}, {3, 0.02}, {0, 0.02}}), 0.3, 2);
  EXPECT_GT(count(surface, NeedleCause::strip), 0);
  EXPECT_EQ(count(surface, NeedleCause::mesh), 0);
  EXPECT_EQ(count(surface, NeedleCause::corner), 0);
  EXPECT_EQ(surface.report.mending_rounds, 0);
}

}  // namespace
}  // namespace aeroloom::surface
