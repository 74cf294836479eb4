#include "io/raw_mesh.hpp"
#include "io/ugrid/mapbc.hpp"
#include "io/ugrid/ugrid_format.hpp"
#include "io/ugrid/ugrid_reader.hpp"
#include "io/ugrid/ugrid_writer.hpp"
#include "parallel/communication/collective_error.hpp"
#include "tests/io/damage.hpp"
#include "tests/io/mixed_mesh.hpp"
#include "tests/io/solver_files.hpp"

#include <cstring>

namespace aeroloom::io {
namespace {

namespace fs = std::filesystem;
using examples::bytes_of;
using parallel::CollectiveError;
using parallel::Communicator;
using parallel::FailureKind;

class Ugrid : public examples::ScratchFolder {
protected:
  /// The kind and text of the error that reading gives.
  std::string error_of(const std::string& file, FailureKind kind = FailureKind::input) const {
    try {
      read_ugrid({world, file});
    } catch (const CollectiveError& error) {
      EXPECT_EQ(error.kind(), kind) << error.what();
      return error.what();
    }
    ADD_FAILURE() << "no error";
    return {};
  }
};

/// What a file of the mixed mesh must give back: plain names, an oblique plane of symmetry as slip.
examples::Contents expected(const FileMesh& mesh) {
  examples::Contents contents = examples::with_plain_names(examples::contents_of(mesh));
  contents.types["symmetry"] = mesh::PatchType::slip;
  return contents;
}

TEST_F(Ugrid, AllKindsReadBackTheSame) {
  const FileMesh mesh = examples::mixed_mesh(world, 4, 5);
  for (const char* suffix :
       {"lb8.ugrid", "b8.ugrid", "lb8l.ugrid", "b8l.ugrid", "lb8.ugrid64", "b8.ugrid64"}) {
    const std::string file = path(std::string("mixed.") + suffix);
    write_ugrid(mesh, file);
    const Assembled read = assemble(read_ugrid({world, file}), 4);
    EXPECT_EQ(read.turned_cells, 0) << suffix;
    EXPECT_EQ(read.unnamed_faces, 0) << suffix;
    EXPECT_EQ(read.dropped_points, 0) << suffix;
    examples::expect_same(examples::contents_of(read.mesh), expected(mesh));
  }
  EXPECT_EQ(bytes_of(path("mixed.mapbc")),
            "3\n1 4000 wing___lower_side\n2 3000 symmetry\n3 5000 far_field\n");
}

TEST_F(Ugrid, BytesDependOnPartsAlone) {
  const FileMesh mesh = examples::mixed_mesh(world, 3, 4);
  for (const char* suffix : {"b8.ugrid", "lb8l.ugrid"}) {
    const std::string file = path(std::string("all.") + suffix);
    write_ugrid(mesh, file);
    if (world.is_root()) {
      const Communicator self = Communicator::self();
      const std::string alone = path(std::string("alone.") + suffix);
      write_ugrid(examples::mixed_mesh(self, 3, 4), alone);
      EXPECT_TRUE(bytes_of(file) == bytes_of(alone)) << suffix;
      EXPECT_EQ(bytes_of(path("all.mapbc")), bytes_of(path("alone.mapbc")));
    }
    world.barrier();
  }
}

TEST_F(Ugrid, FacesAreSortedByPatchAndPointIntoTheFluid) {
  const FileMesh mesh = examples::mixed_mesh(world, 2, 3);
  const std::string file = path("sorted.lb8.ugrid");
  write_ugrid(mesh, file);
  const std::string bytes = bytes_of(file);
  std::array<std::int32_t, 7> counts{};
  std::memcpy(counts.data(), bytes.data(), sizeof counts);
  const UgridLayout layout =
      ugrid_layout({counts[0], {counts[1], counts[2]}, {counts[3], counts[4], counts[5], counts[6]}}, 4);
  EXPECT_EQ(static_cast<std::int64_t>(bytes.size()), layout.end);
  double volume = 0;
  const auto point = [&](std::int32_t number) {
    geometry::Vec3 p;
    std::memcpy(&p, bytes.data() + layout.points + std::int64_t{24} * (number - 1), sizeof p);
    return p;
  };
  for (std::size_t s = 0; s < face_shape_count; ++s) {
    std::int32_t last = 1;
    for (std::int32_t i = 0; i < counts[1 + s]; ++i) {
      std::array<std::int32_t, 4> v{};
      std::int32_t id = 0;
      std::memcpy(v.data(), bytes.data() + layout.faces[s] + (12 + 4 * s) * i, 12 + 4 * s);
      std::memcpy(&id, bytes.data() + layout.patch_ids[s] + std::int64_t{4} * i, 4);
      EXPECT_GE(id, last);
      EXPECT_LE(id, 3);
      last = id;
      for (std::size_t k = 1; k + 1 < 3 + s; ++k)
        volume += dot(point(v[0]), cross(point(v[k]) - point(v[0]), point(v[k + 1]) - point(v[0]))) / 6;
    }
  }
  EXPECT_NEAR(volume, -examples::contents_of(mesh).enclosed, 1e-9);
}

TEST_F(Ugrid, PlanesOfSymmetryAreKnownByTheirAxis) {
  for (int axis = 0; axis < 3; ++axis) {
    examples::MixedMesh whole(2, 2);
    for (geometry::Vec3& p : whole.points) {
      // The coordinate that the plane was 0 in before it was mapped, along the axis.
      const double y = std::round(2 * (p.y - 0.125 * (p.z + 3)) / 1.5) / 2;
      p = axis == 0   ? geometry::Vec3{y, p.z, p.x}
          : axis == 1 ? geometry::Vec3{p.x, y, p.z}
                      : geometry::Vec3{p.z, p.x, y};
    }
    write_ugrid(examples::distribute(world, whole, 2), path("plane.lb8.ugrid"));
    const auto table = read_mapbc({world, path("plane.mapbc")});
    EXPECT_EQ(table.at(2).type, mesh::PatchType::symmetry);
    EXPECT_NE(bytes_of(path("plane.mapbc")).find("2 666" + std::to_string(axis + 1) + " symmetry"),
              std::string::npos);
    world.barrier();
  }
}

TEST_F(Ugrid, PatchesHaveNamesWithoutMapbcToo) {
  const std::string file = path("bare.lb8.ugrid");
  write_ugrid(examples::mixed_mesh(world, 2, 2), file);
  world.barrier();
  if (world.is_root()) fs::remove(path("bare.mapbc"));
  world.barrier();
  EXPECT_EQ(read_ugrid({world, file}).patches[1], (mesh::Patch{"patch_2", mesh::PatchType::wall}));
  examples::put_bytes(world, path("bare.mapbc"), "3\n1 3000 shell\n3 5050 shell \n\n2 6662\n");
  const RawMesh raw = read_ugrid({world, file});
  ASSERT_EQ(raw.patches.size(), 3U);
  EXPECT_EQ(raw.patches[0], (mesh::Patch{"shell", mesh::PatchType::slip}));
  EXPECT_EQ(raw.patches[1], (mesh::Patch{"patch_2", mesh::PatchType::symmetry}));
  EXPECT_EQ(raw.patches[2], (mesh::Patch{"shell_3", mesh::PatchType::farfield}));
  for (const char* other : {"3\n1 3000 a\n2 5050 b\n7 6662 c\n", "2\n1 3000 a\n2 5050 b\n",
                            "4\n1 3000 a\n2 5050 b\n3 3000 c\n4 3000 d\n"}) {
    examples::put_bytes(world, path("bare.mapbc"), other);
    EXPECT_EQ(read_ugrid({world, file}).patches[0], (mesh::Patch{"patch_1", mesh::PatchType::wall}));
  }
  examples::put_bytes(world, path("bare.mapbc"), "2\n1 4000 shell\n1 4000 hull\n");
  EXPECT_NE(error_of(file).find("bare.mapbc, line 3"), std::string::npos);
  examples::put_bytes(world, path("bare.mapbc"), "2\n1 4000 shell\n");
  EXPECT_NE(error_of(file).find("the file ends after 1 of 2"), std::string::npos);
}

TEST_F(Ugrid, NumbersOfUsm3dAreConditionsToo) {
  const std::string file = path("old.mapbc");
  examples::put_bytes(world, file, "8\n1 0 a\n2 1 b\n3 2 c\n4 3 d\n5 4 e\n6 5 f\n7 1001 g\n8 1002 h\n");
  const auto table = read_mapbc({world, file});
  using mesh::PatchType;
  const std::array types = {PatchType::farfield, PatchType::symmetry, PatchType::outlet, PatchType::farfield,
                            PatchType::wall,     PatchType::slip,     PatchType::inlet,  PatchType::outlet};
  for (std::size_t i = 0; i < types.size(); ++i)
    EXPECT_EQ(table.at(static_cast<std::int64_t>(i) + 1).type, types[i]) << i;
}

TEST_F(Ugrid, MeshesTooLargeFor32BitsNameTheSuffixThatIsNot) {
  ShapeCounts counts;
  counts.vertices = 500'000'000;
  counts.cells = {3'000'000'000, 7, 11};
  counts.faces = {2'000'000'000, 5};
  const UgridLayout layout = ugrid_layout(counts, 8);
  EXPECT_EQ(layout.faces[0], 56 + 12'000'000'000);
  EXPECT_EQ(layout.patch_ids[0], layout.faces[0] + 48'000'000'000 + 160);
  EXPECT_EQ(layout.cells[0], layout.patch_ids[1] + 40);
  EXPECT_EQ(layout.cells[1], layout.cells[0] + 96'000'000'000);
  EXPECT_EQ(layout.end, layout.cells[1] + 280 + 528);
  require_ugrid_fits(counts, ugrid_kind_of("a/x.b8l.ugrid"), "a/x.b8l.ugrid");
  try {
    require_ugrid_fits(counts, ugrid_kind_of("a/x.b8.ugrid"), "a/x.b8.ugrid");
    ADD_FAILURE() << "no error";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("a/x.b8l.ugrid"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("3000000000 tetrahedra"), std::string::npos);
  }
  counts.cells[0] = 2'147'483'647;
  require_ugrid_fits(counts, ugrid_kind_of("x.lb8.ugrid"), "x.lb8.ugrid");
  EXPECT_THROW(ugrid_kind_of("x.ugrid"), std::runtime_error);
  EXPECT_THROW(ugrid_kind_of("x.r8.ugrid"), std::runtime_error);
  EXPECT_THROW(ugrid_kind_of(".lb8.ugrid"), std::runtime_error);
}

TEST_F(Ugrid, WhatIsWrongIsSaidWithItsPlace) {
  const std::string file = path("wrong.lb8.ugrid");
  const FileMesh mesh = examples::mixed_mesh(world, 2, 2);
  write_ugrid(mesh, file);
  const std::string good = bytes_of(file);
  const auto with = [&](std::size_t offset, auto value) {
    std::string bytes = good;
    std::memcpy(bytes.data() + offset, &value, sizeof value);
    examples::put_bytes(world, file, bytes);
  };
  with(0, std::int32_t{1 << 30});
  EXPECT_NE(error_of(file).find("1073741824 points do not fit a file of"), std::string::npos);
  with(28, std::numeric_limits<double>::quiet_NaN());
  EXPECT_NE(error_of(file).find("byte 28: a coordinate of point 1 is no number"), std::string::npos);
  const auto triangles = static_cast<std::size_t>(28 + 24 * mesh.vertex_count);
  with(triangles, std::int32_t{0});
  EXPECT_NE(error_of(file).find("triangle 1 has point 0"), std::string::npos);
  with(24, std::int32_t{1});
  error_of(file);  // has more hexahedra
  error_of(path("nowhere.lb8.ugrid"), FailureKind::files);
  if (world.is_root()) fs::create_directory(path("folder.b8.ugrid"));
  world.barrier();
  error_of(path("folder.b8.ugrid"), FailureKind::files);
  EXPECT_NE(error_of(path("mesh.ugrid")).find(".lb8.ugrid"), std::string::npos);
}

TEST_F(Ugrid, MoreThanTheCountsSayIsRefused) {
  const FileMesh mesh = examples::mixed_mesh(world, 2, 2);
  const std::string file = path("long.lb8.ugrid");
  write_ugrid(mesh, file);
  const std::string good = bytes_of(file);
  // A byte before the end moves the last integers of the last hexahedron; some numbers stay valid.
  for (const std::size_t from_end : {0, 1, 2, 30}) {
    std::string bytes = good;
    bytes.insert(bytes.size() - from_end, 1, '\0');
    examples::put_bytes(world, file, bytes);
    EXPECT_NE(error_of(file).find("counts of the file end here, but 1 bytes follow"), std::string::npos);
  }
  // What may follow: tetrahedra in boundary layers, an id of each cell, two flags of each face.
  std::array<std::int32_t, 7> counts{};
  std::memcpy(counts.data(), good.data(), sizeof counts);
  const auto cells = static_cast<std::size_t>(counts[3] + counts[4] + counts[5] + counts[6]),
             faces = static_cast<std::size_t>(counts[1] + counts[2]);
  for (const std::size_t integers : {1 + cells, 1 + cells + faces, 1 + cells + 2 * faces}) {
    examples::put_bytes(world, file, good + std::string(4 * integers, '\0'));
    EXPECT_EQ(read_ugrid({world, file}).patches.size(), 3U);
    examples::put_bytes(world, file, good + std::string(4 * integers, '\x7f'));
    EXPECT_NE(error_of(file).find("end here"), std::string::npos);
  }
}

TEST_F(Ugrid, DamagedFilesAreErrorsOrMeshes) {
  const auto read = [&](const std::string& file) { assemble(read_ugrid({world, file}), 2); };
  for (const char* suffix : {"lb8.ugrid", "b8l.ugrid"}) {
    const std::string file = path(std::string("damaged.") + suffix);
    write_ugrid(examples::mixed_mesh(world, 1, 2), file);
    const std::string good = bytes_of(file);
    world.barrier();
    const damage::Options cuts{.truncations = 50, .flips = 0, .fields = 0, .pieces = 0};
    const damage::Options all{.truncations = 0, .flips = 80, .fields = 20, .pieces = 20};
    EXPECT_EQ(damage::survive(world, good, file, read, cuts).accepted, 0);
    EXPECT_GT(damage::survive(world, good, file, read, all).refused, 10);
    examples::put_bytes(world, file, good);
  }
  const auto read_beside = [&](const std::string&) { read(path("damaged.b8l.ugrid")); };
  const std::string table = bytes_of(path("damaged.mapbc"));
  world.barrier();
  damage::survive(world, table, path("damaged.mapbc"), read_beside, {.flips = 60, .fields = 10});
}

TEST_F(Ugrid, FilesThatCannotBeWrittenAreErrors) {
  const FileMesh mesh = examples::mixed_mesh(world, 2, 2);
  try {
    write_ugrid(mesh, "/proc/aeroloom/x.lb8.ugrid");
    ADD_FAILURE() << "no error";
  } catch (const CollectiveError& error) {
    EXPECT_EQ(error.kind(), FailureKind::files);
    EXPECT_NE(std::string(error.what()).find("/proc/aeroloom"), std::string::npos);
  }
  EXPECT_THROW(write_ugrid(mesh, path("x.ugrid")), CollectiveError);
}

}  // namespace
}  // namespace aeroloom::io
