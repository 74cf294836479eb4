#include "io/openfoam/foam_case.hpp"
#include "io/openfoam/foam_faces.hpp"
#include "io/openfoam/openfoam_writer.hpp"
#include "parallel/communication/collective_error.hpp"
#include "tests/io/mixed_mesh.hpp"
#include "tests/io/scratch_folder.hpp"
#include "tests/several_ranks.hpp"

#include <map>
#include <set>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

namespace aeroloom::io {
namespace {

namespace fs = std::filesystem;
using mesh::GlobalIndex;
using mesh::LocalIndex;
using parallel::CollectiveError;
using parallel::Communicator;

class OpenFoam : public examples::ScratchFolder {};

struct OrderedPart {
  const MeshPart* part;
  FoamFaces order;
};

std::vector<OrderedPart> order_all(const FileMesh& mesh, FoamPlan& plan) {
  const mesh::FaceLinks links = mesh::link_faces(*mesh.pieces);
  plan = plan_faces(mesh, links);
  std::vector<OrderedPart> parts;
  for (std::size_t i = 0; i < mesh.parts.size(); ++i)
    parts.push_back({&mesh.parts[i], order_faces(mesh, mesh.parts[i], links.pieces[i], plan)});
  return parts;
}

TEST(FoamFacesLocal, InnerFacesAreUpperTriangularAndPatchesFollow) {
  const Communicator world = Communicator::world();
  const FileMesh mesh = examples::mixed_mesh(world, 4, 3);
  FoamPlan plan;
  for (const auto& [part, order] : order_all(mesh, plan)) {
    std::pair<LocalIndex, LocalIndex> last{-1, -1};
    for (LocalIndex f = 0; f < order.inner; ++f) {
      const std::pair here{order.faces[f].cell, order.faces[f].neighbour};
      EXPECT_LT(here.first, here.second);
      EXPECT_LT(last, here);
      last = here;
    }
    std::size_t expected = static_cast<std::size_t>(order.inner);
    EXPECT_EQ(order.of_patch.size(), mesh.patches.size());
    EXPECT_EQ(order.of_patch[examples::MixedMesh::interface], 0);
    for (const LocalIndex count : order.of_patch) expected += static_cast<std::size_t>(count);
    for (const FoamProcessorPatch& patch : order.processors)
      expected += static_cast<std::size_t>(patch.count);
    EXPECT_EQ(order.faces.size(), expected);
  }
  const GlobalIndex sides = 4 * 104 + 5 * 20 + 5 * 32 + 6 * 4, boundary = 40 + 13 + 83;
  EXPECT_EQ(plan.faces, (sides - boundary) / 2 + boundary);
}

TEST(FoamFacesLocal, PartsAgreeOnWhatLiesBetweenThem) {
  const Communicator self = Communicator::self();
  const FileMesh mesh = examples::mixed_mesh(self, 4, 3);
  FoamPlan plan;
  // By pair of parts and place in the patch between them: the corners, from either side.
  std::map<std::tuple<int, int, int>, std::vector<GlobalIndex>> seen;
  std::multiset<GlobalIndex> numbers;
  std::map<std::int32_t, int> zoned;
  for (const auto& [part, order] : order_all(mesh, plan)) {
    std::size_t f = order.faces.size();
    for (const FoamProcessorPatch& patch : order.processors) f -= static_cast<std::size_t>(patch.count);
    for (const FoamProcessorPatch& patch : order.processors) {
      for (int i = 0; i < patch.count; ++i, ++f) {
        const FoamFace& face = order.faces[f];
        EXPECT_EQ(face.flipped, part->id > patch.other ? 1 : 0);
        const FoamCorners corners = corners_of_face(*part, face);
        std::vector<GlobalIndex> mine;
        for (int k = 0; k < corners.count; ++k) mine.push_back(part->numbers[corners.corners[k]]);
        const auto key = std::tuple(std::min(part->id, patch.other), std::max(part->id, patch.other), i);
        if (const auto [other, is_new] = seen.try_emplace(key, mine); !is_new) {
          std::reverse(mine.begin() + 1, mine.end());
          EXPECT_EQ(mine, other->second);
        }
      }
    }
    for (const FoamFace& face : order.faces) {
      if (face.flipped == 0) numbers.insert(face.number);
      if (face.zone >= 0) ++zoned[face.from_front];
    }
  }
  EXPECT_FALSE(seen.empty());
  // Every face of the whole mesh once.
  EXPECT_EQ(numbers.size(), static_cast<std::size_t>(plan.faces));
  EXPECT_EQ(std::set<GlobalIndex>(numbers.begin(), numbers.end()).size(), numbers.size());
  EXPECT_EQ(*numbers.rbegin(), plan.faces - 1);
  // No part of this mesh ends at the interface: all its faces lie inside parts, seen from one side.
  EXPECT_EQ(zoned[0] + zoned[1], 32);
}

TEST(FoamFacesLocal, ZonesBetweenPartsAreKnownToBoth) {
  const Communicator world = Communicator::world();
  const FileMesh mesh = repartition(examples::mixed_mesh(world, 4, 3), 4, mesh::PieceRegions::one);
  FoamPlan plan;
  std::int64_t front = 0, back = 0;
  for (const auto& [part, order] : order_all(mesh, plan)) {
    for (const FoamFace& face : order.faces) {
      if (face.zone >= 0) ++(face.from_front != 0 ? front : back);
    }
  }
  EXPECT_EQ(world.sum(front), 32);
  EXPECT_EQ(world.sum(back), 32);
}

TEST_F(OpenFoam, BytesDoNotDependOnRanks) {
  NEEDS_SEVERAL_RANKS();
  const FileMesh mesh = examples::mixed_mesh(world, 3, 4);
  for (const bool binary : {true, false}) {
    write_openfoam(mesh, path("all"), {binary, 0});
    if (!world.is_root()) continue;
    const Communicator self = Communicator::self();
    write_openfoam(examples::mixed_mesh(self, 3, 4), path("one"), {binary, 0});
    const auto files = examples::files_below(folder / "all");
    EXPECT_EQ(files, examples::files_below(folder / "one"));
    // Of each part the mesh and what refers to fields; dictionaries in system/ and constant/; fields with
    // their numbers; a script.
    EXPECT_EQ(files.size(), 4U * (11 + 6) + 8 + 2 + 7 + 1);
    const std::string boundary = files.at("processor2/constant/polyMesh/boundary");
    for (const char* expected : {"wing___lower_side", "inGroups        1(wall);", "far_field",
                                 "procBoundary2to1", "type            symmetry;"})
      EXPECT_NE(boundary.find(expected), std::string::npos) << expected;
    EXPECT_EQ(boundary.find("interface"), std::string::npos);
  }
}

TEST_F(OpenFoam, FilesOfUsersStay) {
  if (world.is_root()) {
    fs::create_directories(folder / "case" / "system");
    std::ofstream(path("case/system/controlDict")) << "mine";
  }
  world.barrier();
  write_openfoam(examples::mixed_mesh(world, 4, 3), path("case"));
  EXPECT_EQ(examples::bytes_of(path("case/system/controlDict")), "mine");
  // Fewer parts: folders of the others go, unless there is more in them.
  write_openfoam(examples::mixed_mesh(world, 4, 2), path("case"));
  EXPECT_TRUE(fs::exists(path("case/processor1")));
  EXPECT_FALSE(fs::exists(path("case/processor2")));
  world.barrier();
  if (world.is_root()) fs::create_directories(folder / "case" / "processor7" / "100");
  world.barrier();
  for (const int parts : {2, 1}) {
    try {
      write_openfoam(examples::mixed_mesh(world, 4, parts), path("case"));
      ADD_FAILURE() << parts;
    } catch (const CollectiveError& error) {
      EXPECT_EQ(error.kind(), parallel::FailureKind::files);
      EXPECT_NE(std::string(error.what()).find("processor7"), std::string::npos) << error.what();
    }
  }
  EXPECT_TRUE(fs::exists(path("case/processor1/constant/polyMesh/points")));
  world.barrier();
  if (world.is_root()) fs::remove_all(folder / "case" / "processor7");
  world.barrier();
  // One part: a mesh that needs no decomposition.
  write_openfoam(examples::mixed_mesh(world, 4, 1), path("case"));
  EXPECT_TRUE(fs::exists(path("case/constant/polyMesh/owner")));
  EXPECT_FALSE(fs::exists(path("case/processor0")));
}

TEST_F(OpenFoam, FieldsStandOnceAndThoseOfUsersStay) {
  write_openfoam(examples::mixed_mesh(world, 4, 3), path("case"));
  EXPECT_NE(examples::bytes_of(path("case/0.orig/U")).find("farfield    { type freestreamVelocity"),
            std::string::npos);
  EXPECT_NE(examples::bytes_of(path("case/processor2/0/U")).find("#include \"../../0.orig/U\""),
            std::string::npos);
  // There is a far field: what flows starts as it does there.
  EXPECT_NE(examples::bytes_of(path("case/0.orig/conditions")).find("$velocity"), std::string::npos);
  examples::put_bytes(world, path("case/0.orig/p"), "my pressure");
  examples::put_bytes(world, path("case/processor1/0/p"), "my pressure there");
  write_openfoam(examples::mixed_mesh(world, 4, 2), path("case"));
  EXPECT_EQ(examples::bytes_of(path("case/0.orig/p")), "my pressure");
  EXPECT_EQ(examples::bytes_of(path("case/processor1/0/p")), "my pressure there");
  EXPECT_FALSE(fs::exists(path("case/processor2")));
  world.barrier();
  if (world.is_root()) fs::remove_all(path("case/processor1/0"));
  world.barrier();
  write_openfoam(examples::mixed_mesh(world, 4, 1), path("case"));
  EXPECT_NE(examples::bytes_of(path("case/0/U")).find("#include \"../0.orig/U\""), std::string::npos);
  // An undivided case has fields of its own: parts get none beside them.
  examples::put_bytes(world, path("case/0/k"), "my turbulence");
  write_openfoam(examples::mixed_mesh(world, 4, 2), path("case"));
  EXPECT_EQ(examples::bytes_of(path("case/0/k")), "my turbulence");
  EXPECT_FALSE(fs::exists(path("case/0/U")));
  EXPECT_FALSE(fs::exists(path("case/processor0/0")));
}

TEST_F(OpenFoam, ViscosityFollowsFromTheReynoldsNumber) {
  FileMesh mesh = examples::mixed_mesh(world, 4, 2);
  write_openfoam(mesh, path("air"));
  const std::string air = examples::bytes_of(path("air/0.orig/conditions"));
  EXPECT_NE(air.find("viscosity       1.5e-05;"), std::string::npos) << air;
  EXPECT_NE(air.find("no Reynolds number"), std::string::npos) << air;
  mesh.flow = {.reynolds = 0, .length = 0, .unit = "mm", .unit_in_metres = 1e-3};
  write_openfoam(mesh, path("small"));
  const std::string small = examples::bytes_of(path("small/0.orig/conditions"));
  for (const char* expected : {"viscosity       0.015;", "Lengths are in mm"})
    EXPECT_NE(small.find(expected), std::string::npos) << small;
  mesh.flow = {.reynolds = 2e6, .length = 7};
  write_openfoam(repartition(mesh, 3), path("case"));
  const std::string given = examples::bytes_of(path("case/0.orig/conditions"));
  for (const char* expected : {"viscosity       0.000175;", "Reynolds number of 2e+06 over a length of 7",
                               "reference_length 7;", "omega           21.4285714;"})
    EXPECT_NE(given.find(expected), std::string::npos) << given;
}

TEST_F(OpenFoam, AScriptRunsTheCaseOnItsParts) {
  for (const int parts : {3, 2, 1}) {
    write_openfoam(examples::mixed_mesh(world, 4, parts), path("case"));
    const std::string script = examples::bytes_of(path("case/run.sh"));
    const std::string launch = parts == 1 ? "simpleFoam >" : "-n " + std::to_string(parts) + " ";
    EXPECT_NE(script.find(launch), std::string::npos) << script;
    EXPECT_TRUE((fs::status(path("case/run.sh")).permissions() & fs::perms::owner_exec) != fs::perms::none);
    world.barrier();
  }
  examples::put_bytes(world, path("case/run.sh"), "my script");
  write_openfoam(examples::mixed_mesh(world, 4, 2), path("case"));
  EXPECT_EQ(examples::bytes_of(path("case/run.sh")), "my script");
}

TEST_F(OpenFoam, DecompositionsOfOtherCountsAreOfUsersAlone) {
  const std::string dictionary = path("case/system/decomposeParDict");
  for (const int parts : {4, 3, 2}) {
    write_openfoam(examples::mixed_mesh(world, 4, parts), path("case"));
    EXPECT_NE(examples::bytes_of(dictionary).find("numberOfSubdomains " + std::to_string(parts) + ";"),
              std::string::npos);
  }
  const std::string own = "numberOfSubdomains 7; method simple;\n";
  examples::put_bytes(world, dictionary, own);
  write_openfoam(examples::mixed_mesh(world, 4, 3), path("case"));
  EXPECT_EQ(examples::bytes_of(dictionary), own);
}

TEST_F(OpenFoam, OpenMeshesAreRefused) {
  mesh::DistributedMesh open = mesh::examples::mixed_mesh(world, 2, 1);
  for (mesh::Piece& piece : open.pieces)
    piece.boundary = {}, piece.triangle_face = {}, piece.triangle_patch = {};
  const mesh::NumberedMesh numbered = mesh::number_mesh(open);
  try {
    write_openfoam(file_mesh_of(numbered), path("case"));
    ADD_FAILURE();
  } catch (const CollectiveError& error) {
    EXPECT_EQ(error.kind(), parallel::FailureKind::input);
    EXPECT_NE(std::string(error.what()).find("neither a second cell nor a patch"), std::string::npos);
  }
}

TEST(FoamNamesLocal, AreWordsAndDistinct) {
  EXPECT_EQ(foam_words({"wing/left", "wing left", "wing_left", "1st", "", "procBoundary0to1", "Flügel"}),
            (std::vector<std::string>{"wing_left_2", "wing_left_3", "wing_left", "_1st", "unnamed",
                                      "_procBoundary0to1", "Flügel"}));
}

TEST(FoamPatches, HaveNoNameOfAnotherGroup) {
  using enum mesh::PatchType;
  // The only far field may be called so; OpenFOAM has groups of walls and symmetries by itself.
  FoamPatches made =
      foam_patches({{"farfield", farfield}, {"symmetry", symmetry}, {"wing", wall}, {"hub", interior}});
  EXPECT_EQ(made.names, (std::vector<std::string>{"farfield", "symmetry_patch", "wing", "hub"}));
  EXPECT_EQ(made.groups[0], "");
  EXPECT_EQ(made.groups[1], "symmetry");
  EXPECT_EQ(made.groups[2], "wall");
  made = foam_patches({{"inlet", inlet}, {"inlet 2", inlet}, {"wall", slip}, {"wall_patch", wall}});
  EXPECT_EQ(made.names, (std::vector<std::string>{"inlet_patch", "inlet_2", "wall_patch", "wall_patch_2"}));
  EXPECT_EQ(made.groups, (std::vector<std::string>{"inlet", "inlet", "slip", "wall"}));
}

TEST(FoamLabelsLocal, GrowWithTheMesh) {
  EXPECT_EQ(foam_label_bits(1000, 2000, 300, 10000), 32);
  EXPECT_EQ(foam_label_bits(3'000'000'000, 6'000'000'000, 500'000'000, 10000), 64);
  EXPECT_EQ(foam_label_bits(1000, (std::int64_t{1} << 31) - 1, 300, 10000), 64);
}

}  // namespace
}  // namespace aeroloom::io
