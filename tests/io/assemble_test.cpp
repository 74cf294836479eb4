#include "io/raw_mesh.hpp"
#include "mesh/quality/face_links.hpp"
#include "parallel/communication/collective_error.hpp"
#include "tests/io/mixed_mesh.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace aeroloom::io {
namespace {

using mesh::GlobalIndex;
using mesh::LocalIndex;
using parallel::Communicator;

/// The share of a rank of all items in their order.
bool is_mine(const Communicator& world, std::size_t item, std::size_t count) {
  return static_cast<int>(item * static_cast<std::size_t>(world.size()) / count) == world.rank();
}

/// The mesh as a file might have it: sparse ids, some cells and faces the other way round or crosswise.
RawMesh raw_of(const Communicator& world, const examples::MixedMesh& whole,
               const std::string& path = "file") {
  RawMesh raw({world, path});
  raw.patches = whole.patches;
  raw.regions = whole.regions;
  for (std::size_t v = 0; v < whole.points.size(); ++v) {
    if (!is_mine(world, v, whole.points.size())) continue;
    raw.point_ids.push_back(static_cast<GlobalIndex>(7 * v + 1000));
    raw.coordinates.insert(raw.coordinates.end(), {whole.points[v].x, whole.points[v].y, whole.points[v].z});
  }
  for (std::size_t c = 0; c < whole.cells.size(); ++c) {
    if (!is_mine(world, c, whole.cells.size())) continue;
    const auto s = static_cast<std::size_t>(whole.cells[c].shape);
    std::vector<int> corners = whole.cells[c].corners;
    if (c % 5 == 0 && s == 0) std::swap(corners[2], corners[3]);
    if (whole.cells[c].shape == CellShape::hexahedron)
      std::swap(corners[1], corners[3]), std::swap(corners[5], corners[7]);
    for (const int v : corners) raw.cells[s].push_back(7 * v + 1000);
    raw.cell_regions[s].push_back(whole.cells[c].region);
  }
  for (std::size_t f = 0; f < whole.faces.size(); ++f) {
    if (!is_mine(world, f, whole.faces.size())) continue;
    std::vector<int> corners = whole.faces[f].corners;
    const std::size_t s = corners.size() - 3;
    if (f % 2 == 0) std::reverse(corners.begin(), corners.end());
    if (s == 1 && f % 3 == 0) std::swap(corners[1], corners[2]);  // crosswise
    for (const int v : corners) raw.faces[s].push_back(7 * v + 1000);
    raw.face_patches[s].push_back(whole.faces[f].patch);
  }
  return raw;
}

void expect_sound(const FileMesh& mesh) {
  const mesh::LinkDefects defects = mesh::link_faces(*mesh.pieces).defects;
  EXPECT_EQ(defects.open_faces + defects.stray_faces + defects.crowded_faces + defects.repeated_faces, 0);
}

TEST(Assemble, WholeMeshInTheOrderOfTheFile) {
  const Communicator world = Communicator::world();
  const examples::MixedMesh whole(4, 3);
  for (const int parts : {1, 4}) {
    const Assembled result = assemble(raw_of(world, whole), parts);
    EXPECT_EQ(result.mesh.part_count, parts);
    EXPECT_EQ(result.mesh.vertex_count, static_cast<GlobalIndex>(whole.points.size()));
    EXPECT_EQ(result.turned_cells, 20 + 4);
    EXPECT_EQ(result.dropped_points, 0);
    EXPECT_EQ(result.unnamed_faces, 0);
    EXPECT_EQ(result.left_out_faces, 0);
    EXPECT_EQ(result.mesh.patches, whole.patches);
    EXPECT_EQ(result.mesh.patch_faces, examples::distribute(world, whole, 3).patch_faces);
    EXPECT_EQ(result.mesh.region_cells, examples::distribute(world, whole, 3).region_cells);
    expect_sound(result.mesh);
    expect_sound(repartition(result.mesh, 3));
    for (const MeshPart& part : result.mesh.parts) {
      for (LocalIndex v = 0; v < part.vertex_count(); ++v) {
        const geometry::Vec3 p = whole.points[static_cast<std::size_t>(part.numbers[v])];
        EXPECT_TRUE(part.point(v).x == p.x && part.point(v).y == p.y && part.point(v).z == p.z);
      }
    }
  }
}

TEST(Assemble, OneMeshWhateverTheRanks) {
  const Communicator world = Communicator::world(), self = Communicator::self();
  const examples::MixedMesh whole(4, 3);
  const Assembled mine = assemble(raw_of(world, whole), 5);
  const Assembled all = assemble(raw_of(self, whole), 5);
  const FileMesh cut = repartition(mine.mesh, 4), cut_alone = repartition(all.mesh, 4);
  for (const auto& [some, every] : {std::pair(&mine.mesh, &all.mesh), std::pair(&cut, &cut_alone)}) {
    for (const MeshPart& part : some->parts) {
      const MeshPart& other = every->parts[static_cast<std::size_t>(part.id)];
      EXPECT_TRUE(std::equal(part.coordinates.begin(), part.coordinates.end(), other.coordinates.begin(),
                             other.coordinates.end()));
      EXPECT_TRUE(
          std::equal(part.numbers.begin(), part.numbers.end(), other.numbers.begin(), other.numbers.end()));
      for (std::size_t s = 0; s < cell_shape_count; ++s) {
        const auto &a = part.cells[s].connectivity, &b = other.cells[s].connectivity;
        EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end()));
      }
      for (std::size_t s = 0; s < face_shape_count; ++s) {
        const auto &a = part.faces[s].connectivity, &b = other.faces[s].connectivity;
        EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end()));
      }
    }
  }
}

TEST(Assemble, WhatTheFileLeavesOpenGetsAName) {
  const Communicator world = Communicator::world();
  const examples::MixedMesh whole(3, 3);
  RawMesh raw = raw_of(world, whole);
  raw.faces = {}, raw.face_patches = {}, raw.patches = {};
  const Assembled result = assemble(std::move(raw), 2);
  ASSERT_EQ(result.mesh.patches.size(), 3U);
  EXPECT_EQ(result.mesh.patches[0].name, "boundary_of_lower layer");
  EXPECT_EQ(result.mesh.patches[1].name, "lower layer_to_upper");
  EXPECT_EQ(result.mesh.patches[1].type, mesh::PatchType::interior);
  EXPECT_EQ(result.unnamed_faces, static_cast<GlobalIndex>(whole.faces.size()));
  expect_sound(result.mesh);
}

/// A cell whose neighbours all stand in the share of rank 0, as it does, and in its region.
std::size_t cell_inside(const Communicator& world, const examples::MixedMesh& whole) {
  std::map<std::set<int>, std::vector<std::size_t>> cells_at;
  for (std::size_t c = 0; c < whole.cells.size(); ++c) {
    for (const CellFace& face : faces_of(whole.cells[c].shape)) {
      std::set<int> corners;
      for (const std::int8_t k : face) {
        if (k >= 0) corners.insert(whole.cells[c].corners[static_cast<std::size_t>(k)]);
      }
      cells_at[corners].push_back(c);
    }
  }
  std::vector<int> inner_faces(whole.cells.size(), 0);
  const std::size_t last = (whole.cells.size() - 1) / static_cast<std::size_t>(world.size());
  for (const auto& [corners, cells] : cells_at) {
    const bool near = cells.size() == 2 && std::max(cells[0], cells[1]) <= last &&
                      whole.cells[cells[0]].region == whole.cells[cells[1]].region;
    for (const std::size_t c : cells) inner_faces[c] += near ? 1 : 0;
  }
  for (std::size_t c = 0; c <= last; ++c) {
    const CellShape shape = whole.cells[c].shape;
    if (inner_faces[c] == static_cast<int>(faces_of(shape).size())) return c;
  }
  return 0;
}

TEST(Assemble, ACellThatAnotherRankRepeatsIsRefused) {
  const Communicator world = Communicator::world();
  const examples::MixedMesh whole(8, 3);
  RawMesh raw = raw_of(world, whole);
  if (world.rank() == world.size() - 1) {
    const examples::WholeCell& cell = whole.cells[cell_inside(world, whole)];
    const auto s = static_cast<std::size_t>(cell.shape);
    for (const int v : cell.corners) raw.cells[s].push_back(7 * v + 1000);
    raw.cell_regions[s].push_back(cell.region);
  }
  EXPECT_THROW(assemble(std::move(raw), 1), parallel::CollectiveError);
}

TEST(Assemble, BadFilesAreRefusedWithThePlace) {
  const Communicator world = Communicator::world();
  const examples::MixedMesh whole(3, 3);
  const auto expect_refused = [&](const std::string& reason, const std::function<void(RawMesh&)>& spoil) {
    RawMesh raw = raw_of(world, whole, "bad.mesh");
    if (world.is_root()) spoil(raw);
    try {
      assemble(std::move(raw), 2);
      ADD_FAILURE() << "accepted: " << reason;
    } catch (const parallel::CollectiveError& error) {
      EXPECT_EQ(error.kind(), parallel::FailureKind::input) << error.what();
      EXPECT_NE(std::string(error.what()).find("'bad.mesh'"), std::string::npos);
      EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
    }
  };
  expect_refused("refers to point 5, which there is not", [](RawMesh& raw) { raw.cells[2][0] = 5; });
  expect_refused("refers to point -2", [](RawMesh& raw) { raw.cells[2][0] = -2; });
  expect_refused("twice", [](RawMesh& raw) { raw.cells[2][1] = raw.cells[2][0]; });
  expect_refused("no number", [](RawMesh& raw) { raw.coordinates[4] = std::nan(""); });
  expect_refused("different coordinates", [](RawMesh& raw) {
    raw.point_ids.push_back(raw.point_ids[0]);
    raw.coordinates.insert(raw.coordinates.end(), {1, 2, 3});
  });
  expect_refused("more than two cells meet", [](RawMesh& raw) {
    for (int copy = 0; copy < 2; ++copy) {
      raw.cells[2].insert(raw.cells[2].end(), raw.cells[2].begin(), raw.cells[2].begin() + 6);
      raw.cell_regions[2].push_back(0);
    }
  });
  RawMesh empty({world, "empty.mesh"});
  empty.regions = {"fluid"};
  EXPECT_THROW(assemble(std::move(empty), 1), parallel::CollectiveError);
}

}  // namespace
}  // namespace aeroloom::io
