#include "parallel/communication/collective_error.hpp"

#include <filesystem>
#include <fstream>
#include <new>

#include <gtest/gtest.h>

namespace aeroloom::parallel {
namespace {

class AgreeTest : public testing::Test {
protected:
  /// The error every rank must have got; checks that they all got the same.
  CollectiveError error_of(const std::function<void()>& work) {
    std::string text;
    FailureKind kind{};
    bool thrown = false;
    try {
      agree(world, work);
    } catch (const CollectiveError& error) {
      thrown = true;
      text = error.what();
      kind = error.kind();
    }
    EXPECT_TRUE(thrown);
    Bytes bytes = to_bytes(std::span<const char>(text));
    for (const Bytes& other : world.all_gather(bytes)) EXPECT_EQ(other, bytes);
    EXPECT_EQ(world.minimum(static_cast<std::int64_t>(kind)), world.maximum(static_cast<std::int64_t>(kind)));
    return CollectiveError(kind, text);
  }

  const Communicator world = Communicator::world();
  const Rank rank = world.rank();
  const int size = world.size();
};

TEST_F(AgreeTest, PassesWhenNobodyThrows) {
  int done = 0;
  agree(world, [&] { ++done; });
  EXPECT_EQ(done, 1);
}

TEST_F(AgreeTest, TellsEveryRankOfOneFailure) {
  for (Rank failing = 0; failing < size; ++failing) {
    const auto error = error_of([&] {
      if (rank == failing) throw std::runtime_error("face 'wing' of rank " + std::to_string(failing));
    });
    EXPECT_EQ(error.what(), "face 'wing' of rank " + std::to_string(failing));
    EXPECT_EQ(error.kind(), FailureKind::input);
  }
}

TEST_F(AgreeTest, SpeaksForTheLowestOfSeveral) {
  const auto error = error_of([&] {
    if (rank > 0 || size == 1) throw std::runtime_error("rank " + std::to_string(rank));
  });
  std::string expected = size == 1 ? "rank 0" : "rank 1";
  if (size == 3) expected += " (1 other rank failed as well)";
  if (size > 3) expected += " (" + std::to_string(size - 2) + " other ranks failed as well)";
  EXPECT_EQ(error.what(), expected);
}

TEST_F(AgreeTest, PassesNestedErrorsThrough) {
  const auto error = error_of([&] {
    agree(world, [&] {
      if (rank == size - 1) throw std::runtime_error("inner");
    });
  });
  EXPECT_STREQ(error.what(), "inner");
  agree(world, [] {});  // the ranks are still in step
}

TEST_F(AgreeTest, ClassifiesCauses) {
  EXPECT_EQ(error_of([] { throw std::bad_alloc(); }).kind(), FailureKind::resources);
  EXPECT_EQ(error_of([] { throw std::logic_error("x"); }).kind(), FailureKind::bug);
  EXPECT_EQ(error_of([] { throw std::runtime_error("x"); }).kind(), FailureKind::input);
  EXPECT_EQ(error_of([] { throw 7; }).kind(), FailureKind::bug);
  EXPECT_EQ(error_of([] { (void)std::filesystem::file_size("/nowhere/at/all"); }).kind(), FailureKind::files);
  EXPECT_EQ(error_of([] {
              std::ifstream stream;
              stream.exceptions(std::ios::failbit);
              stream.open("/nowhere/at/all");
            }).kind(),
            FailureKind::files);
}

TEST_F(AgreeTest, KindAndTextComeFromTheSameRank) {
  if (size == 1) GTEST_SKIP() << "needs two ranks";
  const auto error = error_of([&] {
    if (rank == 0) throw std::logic_error("a bug");
    throw std::runtime_error("an input");
  });
  EXPECT_EQ(error.kind(), FailureKind::bug);
  EXPECT_EQ(std::string(error.what()).rfind("a bug", 0), 0u);
}

}  // namespace
}  // namespace aeroloom::parallel
