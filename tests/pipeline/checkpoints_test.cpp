// Checkpoints within one process: what is kept and found again, by other ranks, where files are damaged, of
// other cases, and where nothing can be kept.
#include "tests/pipeline/command_line.hpp"
#include "tests/source_tree.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace aeroloom::pipeline {
namespace {

namespace fs = std::filesystem;

using Names = std::vector<std::string>;
const Names stages = {"geometry", "sizing", "surface", "volume", "improve"};
/// The volume goes when the improved one is there.
const Names kept = {"geometry", "improve", "sizing", "surface"};

class CheckpointedRuns : public CommandLine {
protected:
  void SetUp() override {
    CommandLine::SetUp();
    write("case.yaml", coarse_duct() + "surface: {piece_triangles: 200}\nvolume: {piece_tets: 800}\n");
  }
  /// Stages that the last run has found.
  Names resumed() const { return read_json("out/report.json")["resumed"].get<Names>(); }
  std::string hash() const { return read_json("out/report.json")["mesh"]["hash"]; }
  void expect_kept() const {
    Names names;
    for (const auto& entry : fs::directory_iterator(folder / "out" / "checkpoint"))
      names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    Names wanted;
    for (const std::string& stage : kept) wanted.push_back(stage + ".checkpoint");
    EXPECT_EQ(names, wanted);
    world.barrier();
  }
  std::string checkpoint(const std::string& stage) const { return "out/checkpoint/" + stage + ".checkpoint"; }
};

TEST_F(CheckpointedRuns, FindWhatOthersHaveLeftOnAnotherNumberOfRanks) {
  expect(0, "run case.yaml");
  EXPECT_FALSE(exists("out/checkpoint"));
  EXPECT_EQ(resumed(), Names());
  const std::string wanted = hash();
  expect(0, "run case.yaml --resume");
  EXPECT_EQ(hash(), wanted);
  EXPECT_EQ(resumed(), Names()) << "nothing was there";
  expect_kept();
  const CommandResult alone = run_alone("run case.yaml --resume");
  EXPECT_EQ(alone.code, 0) << alone;
  EXPECT_EQ(hash(), wanted);
  EXPECT_EQ(resumed(), stages);
  expect(0, "run case.yaml --set output.checkpoints=resume");
  EXPECT_EQ(hash(), wanted);
  EXPECT_EQ(resumed(), stages);
}

// Any bit of any file: that stage is done anew, the mesh is the same. The warning comes once more at the end.
TEST_F(CheckpointedRuns, MakeDamagedStagesAnew) {
  expect(0, "run case.yaml --checkpoints");
  const std::string wanted = hash();
  std::mt19937 random(5);
  for (const std::string& stage : kept) {
    std::string bytes = read(checkpoint(stage));
    const std::size_t bit = random() % (8 * bytes.size());
    bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ 1 << bit % 8);
    write(checkpoint(stage), bytes);
    const CommandResult ended = expect(0, "run case.yaml --resume", {"stage " + stage + " is done anew"});
    EXPECT_EQ(hash(), wanted) << stage << ", bit " << bit;
    EXPECT_EQ(count_of("is damaged", ended.text()), 2) << "bit " << bit << ": " << ended;
    const Names found = resumed();
    EXPECT_EQ(std::count(found.begin(), found.end(), stage), 0) << stage;
  }
  const std::string bytes = read(checkpoint("improve"));
  write(checkpoint("improve"), bytes.substr(0, bytes.size() - 1));
  expect(0, "run case.yaml --resume", {"is damaged"});
  EXPECT_EQ(hash(), wanted);
}

TEST_F(CheckpointedRuns, GoOnWhereACaseDiffersAndRefuseAnotherGeometry) {
  expect(0, "run case.yaml --checkpoints");
  const std::string other = "run case.yaml --resume --set improve.target_angle=20";
  expect(0, other, {"improve.target_angle: 28, in the case 20"});
  EXPECT_EQ(resumed(), Names(stages.begin(), stages.begin() + 3));
  for (const std::string name :
       {"improve.0.0.tasks", "volume.checkpoint"})  // as if killed before they were removed
    write("out/checkpoint/" + name, "left over");
  expect(0, other);
  EXPECT_EQ(resumed(), stages);
  expect_kept();

  std::ifstream stream(source_tree() / "configs" / "geometry" / "duct.step", std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  const std::string moved = " --set geometry.file=" + write("other.step", bytes + "\n");
  expect(2, "run case.yaml --resume" + moved, {"of another geometry", "Remedy"});
  expect(0, "run case.yaml --checkpoints" + moved);
  EXPECT_EQ(resumed(), Names());
  expect_kept();
}

TEST_F(CheckpointedRuns, GoOnWhereNothingCanBeKept) {
  expect(0, "run case.yaml");
  const std::string wanted = hash();
  write("out/checkpoint", "in the way");
  expect(0, "run case.yaml --checkpoints", {"nothing is kept for another run"});
  EXPECT_EQ(hash(), wanted);
}

}  // namespace
}  // namespace aeroloom::pipeline
