#include "io/import/imported_mesh.hpp"

#include "mesh/checks/validity.hpp"
#include "mesh/data/piece_faces.hpp"
#include "parallel/communication/collective_error.hpp"
#include "tests/io/mixed_mesh.hpp"
#include "tests/io/scratch_folder.hpp"
#include "tests/meshes/small_meshes.hpp"
#include "tests/several_ranks.hpp"

#include <algorithm>
#include <cstring>
#include <map>
#include <sstream>

#include <gtest/gtest.h>

namespace aeroloom::imported {
namespace {

using mesh::CadDimension;
using mesh::DistributedMesh;
using mesh::GlobalIndex;
using mesh::LocalIndex;
using mesh::Piece;
using parallel::Communicator;

constexpr int squares = 4;
constexpr GlobalIndex tets = 6 * squares * squares * squares;

/// The unit cube as a file of some pieces has it.
io::FileMesh cube_of_file(const Communicator& communicator) {
  return io::file_mesh_of(mesh::number_mesh(mesh::examples::cube(communicator, squares, 5)));
}

/// The unit cube as Medit text: two regions, below and above half its height, and no triangles.
std::string two_regions_as_text() {
  const mesh::examples::WholeMesh whole = mesh::examples::whole_cube(squares, 1);
  std::ostringstream text;
  text.precision(17);
  text << "MeshVersionFormatted 2\nDimension 3\nVertices " << whole.points.size() << '\n';
  for (const geometry::Vec3 p : whole.points) text << p.x << ' ' << p.y << ' ' << p.z << " 0\n";
  text << "Tetrahedra " << whole.cells.size() << '\n';
  for (const std::vector<int>& cell : whole.cells) {
    double height = 0;
    for (const int v : cell) {
      text << v + 1 << ' ';
      height += whole.points[v].z / 4;
    }
    text << (height < 0.5 ? 7 : 8) << '\n';
  }
  text << "End\n";
  return text.str();
}

/// Vertices on the boundary lie on the largest CAD face that any piece has around them, others in a region.
void expect_classified(const DistributedMesh& mesh) {
  const Communicator& world = mesh.communicator;
  const mesh::NumberedMesh numbered = mesh::number_mesh(mesh);
  // By global number: the largest face around it, from all pieces.
  std::map<GlobalIndex, std::int32_t> largest;
  parallel::Bytes mine;
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    const Piece& piece = mesh.pieces[p];
    for (LocalIndex f = 0; f < mesh::boundary_face_count(piece); ++f) {
      for (const LocalIndex v : mesh::corners_of_boundary(piece, f)) {
        const GlobalIndex entry[2] = {numbered.numbering.vertices[p][v], mesh::cad_face_of(piece, f)};
        const auto* bytes = reinterpret_cast<const std::byte*>(entry);
        mine.insert(mine.end(), bytes, bytes + sizeof entry);
      }
    }
  }
  for (const parallel::Bytes& of_rank : world.all_gather(std::move(mine))) {
    for (std::size_t at = 0; at < of_rank.size(); at += 2 * sizeof(GlobalIndex)) {
      GlobalIndex entry[2];
      std::memcpy(entry, of_rank.data() + at, sizeof entry);
      const auto face = static_cast<std::int32_t>(entry[1]);
      const auto [found, is_new] = largest.emplace(entry[0], face);
      if (!is_new) found->second = std::max(found->second, face);
    }
  }
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    const Piece& piece = mesh.pieces[p];
    for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      const auto found = largest.find(numbered.numbering.vertices[p][v]);
      const bool is_inside = found == largest.end();
      EXPECT_EQ(piece.vertex_dimension[v], is_inside ? CadDimension::region : CadDimension::face);
      EXPECT_EQ(piece.vertex_entity[v], is_inside ? piece.region : found->second);
    }
  }
}

TEST(Imported, IsTheSameMeshInPiecesOfTheSizeAskedFor) {
  const Communicator world = Communicator::world();
  const DistributedMesh mesh = pieces_of(cube_of_file(world), "cube.mesh", 50);
  EXPECT_EQ(mesh.piece_count, (tets + 25) / 50);
  for (const Piece& piece : mesh.pieces) {
    EXPECT_GT(piece.cell_count(), 40);
    EXPECT_LT(piece.cell_count(), 60);
  }
  const mesh::NumberedMesh numbered = mesh::number_mesh(mesh);
  const mesh::MeshCounts counts = mesh::count_mesh(numbered);
  EXPECT_EQ(counts.cells, tets);
  EXPECT_EQ(counts.vertices, (squares + 1) * (squares + 1) * (squares + 1));
  EXPECT_EQ(counts.boundary_triangles, 12 * squares * squares);
  EXPECT_EQ(mesh.patches, (std::vector<std::string>{"x sides", "y sides", "z sides"}));
  const mesh::ValidityReport report = mesh::check_volume_mesh(numbered, nullptr);
  EXPECT_TRUE(report.valid());
  EXPECT_NEAR(report.volume, 1, 1e-12);
  expect_classified(mesh);
}

TEST(Imported, IsOnePieceWhereItIsSmall) {
  const Communicator world = Communicator::world();
  EXPECT_EQ(pieces_of(cube_of_file(world), "cube.mesh", std::nullopt).piece_count, 1);
  EXPECT_EQ(pieces_of(cube_of_file(world), "cube.mesh", tets * 2 / 3).piece_count, 1);
  EXPECT_EQ(pieces_of(cube_of_file(world), "cube.mesh", tets * 2 / 3 - 1).piece_count, 2);
}

TEST(Imported, IsTheSameForAnyNumberOfRanks) {
  NEEDS_SEVERAL_RANKS();
  const auto hash_of = [](const Communicator& communicator) {
    const DistributedMesh mesh = pieces_of(cube_of_file(communicator), "cube.mesh", 40);
    return mesh::hash_mesh(mesh::number_mesh(mesh));
  };
  EXPECT_EQ(hash_of(Communicator::world()), hash_of(Communicator::self()));
}

TEST(Imported, MeshesOfOtherCellsAreRefused) {
  const Communicator world = Communicator::world();
  try {
    pieces_of(io::examples::mixed_mesh(world, 3, 2), "mixed.cgns", 50);
    ADD_FAILURE() << "taken";
  } catch (const parallel::CollectiveError& error) {
    EXPECT_EQ(error.kind(), parallel::FailureKind::input);
    EXPECT_NE(std::string(error.what()).find("'mixed.cgns' has 36 pyramids, prisms and hexahedra beside 60"),
              std::string::npos)
        << error.what();
  }
}

using ImportedFile = io::examples::ScratchFolder;

TEST_F(ImportedFile, RegionsHavePiecesOfTheirOwnAndAFaceBetweenThem) {
  io::examples::put_bytes(world, path("cube.mesh"), two_regions_as_text());
  const DistributedMesh mesh = import_mesh({world, path("cube.mesh")}, 100);
  EXPECT_EQ(mesh.regions, (std::vector<std::string>{"region_7", "region_8"}));
  EXPECT_EQ(mesh.piece_count, 4);
  for (const Piece& piece : mesh.pieces) EXPECT_TRUE(piece.runs.empty()) << "one region each";
  ASSERT_EQ(mesh.sides.size(), 3u);
  EXPECT_EQ(std::count_if(mesh.sides.begin(), mesh.sides.end(), [](const auto& s) { return s.is_inner(); }),
            1);
  const mesh::ValidityReport report = mesh::check_volume_mesh(mesh::number_mesh(mesh), nullptr);
  EXPECT_TRUE(report.valid());
  ASSERT_EQ(report.region_volumes.size(), 2u);
  EXPECT_NEAR(report.region_volumes[0] + report.region_volumes[1], 1, 1e-12);
  expect_classified(mesh);
}

TEST_F(ImportedFile, WhatCannotBeReadIsNamedOnAllRanks) {
  io::examples::put_bytes(world, path("cube.mesh"), two_regions_as_text().substr(0, 2000));
  for (const char* name : {"cube.mesh", "missing.mesh"}) {
    try {
      import_mesh({world, path(name)}, std::nullopt);
      ADD_FAILURE() << name << " is taken";
    } catch (const parallel::CollectiveError& error) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace aeroloom::imported
