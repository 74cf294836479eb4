// Faces with cells of one region on both sides, in files and back.
#include "io/file_formats.hpp"
#include "io/raw_mesh.hpp"
#include "io/read_mesh.hpp"
#include "io/write_mesh.hpp"
#include "mesh/quality/face_links.hpp"
#include "parallel/observation/warnings.hpp"
#include "tests/io/mixed_mesh.hpp"
#include "tests/io/scratch_folder.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace aeroloom::io {
namespace {

using geometry::Vec3;
using mesh::GlobalIndex;
using mesh::LocalIndex;
using parallel::Communicator;

using BafflesInFiles = examples::ScratchFolder;

/// The hand-made mesh as one region: the faces between its slabs are a baffle.
examples::MixedMesh mesh_with_baffle() {
  examples::MixedMesh whole(4, 3);
  for (examples::WholeCell& cell : whole.cells) cell.region = 0;
  whole.regions = {"air"};
  whole.patches[examples::MixedMesh::interface].name = "vane";
  return whole;
}

/// Of all ranks: the faces of baffles, and the sum of their area vectors. Each must have the cell that sees
/// it from outside in its piece, and a face of the model with its region on both sides.
struct BaffleSum {
  GlobalIndex faces = 0;
  Vec3 area;
};
BaffleSum sum_baffles(const FileMesh& mesh) {
  BaffleSum sum;
  for (const mesh::Piece& piece : mesh.pieces->pieces) {
    const mesh::PieceFaces faces(piece);
    mesh::match_faces(static_cast<std::size_t>(piece.vertex_count()), faces,
                      [&](const mesh::FaceKey<LocalIndex>&, std::span<const mesh::FaceUser> users) {
                        for (const mesh::FaceUser& user : users) {
                          if (user.is_cell()) continue;
                          const mesh::FaceSides sides =
                              mesh.pieces->sides_of(mesh::cad_face_of(piece, user.item));
                          if (!sides.is_inner()) continue;
                          EXPECT_EQ(sides.front, sides.back);
                          const auto corners = faces.face(user.item);
                          EXPECT_TRUE(std::any_of(users.begin(), users.end(), [&](const mesh::FaceUser& u) {
                            return u.is_cell() && mesh::same_direction(corners, faces.side(u.item, u.side));
                          }));
                          const Vec3 a = piece.point(corners[0]);
                          ++sum.faces;
                          sum.area += 0.5 * cross(piece.point(corners[1]) - a, piece.point(corners[2]) - a);
                        }
                      });
  }
  const Communicator& world = mesh.communicator();
  return {world.sum(sum.faces), {world.sum(sum.area.x), world.sum(sum.area.y), world.sum(sum.area.z)}};
}

TEST_F(BafflesInFiles, AreReadAsTheyWereWritten) {
  const FileMesh mesh = examples::distribute(world, mesh_with_baffle(), 3);
  const BaffleSum written = sum_baffles(mesh);
  EXPECT_EQ(written.faces, 32);
  for (const FormatRow& format : file_formats()) {
    const std::string name(format.name);
    if (world.is_root()) std::filesystem::create_directories(path(name));
    const std::string file = path(name + "/mesh" + std::string(format.ends.front()));
    parallel::take_warnings(world);
    write_mesh(mesh, format.format, file, {.surface = true});
    const parallel::Warnings warnings = parallel::take_warnings(world);
    const std::string warning = warnings.kept.empty() ? std::string() : std::string(warnings.kept[0].message);
    if (world.is_root()) {
      EXPECT_EQ(warning.find("'vane'") == std::string::npos, format.content.interfaces) << warning;
      EXPECT_EQ(warning.find("regions"), std::string::npos) << warning;
    }
    if (format.read == nullptr) continue;
    const Assembled read = read_mesh({world, file}, 2);
    EXPECT_EQ(read.left_out_faces, 0) << name;
    const BaffleSum found = sum_baffles(read.mesh);
    EXPECT_EQ(found.faces, format.content.interfaces ? written.faces : 0) << name;
    if (format.content.interfaces) {
      EXPECT_LT(norm(found.area - written.area), 1e-12) << name;
    }
    EXPECT_EQ(read.mesh.pieces->regions.size(), 1U) << name;
    const mesh::LinkDefects defects = mesh::link_faces(*read.mesh.pieces).defects;
    EXPECT_EQ(defects.open_faces + defects.stray_faces + defects.crowded_faces + defects.repeated_faces, 0);
    EXPECT_EQ(sum_baffles(repartition(read.mesh, 5)).faces, found.faces) << name;
  }
}

TEST_F(BafflesInFiles, OpenFoamHasAFaceZone) {
  for (const int parts : {1, 3}) {
    const FileMesh mesh = examples::distribute(world, mesh_with_baffle(), 3);
    const std::string name = "foam" + std::to_string(parts);
    write_mesh(mesh, FileFormat::openfoam, path(name + "/case.foam"), {.parts = parts, .recut = true});
    world.barrier();
    int zones = 0;
    for (const auto& [file, bytes] : examples::files_below(folder / name)) {
      if (!file.ends_with("faceZones")) continue;
      ++zones;
      EXPECT_NE(bytes.find("vane"), std::string::npos) << file;
    }
    EXPECT_EQ(zones, parts == 1 ? 1 : 3);
  }
}

/// The mesh as a file might have it, each rank with some of it; some faces the other way round or twice.
RawMesh raw_of_baffles(const Communicator& world, const examples::MixedMesh& whole) {
  RawMesh raw({world, "file"});
  raw.patches = whole.patches;
  raw.regions = whole.regions;
  const auto is_mine = [&](std::size_t item, std::size_t count) {
    return static_cast<int>(item * static_cast<std::size_t>(world.size()) / count) == world.rank();
  };
  for (std::size_t v = 0; v < whole.points.size(); ++v) {
    if (!is_mine(v, whole.points.size())) continue;
    raw.point_ids.push_back(static_cast<GlobalIndex>(v));
    raw.coordinates.insert(raw.coordinates.end(), {whole.points[v].x, whole.points[v].y, whole.points[v].z});
  }
  for (std::size_t c = 0; c < whole.cells.size(); ++c) {
    if (!is_mine(c, whole.cells.size())) continue;
    const auto s = static_cast<std::size_t>(whole.cells[c].shape);
    raw.cells[s].insert(raw.cells[s].end(), whole.cells[c].corners.begin(), whole.cells[c].corners.end());
    raw.cell_regions[s].push_back(whole.cells[c].region);
  }
  for (std::size_t f = 0; f < whole.faces.size(); ++f) {
    if (!is_mine(f, whole.faces.size())) continue;
    std::vector<int> corners = whole.faces[f].corners;
    const std::size_t s = corners.size() - 3;
    const bool twice = whole.faces[f].patch == examples::MixedMesh::interface && f % 2 == 0;
    for (int copy = 0; copy < (twice ? 2 : 1); ++copy) {
      raw.faces[s].insert(raw.faces[s].end(), corners.begin(), corners.end());
      raw.face_patches[s].push_back(whole.faces[f].patch);
      std::reverse(corners.begin(), corners.end());
    }
  }
  return raw;
}

TEST_F(BafflesInFiles, AreFoundWhicheverRankReadsThem) {
  const examples::MixedMesh whole = mesh_with_baffle();
  const BaffleSum wanted = sum_baffles(examples::distribute(world, whole, 3));
  const Assembled mine = assemble(raw_of_baffles(world, whole), 4);
  const Assembled alone = assemble(raw_of_baffles(Communicator::self(), whole), 4);
  const BaffleSum found = sum_baffles(mine.mesh);
  EXPECT_EQ(found.faces, wanted.faces);
  EXPECT_LT(norm(found.area - wanted.area), 1e-12);
  EXPECT_EQ(mine.unnamed_faces, 0);
  EXPECT_GT(mine.left_out_faces, 0);
  EXPECT_EQ(mine.left_out_faces, alone.left_out_faces);
  for (const MeshPart& part : mine.mesh.parts) {
    const MeshPart& other = alone.mesh.parts[static_cast<std::size_t>(part.id)];
    for (std::size_t s = 0; s < face_shape_count; ++s) {
      const auto &a = part.faces[s].connectivity, &b = other.faces[s].connectivity;
      EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end()));
    }
  }
}

}  // namespace
}  // namespace aeroloom::io
