#include "mesh/checks/validity.hpp"

#include "mesh/data/boundary_mesh.hpp"
#include "parallel/communication/collective_error.hpp"
#include "tests/meshes/small_meshes.hpp"
#include "tests/several_ranks.hpp"

#include <functional>
#include <limits>

#include <gtest/gtest.h>

namespace aeroloom::mesh {
namespace {

using parallel::Communicator;
using Change = std::function<void(Piece&)>;

constexpr int side = 3, pieces = 4;

/// Applies a change to one piece, on whichever rank it lives.
void change_piece(DistributedMesh& mesh, PieceId id, const Change& change) {
  for (Piece& piece : mesh.pieces) {
    if (piece.id == id) change(piece);
  }
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

/// Numbers the sound mesh, then spoils it, so that faults a numbering would refuse can be looked at too.
ValidityReport check_cube(const Communicator& communicator, PieceId id, const Change& change) {
  auto mesh = examples::cube(communicator, side, pieces);
  const auto surface = examples::cube_surface(communicator, side, 3);
  const NumberedMesh sound = number_mesh(mesh);
  change_piece(mesh, id, change);
  bool same_shape = true;
  for (std::size_t i = 0; i < mesh.pieces.size(); ++i) {
    same_shape = same_shape && sound.numbering.vertices[i].size() ==
                                   static_cast<std::size_t>(mesh.pieces[i].vertex_count());
  }
  const bool keep = communicator.minimum(std::int64_t{same_shape}) == 1;
  return check_volume_mesh(keep ? NumberedMesh{mesh, sound.numbering} : number_mesh(mesh), &surface);
}

/// The report on a cube whose piece `id` was changed. It must be the same on one rank and on all.
std::string volume_faults(PieceId id, const Change& change) {
  const ValidityReport report = check_cube(Communicator::world(), id, change);
  const ValidityReport alone = check_cube(Communicator::self(), id, change);
  EXPECT_EQ(joined(report.violations), joined(alone.violations));
  EXPECT_EQ(report.valid(), report.violations.empty());
  return joined(report.violations);
}

ValidityReport check_sides(const Communicator& communicator, PieceId id, const Change& change) {
  auto mesh = examples::cube_surface(communicator, side, pieces);
  change_piece(mesh, id, change);
  return check_surface_mesh(number_mesh(mesh));
}

std::string surface_faults(PieceId id, const Change& change) {
  const ValidityReport report = check_sides(Communicator::world(), id, change);
  EXPECT_EQ(joined(report.violations), joined(check_sides(Communicator::self(), id, change).violations));
  return joined(report.violations);
}

#define EXPECT_FOUND(text, what) EXPECT_NE((text).find(what), std::string::npos) << (text)

void erase_triangle(Piece& piece, std::size_t t) {
  auto& corners = piece.kind == CellKind::triangle ? piece.cells : piece.boundary;
  const auto at = static_cast<std::ptrdiff_t>(t);
  corners.erase(corners.begin() + 3 * at, corners.begin() + 3 * at + 3);
  piece.triangle_face.erase(piece.triangle_face.begin() + at);
  piece.triangle_patch.erase(piece.triangle_patch.begin() + at);
}

void repeat_triangle(Piece& piece, std::size_t t) {
  auto& corners = piece.kind == CellKind::triangle ? piece.cells : piece.boundary;
  for (int k = 0; k < 3; ++k) corners.push_back(LocalIndex{corners[3 * t + k]});
  piece.triangle_face.push_back(std::int32_t{piece.triangle_face[t]});
  piece.triangle_patch.push_back(std::int32_t{piece.triangle_patch[t]});
}

LocalIndex add_vertex(Piece& piece, geometry::Vec3 p) {
  piece.coordinates.insert(piece.coordinates.end(), {p.x, p.y, p.z});
  piece.vertex_dimension.push_back(CadDimension::region);
  piece.vertex_entity.push_back(0);
  return piece.vertex_count() - 1;
}

TEST(VolumeValidity, AcceptsSoundMeshesHoweverTheyAreCut) {
  const auto world = Communicator::world();
  for (const int cuts : {1, 2, 5, 27}) {
    const auto mesh = examples::cube(world, 3, cuts);
    const auto surface = examples::cube_surface(world, 3, cuts);
    const auto report = check_volume_mesh(number_mesh(mesh), &surface);
    EXPECT_TRUE(report.valid()) << joined(report.violations);
    EXPECT_NEAR(report.volume, 1, 1e-14);
    EXPECT_NEAR(report.surface_volume, 1, 1e-14);
  }
  for (const auto& mesh : {examples::two_tets(world), examples::fan(world, 5)}) {
    const auto report = check_volume_mesh(number_mesh(mesh), nullptr);
    EXPECT_TRUE(report.valid()) << joined(report.violations);
  }
}

TEST(VolumeValidity, HasTheSameBitsOfVolumeOnOneRank) {
  NEEDS_SEVERAL_RANKS();
  const auto world = Communicator::world(), self = Communicator::self();
  const auto here = examples::cube(world, 4, 7), alone = examples::cube(self, 4, 7);
  const auto a = check_volume_mesh(number_mesh(here), nullptr);
  const auto b = check_volume_mesh(number_mesh(alone), nullptr);
  EXPECT_EQ(a.volume, b.volume);
  EXPECT_EQ(a.surface_volume, b.surface_volume);
}

TEST(VolumeValidity, AcceptsAMeshFarFromTheOrigin) {
  const auto world = Communicator::world();
  auto mesh = examples::cube(world, 3, 4);
  for (Piece& piece : mesh.pieces) {
    for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      piece.set_point(v, piece.point(v) + geometry::Vec3{1e7, -3e6, 5e6});
    }
  }
  const auto report = check_volume_mesh(number_mesh(mesh), nullptr);
  EXPECT_TRUE(report.valid()) << joined(report.violations);
}

TEST(VolumeValidity, FindsAnInvertedTetrahedron) {
  const auto faults = volume_faults(2, [](Piece& piece) { std::swap(piece.cells[4], piece.cells[5]); });
  EXPECT_FOUND(faults,
               "tetrahedra without positive volume: 1, the first being tetrahedron 1 of piece 2 at (");
}

TEST(VolumeValidity, FindsAFlatTetrahedron) {
  const auto faults = volume_faults(1, [](Piece& piece) { piece.cells[7] = piece.cells[6]; });
  EXPECT_FOUND(faults, "without positive volume: 1");
}

TEST(VolumeValidity, FindsACoordinateThatIsNoNumber) {
  const auto faults = volume_faults(
      3, [](Piece& piece) { piece.coordinates.back() = std::numeric_limits<double>::quiet_NaN(); });
  EXPECT_FOUND(faults, "no finite number: 1, the first being vertex");
}

TEST(VolumeValidity, FindsAMissingBoundaryTriangle) {
  const auto faults = volume_faults(0, [](Piece& piece) { erase_triangle(piece, 5); });
  EXPECT_FOUND(faults, "faces of one tetrahedron without a boundary triangle: 1,");
  EXPECT_FOUND(faults, "open edges, with a triangle on one side only: 3,");
  EXPECT_FOUND(faults, "triangles of the surface mesh that the boundary does not have: 1,");
}

TEST(VolumeValidity, FindsAMissingTetrahedron) {
  const auto faults =
      volume_faults(1, [](Piece& piece) { piece.cells.erase(piece.cells.begin(), piece.cells.begin() + 4); });
  EXPECT_FOUND(faults, "faces of one tetrahedron without a boundary triangle:");
}

TEST(VolumeValidity, FindsADuplicatedTetrahedron) {
  const auto faults = volume_faults(1, [](Piece& piece) {
    for (int k = 0; k < 4; ++k) piece.cells.push_back(LocalIndex{piece.cells[k]});
  });
  EXPECT_FOUND(faults, "faces of more than two tetrahedra:");
  EXPECT_FOUND(faults, "the tetrahedra fill");
}

TEST(VolumeValidity, FindsAnOrphan) {
  const auto faults = volume_faults(1, [](Piece& piece) { add_vertex(piece, {0.25, 0.5, 0.75}); });
  EXPECT_FOUND(faults, "orphan vertices, which no cell of their piece uses: 1,");
  EXPECT_FOUND(faults, "of piece 1 at (0.25, 0.5, 0.75)");
}

TEST(VolumeValidity, FindsSharedCoordinatesThatDiffer) {
  const auto faults = volume_faults(2, [](Piece& piece) {
    double& x = piece.coordinates[3 * piece.shared_vertices[0]];
    x = std::nextafter(x, 0.5);
  });
  EXPECT_FOUND(faults, "shared vertices whose coordinates differ between pieces: 1, the first being vertex");
}

TEST(VolumeValidity, FindsAMissingPatchAndFace) {
  const auto faults = volume_faults(3, [](Piece& piece) {
    piece.triangle_patch[0] = -1;
    piece.triangle_patch[2] = 3;
    piece.triangle_face[1] = 6;
  });
  EXPECT_FOUND(faults,
               "boundary triangles without a patch: 2, the first being boundary triangle 0 of piece 3");
  EXPECT_FOUND(faults, "boundary triangles without a CAD face: 1,");
}

TEST(VolumeValidity, FindsATriangleTurnedInward) {
  const auto faults = volume_faults(0, [](Piece& piece) { std::swap(piece.boundary[0], piece.boundary[1]); });
  EXPECT_FOUND(faults, "boundary triangles turned inward: 1,");
  EXPECT_FOUND(faults, "do not pair up in opposite directions: 3,");
  EXPECT_FOUND(faults, "boundary triangles that the surface mesh does not have: 1,");
}

TEST(VolumeValidity, FindsARepeatedTriangle) {
  EXPECT_FOUND(volume_faults(0, [](Piece& piece) { repeat_triangle(piece, 4); }), "repeated triangles: 1,");
}

TEST(VolumeValidity, FindsATriangleOnAnInterface) {
  const auto faults = volume_faults(1, [](Piece& piece) {
    const auto inside = [](double x) { return x > 0.01 && x < 0.99; };
    const auto is_shared = [&](LocalIndex v) {
      return std::binary_search(piece.shared_vertices.begin(), piece.shared_vertices.end(), v);
    };
    for (LocalIndex c = 0; c < piece.cell_count(); ++c) {
      for (const auto& face : tetrahedron_faces) {
        const LocalIndex v[3] = {piece.cell(c)[face[0]], piece.cell(c)[face[1]], piece.cell(c)[face[2]]};
        const geometry::Vec3 center = (piece.point(v[0]) + piece.point(v[1]) + piece.point(v[2])) / 3;
        if (!std::all_of(v, v + 3, is_shared) || !inside(center.x) || !inside(center.y) || !inside(center.z))
          continue;
        piece.boundary.insert(piece.boundary.end(), v, v + 3);
        piece.triangle_face.push_back(0);
        piece.triangle_patch.push_back(0);
        return;
      }
    }
  });
  EXPECT_FOUND(faults, "boundary triangles between two tetrahedra: 1,");
}

TEST(VolumeValidity, FindsATriangleOfNoTetrahedron) {
  const auto faults = volume_faults(0, [](Piece& piece) {
    const LocalIndex v = add_vertex(piece, {2, 2, 2});
    piece.boundary.insert(piece.boundary.end(), {piece.cells[0], piece.cells[1], v});
    piece.triangle_face.push_back(0);
    piece.triangle_patch.push_back(0);
  });
  EXPECT_FOUND(faults, "boundary triangles that are no face of a tetrahedron: 1,");
}

TEST(VolumeValidity, FindsALostSharedVertexKey) {
  const auto faults = volume_faults(1, [](Piece& piece) {
    const LocalIndex v = piece.shared_vertices.back();
    piece.shared_vertices.pop_back();
    piece.shared_keys.pop_back();
    add_vertex(piece, piece.point(v));  // makes the mesh to be numbered anew
  });
  EXPECT_FOUND(faults, "faces of one tetrahedron without a boundary triangle:");
}

TEST(VolumeValidity, FindsTwoTetrahedraOnOneSide) {
  const auto world = Communicator::world();
  auto mesh = examples::two_tets(world);
  // The apex of the lower one moves above the common face.
  change_piece(mesh, 1, [](Piece& piece) {
    std::swap(piece.cells[1], piece.cells[2]);
    piece.set_point(piece.cells[3], {0.2, 0.2, 0.7});
  });
  const auto report = check_volume_mesh(number_mesh(mesh), nullptr);
  EXPECT_FOUND(joined(report.violations),
               "faces with both tetrahedra on one side: 1, the first being tetrahedron 0 of");
}

TEST(VolumeValidity, FindsASurfaceThatIsAnother) {
  const auto world = Communicator::world();
  const auto mesh = examples::cube(world, side, pieces);
  auto surface = examples::cube_surface(world, side, 2);
  change_piece(surface, 1,
               [](Piece& piece) { piece.coordinates[0] += 1e-16 + 1e-15 * piece.coordinates[0]; });
  const auto report = check_volume_mesh(number_mesh(mesh), &surface);
  EXPECT_FOUND(joined(report.violations), "boundary triangles that the surface mesh does not have:");
  EXPECT_FOUND(joined(report.violations), "triangles of the surface mesh that the boundary does not have:");
}

TEST(VolumeValidity, KnowsItsOwnSurfaceFromAnother) {
  const auto world = Communicator::world();
  const auto mesh = examples::cube(world, side, pieces);
  const NumberedMesh numbered = number_mesh(mesh);
  DistributedMesh surface = boundary_mesh(numbered);
  EXPECT_TRUE(check_volume_mesh(numbered, &surface).valid());
  change_piece(surface, 2, [](Piece& piece) { piece.coordinates[4] += 1e-15; });
  const std::string moved = joined(check_volume_mesh(numbered, &surface).violations);
  EXPECT_FOUND(moved, "boundary triangles that the surface mesh does not have");
  EXPECT_FOUND(moved, "triangles of the surface mesh that the boundary does not have");
  surface = boundary_mesh(numbered);
  change_piece(surface, surface.piece_count - 1, [](Piece& piece) { repeat_triangle(piece, 0); });
  EXPECT_FOUND(joined(check_volume_mesh(numbered, &surface).violations),
               "triangles of the surface mesh that the boundary does not have: 1,");
}

TEST(VolumeValidity, RefusesANumberingOfAnotherMesh) {
  const auto world = Communicator::world();
  const auto mesh = examples::cube(world, side, pieces);
  const NumberedMesh other = number_mesh(examples::cube(world, side + 1, pieces));
  EXPECT_THROW(check_volume_mesh({mesh, other.numbering}, nullptr), parallel::CollectiveError);
}

TEST(VolumeValidity, FindsAMeshWithoutTetrahedra) {
  const auto world = Communicator::world();
  const DistributedMesh mesh(world);
  const auto report = check_volume_mesh(number_mesh(mesh), nullptr);
  EXPECT_EQ(joined(report.violations), "the mesh has no tetrahedra\n");
}

TEST(VolumeValidity, RefusesASurfaceMesh) {
  const auto world = Communicator::world();
  const auto mesh = examples::cube_surface(world, 2, 2);
  EXPECT_THROW(check_volume_mesh(number_mesh(mesh), nullptr), parallel::CollectiveError);
}

TEST(SurfaceValidity, AcceptsSoundMeshesHoweverTheyAreCut) {
  const auto world = Communicator::world();
  for (const int cuts : {1, 2, 7}) {
    const auto mesh = examples::cube_surface(world, 3, cuts);
    const auto report = check_surface_mesh(number_mesh(mesh));
    EXPECT_TRUE(report.valid()) << joined(report.violations);
    EXPECT_NEAR(report.volume, 1, 1e-14);
  }
}

TEST(SurfaceValidity, FindsAHole) {
  const auto faults = surface_faults(1, [](Piece& piece) { erase_triangle(piece, 0); });
  EXPECT_FOUND(faults, "open edges, with a triangle on one side only: 3, the first being triangle");
}

TEST(SurfaceValidity, FindsATriangleTurnedOver) {
  const auto faults = surface_faults(2, [](Piece& piece) { std::swap(piece.cells[3], piece.cells[4]); });
  EXPECT_FOUND(faults, "edges whose triangles do not pair up in opposite directions: 3,");
}

TEST(SurfaceValidity, FindsARepeatedTriangle) {
  EXPECT_FOUND(surface_faults(3, [](Piece& piece) { repeat_triangle(piece, 1); }), "repeated triangles: 1,");
}

TEST(SurfaceValidity, FindsADegenerateTriangle) {
  const auto faults = surface_faults(0, [](Piece& piece) {
    const LocalIndex v = add_vertex(piece, 0.5 * (piece.point(piece.cells[0]) + piece.point(piece.cells[1])));
    piece.cells.insert(piece.cells.end(), {piece.cells[0], piece.cells[1], v});
    piece.triangle_face.push_back(0);
    piece.triangle_patch.push_back(0);
  });
  EXPECT_FOUND(faults, "degenerate triangles: 1,");
}

TEST(SurfaceValidity, FindsAnOrphanAndAMissingPatch) {
  const auto faults = surface_faults(2, [](Piece& piece) {
    add_vertex(piece, {3, 0, 0});
    piece.triangle_patch[6] = 17;
  });
  EXPECT_FOUND(faults, "orphan vertices, which no cell of their piece uses: 1,");
  EXPECT_FOUND(faults, "boundary triangles without a patch: 1, the first being triangle 6 of piece 2");
}

TEST(SurfaceValidity, FindsASurfaceInsideOut) {
  const auto world = Communicator::world();
  auto mesh = examples::cube_surface(world, 2, 3);
  for (Piece& piece : mesh.pieces) {
    for (std::size_t t = 0; t < piece.cells.size(); t += 3) std::swap(piece.cells[t], piece.cells[t + 1]);
  }
  const auto report = check_surface_mesh(number_mesh(mesh));
  ASSERT_EQ(report.violations.size(), 1U);
  EXPECT_FOUND(report.violations[0], "no positive volume");
}

TEST(SurfaceValidity, AcceptsSheetsThatTouchAlongAnEdge) {
  const auto world = Communicator::world();
  // Two tetrahedra that share nothing but the edge from 0 to 1: four triangles meet there.
  examples::WholeMesh whole;
  whole.kind = CellKind::triangle;
  whole.points = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}};
  whole.dimensions.assign(6, CadDimension::face);
  whole.entities.assign(6, 0);
  whole.face_names = whole.patch_names = {"all"};
  for (const auto& tet : {std::array{0, 2, 3, 1}, std::array{0, 4, 5, 1}}) {
    for (const auto& face : tetrahedron_faces) {
      whole.cells.push_back({tet[face[0]], tet[face[1]], tet[face[2]]});
      whole.piece_of_cell.push_back(static_cast<int>(whole.cells.size() - 1) % 3);
    }
  }
  whole.faces.assign(8, 0);
  whole.patches.assign(8, 0);
  const auto mesh = examples::distribute(world, whole, 3);
  const auto report = check_surface_mesh(number_mesh(mesh));
  EXPECT_TRUE(report.valid()) << joined(report.violations);
}

}  // namespace
}  // namespace aeroloom::mesh
