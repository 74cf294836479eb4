/// What the stage does about zones that cannot be filled: the retries, and the message at its end.
#include "parallel/communication/collective_error.hpp"
#include "parallel/sandbox/fault.hpp"
#include "tests/references.hpp"
#include "tests/scoped_fault.hpp"
#include "tests/volume/fields.hpp"
#include "tests/volume/filled.hpp"

#include <map>
#include <optional>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace aeroloom::volume {
namespace {

using geometry::Vec3;
using parallel::Communicator;
using Fault = parallel::Fault;

const surfaces::Surface& body() {
  static const surfaces::Surface surface = surfaces::shaken(surfaces::cube_with_ball(8, 5), 0.03);
  return surface;
}
sizing::SizeField sizes() {
  return fields::uniform(0.35);
}

const std::map<Fault, std::string> names{
    {Fault::none, "none"}, {Fault::throws, "throws"}, {Fault::aborts, "aborts"}};

/// Options of a filling in which a zone, or all (-1), have a fault; while this lives.
struct Faulty : VolumeOptions {
  Faulty(Fault fault, std::int64_t zone, int wanted_retries) {
    piece_tets = 2000;
    retries = wanted_retries;
    if (fault != Fault::none)
      injected.emplace("zone=" + names.at(fault) + (zone < 0 ? "" : "@" + std::to_string(zone)));
  }

  std::optional<ScopedFault> injected;
};

/// Bytes that are the same on every rank, or the test fails.
void expect_same_everywhere(const Communicator& communicator, const std::string& text) {
  for (const std::string& other : communicator.all_gather_values(text)) EXPECT_EQ(other, text);
}

// --- one zone

class OneZone : public testing::TestWithParam<std::tuple<Fault, int>> {};

TEST_P(OneZone, has_all_retries_and_is_merged) {
  const Communicator world = Communicator::world();
  const auto [fault, retries] = GetParam();
  const Filled filled(world, body(), sizes(), Faulty(fault, 2, retries));
  EXPECT_GE(filled.decomposed.zones, 4);
  expect_valid(filled, body());
  ASSERT_EQ(filled.report.retries.size(), static_cast<std::size_t>(retries) + 1);
  EXPECT_EQ(filled.report.rounds, retries + 2);
  std::set<std::string> changes;
  for (const Retry& retry : filled.report.retries) {
    EXPECT_EQ(retry.zone, 2);
    EXPECT_FALSE(retry.reason.empty());
    changes.insert(retry.change);
  }
  EXPECT_EQ(changes.size(), filled.report.retries.size());  // none twice
  EXPECT_NE(filled.report.retries.back().change.find("merged with zone"), std::string::npos);
  std::string said;
  for (const Retry& retry : filled.report.retries) said += retry.change + "; " + retry.reason + "; ";
  expect_same_everywhere(world, said);
  // The merged zone has its pieces, the one that is gone none.
  const Filled whole(world, body(), sizes(), Faulty(Fault::none, 2, retries));
  EXPECT_LT(filled.mesh.piece_count, whole.mesh.piece_count);
}

INSTANTIATE_TEST_SUITE_P(all, OneZone,
                         testing::Combine(testing::Values(Fault::throws, Fault::aborts),
                                          testing::Values(0, 1, 3)));

TEST(RetryPolicy, leads_to_the_same_mesh_on_any_number_of_ranks) {
  const Communicator world = Communicator::world();
  for (const int retries : {0, 3}) {
    const Faulty options(Fault::throws, 1, retries);
    const Filled filled(world, body(), sizes(), options);
    const std::string hash = mesh::hash_mesh(filled.mesh);
    if (!world.is_root()) continue;
    EXPECT_EQ(hash, references::of_one_rank(world, hash, [&] {
                const Filled same(Communicator::self(), body(), sizes(), options);
                return mesh::hash_mesh(same.mesh);
              }));
  }
}

/// A merger changes no point, and the mesh is unique: it is that of zones which nothing happened to.
TEST(RetryPolicy, changes_no_cell_where_zones_are_merged) {
  const Communicator world = Communicator::world();
  const Filled merged(world, body(), sizes(), Faulty(Fault::throws, 0, 1));
  const Filled untouched(world, body(), sizes(), Faulty(Fault::none, -1, 1));
  EXPECT_FALSE(merged.report.retries.empty());
  EXPECT_TRUE(untouched.report.retries.empty());
  EXPECT_EQ(merged.report.rounds, 3);
  EXPECT_TRUE(merged.report.disagreements.empty());
  EXPECT_TRUE(cells_by_coordinates(merged) == cells_by_coordinates(untouched));
}

TEST(RetryPolicy, moves_points_of_the_zone_in_its_later_steps) {
  const Communicator world = Communicator::world();
  const Filled moved(world, body(), sizes(), Faulty(Fault::throws, 0, 2));
  const Filled untouched(world, body(), sizes(), Faulty(Fault::none, -1, 2));
  expect_valid(moved, body());
  const auto a = cells_by_coordinates(moved), b = cells_by_coordinates(untouched);
  std::vector<std::uint64_t> common;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
  EXPECT_LT(common.size(), b.size());
  EXPECT_GT(common.size(), b.size() / 4);
}

// --- no way out

/// What the stage says when it ends with a VolumeFailure, on every rank the same; empty when it does not.
struct Ending {
  std::string text;
  std::vector<Vec3> points;
  std::vector<LocalTriangle> triangles;
};
Ending failure_of(const Communicator& communicator, const surfaces::Surface& surface,
                  const sizing::SizeField& field, const VolumeOptions& options) {
  Ending ending;
  try {
    const Filled filled(communicator, surface, field, options);
    ADD_FAILURE() << "filled " << filled.mesh.numbering.cell_count << " cells";
  } catch (const VolumeFailure& failure) {
    ending = {failure.what(), failure.points(), failure.triangles()};
    EXPECT_EQ(failure.kind(), parallel::FailureKind::input);
  } catch (const std::exception& error) {
    ADD_FAILURE() << "another error: " << error.what();
  }
  expect_same_everywhere(communicator, ending.text);
  const auto all = communicator.all_gather(parallel::to_wire(std::tie(ending.points, ending.triangles)));
  for (const parallel::Bytes& other : all) EXPECT_EQ(other, all.front());
  for (const LocalTriangle& t : ending.triangles) {
    for (const auto v : t) {
      EXPECT_GE(v, 0);
      EXPECT_LT(static_cast<std::size_t>(v), ending.points.size());
    }
  }
  return ending;
}

TEST(VolumeFailures, name_place_faces_and_what_was_tried) {
  const Communicator world = Communicator::world();
  for (const int retries : {0, 1}) {
    const Ending ending = failure_of(world, body(), sizes(), Faulty(Fault::throws, -1, retries));
    EXPECT_FALSE(ending.triangles.empty());
    for (const char* part : {"zone 0 between (-2, -2, -2) and (2, 2, 2)", "injected fault: an exception",
                             "'face ", "Tried:", "merged with zone", "piece size"})
      EXPECT_NE(ending.text.find(part), std::string::npos) << part << " in: " << ending.text;
    EXPECT_EQ(ending.text.find("wider halo") != std::string::npos, retries > 0) << ending.text;
  }
}

TEST(VolumeFailures, say_the_same_on_any_number_of_ranks) {
  const Communicator world = Communicator::world();
  const Faulty options(Fault::throws, -1, 0);
  const Ending ending = failure_of(world, body(), sizes(), options);
  if (!world.is_root()) return;
  const Ending alone = failure_of(Communicator::self(), body(), sizes(), options);
  EXPECT_EQ(ending.text, alone.text);
  EXPECT_EQ(ending.points, alone.points);
}

TEST(VolumeFailures, leave_the_ranks_able_to_go_on) {
  const Communicator world = Communicator::world();
  failure_of(world, body(), sizes(), Faulty(Fault::aborts, -1, 0));
  const Filled filled(world, body(), sizes(), Faulty(Fault::none, -1, 0));
  expect_valid(filled, body());
}

/// What a failure says of a surface that intersects itself in several places; the first of them is named.
void expect_named(const surfaces::Surface& surface, const std::vector<Vec3>& places,
                  const std::set<std::string>& faces, std::int64_t tets) {
  const Communicator world = Communicator::world();
  VolumeOptions options;
  options.piece_tets = tets;
  const Ending ending = failure_of(world, surface, fields::uniform(0.3), options);
  EXPECT_NE(ending.text.find("intersects itself"), std::string::npos) << ending.text;
  EXPECT_TRUE(std::any_of(faces.begin(), faces.end(), [&](const std::string& face) {
    return ending.text.find("'" + face + "'") != std::string::npos;
  })) << ending.text;
  ASSERT_FALSE(ending.triangles.empty());
  for (const Vec3& p : ending.points) {
    EXPECT_TRUE(
        std::any_of(places.begin(), places.end(), [&](const Vec3& q) { return distance(p, q) < 1.2; }));
  }
  if (!world.is_root()) return;
  EXPECT_EQ(failure_of(Communicator::self(), surface, fields::uniform(0.3), options).text, ending.text);
}

class Crossing : public testing::TestWithParam<std::int64_t> {};

TEST_P(Crossing, voids_are_named) {
  surfaces::Surface surface = surfaces::cube({0, 0, 0}, 1.8, 9);
  const std::vector<Vec3> places{{1.1, 0, 0}, {-1.1, 0.2, 0.1}, {0.1, 1.1, 0.3}};
  for (const Vec3& place : places) {
    surfaces::append(surface, surfaces::sphere(place, 0.25, 2), surfaces::Turn::inward);
    surfaces::append(surface, surfaces::sphere(place + Vec3{0.1, 0.2, 0.15}, 0.25, 2),
                     surfaces::Turn::inward);
  }
  expect_named(surface, places, {"face 6", "face 7", "face 8", "face 9", "face 10", "face 11"}, GetParam());
}

TEST_P(Crossing, voids_through_a_wall_are_named) {
  surfaces::Surface surface = surfaces::cube({0, 0, 0}, 1.8, 9);
  const std::vector<Vec3> places{{1.75, 0, 0}, {-1.75, 0.2, 0.1}, {0.1, 1.75, 0.3}};
  for (const Vec3& place : places)
    surfaces::append(surface, surfaces::sphere(place, 0.3, 4), surfaces::Turn::inward);
  expect_named(surface, places, {"face 6", "face 7", "face 8"}, GetParam());
}

INSTANTIATE_TEST_SUITE_P(in_zones_of, Crossing, testing::Values(100'000, 1'000));

TEST(VolumeFailures, name_the_faces_beside_a_gap) {
  surfaces::Surface surface = surfaces::cube({0, 0, 0}, 1.8, 9);
  const auto is_in_gap = [&](std::size_t t) {
    return std::all_of(surface.triangles[t].begin(), surface.triangles[t].end(), [&](auto v) {
      const Vec3 p = surface.points[v];
      return p.z == 1.8 && std::max(std::abs(p.x), std::abs(p.y)) < 1.2;
    });
  };
  for (std::size_t t = surface.triangles.size(); t-- > 0;) {
    if (!is_in_gap(t)) continue;
    surface.triangles.erase(surface.triangles.begin() + static_cast<std::ptrdiff_t>(t));
    surface.face.erase(surface.face.begin() + static_cast<std::ptrdiff_t>(t));
  }
  const Ending ending = failure_of(Communicator::world(), surface, fields::uniform(0.3), {});
  for (const char* part : {"the surface has a gap", "outside seen from", "'face ", "repair the geometry"})
    EXPECT_NE(ending.text.find(part), std::string::npos) << part << " in: " << ending.text;
  EXPECT_EQ(ending.triangles.size(), 1U);
}

TEST(VolumeFailures, refuse_a_piece_too_large_on_every_rank) {
  const Communicator world = Communicator::world();
  VolumeOptions options;
  options.largest_zone = 1000;
  std::string said;
  try {
    const Filled filled(world, body(), sizes(), options);
  } catch (const parallel::CollectiveError& error) {
    said = error.what();
  }
  EXPECT_NE(said.find("more than 1000. Ask for smaller pieces (VolumeOptions::piece_tets)"),
            std::string::npos)
      << said;
  expect_same_everywhere(world, said);
}

}  // namespace
}  // namespace aeroloom::volume
