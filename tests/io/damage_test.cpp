#include "tests/io/damage.hpp"

#include "tests/io/scratch_folder.hpp"

#include <filesystem>
#include <string>

#include <gtest/gtest-spi.h>
#include <gtest/gtest.h>

namespace aeroloom::io {
namespace {

using parallel::Communicator;

/// A file of this test: a count, then so many bytes.
std::string good_file() {
  return std::string("\x10\0\0\0\0\0\0\0", 8) + "sixteen letters!";
}

class Damage : public examples::ScratchFolder {};

/// Reads such a file on rank 0 with or without a look at its size.
void read_counted(const Communicator& communicator, const std::string& path, bool careful) {
  parallel::agree(communicator, [&] {
    if (!communicator.is_root()) return;
    const std::string bytes = examples::bytes_of(path);
    if (bytes.size() < 8) throw std::runtime_error("'" + path + "' ends before its count");
    std::uint64_t count = 0;
    std::memcpy(&count, bytes.data(), 8);
    if (careful && count != bytes.size() - 8) throw std::runtime_error("'" + path + "': the count is wrong");
    if (count > std::uint64_t{1} << 62) throw std::bad_alloc();
  });
}

TEST_F(Damage, IsNoMatterToAReaderThatLooksFirst) {
  const std::string file = path("damaged");
  const damage::Outcome outcome =
      damage::survive(world, good_file(), file, [&](const std::string& p) { read_counted(world, p, true); });
  EXPECT_EQ(outcome.cases, outcome.refused + outcome.accepted);
  EXPECT_GT(outcome.cases, 50);
  EXPECT_GT(outcome.refused, outcome.cases / 5);
  EXPECT_GT(outcome.accepted, outcome.cases / 10) << "changed letters do not matter";
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST_F(Damage, ShowsAReaderThatTrustsItsCounts) {
  if (!world.is_root()) return;
  const auto self = Communicator::self();
  const std::string file = path("damaged");
  testing::TestPartResultArray failures;
  {
    const testing::ScopedFakeTestPartResultReporter reporter(
        testing::ScopedFakeTestPartResultReporter::INTERCEPT_ALL_THREADS, &failures);
    damage::survive(self, good_file(), file, [&](const std::string& p) { read_counted(self, p, false); });
  }
  ASSERT_GT(failures.size(), 0);
  EXPECT_NE(std::string(failures.GetTestPartResult(0).message()).find("kind 2"), std::string::npos)
      << failures.GetTestPartResult(0).message();
}

}  // namespace
}  // namespace aeroloom::io
