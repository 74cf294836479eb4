#include "parallel/storage/task_store.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

namespace aeroloom::parallel {
namespace {

namespace fs = std::filesystem;
using Earlier = TaskStore::Earlier;

class TaskStoreTest : public testing::Test {
protected:
  void SetUp() override {
    std::vector<std::int64_t> process{getpid()};
    world.broadcast_items(process);
    folder = (fs::temp_directory_path() / ("aeroloom_tasks_" + std::to_string(process[0]))).string();
  }
  void TearDown() override {
    world.barrier();
    if (world.is_root()) fs::remove_all(folder);
    world.barrier();
  }
  static Bytes result(std::uint64_t task) { return {100 + task, static_cast<std::byte>(task)}; }
  static Digest key(std::uint64_t task) { return {task, ~task}; }
  /// Task by task, in turn.
  void keep(TaskStore& store, std::uint64_t first, std::uint64_t last) const {
    for (std::uint64_t task = first; task < last; ++task) {
      if (static_cast<Rank>(task % static_cast<std::uint64_t>(world.size())) == world.rank())
        store.keep(key(task), result(task));
    }
    world.barrier();
  }
  std::int64_t files() const { return std::distance(fs::directory_iterator(folder), {}); }

  const Communicator world = Communicator::world();
  const Digest context{1, 2};
  std::string folder;
};

TEST_F(TaskStoreTest, EveryRankFindsWhatAnyRankKept) {
  {
    TaskStore store(world, folder, "zones", context, Earlier::find);
    keep(store, 0, 10);
    EXPECT_FALSE(store.find(key(0)));  // only what an earlier run kept
  }
  TaskStore again(world, folder, "zones", context, Earlier::find);
  keep(again, 10, 12);
  TaskStore third(world, folder, "zones", context, Earlier::find);
  for (std::uint64_t task = 0; task < 12; ++task) EXPECT_EQ(third.find(key(task)), result(task)) << task;
  EXPECT_EQ(third.found(), 12);
  EXPECT_FALSE(third.find(key(12)));
  TaskStore other(world, folder, "zones", {1, 3}, Earlier::find);
  EXPECT_FALSE(other.find(key(1)));
  world.barrier();
  other.remove();
  EXPECT_EQ(files(), 0);
}

TEST_F(TaskStoreTest, ForgetsWhatIsNotAskedFor) {
  TaskStore other(world, folder, "pieces", context, Earlier::find);
  keep(other, 0, 6);
  TaskStore store(world, folder, "zones", context, Earlier::find);
  keep(store, 0, 6);
  const TaskStore anew(world, folder, "zones", context, Earlier::forget);
  TaskStore kept(world, folder, "pieces", context, Earlier::find);
  EXPECT_TRUE(kept.find(key(5)));
  TaskStore gone(world, folder, "zones", context, Earlier::find);
  EXPECT_FALSE(gone.find(key(5)));
}

TEST_F(TaskStoreTest, DamagedAndUnfinishedRecordsAreNotFound) {
  if (!world.is_root()) return;
  const Communicator self = Communicator::self();
  {
    TaskStore store(self, folder, "zones", context, Earlier::find);
    for (std::uint64_t task = 0; task < 3; ++task) store.keep(key(task), result(task));
  }
  const std::string path = folder + "/zones.0.0.tasks";
  std::ifstream stream(path, std::ios::binary);
  const std::string good{std::istreambuf_iterator<char>(stream), {}};
  for (std::size_t at = 0; at < good.size(); ++at) {
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ 1 << at % 8);
    std::ofstream(path, std::ios::binary) << bad;
    TaskStore store(self, folder, "zones", context, Earlier::find);
    for (std::uint64_t task = 0; task < 3; ++task) {
      const std::optional<Bytes> found = store.find(key(task));
      EXPECT_TRUE(!found || *found == result(task)) << "byte " << at;
    }
    EXPECT_LT(store.found(), 3) << "byte " << at;
  }
  for (std::size_t length = 0; length < good.size(); length += 7) {
    std::ofstream(path, std::ios::binary) << good.substr(0, length);
    TaskStore store(self, folder, "zones", context, Earlier::find);
    const std::size_t record = good.size() / 3;
    EXPECT_EQ(store.find(key(0)).has_value(), length > record) << length;
    EXPECT_FALSE(store.find(key(2)));
  }
}

TEST_F(TaskStoreTest, GoesOnWithoutWhereItCannotWrite) {
  TaskStore store(world, folder, "zones", context, Earlier::find);
  world.barrier();
  if (world.is_root()) fs::remove_all(folder);
  world.barrier();
  EXPECT_NO_THROW(store.keep(key(1), result(1)));
  EXPECT_NO_THROW(store.keep(key(2), result(2)));
}

TEST(DigestLocal, DependsOnAllBytesAndNotOnTheirDivision) {
  const Bytes bytes{std::byte{1}, std::byte{2}, std::byte{3}};
  const auto part = [&](std::size_t from, std::size_t count) {
    return std::span<const std::byte>(bytes).subspan(from, count);
  };
  EXPECT_EQ(digest_of(bytes), Digester().bytes(part(0, 1)).bytes(part(1, 2)).result());
  EXPECT_NE(digest_of(bytes), digest_of(part(0, 2)));
  EXPECT_NE(Digester().text("ab").text("c").result(), Digester().text("a").text("bc").result());
  EXPECT_EQ(digest_of(bytes).text().size(), 32U);
}

}  // namespace
}  // namespace aeroloom::parallel
