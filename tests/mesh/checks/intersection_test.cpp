#include "mesh/checks/intersection.hpp"

#include "geometry/predicates.hpp"
#include "mesh/checks/triangle_contact.hpp"
#include "tests/several_ranks.hpp"

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <tuple>

#include <gtest/gtest.h>

namespace aeroloom::mesh {
namespace {

std::vector<TriangleHit> intersections_of(const DistributedMesh& surface) {
  return find_intersections(surface);
}

using geometry::Vec3;

/// A surface in one part: corners by index.
struct Soup {
  std::vector<Vec3> points;
  std::vector<std::array<int, 3>> triangles;
};

/// The soup cut into pieces of consecutive triangles, piece p on rank p modulo ranks. Every vertex is shared
/// by its index.
DistributedMesh distribute(const Soup& soup, int pieces, const parallel::Communicator& communicator) {
  DistributedMesh surface(communicator);
  surface.kind = CellKind::triangle;
  surface.piece_count = pieces;
  const int count = static_cast<int>(soup.triangles.size());
  for (int id = 0; id < pieces; ++id) {
    if (id % communicator.size() != communicator.rank()) continue;
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
          if (pieces > 1) {
            piece.shared_vertices.push_back(at->second);
            piece.shared_keys.push_back(static_cast<SharedVertexKey>(v) + 1000);
          }
        }
        piece.cells.push_back(at->second);
      }
    }
  }
  return surface;
}

/// Pairs of triangles by their number in the soup.
using Pairs = std::set<std::pair<int, int>>;

Pairs find_pairs(const Soup& soup, int pieces) {
  const auto world = parallel::Communicator::world();
  const int count = static_cast<int>(soup.triangles.size());
  Pairs pairs;
  std::tuple<int, int, int, int> last{-1, -1, -1, -1};
  for (const TriangleHit& hit : intersections_of(distribute(soup, pieces, world))) {
    const std::tuple<int, int, int, int> key{hit.first_piece, hit.first, hit.second_piece, hit.second};
    EXPECT_LT(last, key) << "hits ascend and none comes twice";
    EXPECT_LE(hit.first_piece, hit.second_piece);
    last = key;
    pairs.insert(
        {count * hit.first_piece / pieces + hit.first, count * hit.second_piece / pieces + hit.second});
  }
  return pairs;
}

Pairs find_pairs_by_brute_force(const Soup& soup) {
  const auto named = [&](int t) {
    NamedTriangle triangle;
    for (int i = 0; i < 3; ++i) {
      const int v = soup.triangles[t][i];
      triangle.points[i] = soup.points[v];
      triangle.names[i] = {0, static_cast<std::uint64_t>(v)};
    }
    return triangle;
  };
  Pairs pairs;
  const int count = static_cast<int>(soup.triangles.size());
  for (int a = 0; a < count; ++a) {
    for (int b = a + 1; b < count; ++b) {
      if (meet_wrongly(named(a), named(b))) pairs.insert({a, b});
    }
  }
  return pairs;
}

/// An n by n sheet of squares in the plane z = 0, mapped by `place`.
template <class Place>
void add_sheet(Soup& soup, int n, Place&& place) {
  const int base = static_cast<int>(soup.points.size());
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i)
      soup.points.push_back(place(static_cast<double>(i) / n, static_cast<double>(j) / n));
  }
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const int v = base + j * (n + 1) + i;
      soup.triangles.push_back({v, v + 1, v + n + 2});
      soup.triangles.push_back({v, v + n + 2, v + n + 1});
    }
  }
}

bool has_area(const Soup& soup, const std::array<int, 3>& t) {
  const Vec3 a = soup.points[t[0]], b = soup.points[t[1]], c = soup.points[t[2]];
  return geometry::orient2d({a.x, a.y}, {b.x, b.y}, {c.x, c.y}) != 0 ||
         geometry::orient2d({a.y, a.z}, {b.y, b.z}, {c.y, c.z}) != 0 ||
         geometry::orient2d({a.z, a.x}, {b.z, b.x}, {c.z, c.x}) != 0;
}

/// A sphere from the cube's six sides, whose border vertices are merged by their exact coordinates.
Soup make_sphere(int n) {
  Soup sheets;
  const auto on_sphere = [](double x, double y, double z) { return geometry::normalized(Vec3{x, y, z}); };
  for (const double s : {-1.0, 1.0}) {
    add_sheet(sheets, n, [&](double u, double v) { return on_sphere(s, 2 * u - 1, 2 * v - 1); });
    add_sheet(sheets, n, [&](double u, double v) { return on_sphere(2 * u - 1, s, 2 * v - 1); });
    add_sheet(sheets, n, [&](double u, double v) { return on_sphere(2 * u - 1, 2 * v - 1, s); });
  }
  Soup sphere;
  std::map<std::tuple<double, double, double>, int> merged;
  for (auto triangle : sheets.triangles) {
    for (int& v : triangle) {
      const Vec3 p = sheets.points[v];
      const auto [at, is_new] = merged.try_emplace({p.x, p.y, p.z}, static_cast<int>(sphere.points.size()));
      if (is_new) sphere.points.push_back(p);
      v = at->second;
    }
    sphere.triangles.push_back(triangle);
  }
  return sphere;
}

TEST(MeetWronglyLocal, FollowsWhatTheTrianglesShare) {
  const auto triangle = [](std::array<Vec3, 3> p, std::array<std::uint64_t, 3> names) {
    return NamedTriangle{{p[0], p[1], p[2]}, {{0, names[0]}, {0, names[1]}, {0, names[2]}}};
  };
  const Vec3 o{0, 0, 0}, x{1, 0, 0}, y{0, 1, 0};
  const NamedTriangle base = triangle({o, x, y}, {0, 1, 2});
  EXPECT_TRUE(meet_wrongly(base, triangle({y, o, x}, {2, 0, 1}))) << "the same triangle";
  EXPECT_FALSE(meet_wrongly(base, triangle({o, x, {0.2, -1, 0}}, {0, 1, 3}))) << "flat continuation";
  EXPECT_TRUE(meet_wrongly(base, triangle({o, x, {0.2, 0.1, 0}}, {0, 1, 3}))) << "folded back";
  EXPECT_FALSE(meet_wrongly(base, triangle({o, x, {0.2, 0.1, 1e-300}}, {0, 1, 3})))
      << "folded by almost 180 degrees";
  EXPECT_FALSE(meet_wrongly(base, triangle({o, {-1, 0, 0}, {0, -1, 0}}, {0, 3, 4})))
      << "coplanar, one vertex";
  EXPECT_TRUE(meet_wrongly(base, triangle({o, {1, 0.1, 0}, {1, 0.2, 0}}, {0, 3, 4})))
      << "coplanar, overlapping";
  EXPECT_TRUE(meet_wrongly(base, triangle({o, {1, 1, 1}, {1, 1, -1}}, {0, 3, 4})))
      << "pierced from the vertex";
  EXPECT_FALSE(meet_wrongly(base, triangle({o, {0, 0, 1}, {1, 1, 1}}, {0, 3, 4})))
      << "standing on the vertex";
  EXPECT_TRUE(meet_wrongly(base, triangle({o, {0, 0, 1}, {-1, 0, 0}}, {5, 3, 4})))
      << "touching without being joined";
  EXPECT_FALSE(meet_wrongly(base, triangle({Vec3{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}, {5, 3, 4}))) << "parallel";
}

TEST(FindIntersections, LeavesCleanSurfacesAlone) {
  Soup sheets;
  add_sheet(sheets, 20, [](double u, double v) { return Vec3{u, v, 0}; });
  add_sheet(sheets, 20, [](double u, double v) { return Vec3{u, v, 1e-9}; });
  for (const int pieces : {1, 5}) {
    EXPECT_TRUE(find_pairs(sheets, pieces).empty());
    EXPECT_TRUE(find_pairs(make_sphere(20), pieces).empty());
  }
}

TEST(FindIntersections, FindsCrossingSheets) {
  Soup sheets;
  add_sheet(sheets, 12, [](double u, double v) { return Vec3{u, v, 0}; });
  add_sheet(sheets, 12, [](double u, double v) { return Vec3{u, 0.513, v - 0.5}; });
  const Pairs expected = find_pairs_by_brute_force(sheets);
  EXPECT_GE(expected.size(), 12u);
  for (const int pieces : {1, 2, 7}) EXPECT_EQ(find_pairs(sheets, pieces), expected);
}

TEST(FindIntersections, FindsDuplicatesAndFoldsAcrossPieces) {
  Soup soup = make_sphere(6);
  const int count = static_cast<int>(soup.triangles.size());
  const auto [a, b, c] = soup.triangles[3];
  soup.triangles.push_back({b, c, a});
  const Pairs pairs = find_pairs(soup, 3);
  EXPECT_TRUE(pairs.contains({3, count}));

  Soup folded;
  folded.points = {{0, 0, 0}, {1, 0, 0}, {0.3, 1, 0}, {0.4, 0.5, 0}};
  folded.triangles = {{0, 1, 2}, {1, 0, 3}};
  EXPECT_EQ(find_pairs(folded, 2), (Pairs{{0, 1}}));
  folded.points[3].y = -0.5;
  EXPECT_TRUE(find_pairs(folded, 2).empty());
}

TEST(FindIntersections, AgreesWithBruteForceOnRandomSoups) {
  std::mt19937 random(7);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * (random() / 4294967296.0);
  };
  for (int round = 0; round < 4; ++round) {
    Soup soup;
    for (int v = 0; v < 700; ++v) soup.points.push_back({uniform(0, 1), uniform(0, 1), uniform(0, 1)});
    // Neighbours in the list share vertices; every other round lies on a coarse grid, where contacts are
    // degenerate.
    for (int t = 0; t < 700; ++t) {
      const int first = static_cast<int>(random() % 690);
      const Vec3 center = soup.points[first];
      std::array<int, 3> corners{first, first + 1 + static_cast<int>(random() % 4), first + 5};
      for (int i = 1; i < 3; ++i) {
        Vec3& p = soup.points[corners[i]];
        p = center + Vec3{uniform(-0.1, 0.1), uniform(-0.1, 0.1), uniform(-0.1, 0.1)};
        if (round % 2 == 1) {
          for (int axis = 0; axis < 3; ++axis) p[axis] = std::round(p[axis] * 12) / 12;
        }
      }
      soup.triangles.push_back(corners);
    }
    std::erase_if(soup.triangles, [&](const auto& t) { return !has_area(soup, t); });
    const Pairs expected = find_pairs_by_brute_force(soup);
    EXPECT_GT(expected.size(), 100u);
    for (const int pieces : {1, 4}) EXPECT_EQ(find_pairs(soup, pieces), expected);
  }
}

TEST(FindIntersections, GivesTheSameHitsOnAnyRankCount) {
  NEEDS_SEVERAL_RANKS();
  Soup soup = make_sphere(16);
  add_sheet(soup, 16, [](double u, double v) { return Vec3{1.4 * u - 0.7, 1.4 * v - 0.7, 0.8 + 0.1 * u}; });
  const auto world = parallel::Communicator::world();
  const auto self = parallel::Communicator::self();
  const auto spread = intersections_of(distribute(soup, 6, world));
  const auto alone = intersections_of(distribute(soup, 6, self));
  ASSERT_EQ(spread.size(), alone.size());
  EXPECT_FALSE(spread.empty());
  for (std::size_t i = 0; i < spread.size(); ++i) {
    EXPECT_EQ(spread[i].first_piece, alone[i].first_piece);
    EXPECT_EQ(spread[i].second_piece, alone[i].second_piece);
    EXPECT_EQ(spread[i].first, alone[i].first);
    EXPECT_EQ(spread[i].second, alone[i].second);
    EXPECT_EQ(spread[i].center, alone[i].center);
    EXPECT_EQ(spread[i].size, alone[i].size);
    EXPECT_GT(spread[i].size, 0);
  }
}

TEST(FindIntersections, RefusesTetrahedraOnAllRanks) {
  const auto world = parallel::Communicator::world();
  DistributedMesh volume(world);
  if (world.rank() != world.size() - 1) volume.kind = CellKind::triangle;
  EXPECT_THROW(intersections_of(volume), std::runtime_error);
}

}  // namespace
}  // namespace aeroloom::mesh
