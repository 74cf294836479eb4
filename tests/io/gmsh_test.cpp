#include "io/gmsh/gmsh_reader.hpp"
#include "io/gmsh/gmsh_writer.hpp"
#include "io/gmsh/msh_head.hpp"
#include "io/gmsh/msh_layout.hpp"
#include "io/gmsh/msh_tables.hpp"
#include "parallel/communication/collective_error.hpp"
#include "tests/io/damage.hpp"
#include "tests/io/mesh_volumes.hpp"
#include "tests/io/mixed_mesh.hpp"
#include "tests/io/scratch_folder.hpp"
#include "tests/several_ranks.hpp"

#include <array>
#include <string>

#include <gtest/gtest.h>

namespace aeroloom::io {
namespace {

namespace fs = std::filesystem;
using parallel::CollectiveError;
using parallel::Communicator;

class Msh : public examples::ScratchFolder {};

void expect_same(const FileMesh& found, const FileMesh& expected) {
  EXPECT_EQ(found.vertex_count, expected.vertex_count);
  EXPECT_EQ(found.patches, expected.patches);
  EXPECT_EQ(found.regions, expected.regions);
  EXPECT_EQ(found.region_cells, expected.region_cells);
  EXPECT_EQ(found.patch_faces, expected.patch_faces);
  const auto volumes = examples::volumes_of(found), wanted = examples::volumes_of(expected);
  for (std::size_t s = 0; s < cell_shape_count; ++s) EXPECT_NEAR(volumes[s], wanted[s], 1e-9);
}

TEST_F(Msh, ComesBackAsItWas) {
  const FileMesh mesh = examples::mixed_mesh(world, 4, 3);
  write_msh(mesh, path("mesh.msh"));
  const Assembled back = assemble(read_msh({world, path("mesh.msh")}), 3);
  expect_same(back.mesh, mesh);
  EXPECT_EQ(back.turned_cells + back.dropped_points + back.unnamed_faces, 0);
}

TEST_F(Msh, PartsComeBackAsOneMesh) {
  const FileMesh mesh = examples::mixed_mesh(world, 4, 4);
  write_msh_parts(mesh, path("mesh.msh"));
  for (const char* name : {"mesh_1.msh", "mesh_*.msh"}) {
    const Assembled back = assemble(read_msh({world, path(name)}), 4);
    expect_same(back.mesh, mesh);
    EXPECT_EQ(back.turned_cells + back.dropped_points + back.unnamed_faces, 0);
  }
  // Fewer parts leave none of the former behind, and a lost part is missed, the second too.
  write_msh_parts(examples::mixed_mesh(world, 4, 3), path("mesh.msh"));
  EXPECT_FALSE(fs::exists(path("mesh_4.msh")));
  for (const char* lost : {"mesh_3.msh", "mesh_2.msh"}) {
    world.barrier();
    if (world.is_root()) fs::remove(path(lost));
    world.barrier();
    try {
      read_msh({world, path("mesh_1.msh")});
      ADD_FAILURE() << "a part is missing";
    } catch (const CollectiveError& error) {
      EXPECT_EQ(error.kind(), parallel::FailureKind::files);
      EXPECT_NE(std::string(error.what()).find(lost), std::string::npos);
    }
  }
}

TEST_F(Msh, BytesDoNotDependOnRanks) {
  NEEDS_SEVERAL_RANKS();
  const FileMesh mesh = examples::mixed_mesh(world, 3, 5);
  write_msh(mesh, path("all/mesh.msh"));
  write_msh_parts(mesh, path("all/mesh.msh"));
  if (world.is_root()) {
    const Communicator self = Communicator::self();
    const FileMesh alone = examples::mixed_mesh(self, 3, 5);
    write_msh(alone, path("one/mesh.msh"));
    write_msh_parts(alone, path("one/mesh.msh"));
    EXPECT_EQ(examples::files_below(folder / "all"), examples::files_below(folder / "one"));
    EXPECT_EQ(examples::files_below(folder / "one").size(), 6U);
  }
}

/// With names that are long, alike, and hard to write down.
FileMesh awkward_mesh(const Communicator& world) {
  FileMesh mesh = examples::mixed_mesh(world, 2, 2);
  const std::string shared(200, 'x');
  mesh.patches[0].name = shared + "1";
  mesh.patches[1].name = shared + "2";
  mesh.patches[2].name = "Flügel \"links\"\\\nunten";
  mesh.regions[1] = "";
  return mesh;
}

TEST_F(Msh, AwkwardNamesComeBack) {
  const FileMesh mesh = awkward_mesh(world);
  write_msh(mesh, path("mesh.msh"));
  const RawMesh raw = read_msh({world, path("mesh.msh")});
  EXPECT_EQ(raw.patches, mesh.patches);
  const std::string bytes = examples::bytes_of(path("mesh.msh"));
  EXPECT_NE(bytes.find('"' + std::string(127, 'x') + "\"\n"), std::string::npos);
  EXPECT_NE(bytes.find('"' + std::string(125, 'x') + "_2\"\n"), std::string::npos);
}

TEST(MshLayoutLocal, IsExactFarBeyond32Bits) {
  constexpr std::int64_t many = 3'000'000'000;
  const MshBlocks blocks = lay_out_elements({{5, many}, {0, 7}}, {{many, 0, 11, 6}});
  EXPECT_EQ(blocks.written, 6);
  EXPECT_EQ(blocks.elements, 2 * many + 5 + 7 + 11 + 6);
  EXPECT_EQ(blocks.cells[0][0].first_tag, 5 + many + 7 + 1);
  const std::int64_t faces = 20 + 5 * 32 + 20 + many * 40 + 20 + 7 * 40;
  EXPECT_EQ(blocks.cells[0][0].offset, faces);
  EXPECT_EQ(blocks.cells[0][0].record(many), faces + 20 + many * 40);
  EXPECT_EQ(blocks.bytes, faces + 20 + many * 40 + 20 + 11 * 56 + 20 + 6 * 72);
  const MshLayout layout = lay_out_file(100, many, blocks);
  EXPECT_EQ(layout.points - layout.tags, 8 * many);
  EXPECT_EQ(layout.end - layout.blocks, blocks.bytes);
  EXPECT_EQ(partitioned_tag(10, 3, 2), 33);
}

/// A file of more than 4 GiB, nearly all of it a hole.
TEST_F(Msh, ElementsBeyond32BitsAreFound) {
  if (!world.is_root()) return;
  constexpr std::int64_t vertices = 200'000'000;
  const auto bytes = [](std::initializer_list<std::int64_t> values) {
    return std::string(reinterpret_cast<const char*>(values.begin()), 8 * values.size());
  };
  const auto words = [](std::initializer_list<std::int32_t> values) {
    return std::string(reinterpret_cast<const char*>(values.begin()), 4 * values.size());
  };
  const std::string head = "$MeshFormat\n4.1 1 8\n" + words({1}) + "\n$EndMeshFormat\n";
  const MshBlocks blocks = lay_out_elements({}, {{1, 0, 0}});
  const MshLayout layout = lay_out_file(static_cast<std::int64_t>(head.size()), vertices, blocks);
  std::ofstream stream(path("hole.msh"), std::ios::binary);
  stream << head << msh_nodes_begin << bytes({1, vertices, 1, vertices}) << words({3, 1, 0})
         << bytes({vertices});
  stream.seekp(layout.elements);
  stream << msh_nodes_end << bytes({1, 1, 1, 1}) << words({3, 1, 4}) << bytes({1, 77, 1, 2, 3, vertices})
         << msh_elements_end;
  stream.close();
  ASSERT_TRUE(stream);
  MshScanner scanner(path("hole.msh"));
  const MshTables tables = read_msh_tables(scanner, 0, MshExtent::all);
  ASSERT_EQ(tables.elements.size(), 1U);
  EXPECT_EQ(tables.nodes.at(0).points, layout.points);
  EXPECT_EQ(tables.elements[0].place, layout.blocks + blocks.cells[0][0].record(0));
  EXPECT_GT(tables.elements[0].place, std::int64_t{1} << 32);
  scanner.seek(tables.elements[0].place);
  std::array<std::int64_t, 5> record{};
  scanner.int64s(record.data(), 5);
  EXPECT_EQ(record, (std::array<std::int64_t, 5>{77, 1, 2, 3, vertices}));
}

void write_text(const Communicator& world, const std::string& path, const std::string& text) {
  if (world.is_root()) std::ofstream(path, std::ios::binary) << text;
  world.barrier();
}

/// One tetrahedron with a face, as others write it: sparse tags, parameters, a group of negative sign.
constexpr char small[] = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
2
2 9 "Symmetry"
3 4 "gas"
$EndPhysicalNames
$Entities
0 0 1 1
1 0 0 0 1 1 1 2 -9 8 0
1 0 0 0 1 1 1 1 4 1 1
$EndEntities
$Nodes
2 4 10 40
2 1 1 3
10
30
20
0 0 0 0.1 0.2
1 0 0 0.1 0.2
0 1 0 0.1 0.2
3 1 0 1
40
0 0 1
$EndNodes
$Elements
3 3 1 9
0 1 15 1
1 10
2 1 2 1
5 10 30 20
3 1 4 1
9 10 30 20 40
$EndElements
$NodeData
1
"a field"
$EndNodeData
)";

TEST_F(Msh, TextOfOtherOriginIsRead) {
  write_text(world, path("small.msh"), small);
  RawMesh raw = read_msh({world, path("small.msh")});
  EXPECT_EQ(raw.patches, (std::vector<mesh::Patch>{{"Symmetry", mesh::PatchType::symmetry}}));
  EXPECT_EQ(raw.regions, std::vector<std::string>{"gas"});
  if (world.is_root()) {
    EXPECT_EQ(raw.point_ids, (std::vector<mesh::GlobalIndex>{10, 30, 20, 40}));
    EXPECT_EQ(raw.coordinates, (std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}));
  }
  const Assembled whole = assemble(std::move(raw), 1);
  EXPECT_EQ(whole.mesh.cell_count(), 1);
  EXPECT_EQ(whole.unnamed_faces, 3);
}

TEST_F(Msh, WhatIsNotReadIsSaid) {
  const auto with = [](std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
  };
  const std::string text = small;
  const std::array<std::pair<std::string, const char*>, 6> cases = {{
      {with(text, "4.1 0 8", "2.2 0 8"), "-format msh41"},
      {with(text, "4.1 0 8", "4.1 1 4"), "bytes"},
      {with(text, "3 1 4 1\n", "3 1 11 1\n"), "-order 1"},
      {with(text, "2 4 10 40\n2 1 1 3", "2 4 10 40\n2 1 1 4611686018427387904"), "more than the rest"},
      {with(text, "$Elements", "$Element"), "$EndElement"},
      {with(text, "9 10 30 20 40", "9 10 30 20 -4"), "tag"},
  }};
  for (const auto& [content, expected] : cases) {
    write_text(world, path("bad.msh"), content);
    try {
      read_msh({world, path("bad.msh")});
      ADD_FAILURE() << expected;
    } catch (const CollectiveError& error) {
      EXPECT_EQ(error.kind(), parallel::FailureKind::input);
      EXPECT_NE(std::string(error.what()).find(expected), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("bad.msh, byte "), std::string::npos) << error.what();
    }
    world.barrier();
  }
  try {
    read_msh({world, path("absent.msh")});
    ADD_FAILURE();
  } catch (const CollectiveError& error) {
    EXPECT_EQ(error.kind(), parallel::FailureKind::files);
  }
}

TEST_F(Msh, DamageIsSurvived) {
  write_msh(examples::mixed_mesh(world, 2, 2), path("good.msh"));
  const auto read = [&](const std::string& damaged) { assemble(read_msh({world, damaged}), 2); };
  const std::string binary = examples::bytes_of(path("good.msh"));
  EXPECT_GT(damage::survive(world, binary, path("bad.msh"), read).refused, 20);
  damage::Options options;
  options.seed = 2;
  EXPECT_GT(damage::survive(world, small, path("bad.msh"), read, options).refused, 20);
}

TEST_F(Msh, UnwritablePlacesAreNamed) {
  write_text(world, path("file"), "no folder");
  const FileMesh mesh = examples::mixed_mesh(world, 2, 2);
  for (const auto write : {write_msh, write_msh_parts}) {
    try {
      write(mesh, path("file/mesh.msh"));
      ADD_FAILURE();
    } catch (const CollectiveError& error) {
      EXPECT_EQ(error.kind(), parallel::FailureKind::files);
      EXPECT_NE(std::string(error.what()).find("file"), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace aeroloom::io
