/// Failures inside the contained run, injected: each ends in one VolumeError, and the rank goes on.
#include "tests/volume/fields.hpp"
#include "tests/volume/surfaces.hpp"
#include "volume/contained_fill.hpp"

#include <gtest/gtest.h>

namespace aeroloom::volume {
namespace {

using Sabotage = VolumeOptions::Sabotage;

const bool tasks_are_known = (register_volume_tasks(), true);

class Containment : public testing::TestWithParam<Sabotage> {};

TEST_P(Containment, turns_the_failure_into_an_error_and_goes_on) {
  const ClosedSurface surface = surfaces::cube({0, 0, 0}, 1, 4);
  const auto field = fields::uniform(0.5);
  VolumeOptions options;
  options.sabotage = GetParam();
  options.retries = GetParam() == Sabotage::hangs ? 0 : 1;
  try {
    fill_volume(surface, field, options);
    FAIL() << "the sabotage went unnoticed";
  } catch (const VolumeError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("lattice points given at once"), std::string::npos) << text;
    EXPECT_EQ(text.find("other perturbations") != std::string::npos, options.retries > 0) << text;
  }
  const FilledVolume filled = fill_volume(surface, field, {});
  EXPECT_EQ(filled.attempts, 1);
  EXPECT_FALSE(filled.tetrahedra.empty());
}

INSTANTIATE_TEST_SUITE_P(all, Containment,
                         testing::Values(Sabotage::throws, Sabotage::aborts, Sabotage::hangs,
                                         Sabotage::exhausts_memory));

FillRequest request_without_lattice(const ClosedSurface& surface) {
  FillRequest request;
  request.points = surface.points;
  request.surface_points = surface.points.size();
  request.triangles = surface.triangles;
  return request;
}

TEST(Ladder, inserts_points_after_the_boundary) {
  const ClosedSurface surface = surfaces::cube_with_ball(8, 4);
  FillRequest request = request_without_lattice(surface);
  request.interior = InteriorPoints::after_recovery;
  const auto lattice = lattice_points(surface, fields::uniform(0.4), {});
  request.interior_points = lattice.size();
  request.points.insert(request.points.end(), lattice.begin(), lattice.end());
  const FillReply reply = fill_contained(request);
  ASSERT_TRUE(reply.filled) << reply.failure;
  EXPECT_EQ(reply.volume.steiner_points, 0);
  EXPECT_EQ(reply.volume.coordinates.size() / 3 + reply.volume.dropped_points, request.points.size());
  double filled = 0;
  const auto& t = reply.volume.tetrahedra;
  const auto point = [&](mesh::LocalIndex v) {
    const double* p = reply.volume.coordinates.data() + 3 * v;
    return geometry::Vec3{p[0], p[1], p[2]};
  };
  for (std::size_t i = 0; i < t.size(); i += 4) {
    filled += volume6(point(t[i]), point(t[i + 1]), point(t[i + 2]), point(t[i + 3])) / 6;
  }
  EXPECT_NEAR(filled, surfaces::volume(surface), 1e-10 * filled);
}

TEST(Ladder, fills_without_interior_points) {
  const FillReply reply = fill_contained(request_without_lattice(surfaces::cube_with_ball(8, 4)));
  EXPECT_TRUE(reply.filled) << reply.failure;
}

TEST(Ladder, reports_what_the_mesher_said) {
  ClosedSurface surface = surfaces::cube({0, 0, 0}, 1, 2);
  surfaces::append(surface, surfaces::cube({0.7, 0.1, 0.2}, 1, 2));
  const FillReply reply = fill_contained(request_without_lattice(surface));
  EXPECT_FALSE(reply.filled);
  EXPECT_FALSE(reply.failure.empty());
}

}  // namespace
}  // namespace aeroloom::volume
