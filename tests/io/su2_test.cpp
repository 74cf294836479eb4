#include "io/raw_mesh.hpp"
#include "io/su2/su2_markers.hpp"
#include "io/su2/su2_reader.hpp"
#include "io/su2/su2_writer.hpp"
#include "io/su2/su2b_layout.hpp"
#include "parallel/communication/collective_error.hpp"
#include "tests/io/damage.hpp"
#include "tests/io/mixed_mesh.hpp"
#include "tests/io/solver_files.hpp"

#include <algorithm>
#include <cstring>
#include <set>

#include <fmt/format.h>

namespace aeroloom::io {
namespace {

namespace fs = std::filesystem;
using examples::bytes_of;
using parallel::CollectiveError;
using parallel::Communicator;
using parallel::FailureKind;

struct Format {
  const char* suffix;
  void (*write)(const FileMesh&, const std::string&);
  RawMesh (*read)(const SharedPath&);
};
constexpr std::array<Format, 2> formats = {{{".su2", write_su2, read_su2}, {".su2b", write_su2b, read_su2b}}};

class Su2 : public examples::ScratchFolder {
protected:
  /// The text of the error that reading `text` gives.
  std::string error_of(const std::string& text) {
    const std::string file = path("text.su2");
    examples::put_bytes(world, file, text);
    try {
      read_su2({world, file});
    } catch (const CollectiveError& error) {
      EXPECT_EQ(error.kind(), FailureKind::input) << error.what();
      EXPECT_NE(std::string(error.what()).find(file + ", line "), std::string::npos) << error.what();
      return std::string(error.what()).substr(file.size() + 2);
    }
    ADD_FAILURE() << "no error";
    return {};
  }
};

/// What a file of the mixed mesh must give back: names as SU2 can have them.
examples::Contents expected(const FileMesh& mesh) {
  return examples::with_plain_names(examples::contents_of(mesh));
}

TEST_F(Su2, TextAndBinaryReadBackTheSame) {
  const FileMesh mesh = examples::mixed_mesh(world, 4, 5);
  for (const Format& format : formats) {
    const std::string file = path(std::string("mixed") + format.suffix);
    format.write(mesh, file);
    const Assembled read = assemble(format.read({world, file}), 4);
    EXPECT_EQ(read.turned_cells, 0) << format.suffix;
    EXPECT_EQ(read.unnamed_faces, 0) << format.suffix;
    EXPECT_EQ(read.dropped_points, 0) << format.suffix;
    examples::expect_same(examples::contents_of(read.mesh), expected(mesh));
  }
}

TEST_F(Su2, BytesDependOnPartsAlone) {
  const FileMesh mesh = examples::mixed_mesh(world, 3, 4);
  for (const Format& format : formats) {
    const std::string file = path(std::string("all") + format.suffix);
    format.write(mesh, file);
    if (world.is_root()) {
      const Communicator self = Communicator::self();
      const std::string alone = path(std::string("alone") + format.suffix);
      format.write(examples::mixed_mesh(self, 3, 4), alone);
      EXPECT_TRUE(bytes_of(file) == bytes_of(alone)) << format.suffix;
    }
    world.barrier();
  }
}

TEST_F(Su2, TextIsAsDocumentedAndConditionsStandBesideIt) {
  const FileMesh mesh = examples::mixed_mesh(world, 2, 3);
  write_su2(mesh, path("text.su2"));
  const std::string text = bytes_of(path("text.su2"));
  EXPECT_TRUE(text.starts_with("NDIME= 3\nNPOIN= " + std::to_string(mesh.vertex_count) + "\n"));
  const std::size_t cells = text.find("\nNELEM= " + std::to_string(mesh.cell_count()) + "\n10 ");
  EXPECT_NE(cells, std::string::npos);
  EXPECT_NE(text.find("\nNMARK= 3\nMARKER_TAG= wing___lower_side\nMARKER_ELEMS= "), std::string::npos);
  EXPECT_EQ(text.find("interface"), std::string::npos);
  EXPECT_EQ(text.back(), '\n');
  EXPECT_EQ(text.find('\0'), std::string::npos);
  EXPECT_EQ(bytes_of(path("text_markers.cfg")),
            "% Markers of a mesh by condition, for an SU2 configuration.\nMESH_FILENAME= text.su2\n"
            "MARKER_HEATFLUX= ( wing___lower_side, 0.0 )\n% Without viscosity: MARKER_EULER instead.\n"
            "MARKER_PLOTTING= ( wing___lower_side )\nMARKER_MONITORING= ( wing___lower_side )\n"
            "MARKER_SYM= ( symmetry )\nMARKER_FAR= ( far_field )\n");
}

TEST_F(Su2, ConditionsOfAllTypesComeBack) {
  const int count = static_cast<int>(mesh::patch_type_names.size()) - 1;
  FileMesh mesh = examples::mixed_mesh(world, 1, 1);
  BoundaryPatches patches;
  std::vector<mesh::Patch> wanted;
  mesh.patches.clear();
  for (int i = 0; i < 2 * count; ++i) {
    mesh.patches.push_back(
        {std::string("m").append(std::to_string(i)), static_cast<mesh::PatchType>(i % count)});
    patches.ids.push_back(i);
  }
  write_markers(path("types.su2b"), mesh, patches, marker_names(mesh, patches));
  std::vector<mesh::Patch> read = mesh.patches;
  for (mesh::Patch& patch : read) patch.type = mesh::PatchType::wall;
  set_marker_types({world, path("types.su2")}, read);
  EXPECT_EQ(read, mesh.patches);
}

TEST_F(Su2, ConditionsOfAnotherMeshAreLeftAlone) {
  examples::put_bytes(world, path("shared_markers.cfg"),
                      "MARKER_EULER= ( hull, tail )\nMARKER_FAR= ( out )\n");
  std::vector<mesh::Patch> patches = {{"hull"}, {"out"}, {"Inflow 2"}};
  set_marker_types({world, path("shared.su2")}, patches);
  EXPECT_EQ(patches, (std::vector<mesh::Patch>{{"hull"}, {"out"}, {"Inflow 2", mesh::PatchType::inlet}}));
  patches.push_back({"tail"});
  set_marker_types({world, path("shared.su2")}, patches);
  EXPECT_EQ(patches[0].type, mesh::PatchType::slip);
  EXPECT_EQ(patches[1].type, mesh::PatchType::farfield);
  EXPECT_EQ(patches[2].type, mesh::PatchType::inlet);
  EXPECT_EQ(patches[3].type, mesh::PatchType::slip);
}

TEST_F(Su2, ConditionsOfThousandsOfMarkersComeBack) {
  FileMesh mesh = examples::mixed_mesh(world, 1, 1);
  BoundaryPatches patches;
  mesh.patches.clear();
  for (std::int32_t i = 0; i < 50000; ++i) {
    mesh.patches.push_back({fmt::format("outside_of_the_building_{:08}", i), mesh::PatchType::farfield});
    patches.ids.push_back(i);
  }
  write_markers(path("many.su2"), mesh, patches, marker_names(mesh, patches));
  std::vector<mesh::Patch> read = mesh.patches;
  for (mesh::Patch& patch : read) patch.type = mesh::PatchType::wall;
  set_marker_types({world, path("many.su2")}, read);
  EXPECT_EQ(read, mesh.patches);
}

TEST(PlainNamesLocal, AreAllowedAndDifferentAfterCutting) {
  const std::string umlauts =
      "\u00e4\u00f6\u00fc\u00e4\u00f6\u00fc\u00e4\u00f6\u00fc\u00e4\u00f6\u00fc\u00e4\u00f6\u00fc\u00e4\u00f6"
      "\u00fc";
  const std::vector<std::string> names = {
      "a b",   "a_b",   "a/b",       "", "SEND_RECEIVE", umlauts, std::string(40, 'x'), std::string(41, 'x'),
      "patch", "a_b_2", "50%, (tip)"};
  constexpr std::array<std::string_view, 1> reserved = {"SEND_RECEIVE"};
  const auto plain = plain_names(names, {.signs = "_-+.", .most_bytes = 32, .reserved = reserved});
  EXPECT_EQ(std::set<std::string>(plain.begin(), plain.end()).size(), names.size());
  EXPECT_EQ(plain[0], "a_b_3");
  EXPECT_EQ(plain[1], "a_b");
  EXPECT_EQ(plain[2], "a_b_4");
  EXPECT_EQ(plain[3], "patch_2");
  EXPECT_EQ(plain[4], "SEND_RECEIVE_2");
  EXPECT_EQ(plain[5], umlauts.substr(0, 32));
  EXPECT_EQ(plain[6], std::string(32, 'x'));
  EXPECT_EQ(plain[7], std::string(30, 'x') + "_2");
  EXPECT_EQ(plain[10], "50____tip_");
}

TEST(Su2bLayoutLocal, OfBillionsHas64Bits) {
  Su2bCounts counts;
  counts.points = 500'000'000;
  counts.cells = {3'000'000'000, 2, 5, 3};
  counts.markers = {{2'000'000'000, 3}, {1, 0}};
  const Su2bLayout layout = su2b_layout(counts);
  EXPECT_EQ(layout.integer_bytes, 8);
  EXPECT_EQ(layout.cells.count, 16);
  EXPECT_EQ(layout.cells.connectivity, 16 + 8 + 8 * 3'000'000'011);
  EXPECT_EQ(layout.point_count, layout.cells.connectivity + 8 * (18'000'000'000 + 14 + 40 + 30));
  EXPECT_EQ(layout.marker_count, layout.points + 32 * counts.points);
  EXPECT_EQ(layout.names[0], layout.marker_count + 4);
  EXPECT_EQ(layout.markers[0].connectivity, layout.names[0] + 33 + 8 + std::int64_t{8} * 2'000'000'004);
  EXPECT_EQ(layout.names[1], layout.markers[0].connectivity + 8 * (8'000'000'000 + 15));
  EXPECT_EQ(layout.end, layout.names[1] + 33 + 8 + 16 + 32);
  counts.cells[0] = 715'827'873;  // the last count whose connectivity 32 bits can address
  counts.cells[1] = counts.cells[2] = counts.cells[3] = 0;
  counts.markers.clear();
  EXPECT_EQ(su2b_layout(counts).integer_bytes, 4);
  counts.cells[0] += 10;
  EXPECT_EQ(su2b_layout(counts).integer_bytes, 8);
}

/// The integers of a binary file in 64 bits and the bytes of all numbers the other way round.
std::string widened(const std::string& bytes) {
  std::string wide;
  std::size_t at = 0;
  const auto put = [&](auto value) {
    auto* first = reinterpret_cast<char*>(&value);
    std::reverse(first, first + sizeof value);
    wide.append(first, sizeof value);
  };
  const auto take = [&](auto value) {
    std::memcpy(&value, bytes.data() + at, sizeof value);
    at += sizeof value;
    return value;
  };
  const auto copy_integers = [&](std::uint64_t count) {
    std::uint32_t last = 0;
    for (std::uint64_t i = 0; i < count; ++i) put(std::uint64_t{last = take(std::uint32_t{})});
    return last;
  };
  take(std::int32_t{});
  put(std::int32_t{8});
  for (int i = 0; i < 3; ++i) put(take(std::int32_t{}));
  copy_integers(copy_integers(copy_integers(1) + 1));
  const std::uint32_t points = copy_integers(1);
  for (std::uint32_t i = 0; i < points; ++i) {
    for (int k = 0; k < 3; ++k) put(take(double{}));
    copy_integers(1);
  }
  const auto markers = take(std::int32_t{});
  put(markers);
  for (std::int32_t i = 0; i < markers; ++i) {
    wide.append(bytes.data() + at, 33);
    at += 33;
    copy_integers(copy_integers(copy_integers(1) + 1));
  }
  EXPECT_EQ(at, bytes.size());
  return wide;
}

TEST_F(Su2, BinaryFilesOfEitherOrderAndWidthAreRead) {
  const FileMesh mesh = examples::mixed_mesh(world, 3, 3);
  write_su2b(mesh, path("own.su2b"));
  const std::string wide = path("own.wide.su2b");
  examples::put_bytes(world, wide, widened(bytes_of(path("own.su2b"))));
  if (world.is_root()) fs::copy_file(path("own_markers.cfg"), path("own.wide_markers.cfg"));
  world.barrier();
  const Assembled read = assemble(read_su2b({world, wide}), 2);
  examples::expect_same(examples::contents_of(read.mesh), expected(mesh));
}

TEST_F(Su2, BinaryFilesWithMoreThanTheirCountsSayAreRefused) {
  write_su2b(examples::mixed_mesh(world, 2, 2), path("long.su2b"));
  const std::string good = bytes_of(path("long.su2b"));
  for (const std::size_t from_end : {0, 1, 2}) {
    std::string bytes = good;
    bytes.insert(bytes.size() - from_end, 1, '\0');
    examples::put_bytes(world, path("long.su2b"), bytes);
    try {
      read_su2b({world, path("long.su2b")});
      ADD_FAILURE() << from_end;
    } catch (const CollectiveError& error) {
      EXPECT_NE(std::string(error.what()).find("but 1 bytes follow"), std::string::npos) << error.what();
    }
  }
}

TEST_F(Su2, TextOfOthersIsRead) {
  const std::string text =
      "% one tetrahedron\r\nNZONE= 1\r\nIZONE= 1\r\nAOA= 3.0\r\nNDIME = 3\r\nNELEM= 2\r\n10 0 1 2 3 0\r\n3 0 "
      "1 1\r\n"
      "NPOIN= 4 4\r\n0 0 0 0\r\n+1.0e0 0 0 1 % tip\r\n\r\n0 1 0 2\r\n0.0 0 1 3\r\nNMARK= 3\r\n"
      "MARKER_TAG= hull\r\nMARKER_ELEMS= 3\r\n5 0 1 2\r\n5 0 1 3 7\r\n3 0 1\r\n"
      "MARKER_TAG= SEND_RECEIVE\r\nMARKER_ELEMS= 1\r\nSEND_TO= 2\r\n1 0 0\r\n"
      "MARKER_TAG= far\r\nMARKER_ELEMS= 2\r\n5 1 2 3\r\n5 0 2 3\r\nFFD_NBOX= 1\r\n0 0 0\r\nNPERIODIC= 1\r\n0 "
      "0 0";
  const std::string file = path("others.su2");
  examples::put_bytes(world, file, text);
  const RawMesh raw = read_su2({world, file});
  EXPECT_EQ(raw.patches, (std::vector<mesh::Patch>{{"hull"}, {"far"}}));
  const Assembled read = assemble(read_su2({world, file}), 1);
  EXPECT_EQ(read.mesh.cell_count(), 1);
  EXPECT_EQ(read.mesh.vertex_count, 4);
  EXPECT_EQ(read.mesh.boundary_count(FaceShape::triangle), 4);
  EXPECT_EQ(read.unnamed_faces, 0);
}

TEST_F(Su2, WhatIsWrongIsSaidWithItsLine) {
  const std::string points = "NDIME= 3\nNPOIN= 4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
  const std::string cell = "NELEM= 1\n10 0 1 2 3\n";
  EXPECT_TRUE(error_of("").starts_with("line 1: the file has no NDIME"));
  EXPECT_TRUE(error_of("NDIME= 2\n").starts_with("line 1: only meshes of three"));
  EXPECT_TRUE(error_of(points).starts_with("line 7: the file has no NELEM"));
  EXPECT_TRUE(error_of("NDIME= 3\n" + cell).starts_with("line 4: the file has no NPOIN"));
  EXPECT_TRUE(
      error_of(points + "NELEM= 4611686018427387904\n").starts_with("line 7: 4611686018427387904 elem"));
  EXPECT_TRUE(error_of(points + "NELEM= -1\n").starts_with("line 7: -1 elements do not fit"));
  EXPECT_TRUE(error_of(points + "NELEM= many\n").starts_with("line 7: `many` is no whole number"));
  EXPECT_TRUE(error_of(points + "NELEM= 2\n10 0 1 2 3\n").starts_with("line 9: the file ends after 1 of 2"));
  EXPECT_TRUE(
      error_of(points + "NELEM= 2\n10 0 1 2 3\nNMARK= 0\n").starts_with("line 9: a keyword after 1 of 2"));
  EXPECT_TRUE(error_of(points + cell + "10 0 1 2 3\n").starts_with("line 9: a keyword is expected here"));
  EXPECT_TRUE(error_of(points + "NELEM= 1\n10 0 1 2 4\n").starts_with("line 8: there is no point 4"));
  EXPECT_TRUE(error_of(points + "NELEM= 1\n10 0 1 2 -3\n").starts_with("line 8: there is no point -3"));
  EXPECT_TRUE(
      error_of(points + "NELEM= 1\n10 0 1 2\n").starts_with("line 8: the element has too few points"));
  EXPECT_TRUE(error_of(points + "NELEM= 1\n24 0 1 2 3\n").starts_with("line 8: elements of type 24"));
  EXPECT_TRUE(error_of("NDIME= 3\nNPOIN= 1\n0 nan 0\n").starts_with("line 3: coordinate 2 of point 0"));
  EXPECT_TRUE(error_of("NDIME= 3\nNPOIN= 1\n0 1e999 0\n").starts_with("line 3: coordinate 2 of point 0"));
  EXPECT_TRUE(error_of(points + cell + "NMARK= 1\n").starts_with("line 10: the file has 0 markers"));
  EXPECT_TRUE(error_of(points + cell + "MARKER_ELEMS= 1\n").starts_with("line 9: MARKER_TAG is expected"));
  EXPECT_TRUE(error_of(points + cell + "MARKER_TAG= a\nMARKER_ELEMS= 1\n10 0 1 2 3\n")
                  .starts_with("line 11: a marker"));
  EXPECT_TRUE(error_of("NZONE= 2\n").starts_with("line 1: only files of one zone"));
  EXPECT_TRUE(error_of(std::string(3 << 20, 'x')).starts_with("line 1: the line is too long"));
  for (const Format& format : formats) {
    try {
      format.read({world, path("nowhere")});
      ADD_FAILURE() << "no error";
    } catch (const CollectiveError& error) {
      EXPECT_EQ(error.kind(), FailureKind::files);
    }
  }
}

TEST_F(Su2, DamagedFilesAreErrorsOrMeshes) {
  const FileMesh mesh = examples::mixed_mesh(world, 1, 2);
  for (const Format& format : formats) {
    const std::string file = path(std::string("damaged") + format.suffix);
    format.write(mesh, file);
    const std::string good = bytes_of(file);
    world.barrier();
    const auto read = [&](const std::string& damaged) { assemble(format.read({world, damaged}), 2); };
    const damage::Options cuts{.truncations = 50, .flips = 0, .fields = 0, .pieces = 0};
    const damage::Options all{.truncations = 0, .flips = 120, .fields = 30, .pieces = 30};
    // Text may lack the end of its last line; without its last digit it is that of another mesh.
    EXPECT_LE(damage::survive(world, good, file, read, cuts).accepted, format.read == read_su2 ? 2 : 0);
    EXPECT_GT(damage::survive(world, good, file, read, all).refused, 10);
  }
}

TEST_F(Su2, FilesThatCannotBeWrittenAreErrors) {
  const FileMesh mesh = examples::mixed_mesh(world, 2, 2);
  for (const Format& format : formats) {
    try {
      format.write(mesh, std::string("/proc/aeroloom/x") + format.suffix);
      ADD_FAILURE() << "no error";
    } catch (const CollectiveError& error) {
      EXPECT_EQ(error.kind(), FailureKind::files);
      EXPECT_NE(std::string(error.what()).find("/proc/aeroloom"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace aeroloom::io
