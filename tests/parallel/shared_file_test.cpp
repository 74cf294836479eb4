#include "parallel/storage/shared_file.hpp"

#include "parallel/communication/collective_error.hpp"

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

namespace aeroloom::parallel {
namespace {

namespace fs = std::filesystem;

/// A path that all ranks agree on.
std::string scratch(const Communicator& world, const std::string& name) {
  std::vector<std::int64_t> process{getpid()};
  world.broadcast_items(process);
  return (fs::temp_directory_path() / ("aeroloom_shared_" + std::to_string(process[0])) / name).string();
}

TEST(SharedFile, EveryRankWritesItsPlace) {
  const Communicator world = Communicator::world();
  const std::string path = scratch(world, "numbers");
  write_shared_file(world, path, [&](SharedFile& file) {
    const std::vector<std::int64_t> mine(3, world.rank());
    file.write_items(static_cast<std::int64_t>(24) * world.rank(), std::span<const std::int64_t>(mine));
  });
  EXPECT_EQ(fs::file_size(path), 24U * static_cast<unsigned>(world.size()));
  EXPECT_FALSE(fs::exists(path + ".unfinished"));
  std::ifstream stream(path, std::ios::binary);
  for (int rank = 0; rank < world.size(); ++rank) {
    std::int64_t values[3];
    stream.read(reinterpret_cast<char*>(values), sizeof values);
    EXPECT_EQ(values[2], rank);
  }
  world.barrier();
  if (world.is_root()) fs::remove_all(fs::path(path).parent_path());
}

TEST(SharedFile, WhatFailsAnywhereLeavesWhatWasThere) {
  const Communicator world = Communicator::world();
  const std::string path = scratch(world, "half");
  if (world.is_root()) {
    fs::create_directories(fs::path(path).parent_path());
    std::ofstream(path) << "old";
  }
  world.barrier();
  const auto work = [&](SharedFile& file) {
    const std::vector<char> some(100, 'x');
    file.write_items(100 * world.rank(), std::span<const char>(some));
    if (world.rank() == world.size() - 1) throw fs::filesystem_error("full", std::error_code());
  };
  EXPECT_THROW(write_shared_file(world, path, work), CollectiveError);
  std::string word;
  EXPECT_TRUE(std::ifstream(path) >> word);
  EXPECT_EQ(word, "old");
  EXPECT_FALSE(fs::exists(path + ".unfinished"));
  world.barrier();
  if (world.is_root()) fs::remove_all(fs::path(path).parent_path());
}

TEST(SharedFile, AFileThatCannotTakeItsNameIsGone) {
  const Communicator world = Communicator::world();
  const std::string path = scratch(world, "taken");
  const auto work = [&](SharedFile& file) {
    const std::vector<char> some(100, 'x');
    file.write_items(100 * world.rank(), std::span<const char>(some));
    if (world.is_root()) fs::create_directories(fs::path(path) / "inside");
  };
  EXPECT_THROW(write_shared_file(world, path, work), CollectiveError);
  EXPECT_TRUE(fs::is_directory(path));
  EXPECT_FALSE(fs::exists(path + ".unfinished"));
  world.barrier();
  if (world.is_root()) fs::remove_all(fs::path(path).parent_path());
}

TEST(SharedFile, NoRoomIsAnErrorAndNoFile) {
  const Communicator world = Communicator::world();
  const std::string path = scratch(world, "full");
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{1 << 16, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const auto work = [&](SharedFile& file) {
    const std::vector<char> some(1 << 20, 'x');
    file.write_items((1 << 20) * world.rank(), std::span<const char>(some));
  };
  EXPECT_THROW(write_shared_file(world, path, work), CollectiveError);
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_FALSE(fs::exists(path));
  EXPECT_FALSE(fs::exists(path + ".unfinished"));
  world.barrier();
  if (world.is_root()) fs::remove_all(fs::path(path).parent_path());
}

TEST(SharedFile, AFolderThatCannotBeMadeIsSaidOnAllRanks) {
  const Communicator world = Communicator::world();
  const auto work = [&](SharedFile& file) {
    const std::vector<char> some(1 << 20, 'x');
    file.write_items(0, std::span<const char>(some));
  };
  // A folder that cannot be made, whoever runs this.
  try {
    write_shared_file(world, "/proc/aeroloom/file", work);
    ADD_FAILURE() << "no error";
  } catch (const CollectiveError& error) {
    EXPECT_EQ(error.kind(), FailureKind::files);
    EXPECT_NE(std::string(error.what()).find("/proc/aeroloom"), std::string::npos);
  }
}

}  // namespace
}  // namespace aeroloom::parallel
