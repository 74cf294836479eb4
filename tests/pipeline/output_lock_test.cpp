// One run at a time in a folder: who comes second is told of the first, and what a killed run leaves is no
// hindrance.
#include "pipeline/output_lock.hpp"

#include "parallel/communication/collective_error.hpp"
#include "tests/pipeline/command_line.hpp"

#include <filesystem>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace aeroloom::pipeline {
namespace {

class OutputLockTest : public CommandLine {
protected:
  /// The message of a lock that cannot be had; empty where it can.
  std::string refusal(const std::string& place) const {
    try {
      const OutputLock lock(world, place);
      return {};
    } catch (const parallel::CollectiveError& error) {
      EXPECT_EQ(error.kind(), parallel::FailureKind::files);
      return error.what();
    }
  }
};

TEST_F(OutputLockTest, TellsTheSecondOfTheFirst) {
  std::optional<OutputLock> first;
  first.emplace(world, folder.string());
  EXPECT_TRUE(exists(".lock"));
  std::int64_t holder = getpid();
  if (!world.is_root()) holder = 0;
  holder = world.sum(holder);
  const std::string text = refusal(folder.string());
  EXPECT_NE(text.find(fmt::format("another run writes there (process {} on ", holder)), std::string::npos)
      << text;
  EXPECT_NE(text.find("Remedy"), std::string::npos) << text;
  EXPECT_TRUE(exists(".lock")) << "the refused one leaves it";
  world.barrier();
  first.reset();
  world.barrier();
  EXPECT_FALSE(exists(".lock"));
  world.barrier();
  EXPECT_EQ(refusal(folder.string()), "");
}

TEST_F(OutputLockTest, IsHadWhereAKilledRunHasLeftItsFile) {
  write(".lock", "process 1 on nowhere\n");
  EXPECT_EQ(refusal(folder.string()), "");
  world.barrier();
  EXPECT_FALSE(exists(".lock"));
}

TEST_F(OutputLockTest, IsOfOneFolderAlone) {
  write("other/file", "");
  const OutputLock first(world, folder.string());
  EXPECT_EQ(refusal(path("other")), "");
}

TEST_F(OutputLockTest, FollowsNoLink) {
  const std::string precious = write("precious", "precious");
  at_root([&] { std::filesystem::create_symlink(precious, path(".lock")); });
  EXPECT_NE(refusal(folder.string()).find("cannot lock"), std::string::npos);
  EXPECT_EQ(read("precious"), "precious");
  EXPECT_NE(refusal(path("nowhere")).find("cannot lock"), std::string::npos);
}

TEST_F(OutputLockTest, RefusesCommandsThatWouldWriteThere) {
  write("case.yaml", coarse_duct());
  write("out/note", "");
  const OutputLock first(world, path("out"));
  const CommandResult ended = expect(7, "run case.yaml");
  EXPECT_NE(ended.err.find("output.directory: "), std::string::npos) << ended;
  EXPECT_NE(ended.err.find("another run writes there (process"), std::string::npos) << ended;
  EXPECT_FALSE(exists("out/report.json")) << "the report of the first is not replaced";
}

}  // namespace
}  // namespace aeroloom::pipeline
