// All that the distributed mesh does, on a mesh of all shapes of cells.
#include "tests/meshes/mixed_mesh.hpp"

#include "mesh/checks/validity.hpp"
#include "mesh/data/piece_faces.hpp"
#include "mesh/quality/cell_measures.hpp"
#include "mesh/transfer/build_pieces.hpp"
#include "mesh/transfer/repartition.hpp"
#include "parallel/communication/collective_error.hpp"

#include <functional>
#include <limits>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace aeroloom::mesh {
namespace {

using parallel::Communicator;

constexpr double determinant = 2 * 1.5 + 0.25 * 0.125 * 0.0625;  // of the map of the mixed mesh

std::string hash_of(const DistributedMesh& mesh) {
  return hash_mesh(number_mesh(mesh));
}

TEST(MixedMesh, IsNumberedByPieceThenShape) {
  const Communicator world = Communicator::world();
  const examples::MixedMesh whole(4, 3);
  const DistributedMesh mesh = examples::distribute(world, whole, 3);
  const NumberedMesh numbered = number_mesh(mesh);
  EXPECT_EQ(numbered.numbering.vertex_count, static_cast<GlobalIndex>(whole.points.size()));
  EXPECT_EQ(numbered.numbering.cell_count, static_cast<GlobalIndex>(whole.cells.size()));
  for (std::size_t i = 0; i < mesh.pieces.size(); ++i) {
    const auto before = std::count_if(whole.cells.begin(), whole.cells.end(),
                                      [&](const auto& cell) { return cell.piece < mesh.pieces[i].id; });
    EXPECT_EQ(numbered.numbering.first_cell[i], before);
  }
  const MeshCounts counts = count_mesh(numbered);
  EXPECT_EQ(counts.cells, 4 + 32 + 20 + 104);
  EXPECT_EQ(counts.pyramids, 20);
  EXPECT_EQ(counts.prisms, 32);
  EXPECT_EQ(counts.hexahedra, 4);
  EXPECT_EQ(counts.of(CellShape::tetrahedron), 104);
  EXPECT_EQ(counts.inner_triangles, 32);
  EXPECT_EQ(counts.inner_quads, 0);
  GlobalIndex triangles = 0, quads = 0;
  for (const examples::WholeFace& face : whole.faces) ++(face.corners.size() == 3 ? triangles : quads);
  EXPECT_EQ(counts.boundary_triangles + counts.inner_triangles, triangles);
  EXPECT_EQ(counts.boundary_quads, quads);
}

TEST(MixedMeshLocal, CellsOfAllShapesAreFound) {
  const DistributedMesh mesh = examples::mixed_mesh(Communicator::self(), 3, 2);
  for (const Piece& piece : mesh.pieces) {
    std::size_t side = 0;
    for (LocalIndex c = 0; c < piece.total_cell_count(); ++c) {
      EXPECT_EQ(first_side(piece, c), side);
      const auto sides = faces_of(cell_of(piece, c).shape).size();
      for (std::size_t s = 0; s < sides; ++s, ++side) {
        EXPECT_EQ(cell_at_side(piece, side).cell, c);
        EXPECT_EQ(cell_at_side(piece, side).side, static_cast<std::int32_t>(s));
      }
    }
    std::int64_t edge = 0;
    for (LocalIndex f = 0; f < boundary_face_count(piece); ++f) {
      EXPECT_EQ(first_edge(piece, f), edge);
      for (std::size_t k = 0; k < corners_of_boundary(piece, f).size(); ++k, ++edge) {
        EXPECT_EQ(face_at_edge(piece, edge).face, f);
        EXPECT_EQ(face_at_edge(piece, edge).edge, static_cast<int>(k));
      }
    }
    LocalIndex first = 0;
    for (const CellShape shape : cell_shapes) {
      LocalIndex seen = 0;
      for_each_region_run(piece, shape, [&](RegionId region, LocalIndex begin, LocalIndex end) {
        EXPECT_EQ(begin, seen);
        for (; seen < end; ++seen) EXPECT_EQ(region_of(piece, first + seen), region);
      });
      first += seen;
    }
    EXPECT_EQ(first, piece.total_cell_count());
  }
}

TEST(MixedMesh, HashIsTheSameOnAnyRanksAndAnyPieceOrder) {
  const Communicator world = Communicator::world(), self = Communicator::self();
  EXPECT_EQ(hash_of(examples::mixed_mesh(world, 4, 5)), hash_of(examples::mixed_mesh(self, 4, 5)));
}

TEST(MixedMeshLocal, EveryPartOfThePiecesCountsInTheHash) {
  const Communicator self = Communicator::self();
  const std::string hash = hash_of(examples::mixed_mesh(self, 3, 2));
  const auto expect_other = [&](const char* what, const std::function<void(Piece&)>& change) {
    DistributedMesh mesh = examples::mixed_mesh(self, 3, 2);
    change(mesh.pieces[1]);
    EXPECT_NE(hash_of(mesh), hash) << what;
  };
  expect_other("pyramids", [](Piece& piece) { std::swap(piece.pyramids[0], piece.pyramids[1]); });
  expect_other("prisms", [](Piece& piece) { std::swap(piece.prisms[3], piece.prisms[4]); });
  expect_other("hexahedra", [](Piece& piece) { std::swap(piece.hexahedra[0], piece.hexahedra[7]); });
  expect_other("quads", [](Piece& piece) { std::swap(piece.quads[0], piece.quads[1]); });
  expect_other("quad_face", [](Piece& piece) { piece.quad_face[0] ^= 1; });
  expect_other("quad_patch", [](Piece& piece) { piece.quad_patch[0] ^= 1; });
  expect_other("runs", [](Piece& piece) { piece.runs[0].end -= 1; });
  expect_other("no classification",
               [](Piece& piece) { piece.vertex_dimension = {}, piece.vertex_entity = {}; });
  expect_other("a prism less", [](Piece& piece) {
    piece.prisms.resize(piece.prisms.size() - 6);
    piece.runs.back().end -= 1;
  });
  expect_other("a hexahedron less", [](Piece& piece) {
    piece.hexahedra.resize(piece.hexahedra.size() - 8);
    piece.runs.back().end -= 1;
  });
}

TEST(MixedMesh, MigratesAndPacksBitForBit) {
  const Communicator world = Communicator::world();
  DistributedMesh mesh = examples::mixed_mesh(world, 4, 5);
  const std::string hash = hash_of(mesh);
  for (int round = 1; round <= 3; ++round) {
    std::vector<parallel::Rank> owner;
    for (PieceId id = 0; id < 5; ++id) owner.push_back((3 * id + round) % world.size());
    migrate(mesh, owner);
    for (const Piece& piece : mesh.pieces) {
      EXPECT_EQ(owner[piece.id], world.rank());
      EXPECT_EQ(parallel::to_wire(parallel::from_wire<Piece>(parallel::to_wire(piece))),
                parallel::to_wire(piece));
      EXPECT_GE(bytes_at_rest(piece),
                static_cast<std::int64_t>(4 * (piece.pyramids.size() + piece.prisms.size() +
                                               piece.hexahedra.size() + piece.quads.size())));
    }
    EXPECT_EQ(hash_of(mesh), hash);
  }
}

TEST(MixedMeshLocal, ArraysThatDoNotFitAreRefused) {
  const auto expect_refused = [](const char* what, const std::function<void(Piece&)>& spoil) {
    Piece piece = examples::mixed_mesh(Communicator::self(), 3, 2).pieces[1];
    ASSERT_NO_THROW(require_consistent_arrays(piece));
    spoil(piece);
    EXPECT_THROW(require_consistent_arrays(piece), std::logic_error) << what;
  };
  expect_refused("incomplete pyramid", [](Piece& piece) { piece.pyramids.pop_back(); });
  expect_refused("incomplete prism", [](Piece& piece) { piece.prisms.push_back(0); });
  expect_refused("incomplete hexahedron", [](Piece& piece) { piece.hexahedra.pop_back(); });
  expect_refused("vertex of a hexahedron", [](Piece& piece) { piece.hexahedra[7] = piece.vertex_count(); });
  expect_refused("vertex of a prism", [](Piece& piece) { piece.prisms[0] = piece.vertex_count(); });
  expect_refused("vertex of a pyramid", [](Piece& piece) { piece.pyramids[0] = -1; });
  expect_refused("vertex of a quadrilateral", [](Piece& piece) { piece.quads[0] = piece.vertex_count(); });
  expect_refused("patches", [](Piece& piece) { piece.quad_patch.pop_back(); });
  expect_refused("faces", [](Piece& piece) { piece.quad_face.pop_back(); });
  expect_refused("runs too short", [](Piece& piece) { piece.runs.back().end -= 1; });
  expect_refused("runs too long", [](Piece& piece) { piece.runs.back().end += 1; });
  expect_refused("empty run", [](Piece& piece) { piece.runs.insert(piece.runs.begin(), {0, 0}); });
  expect_refused("regions descend",
                 [](Piece& piece) { std::swap(piece.runs[0].region, piece.runs[1].region); });
  expect_refused("half a classification", [](Piece& piece) { piece.vertex_entity = {}; });
  expect_refused("triangles", [](Piece& piece) { piece.kind = CellKind::triangle; });
}

ValidityReport check(const DistributedMesh& mesh) {
  return check_volume_mesh(number_mesh(mesh), nullptr);
}

TEST(MixedMesh, IsValidOnAnyRanksHoweverCut) {
  const Communicator world = Communicator::world();
  for (const int pieces : {1, 3, 5}) {
    const ValidityReport report = check(examples::mixed_mesh(world, 4, pieces));
    EXPECT_TRUE(report.valid()) << report.violations.front();
    EXPECT_NEAR(report.volume, 40 * determinant, 1e-10);
    EXPECT_NEAR(report.surface_volume, 40 * determinant, 1e-10);
    EXPECT_NEAR(report.region_volumes.at(1), 16 * determinant, 1e-10);
  }
}

/// The violations of a mesh that `spoil` has broken in piece 1, the last one; the same on every rank.
std::vector<std::string> violations(const Communicator& world, const std::function<void(Piece&)>& spoil) {
  DistributedMesh mesh = examples::mixed_mesh(world, 3, 2);
  for (Piece& piece : mesh.pieces) {
    if (piece.id == 1) spoil(piece);
  }
  return check(mesh).violations;
}

TEST(MixedMesh, EveryBrokenMeshIsFoundOut) {
  const Communicator world = Communicator::world();
  const auto expect_found = [&](const std::string& text, const std::function<void(Piece&)>& spoil) {
    std::string all;
    for (const std::string& violation : violations(world, spoil)) all += violation + "\n";
    EXPECT_NE(all.find(text), std::string::npos) << "wanted: " << text << "\nfound: " << all;
  };
  expect_found("cells without positive volume", [](Piece& piece) {
    for (int k = 0; k < 3; ++k) std::swap(piece.prisms[k], piece.prisms[k + 3]);
  });
  expect_found("cells without positive volume: 1, the first being pyramid 2",
               [](Piece& piece) { std::swap(piece.pyramids[11], piece.pyramids[13]); });
  expect_found("boundary faces that are no face of a cell", [](Piece& piece) {
    const std::set<LocalIndex> corners(piece.quads.begin(), piece.quads.begin() + 4);
    while (corners.count(piece.quads[0])) ++piece.quads[0];
  });
  expect_found("boundary faces turned inward: 1, the first being boundary quadrilateral 0",
               [](Piece& piece) { std::swap(piece.quads[1], piece.quads[3]); });
  expect_found("faces of one cell without a boundary face",  // its corners cross
               [](Piece& piece) { std::swap(piece.quads[1], piece.quads[2]); });
  expect_found("faces of one cell without a boundary face: 1, the first being p", [](Piece& piece) {
    piece.quads.resize(piece.quads.size() - 4);
    piece.quad_face.pop_back(), piece.quad_patch.pop_back();
  });
  expect_found("faces of more than two cells", [](Piece& piece) {
    for (int copy = 0; copy < 2; ++copy)
      piece.pyramids.insert(piece.pyramids.end(), piece.pyramids.begin(), piece.pyramids.begin() + 5);
    for (RegionRun& run : piece.runs) run.end += run.region == 0 && run.end > piece.cell_count() ? 2 : 0;
  });
  expect_found("faces with both cells on one side",
               [](Piece& piece) { std::swap(piece.pyramids[11], piece.pyramids[13]); });
  expect_found("repeated faces", [](Piece& piece) {
    piece.quads.insert(piece.quads.end(), piece.quads.begin(), piece.quads.begin() + 4);
    piece.quad_face.push_back(piece.quad_face[0]), piece.quad_patch.push_back(piece.quad_patch[0]);
  });
  expect_found("orphan vertices", [](Piece& piece) {
    piece.coordinates.insert(piece.coordinates.end(), {7, 7, 7});
    piece.vertex_dimension.push_back(CadDimension::region), piece.vertex_entity.push_back(0);
  });
  expect_found("coordinate that is no finite number",
               [](Piece& piece) { piece.coordinates.back() = std::numeric_limits<double>::infinity(); });
  expect_found("boundary faces without a patch: 1, the first being boundary quadrilateral 1",
               [](Piece& piece) { piece.quad_patch[1] = 4; });
  expect_found("boundary faces without a CAD face", [](Piece& piece) { piece.quad_face[1] = -1; });
  expect_found("faces between two regions without a face", [](Piece& piece) {
    piece.runs.back().region = 1;  // the prisms and pyramids
  });
  expect_found("boundary faces beside cells of other regions",
               [](Piece& piece) { piece.runs.back().region = 1; });
  expect_found("the cells fill", [](Piece& piece) {
    piece.prisms.resize(piece.prisms.size() - 6);
    piece.runs.back().end -= 1;
  });
}

TEST(MixedMeshLocal, AFoldedPrismOfPositiveVolumeIsFoundOut) {
  // One column of a prism goes through its base; its volume stays positive.
  const Communicator self = Communicator::self();
  const std::array<geometry::Vec3, 6> prism = {
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, -0.1}, {1, 0, 1}, {0, 1, 1}}};
  EXPECT_GT(cell_volume(CellShape::prism, prism.data()), 0);
  EXPECT_FALSE(has_positive_corners(CellShape::prism, prism.data()));
  Piece piece;
  for (const geometry::Vec3 p : prism) piece.coordinates.insert(piece.coordinates.end(), {p.x, p.y, p.z});
  piece.prisms = {0, 1, 2, 3, 4, 5};
  piece.boundary = {0, 2, 1, 3, 4, 5};
  piece.quads = {0, 1, 4, 3, 1, 2, 5, 4, 2, 0, 3, 5};
  piece.triangle_face = piece.triangle_patch = {0, 0};
  piece.quad_face = piece.quad_patch = {0, 0, 0};
  DistributedMesh mesh(self);
  mesh.piece_count = 1;
  mesh.faces = mesh.patches = {"all"};
  mesh.pieces = {piece};
  const ValidityReport report = check(mesh);
  ASSERT_EQ(report.violations.size(), 1U);
  EXPECT_NE(report.violations[0].find("corner that is turned inside out: 1, the first being prism 0"),
            std::string::npos)
      << report.violations[0];
}

TEST(MixedMeshLocal, AFoldedHexahedronOfPositiveVolumeIsFoundOut) {
  std::array<geometry::Vec3, 8> hexahedron = {
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};
  EXPECT_TRUE(has_positive_corners(CellShape::hexahedron, hexahedron.data()));
  hexahedron[6] = {1, 1, -0.1};
  EXPECT_GT(cell_volume(CellShape::hexahedron, hexahedron.data()), 0);
  EXPECT_FALSE(has_positive_corners(CellShape::hexahedron, hexahedron.data()));
}

TEST(MixedMesh, VolumesOfWarpedQuadrilateralsAddUp) {
  // Lower prisms and pyramids beside each other, all inner vertices moved: quadrilaterals warp.
  const Communicator world = Communicator::world();
  DistributedMesh mesh = examples::mixed_mesh(world, 4, 3);
  const NumberedMesh numbered = number_mesh(mesh);
  for (std::size_t i = 0; i < mesh.pieces.size(); ++i) {
    for (LocalIndex v = 0; v < mesh.pieces[i].vertex_count(); ++v) {
      const auto bits =
          static_cast<std::uint64_t>(numbered.numbering.vertices[i][v] + 1) * 0x9e3779b97f4a7c15ULL;
      geometry::Vec3 p = mesh.pieces[i].point(v);
      p.z += 0.1 * (static_cast<double>(bits >> 40) / (1 << 23) - 1);
      mesh.pieces[i].set_point(v, p);
    }
  }
  const ValidityReport report = check(mesh);
  EXPECT_TRUE(report.valid()) << report.violations.front();
  EXPECT_NEAR(report.volume, report.surface_volume, 1e-10 * report.volume);
}

TEST(MixedMesh, SharedCoordinatesMustAgree) {
  const Communicator world = Communicator::world();
  NumberedMesh mesh = number_mesh(examples::mixed_mesh(world, 3, 2));
  for (Piece& piece : mesh.pieces) {
    if (piece.id == 1) piece.coordinates[3 * static_cast<std::size_t>(piece.shared_vertices[0])] += 1e-9;
  }
  EXPECT_THROW(number_mesh(mesh), parallel::CollectiveError);
  const ValidityReport report = check_volume_mesh(mesh, nullptr);
  ASSERT_FALSE(report.valid());
  EXPECT_EQ(report.violations[0].find("shared vertices whose coordinates differ"), 0U);
}

TEST(MixedMesh, IsTheSameMeshInOtherPieces) {
  const Communicator world = Communicator::world(), self = Communicator::self();
  const NumberedMesh mesh = number_mesh(examples::mixed_mesh(world, 4, 3));
  const NumberedMesh alone = number_mesh(examples::mixed_mesh(self, 4, 3));
  const MeshCounts counts = count_mesh(mesh);
  for (const auto& [pieces, regions] :
       {std::pair(1, PieceRegions::several), {7, PieceRegions::several}, {4, PieceRegions::one}}) {
    const NumberedMesh cut = repartition(mesh, pieces, regions);
    const NumberedMesh cut_alone = repartition(alone, pieces, regions);
    EXPECT_EQ(hash_mesh(cut), hash_mesh(cut_alone));
    EXPECT_EQ(hash_of(cut), hash_mesh(cut));
    const MeshCounts now = count_mesh(cut);
    EXPECT_EQ(now.vertices, counts.vertices);
    EXPECT_EQ(now.pyramids, counts.pyramids);
    EXPECT_EQ(now.hexahedra, counts.hexahedra);
    EXPECT_EQ(now.boundary_quads, counts.boundary_quads);
    EXPECT_EQ(now.inner_triangles, counts.inner_triangles);
    const ValidityReport report = check_volume_mesh(cut, nullptr);
    EXPECT_TRUE(report.valid()) << report.violations.front();
    for (const Piece& piece : cut.pieces) {
      EXPECT_TRUE(regions == PieceRegions::several || piece.runs.empty());
      EXPECT_EQ(piece.vertex_dimension.size(), static_cast<std::size_t>(piece.vertex_count()));
    }
  }
}

}  // namespace
}  // namespace aeroloom::mesh
