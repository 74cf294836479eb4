/// A folder for the files of a test, and the bytes of files.
#pragma once

#include "parallel/communication/communicator.hpp"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

namespace aeroloom::io::examples {

/// A folder of this test program alone, the same on every rank, empty at the start of each test, removed at
/// its end.
class ScratchFolder : public testing::Test {
protected:
  void SetUp() override {
    const auto id = world.sum(world.is_root() ? static_cast<std::int64_t>(getpid()) : 0);
    folder = std::filesystem::temp_directory_path() / ("aeroloom_io_" + std::to_string(id));
    if (world.is_root()) {
      std::filesystem::remove_all(folder);
      std::filesystem::create_directories(folder);
    }
    world.barrier();
  }
  void TearDown() override {
    world.barrier();
    if (world.is_root()) std::filesystem::remove_all(folder);
    world.barrier();
  }
  std::string path(const std::string& name) const { return (folder / name).string(); }

  const parallel::Communicator world = parallel::Communicator::world();
  std::filesystem::path folder;
};

inline std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// All files below a folder with their bytes.
inline std::map<std::string, std::string> files_below(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file())
      files[std::filesystem::relative(entry.path(), folder).string()] = bytes_of(entry.path());
  }
  return files;
}

/// Rank 0 writes, all wait.
inline void put_bytes(const parallel::Communicator& world, const std::string& path,
                      const std::string& bytes) {
  world.barrier();
  if (world.is_root()) std::ofstream(path, std::ios::binary) << bytes;
  world.barrier();
}

}  // namespace aeroloom::io::examples
