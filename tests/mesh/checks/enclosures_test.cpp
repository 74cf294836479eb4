// Parts of a region that nothing joins, on surfaces cut into many pieces.
#include "mesh/checks/enclosures.hpp"

#include <algorithm>
#include <array>
#include <map>

#include <gtest/gtest.h>

namespace aeroloom::mesh {
namespace {

using geometry::Vec3;

/// Triangles with their CAD face.
struct Boxes {
  std::vector<Vec3> points;
  std::vector<std::array<int, 3>> triangles;
  std::vector<std::int32_t> faces;

  /// A box of two triangles a side; equal corners are one vertex.
  void add(Vec3 low, Vec3 high, std::int32_t face, bool is_void = false) {
    int corner[8];
    for (int i = 0; i < 8; ++i) {
      const Vec3 p{i % 2 ? high.x : low.x, i / 2 % 2 ? high.y : low.y, i / 4 ? high.z : low.z};
      const auto known = std::find(points.begin(), points.end(), p);
      corner[i] = static_cast<int>(known - points.begin());
      if (known == points.end()) points.push_back(p);
    }
    for (const auto& [a, b, c, d] :
         {std::array{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
      for (std::array<int, 3> t :
           {std::array{corner[a], corner[b], corner[c]}, std::array{corner[a], corner[c], corner[d]}}) {
        if (is_void) std::swap(t[1], t[2]);
        triangles.push_back(t), faces.push_back(face);
      }
    }
  }
};

/// In pieces of consecutive triangles, piece p on rank p modulo ranks.
NumberedMesh distribute(const Boxes& soup, int pieces, std::vector<FaceSides> sides = {}) {
  const auto world = parallel::Communicator::world();
  DistributedMesh surface(world);
  surface.kind = CellKind::triangle;
  surface.piece_count = pieces;
  surface.sides = std::move(sides);
  surface.faces = {"first", "second", "third"};
  surface.patches = {"wall"};
  if (!surface.sides.empty()) surface.regions = {"one", "other"};
  const int count = static_cast<int>(soup.triangles.size());
  for (int id = world.rank(); id < pieces; id += world.size()) {
    Piece& piece = surface.pieces.emplace_back();
    piece.id = id;
    piece.kind = CellKind::triangle;
    std::map<int, LocalIndex> local;
    for (int t = count * id / pieces; t < count * (id + 1) / pieces; ++t) {
      for (const int v : soup.triangles[t]) {
        const auto [at, is_new] = local.try_emplace(v, static_cast<LocalIndex>(local.size()));
        if (is_new) {
          const Vec3 p = soup.points[v];
          piece.coordinates.insert(piece.coordinates.end(), {p.x, p.y, p.z});
          piece.shared_vertices.push_back(at->second);
          piece.shared_keys.push_back(static_cast<SharedVertexKey>(v) + 1000);
        }
        piece.cells.push_back(at->second);
      }
      piece.triangle_face.push_back(soup.faces[t]);
      piece.triangle_patch.push_back(0);
    }
  }
  return number_mesh(std::move(surface));
}

std::vector<Enclosure> chambers_in(const Boxes& soup, const std::vector<FaceSides>& sides = {}) {
  std::vector<Enclosure> first = find_enclosures(distribute(soup, 1, sides));
  for (const int pieces : {3, 12}) {
    const std::vector<Enclosure> again = find_enclosures(distribute(soup, pieces, sides));
    EXPECT_EQ(again.size(), first.size()) << pieces;
    for (std::size_t i = 0; i < std::min(again.size(), first.size()); ++i) {
      EXPECT_NEAR(again[i].volume, first[i].volume, 1e-12);
      EXPECT_LT(distance(again[i].place, first[i].place), 1e-12);
    }
  }
  return first;
}

TEST(Enclosures, OfABoxWithVoidsThereAreNone) {
  Boxes soup;
  soup.add({0, 0, 0}, {9, 9, 9}, 0);
  soup.add({1, 1, 1}, {2, 2, 2}, 0, true);
  soup.add({2, 2, 2}, {4, 4, 4}, 0, true);
  EXPECT_TRUE(chambers_in(soup).empty());
}

TEST(Enclosures, AreWhatLiesInAVoid) {
  Boxes soup;
  soup.add({0, 0, 0}, {9, 9, 9}, 0);
  soup.add({1, 1, 1}, {5, 5, 5}, 0, true);
  soup.add({2, 2, 2}, {4, 4, 4}, 0);
  const std::vector<Enclosure> chambers = chambers_in(soup);
  ASSERT_EQ(chambers.size(), 2u);
  EXPECT_NEAR(chambers[0].volume, 729 - 64, 1e-9);
  EXPECT_NEAR(chambers[1].volume, 8, 1e-12);
  EXPECT_EQ(chambers[1].place, (Vec3{3, 3, 3}));
}

// No face of a cell joins what meets in an edge or in a vertex.
TEST(Enclosures, MeetInEdgesAndVertices) {
  for (const double x : {1.0, 0.0}) {
    Boxes soup;
    soup.add({0, 0, 0}, {1, 1, 1}, 0);
    soup.add({x, 1, 1}, {x + 1, 2, 2}, 0);
    const std::vector<Enclosure> chambers = chambers_in(soup);
    ASSERT_EQ(chambers.size(), 2u) << x;
    EXPECT_NEAR(chambers[0].volume, 1, 1e-12);
    EXPECT_NEAR(chambers[1].volume, 1, 1e-12);
  }
}

// The space around two voids that meet in an edge is one.
TEST(Enclosures, AreNotMadeByVoidsThatMeetInAnEdge) {
  Boxes soup;
  soup.add({-5, -5, -5}, {5, 5, 5}, 0);
  soup.add({0, 0, 0}, {1, 1, 1}, 0, true);
  soup.add({0, 1, 1}, {1, 2, 2}, 0, true);
  EXPECT_TRUE(chambers_in(soup).empty());
}

TEST(Enclosures, BelongToTheirRegion) {
  Boxes soup;
  soup.add({0, 0, 0}, {9, 9, 9}, 0);
  soup.add({1, 1, 1}, {2, 2, 2}, 1);
  EXPECT_TRUE(chambers_in(soup, {{0, no_region}, {1, 0}}).empty()) << "a region in another";
  soup.add({4, 4, 4}, {5, 5, 5}, 2);
  const std::vector<Enclosure> chambers = chambers_in(soup, {{0, no_region}, {1, 0}, {1, 0}});
  ASSERT_EQ(chambers.size(), 2u);
  for (const Enclosure& chamber : chambers) EXPECT_EQ(chamber.region, 1);
}

}  // namespace
}  // namespace aeroloom::mesh
