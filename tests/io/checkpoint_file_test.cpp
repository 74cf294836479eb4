#include "io/checkpoint_file.hpp"

#include "parallel/communication/collective_error.hpp"
#include "tests/io/scratch_folder.hpp"
#include "tests/several_ranks.hpp"

#include <random>
#include <utility>

namespace aeroloom::io {
namespace {

using parallel::Bytes;
using parallel::CollectiveError;

Bytes bytes_of_number(std::int64_t number, std::size_t count) {
  std::mt19937_64 random(static_cast<std::uint64_t>(number));
  Bytes bytes(count);
  for (std::byte& byte : bytes) byte = static_cast<std::byte>(random());
  return bytes;
}

class CheckpointFile : public examples::ScratchFolder {
protected:
  static constexpr std::size_t texts = 2;
  const CheckpointLabel label{{7, 9}, {"a text", ""}};

  /// Item i has i * 37 bytes and lies on rank i modulo the ranks; a common part beside them.
  CheckpointDraft draft(std::int64_t items) const {
    CheckpointDraft made;
    made.common = bytes_of_number(-1, 100);
    for (std::int64_t i = items - 1; i >= 0; --i) {
      if (i % world.size() != world.rank()) continue;
      made.items.push_back({i, [i] { return bytes_of_number(i, 37 * static_cast<std::size_t>(i)); }});
    }
    return made;
  }
};

TEST_F(CheckpointFile, GivesBackWhatWasWritten) {
  EXPECT_FALSE(read_checkpoint_label({world, path("c")}, texts));
  EXPECT_THROW(read_checkpoint({world, path("c")}), CollectiveError);
  write_checkpoint({world, path("c")}, label, draft(20));
  const auto found = read_checkpoint_label({world, path("c")}, texts);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->key, label.key);
  EXPECT_EQ(found->about, label.about);
  EXPECT_FALSE(read_checkpoint_label({world, path("c")}, texts + 1));

  const CheckpointContent content = read_checkpoint({world, path("c")});
  EXPECT_EQ(content.common, bytes_of_number(-1, 100));
  std::int64_t last = -1;
  for (const CheckpointContent::Item& item : content.items) {
    EXPECT_GT(item.number, last);
    last = item.number;
    EXPECT_EQ(item.bytes, bytes_of_number(item.number, 37 * static_cast<std::size_t>(item.number)));
  }
  EXPECT_EQ(world.sum(static_cast<std::int64_t>(content.items.size())), 20);
}

TEST_F(CheckpointFile, TheSameBytesOnAnyNumberOfRanks) {
  NEEDS_SEVERAL_RANKS();
  write_checkpoint({world, path("all")}, label, draft(20));
  if (world.is_root()) {
    CheckpointDraft whole = draft(0);
    for (std::int64_t i = 0; i < 20; ++i)
      whole.items.push_back({i, [i] { return bytes_of_number(i, 37 * static_cast<std::size_t>(i)); }});
    write_checkpoint({parallel::Communicator::self(), path("one")}, label, whole);
    EXPECT_EQ(examples::bytes_of(path("all")), examples::bytes_of(path("one")));
  }
}

TEST_F(CheckpointFile, TheOldOneStaysWhereTheNewOneCannotBeWritten) {
  write_checkpoint({world, path("c")}, label, draft(3));
  CheckpointDraft failing = draft(3);
  bool asked = false;  // the first time for its digest
  failing.items.push_back({50 + world.rank(), [&asked]() -> Bytes {
                             if (std::exchange(asked, true)) throw std::ios_base::failure("full");
                             return Bytes(10);
                           }});
  EXPECT_THROW(write_checkpoint({world, path("c")}, {{1, 1}, {}}, failing), CollectiveError);
  EXPECT_EQ(read_checkpoint_label({world, path("c")}, texts)->key, label.key);
  EXPECT_NO_THROW(read_checkpoint({world, path("c")}));
  world.barrier();
  if (world.is_root()) {
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      EXPECT_EQ(entry.path().filename(), "c");
  }
}

TEST_F(CheckpointFile, AnyBitThatTurnsIsRefused) {
  write_checkpoint({world, path("c")}, label, draft(8));
  const std::string good = examples::bytes_of(path("c"));
  std::mt19937 random(3);
  constexpr int trials = 1000;
  for (int trial = 0; trial < trials; ++trial) {
    std::string bad = good;
    // The first bits one by one: they are the beginning and the header, on which all else stands.
    const std::size_t bit = trial < 500 ? static_cast<std::size_t>(trial) : random() % (8 * good.size());
    bad[bit / 8] = static_cast<char>(bad[bit / 8] ^ 1 << bit % 8);
    examples::put_bytes(world, path("c"), bad);
    EXPECT_THROW(read_checkpoint({world, path("c")}), CollectiveError) << "bit " << bit;
    world.barrier();
  }
}

TEST_F(CheckpointFile, AnyEndThatIsMissingIsRefused) {
  write_checkpoint({world, path("c")}, label, draft(4));
  const std::string good = examples::bytes_of(path("c"));
  for (std::size_t length = 0; length < good.size(); length += 11) {
    examples::put_bytes(world, path("c"), good.substr(0, length));
    EXPECT_THROW(read_checkpoint({world, path("c")}), CollectiveError) << length << " bytes";
    world.barrier();
  }
  examples::put_bytes(world, path("c"), good + "x");
  EXPECT_THROW(read_checkpoint({world, path("c")}), CollectiveError);
}

}  // namespace
}  // namespace aeroloom::io
