/// Whether zones fit together, and where they do not.
#include "volume/filling/agreement.hpp"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

namespace aeroloom::volume {
namespace {

using parallel::Communicator;
using Vertices = std::array<mesh::SharedVertexKey, 3>;

ZoneFace face(const Vertices& vertices, ZoneIndex zone, int odd, mesh::RegionId region = 0) {
  ZoneFace result{};
  result.vertices = vertices;
  for (int k = 0; k < 3; ++k) result.leaves[k] = static_cast<std::int64_t>(vertices[k] / 2);
  result.zone = zone;
  result.region = region;
  result.odd = odd;
  return result;
}

/// Faces that fit: 300 pairs between 12 zones.
std::vector<ZoneFace> fitting_faces() {
  std::mt19937_64 random(6);
  std::vector<ZoneFace> faces;
  for (mesh::SharedVertexKey i = 0; i < 300; ++i) {
    const Vertices vertices{i, i + 1 + random() % 50, 1000 + i * i};
    const auto zone = static_cast<ZoneIndex>(random() % 12),
               other = static_cast<ZoneIndex>((zone + 1 + random() % 11) % 12);
    const auto odd = static_cast<int>(random() % 2), region = static_cast<int>(random() % 3);
    faces.push_back(face(vertices, zone, odd, region));
    faces.push_back(face(vertices, other, 1 - odd, region));
  }
  return faces;
}

/// What is found when each zone's faces are on a rank of their own; the same on every rank, or the test
/// fails.
std::vector<ZoneFace> unmatched(const std::vector<ZoneFace>& faces, int shift = 0) {
  const Communicator world = Communicator::world();
  std::vector<ZoneFace> mine;
  for (const ZoneFace& f : faces) {
    if ((f.zone + shift) % world.size() == world.rank()) mine.push_back(f);
  }
  std::vector<ZoneFace> found = find_unmatched(world, mine);
  const auto all = world.all_gather(parallel::to_bytes<ZoneFace>(found));
  for (const parallel::Bytes& other : all) EXPECT_EQ(other, all.front());
  return found;
}

void expect_same(std::vector<ZoneFace> found, std::vector<ZoneFace> expected) {
  const auto before = [](const ZoneFace& a, const ZoneFace& b) {
    return a.vertices != b.vertices ? a.vertices < b.vertices
           : a.zone != b.zone       ? a.zone < b.zone
                                    : a.odd < b.odd;
  };
  EXPECT_TRUE(std::is_sorted(found.begin(), found.end(), before));
  std::sort(expected.begin(), expected.end(), before);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].vertices, expected[i].vertices);
    EXPECT_EQ(found[i].leaves, expected[i].leaves);
    EXPECT_EQ(found[i].zone, expected[i].zone);
    EXPECT_EQ(found[i].region, expected[i].region);
    EXPECT_EQ(found[i].odd, expected[i].odd);
  }
}

void expect_found(const std::vector<ZoneFace>& bad) {
  std::vector<ZoneFace> faces = fitting_faces();
  faces.insert(faces.end(), bad.begin(), bad.end());
  for (const int shift : {0, 1}) {
    expect_same(unmatched(faces, shift), bad);
    std::reverse(faces.begin(), faces.end());
  }
}

TEST(FindUnmatched, finds_nothing_where_all_fits) {
  EXPECT_TRUE(unmatched(fitting_faces()).empty());
  EXPECT_TRUE(unmatched({}).empty());
}

TEST(FindUnmatched, finds_faces_without_a_partner) {
  expect_found({face({5, 6, 7}, 3, 0), face({5, 6, 8}, 4, 1), face({90000, 90001, 90002}, 0, 0)});
}

TEST(FindUnmatched, finds_a_partner_of_another_region) {
  expect_found({face({5, 6, 7}, 3, 0, 1), face({5, 6, 7}, 4, 1, 0)});
}

TEST(FindUnmatched, finds_two_of_the_same_turn) {
  expect_found({face({5, 6, 7}, 3, 1), face({5, 6, 7}, 4, 1)});
}

TEST(FindUnmatched, finds_two_of_the_same_zone) {
  expect_found({face({5, 6, 7}, 3, 0), face({5, 6, 7}, 3, 1)});
}

TEST(FindUnmatched, finds_more_than_two) {
  expect_found({face({5, 6, 7}, 3, 0), face({5, 6, 7}, 4, 1), face({5, 6, 7}, 8, 1)});
}

TEST(FindPlacesLocal, groups_faces_by_vertices) {
  // Two faces with a common vertex, and a third that links to the second; another place apart.
  const std::vector<ZoneFace> faces{face({2, 10, 12}, 7, 0), face({4, 6, 8}, 5, 0), face({8, 20, 22}, 3, 1),
                                    face({22, 24, 26}, 5, 1)};
  const std::vector<DisputedPlace> places = find_places(faces);
  ASSERT_EQ(places.size(), 2u);
  EXPECT_EQ(places[0].faces, 1);
  EXPECT_EQ(places[0].zones, std::vector<ZoneIndex>{7});
  EXPECT_EQ(places[0].leaves, (std::vector<std::int64_t>{1, 5, 6}));
  EXPECT_EQ(places[1].faces, 3);
  EXPECT_EQ(places[1].zones, (std::vector<ZoneIndex>{3, 5}));
  EXPECT_EQ(places[1].leaves, (std::vector<std::int64_t>{2, 3, 4, 10, 11, 12, 13}));
}

TEST(FindPlacesLocal, joins_places_that_a_later_face_connects) {
  const std::vector<ZoneFace> faces{face({0, 1, 2}, 1, 0), face({3, 4, 5}, 2, 0), face({6, 7, 8}, 3, 0),
                                    face({2, 8, 9}, 4, 0), face({5, 9, 11}, 0, 0)};
  const std::vector<DisputedPlace> places = find_places(faces);
  ASSERT_EQ(places.size(), 1u);
  EXPECT_EQ(places[0].faces, 5);
  EXPECT_EQ(places[0].zones, (std::vector<ZoneIndex>{0, 1, 2, 3, 4}));
}

TEST(FindPlacesLocal, leaves_out_vertices_without_a_leaf) {
  ZoneFace one = face({4, 6, 1ULL << 61}, 2, 0);
  one.leaves[2] = -1;
  const std::vector<DisputedPlace> places = find_places(std::vector{one});
  ASSERT_EQ(places.size(), 1u);
  EXPECT_EQ(places[0].leaves, (std::vector<std::int64_t>{2, 3}));
  EXPECT_TRUE(find_places({}).empty());
}

}  // namespace
}  // namespace aeroloom::volume
