#include "io/medit/medit_layout.hpp"
#include "io/medit/medit_names.hpp"
#include "io/medit/medit_reader.hpp"
#include "io/medit/medit_writer.hpp"
#include "mesh/quality/face_links.hpp"
#include "parallel/communication/collective_error.hpp"
#include "tests/io/damage.hpp"
#include "tests/io/mixed_mesh.hpp"
#include "tests/io/scratch_folder.hpp"

#include <algorithm>
#include <bit>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

namespace aeroloom::io {
namespace {

using mesh::GlobalIndex;
using parallel::Communicator;

void expect_sound(const FileMesh& mesh) {
  const mesh::LinkDefects defects = mesh::link_faces(*mesh.pieces).defects;
  EXPECT_EQ(defects.open_faces + defects.stray_faces + defects.crowded_faces + defects.repeated_faces, 0);
}

void expect_same(const FileMesh& mesh, const Assembled& read) {
  EXPECT_EQ(read.mesh.vertex_count, mesh.vertex_count);
  EXPECT_EQ(read.mesh.patches, mesh.patches);
  EXPECT_EQ(read.mesh.regions, mesh.regions);
  EXPECT_EQ(read.mesh.region_cells, mesh.region_cells);
  EXPECT_EQ(read.mesh.patch_faces, mesh.patch_faces);
  EXPECT_EQ(read.turned_cells + read.dropped_points + read.unnamed_faces, 0);
  expect_sound(read.mesh);
}

class Medit : public examples::ScratchFolder {
protected:
  /// What reading says; empty where it succeeds.
  std::string refusal(const std::string& name, const std::string& bytes) {
    const std::string file = path(name);
    examples::put_bytes(world, file, bytes);
    std::string text;
    try {
      assemble(read_medit({world, file}), 1);
    } catch (const parallel::CollectiveError& error) {
      text = error.what();
      EXPECT_EQ(error.kind(), parallel::FailureKind::input);
      EXPECT_NE(text.find(name), std::string::npos);
    }
    world.barrier();
    return text;
  }
};

TEST_F(Medit, WrittenAndReadAgain) {
  const FileMesh mesh = examples::mixed_mesh(world);
  for (const char* name : {"round.meshb", "round.mesh", "wide.meshb"}) {
    const std::string file = path(name);
    write_medit(mesh, file, {std::string(name) == "wide.meshb"});
    const Assembled read = assemble(read_medit({world, file}), 2);
    expect_same(mesh, read);
    // Coordinates come back with every bit.
    const examples::MixedMesh whole(4, 3);
    for (const MeshPart& part : read.mesh.parts) {
      for (mesh::LocalIndex v = 0; v < part.vertex_count(); ++v) {
        const geometry::Vec3 p = part.point(v);
        EXPECT_NE(std::find(whole.points.begin(), whole.points.end(), p), whole.points.end());
      }
    }
  }
}

TEST_F(Medit, BytesDependOnThePartsAlone) {
  const Communicator self = Communicator::self();
  for (const std::string name : {"bytes.meshb", "bytes.mesh"}) {
    const std::string together = path(name);
    write_medit(examples::mixed_mesh(world), together);
    const std::string alone = path("alone" + std::to_string(world.rank()) + name);
    write_medit(examples::mixed_mesh(self), alone);
    EXPECT_EQ(examples::bytes_of(together), examples::bytes_of(alone));
    EXPECT_EQ(examples::bytes_of(medit_names_path(together)), examples::bytes_of(medit_names_path(alone)));
    EXPECT_FALSE(std::filesystem::exists(together + ".unfinished"));
  }
}

TEST_F(Medit, LayoutBeyondThirtyTwoBits) {
  MeditCounts counts;
  counts.vertices = 500'000'000;
  counts.cells = {3'000'000'000, 0, 1'000, 0};
  counts.faces = {20'000'000, 0};
  const MeditLayout wide = medit_layout(counts, MeditEncoding::binary);
  EXPECT_EQ(wide.version, 4);
  ASSERT_EQ(wide.sections.size(), 4U);
  const MeditSection& tetrahedra = *wide.find(MeditKeyword::tetrahedra);
  EXPECT_EQ(tetrahedra.line_bytes, 40);
  EXPECT_EQ(tetrahedra.lines, 28 + 3 * 20 + 500'000'000LL * 32 + 20'000'000LL * 32 - 4);
  EXPECT_EQ(wide.find(MeditKeyword::prisms)->begin, tetrahedra.lines + 120'000'000'000LL);
  EXPECT_EQ(wide.size, wide.find(MeditKeyword::prisms)->end() + 12);
  counts.cells[0] = 2'147'483'647;
  const MeditLayout narrow = medit_layout(counts, MeditEncoding::binary);
  EXPECT_EQ(narrow.version, 3);
  EXPECT_EQ(narrow.find(MeditKeyword::prisms)->begin,
            narrow.find(MeditKeyword::tetrahedra)->lines + 2'147'483'647LL * 20);
}

/// A tetrahedron in a file of any version and byte order, as another program might write it.
class ImportedFile {
public:
  ImportedFile(int version, bool swapped) : _version(version), _swapped(swapped) {
    number<std::int32_t>(1), number<std::int32_t>(version);
    section(3), number<std::int32_t>(3), close();
    section(5), integer(1), integer(1), integer(2), integer(9), close();  // an edge
    section(4), integer(4);
    for (const double x : {0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}) {
      version == 1 ? number(static_cast<float>(x)) : number(x);
      if (++_coordinates % 3 == 0) integer(0);
    }
    close();
    section(8), integer(1);
    for (const int v : {1, 2, 3, 4, 7}) integer(v);
    close();
    section(6), integer(2);
    for (const int v : {1, 2, 3, -5, 1, 2, 4, 12}) integer(v);
    close();
    section(54);
  }
  std::string bytes;

private:
  template <class Number>
  void number(Number value) {
    std::string raw(reinterpret_cast<const char*>(&value), sizeof(Number));
    if (_swapped) std::reverse(raw.begin(), raw.end());
    bytes += raw;
  }
  void integer(std::int64_t value) {
    _version < 4 ? number(static_cast<std::int32_t>(value)) : number(value);
  }
  void position(std::int64_t value) {
    _version < 3 ? number(static_cast<std::int32_t>(value)) : number(value);
  }
  void section(std::int32_t keyword) {
    number(keyword);
    _position_at = bytes.size();
    position(0);
  }
  void close() {
    const std::string all = bytes;
    bytes.resize(_position_at);
    position(static_cast<std::int64_t>(all.size()));
    bytes += all.substr(bytes.size());
  }
  int _version;
  bool _swapped;
  int _coordinates = 0;
  std::size_t _position_at = 0;
};

TEST_F(Medit, VersionsAndByteOrders) {
  for (const int version : {1, 2, 3, 4}) {
    for (const bool swapped : {false, true}) {
      const std::string file = path("imported.meshb");
      examples::put_bytes(world, file, ImportedFile(version, swapped).bytes);
      const Assembled read = assemble(read_medit({world, file}), 1);
      EXPECT_EQ(read.mesh.vertex_count, 4);
      EXPECT_EQ(read.mesh.cell_count(), 1);
      EXPECT_EQ(read.mesh.regions, std::vector<std::string>{"region_7"});
      ASSERT_EQ(read.mesh.patches.size(), 3U);
      EXPECT_EQ(read.mesh.patches[0].name, "patch_-5");
      EXPECT_EQ(read.mesh.patches[1].name, "patch_12");
      EXPECT_EQ(read.unnamed_faces, 2);
      world.barrier();
    }
  }
}

TEST_F(Medit, TextWithCommentsAndOtherSections) {
  const std::string file = path("imported.mesh");
  examples::put_bytes(
      world, file,
      "# by hand\nMeshVersionFormatted\n1\nDimension\n3 Vertices 4 0 0 0 1\n1 0 0 1 0 1. 0 1 # here\n0 0 1e0 "
      "1\n"
      "Ridges 1\n1\nTetrahedra\n1\n2 1 3 4 5\n\nRequiredVertices\n2\n1\n2\nTriangles\n1 1 2 3 8\nEnd\n");
  const Assembled read = assemble(read_medit({world, file}), 1);
  EXPECT_EQ(read.mesh.cell_count(), 1);
  EXPECT_EQ(read.turned_cells, 1);
  EXPECT_EQ(read.mesh.regions, std::vector<std::string>{"region_5"});
}

TEST_F(Medit, NamesOfAllKinds) {
  FileMesh mesh;
  mesh.regions = {" fluid\n", "\\x", "über", ""};
  mesh.region_cells = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 0, 1}, {0, 0, 0, 0}};
  mesh.patches = {{"wing / lower  side ", mesh::PatchType::farfield}, {"wall", mesh::PatchType::wall}};
  mesh.patch_faces = {{0, 3}, {3, 0}};
  const std::string text = medit_names_text(mesh);
  const MeditNames names = parse_medit_names(text, "file.names");
  for (std::size_t r = 0; r < mesh.regions.size(); ++r)
    EXPECT_EQ(names.regions.at(static_cast<std::int64_t>(r) + 1), mesh.regions[r]);
  for (std::size_t p = 0; p < mesh.patches.size(); ++p)
    EXPECT_EQ(names.patches.at(static_cast<std::int64_t>(p) + 1), mesh.patches[p]);
  for (const char* wrong : {"polyhedra 1 a", "triangles x a wall", "triangles 1 a well", "tetrahedra 1 \\y",
                            "tetrahedra 1 a\ntetrahedra 1 b", "triangles", "tetrahedra 1 a\\x0"}) {
    EXPECT_THROW(parse_medit_names(wrong, "file.names"), std::runtime_error) << wrong;
  }
}

TEST_F(Medit, RefusesWithThePlace) {
  const std::string head = "MeshVersionFormatted 2\nDimension 3\n";
  const auto expect = [&](const std::string& name, const std::string& bytes, const std::string& text) {
    EXPECT_NE(refusal(name, bytes).find(text), std::string::npos) << refusal(name, bytes);
  };
  expect("bad.mesh", head + "Polyhedra\n1\n1 2 3 4 5 6 7 8 0\n", "line 4: there are 1 Polyhedra");
  expect("bad.mesh", head + "Vertices\n4611686018427387904\n",
         "line 4: 4611686018427387904 Vertices do not fit");
  expect("bad.mesh", "MeshVersionFormatted 2\nDimension 2\n", "line 2: the mesh has 2 dimensions");
  expect("bad.mesh", head + "Vertices 1\n0 zero 0 0\n", "line 4: 'zero' should be a coordinate");
  expect("bad.mesh", head + "Tetrahedra 1 1 2 3 0 1", "line 3: there is no vertex 0");
  expect("bad.mesh", "solid", "no MeshVersionFormatted");
  expect("bad.mesh", "", "");
  std::string bytes = ImportedFile(3, false).bytes;
  bytes[24 + 0] = 46;
  expect("bad.meshb", bytes, "byte 24: there are 1 Polyhedra");
  expect("bad.meshb", bytes.substr(0, 20), "the file ends here");
  bytes = ImportedFile(3, false).bytes;
  bytes[4] = 5;
  expect("bad.meshb", bytes, "byte 4: there is no version 5");
  EXPECT_NE(refusal("empty.meshb", ""), "");
}

TEST_F(Medit, MoreThanTheCountsSayIsRefused) {
  for (const int version : {1, 3, 4}) {
    const std::string good = ImportedFile(version, false).bytes;
    const std::size_t end_section = version < 3 ? 8 : 12;
    for (const std::size_t from_end : {std::size_t{0}, end_section, end_section + 2}) {
      std::string bytes = good;
      bytes.insert(bytes.size() - from_end, 1, '\0');
      EXPECT_NE(refusal("long.meshb", bytes).find("1 bytes follow"), std::string::npos) << from_end;
    }
    // Some programs end with the keyword alone.
    examples::put_bytes(world, path("short.meshb"), good.substr(0, good.size() - end_section + 4));
    EXPECT_EQ(assemble(read_medit({world, path("short.meshb")}), 1).mesh.cell_count(), 1);
    world.barrier();
  }
}

TEST_F(Medit, WhatCannotBeWrittenOrOpened) {
  const FileMesh mesh = examples::mixed_mesh(world);
  examples::put_bytes(world, path("no_folder"), "a file");
  for (const std::string name : {"no_folder/a.meshb", "wrong.ending"}) {
    const std::string file = path(name);
    try {
      write_medit(mesh, file);
      ADD_FAILURE() << file << " was written";
    } catch (const parallel::CollectiveError& error) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    }
  }
  try {
    read_medit({world, "/no/such/file.meshb"});
    ADD_FAILURE() << "was read";
  } catch (const parallel::CollectiveError& error) {
    EXPECT_EQ(error.kind(), parallel::FailureKind::files);
  }
}

TEST_F(Medit, HostileFiles) {
  const FileMesh mesh = examples::mixed_mesh(world, 2, 2);
  for (const std::string ending : {".meshb", ".mesh"}) {
    const std::string good = path("good" + ending), hostile = path("hostile" + ending);
    for (const bool wide : {false, true}) {
      write_medit(mesh, good, {wide});
      const std::string bytes = examples::bytes_of(good);
      damage::survive(world, bytes, hostile, [&](const std::string& file) {
        assemble(read_medit({world, file}), 2);
      });
      if (ending == ".mesh") break;
    }
  }
}

TEST_F(Medit, NamesOfAnotherMeshAreLeftAlone) {
  const std::string file = path("shared.meshb");
  write_medit(examples::mixed_mesh(world, 2, 2), file);
  examples::put_bytes(world, medit_names_path(file),
                      "tetrahedra 1 lower\ntetrahedra 2 upper\ntriangles 1 hull slip\n");
  RawMesh raw = read_medit({world, file});
  EXPECT_EQ(raw.regions[0], "region_1");
  EXPECT_EQ(raw.patches[0], (mesh::Patch{"patch_1", mesh::PatchType::wall}));
  examples::put_bytes(world, medit_names_path(file), "tetrahedra 1 lower\ntetrahedra 2 upper\n");
  raw = read_medit({world, file});
  EXPECT_EQ(raw.regions, (std::vector<std::string>{"lower", "upper"}));
  EXPECT_EQ(raw.patches[0].name, "patch_1");
}

TEST_F(Medit, HostileNames) {
  const std::string file = path("named.meshb");
  write_medit(examples::mixed_mesh(world, 2, 2), file);
  const std::string names = examples::bytes_of(medit_names_path(file));
  world.barrier();
  damage::survive(world, names, medit_names_path(file), [&](const std::string&) {
    assemble(read_medit({world, file}), 2);
  });
}

TEST_F(Medit, PlacesBeyondFourGibibytes) {
  // Vertices in front of a hole of 5 GiB, tetrahedra behind it; a sparse file takes no room.
  const std::string file = path("sparse.meshb");
  const std::string near = ImportedFile(3, false).bytes;
  const std::int64_t hole = std::int64_t{5} << 30;
  if (world.is_root()) {
    std::string head = near;
    const std::size_t edges = 24;  // where the chain is led across the hole and back into its copy
    std::string link(reinterpret_cast<const char*>(&hole), sizeof(hole));
    head.replace(edges + 4, 8, link);
    std::ofstream stream(file, std::ios::binary);
    stream << head;
    // Behind the hole: the same sections, their positions moved.
    std::string tail = near.substr(edges + 28);
    for (std::size_t at = 0; at + 12 <= tail.size();) {
      std::int64_t next = 0;
      std::memcpy(&next, tail.data() + at + 4, 8);
      if (next == 0) break;
      const std::int64_t moved = next - static_cast<std::int64_t>(edges + 28) + hole;
      std::memcpy(tail.data() + at + 4, &moved, 8);
      at = static_cast<std::size_t>(next) - (edges + 28);
    }
    stream.seekp(hole);
    stream << tail;
  }
  world.barrier();
  const Assembled read = assemble(read_medit({world, file}), 1);
  EXPECT_EQ(read.mesh.cell_count(), 1);
  EXPECT_EQ(read.mesh.vertex_count, 4);
}

}  // namespace
}  // namespace aeroloom::io
