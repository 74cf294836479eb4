/// From a filled zone to pieces of the mesh and the faces by which zones fit together.
#include "volume/filling/zone_piece.hpp"

#include "geometry/predicates.hpp"
#include "tests/volume/fields.hpp"
#include "tests/volume/steps.hpp"
#include "volume/filling/decomposition_data.hpp"

#include <algorithm>
#include <map>
#include <set>

#include <gtest/gtest.h>

namespace aeroloom::volume {
namespace {

using geometry::Vec3;
using mesh::LocalIndex;
using mesh::RegionId;
using mesh::SharedVertexKey;
using parallel::Communicator;

struct Zone {
  ZoneInput input;
  ZoneFilling filling;
  ZoneResult result;

  SharedVertexKey vertex_key(LocalIndex v) const { return input.vertex_keys[v]; }
};

/// All zones of two nested regions, filled one by one.
class ZonePieces : public testing::Test {
protected:
  static void SetUpTestSuite() {
    communicator = new Communicator(Communicator::self());
    surface = new surfaces::Surface(surfaces::nested_cubes(8));
    VolumeOptions options;
    options.piece_tets = 2000;
    problem = new Problem(*communicator, *surface, fields::uniform(0.14), options);
    decomposition = new Decomposition(decompose(problem->input()));
    Decomposition::Data& data = decomposition->data();
    zones = new std::vector<Zone>;
    for (const SendPlan& batch : data.plan.batches) {
      for (ZoneInput& input : gather_zone_inputs(*data.lattice, data.shell, batch)) {
        ZoneFilling filling = fill_zone_in_child(input.problem, parallel::Fault::none);
        if (!filling.filled) throw std::runtime_error(filling.failure);
        ZoneResult result = make_pieces(input, filling);
        zones->push_back({std::move(input), std::move(filling), std::move(result)});
      }
    }
  }
  static void TearDownTestSuite() {
    delete zones;
    delete decomposition;
    delete problem;
    delete surface;
    delete communicator;
  }

  static Communicator* communicator;
  static surfaces::Surface* surface;
  static Problem* problem;
  static Decomposition* decomposition;
  static std::vector<Zone>* zones;
};
Communicator* ZonePieces::communicator = nullptr;
surfaces::Surface* ZonePieces::surface = nullptr;
Problem* ZonePieces::problem = nullptr;
Decomposition* ZonePieces::decomposition = nullptr;
std::vector<Zone>* ZonePieces::zones = nullptr;

RegionId region_of(Vec3 p) {
  return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) < 0.5 ? 1 : 0;
}

TEST_F(ZonePieces, are_one_per_region_with_all_its_cells) {
  EXPECT_GT(zones->size(), 4u);
  int both = 0;
  for (const Zone& zone : *zones) {
    std::map<RegionId, std::int64_t> expected;
    for (const RegionId region : zone.filling.owned.regions) ++expected[region];
    ASSERT_EQ(zone.result.pieces.size(), expected.size());
    both += expected.size() == 2;
    EXPECT_EQ(zone.result.zone, zone.input.zone);
    EXPECT_EQ(zone.result.tetrahedra, static_cast<std::int64_t>(zone.filling.owned.cells.size()));
    EXPECT_EQ(zone.result.steiner_points, 0);
    auto at = expected.begin();
    for (const mesh::Piece& piece : zone.result.pieces) {
      EXPECT_NO_THROW(mesh::require_consistent_arrays(piece));
      EXPECT_EQ(piece.kind, mesh::CellKind::tetrahedron);
      EXPECT_EQ(piece.region, at->first);
      EXPECT_EQ(piece.cell_count(), at->second);
      ++at;
      std::vector<int> used(piece.vertex_count(), 0);
      for (LocalIndex c = 0; c < piece.cell_count(); ++c) {
        const LocalIndex* v = piece.cell(c);
        for (int k = 0; k < 4; ++k) used[v[k]] = 1;
        const Vec3 center =
            0.25 * (piece.point(v[0]) + piece.point(v[1]) + piece.point(v[2]) + piece.point(v[3]));
        EXPECT_EQ(region_of(center), piece.region);
      }
      EXPECT_EQ(std::count(used.begin(), used.end(), 0), 0);
    }
  }
  EXPECT_GT(both, 0);
}

TEST_F(ZonePieces, have_the_triangles_of_their_front_sides) {
  std::size_t triangles = 0;
  for (const Zone& zone : *zones) {
    for (const mesh::Piece& piece : zone.result.pieces) {
      triangles += piece.triangle_face.size();
      for (LocalIndex t = 0; t < piece.boundary_count(); ++t) {
        EXPECT_EQ(surface->sides[piece.triangle_face[t]].front, piece.region);
        EXPECT_EQ(piece.triangle_patch[t], piece.triangle_face[t] % 2);
      }
    }
  }
  EXPECT_EQ(triangles, surface->triangles.size());
}

TEST_F(ZonePieces, classify_their_vertices) {
  for (const Zone& zone : *zones) {
    std::map<std::array<double, 3>, std::size_t> known;
    for (std::size_t v = 0; v < zone.input.problem.points.size(); ++v) {
      const Vec3 p = zone.input.problem.points[v];
      known[{p.x, p.y, p.z}] = v;
    }
    for (const mesh::Piece& piece : zone.result.pieces) {
      for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
        const Vec3 p = piece.point(v);
        const std::size_t w = known.at({p.x, p.y, p.z});
        const bool on_surface = w < zone.input.problem.surface_points();
        EXPECT_EQ(piece.vertex_dimension[v],
                  on_surface ? zone.input.dimension[w] : mesh::CadDimension::region);
        EXPECT_EQ(piece.vertex_entity[v], on_surface ? zone.input.entity[w] : piece.region);
      }
    }
  }
}

TEST_F(ZonePieces, share_the_vertices_on_faces_to_other_zones_and_between_regions) {
  for (const Zone& zone : *zones) {
    std::set<SharedVertexKey> expected;
    for (const Crossing& crossing : zone.filling.owned.crossings) {
      for (int k = 0; k < 4; ++k) {
        if (k != crossing.face) expected.insert(zone.vertex_key(zone.filling.owned.cells[crossing.cell][k]));
      }
    }
    for (std::size_t v = 0; v < zone.input.problem.surface_points(); ++v) {
      const Vec3 p = zone.input.problem.points[v];
      if (std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) == 0.5)
        expected.insert(zone.vertex_key(static_cast<LocalIndex>(v)));
    }
    for (const LocalIndex v : zone.filling.owned.touched) expected.insert(zone.vertex_key(v));
    for (const LocalIndex v : zone.filling.owned.touched) expected.insert(zone.vertex_key(v));
    std::set<SharedVertexKey> found;
    for (const mesh::Piece& piece : zone.result.pieces) {
      std::map<std::array<double, 3>, SharedVertexKey> vertex_keys;
      for (std::size_t v = 0; v < zone.input.vertex_keys.size(); ++v) {
        const Vec3 p = zone.input.problem.points[v];
        vertex_keys[{p.x, p.y, p.z}] = zone.input.vertex_keys[v];
      }
      std::set<SharedVertexKey> of_piece(piece.shared_keys.begin(), piece.shared_keys.end());
      for (std::size_t s = 0; s < piece.shared_vertices.size(); ++s) {
        const Vec3 p = piece.point(piece.shared_vertices[s]);
        EXPECT_EQ(piece.shared_keys[s], vertex_keys.at({p.x, p.y, p.z}));
      }
      for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
        const Vec3 p = piece.point(v);
        const SharedVertexKey vertex_key = vertex_keys.at({p.x, p.y, p.z});
        EXPECT_EQ(of_piece.count(vertex_key), expected.count(vertex_key));
      }
      found.insert(of_piece.begin(), of_piece.end());
    }
    EXPECT_GT(found.size(), 20u);
  }
}

TEST_F(ZonePieces, have_faces_that_tell_vertices_leaves_and_turn) {
  for (const Zone& zone : *zones) {
    ASSERT_EQ(zone.result.faces.size(), zone.filling.owned.crossings.size());
    std::map<SharedVertexKey, LocalIndex> known;
    for (std::size_t v = 0; v < zone.input.vertex_keys.size(); ++v)
      known[zone.input.vertex_keys[v]] = static_cast<LocalIndex>(v);
    const Lattice& lattice = *decomposition->data().lattice;
    for (std::size_t i = 0; i < zone.result.faces.size(); ++i) {
      const ZoneFace& face = zone.result.faces[i];
      const Crossing& crossing = zone.filling.owned.crossings[i];
      const LocalCell& cell = zone.filling.owned.cells[crossing.cell];
      EXPECT_EQ(face.zone, zone.input.zone);
      EXPECT_EQ(face.region, zone.filling.owned.regions[crossing.cell]);
      EXPECT_TRUE(std::is_sorted(face.vertices.begin(), face.vertices.end()));
      std::array<LocalIndex, 3> v;
      for (int k = 0; k < 3; ++k) {
        v[k] = known.at(face.vertices[k]);
        EXPECT_NE(v[k], cell[crossing.face]);
        EXPECT_NE(std::find(cell.begin(), cell.end(), v[k]), cell.end());
        const auto number =
            static_cast<std::int64_t>(face.vertices[k]) - problem->surface.numbering.vertex_count;
        const Leaf leaf = number >= 0 ? leaf_of_lattice(lattice.tree, number)
                                      : lattice.leaf_at(zone.input.problem.points[v[k]]);
        EXPECT_EQ(face.leaves[k], 8 * std::int64_t{leaf.block} + leaf.child);
      }
      // Counter-clockwise seen from outside: the fourth vertex lies on the other side.
      const auto& x = zone.input.problem.points;
      EXPECT_EQ(geometry::orient3d(x[v[0]], x[v[1]], x[v[2]], x[cell[crossing.face]]), face.odd ? 1 : -1);
    }
  }
}

TEST(MakePieces, names_points_that_were_added_after_the_zone_alone) {
  // Two tetrahedra of a zone with an added point, as if more were beside them.
  ZoneInput input;
  input.zone = 5;
  input.problem.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}};
  input.problem.regions.assign(3, 2);
  input.dimension = {mesh::CadDimension::face};
  input.entity = {7};
  input.problem.owners.assign(4, Owner::mine);
  input.vertex_keys = {0, 101, 102, 103};
  input.surface_vertices = 100;
  input.leaves = {3, 4, 5, 6};
  ZoneFilling filling;
  filling.added = {{0.2, 0.2, 1}};
  filling.owned.cells = {{0, 1, 2, 4}, {0, 2, 1, 3}};
  filling.owned.regions = {2, 2};
  filling.owned.crossings = {{0, 0}, {1, 0}};
  filling.owned.touched = {0};
  const ZoneResult result = make_pieces(input, filling);
  ASSERT_EQ(result.pieces.size(), 1u);
  EXPECT_EQ(result.steiner_points, 1);
  const mesh::Piece& piece = result.pieces.front();
  EXPECT_EQ(piece.region, 2);
  EXPECT_EQ(piece.vertex_count(), 5);
  EXPECT_EQ(piece.point(4), filling.added[0]);
  EXPECT_EQ(piece.vertex_dimension[4], mesh::CadDimension::region);
  EXPECT_EQ(piece.vertex_dimension[0], mesh::CadDimension::face);
  EXPECT_EQ(piece.vertex_entity[0], 7);
  // The first is touched by others, three are on faces to them; the added one is nobody else's.
  EXPECT_EQ(piece.shared_keys, (std::vector<SharedVertexKey>{0, 101, 102, 103}));
  ASSERT_EQ(result.faces.size(), 2u);
  EXPECT_EQ(result.faces[0].leaves[2], -1);
  EXPECT_GT(result.faces[0].vertices[2], SharedVertexKey{1} << 60);
  EXPECT_GE(result.faces[1].leaves[2], 0);
}

}  // namespace
}  // namespace aeroloom::volume
