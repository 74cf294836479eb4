// A case as a mesh in memory, for host programs.
#include "pipeline/mesh_case.hpp"

#include "mesh/checks/validity.hpp"
#include "parallel/communication/collective_error.hpp"
#include "tests/pipeline/command_line.hpp"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace aeroloom::pipeline {
namespace {

class MeshCase : public CommandLine {
protected:
  /// Files in the folder besides the case.
  std::int64_t files() const {
    const auto all = std::filesystem::recursive_directory_iterator(folder);
    return std::count_if(begin(all), end(all),
                         [](const auto& each) { return each.path().extension() != ".yaml"; });
  }
  std::string layered() const { return coarse_duct() + "layers: {first: 0.004, growth: 1.4, count: 3}\n"; }
};

TEST_F(MeshCase, IsTheMeshThatARunWrites) {
  const std::string file = write("case.yaml", layered());
  const MeshOfCase made = pipeline::run(read_case(world, file), world);
  EXPECT_EQ(made.missed, "");
  EXPECT_GT(made.unit_in_metres, 0);
  EXPECT_EQ(made.hash, mesh::hash_mesh(made.mesh));
  EXPECT_TRUE(mesh::check_volume_mesh(made.mesh, nullptr).valid());
  std::int64_t prisms = 0, in_layers = 0;
  for (const mesh::Piece& piece : made.mesh.pieces) {
    prisms += static_cast<std::int64_t>(piece.prisms.size() / 6);
    in_layers +=
        std::count_if(piece.layers.begin(), piece.layers.end(), [](std::int16_t layer) { return layer > 0; });
  }
  EXPECT_GT(world.sum(prisms), 1000);
  EXPECT_GE(world.sum(in_layers), world.sum(prisms));
  EXPECT_EQ(made.mesh.patch_types.size(), made.mesh.patches.size());
  world.barrier();
  EXPECT_EQ(files(), 0);
  world.barrier();
  expect(0, "run case.yaml");
  const nlohmann::json report = read_json("out/report.json");
  EXPECT_EQ(report["mesh"]["hash"], made.hash);
  EXPECT_EQ(report["mesh"]["prisms"], world.sum(prisms));
}

// A mesh below its limits is there, and the limits are named.
TEST_F(MeshCase, NamesTheLimitsThatItMisses) {
  const std::string file = write("case.yaml", coarse_duct());
  const MeshOfCase made = pipeline::run(
      read_case(world, file, {"improve.gate.smallest_angle=60", "sizing.target_tetrahedra=500"}), world);
  EXPECT_NE(made.missed.find("smallest_angle"), std::string::npos) << made.missed;
  EXPECT_GT(made.mesh.numbering.cell_count, 100);
}

TEST_F(MeshCase, FailuresHaveTheStageAndTheCodeOfARun) {
  const std::string file = write("case.yaml", coarse_duct());
  try {
    pipeline::run(read_case(world, file, {"patches.lost.faces=nowhere"}), world);
    ADD_FAILURE() << "no failure";
  } catch (const CaseFailure& failure) {
    EXPECT_EQ(failure.code(), 2) << failure.what();
    EXPECT_EQ(failure.stage(), "geometry") << failure.what();
    EXPECT_NE(std::string(failure.what()).find("nowhere"), std::string::npos) << failure.what();
  }
  EXPECT_THROW(read_case(world, file, {"sizing.minimum=-1"}), parallel::CollectiveError);
  EXPECT_THROW(read_case(world, path("nowhere.yaml")), parallel::CollectiveError);
  EXPECT_EQ(files(), 0);
}

}  // namespace
}  // namespace aeroloom::pipeline
