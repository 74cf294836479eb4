#include "io/shared_path.hpp"
#include "io/streams/range_reader.hpp"
#include "io/streams/range_writer.hpp"
#include "io/streams/text_lines.hpp"
#include "tests/io/scratch_folder.hpp"

#include <stdexcept>

namespace aeroloom::io {
namespace {

using Streams = examples::ScratchFolder;

TEST_F(Streams, NumbersBeyondFourGigabytesComeBackInEitherOrder) {
  constexpr std::int64_t far = std::int64_t{5} << 30;
  for (const ByteOrder order : {ByteOrder::little, ByteOrder::big}) {
    // Nothing lies between the numbers: the file takes a page or two for each rank.
    parallel::write_shared_file(world, path("sparse"), [&](parallel::SharedFile& file) {
      RangeWriter writer(file, order);
      writer.move_to(far + 16 * world.rank());
      writer.put(0.1 + world.rank());
      writer.put(std::int64_t{7} * world.rank());
      writer.flush();
    });
    RangeReader reader(path("sparse"));
    reader.set_order(order);
    EXPECT_EQ(reader.size(), far + 16 * world.size());
    for (int rank = 0; rank < world.size(); ++rank) {
      EXPECT_EQ(reader.value<double>(far + 16 * rank), 0.1 + rank);
      EXPECT_EQ(reader.value<std::int64_t>(far + 16 * rank + 8), 7 * rank);
    }
    EXPECT_THROW(reader.value<std::int64_t>(reader.size() - 7), std::runtime_error);
    EXPECT_EQ(reader.bytes_from(far), 16 * world.size());
    EXPECT_EQ(reader.bytes_from(2 * far), 0);
    world.barrier();
  }
}

TEST_F(Streams, MoreThanABufferIsWrittenInTurn) {
  constexpr std::int64_t count = 3 * static_cast<std::int64_t>(RangeWriter::buffer_bytes) / 8 + 5;
  parallel::write_shared_file(world, path("long"), [&](parallel::SharedFile& file) {
    if (!world.is_root()) return;
    RangeWriter writer(file);
    writer.move_to(3);
    for (std::int64_t i = 0; i < count; ++i) writer.put(i);
    writer.put_text(std::string(2 * RangeWriter::buffer_bytes, 'x'));
    writer.flush();
  });
  RangeReader reader(path("long"));
  EXPECT_EQ(reader.size(), 3 + 8 * count + 2 * static_cast<std::int64_t>(RangeWriter::buffer_bytes));
  std::vector<std::int64_t> numbers(count);
  reader.read(3, std::span<std::int64_t>(numbers));
  for (std::int64_t i = 0; i < count; ++i) ASSERT_EQ(numbers[static_cast<std::size_t>(i)], i);
  EXPECT_EQ(reader.value<char>(reader.size() - 1), 'x');
}

TEST_F(Streams, LinesAreTheSameAcrossBuffers) {
  std::string text;
  std::vector<std::string> wanted;
  for (int i = 0; i < 60000; ++i) {
    wanted.push_back(std::string(static_cast<std::size_t>(i % 97), 'a') + std::to_string(i));
    text += wanted.back() + (i % 3 == 0 ? "\r\n" : "\n");
  }
  wanted.push_back("without an end");
  examples::put_bytes(world, path("lines"), text + wanted.back());
  TextLines lines(path("lines"));
  for (const std::string& line : wanted) {
    ASSERT_TRUE(lines.next());
    ASSERT_EQ(lines.line(), line);
  }
  EXPECT_EQ(lines.number(), static_cast<std::int64_t>(wanted.size()));
  EXPECT_FALSE(lines.next());
  EXPECT_FALSE(lines.next());
}

TEST_F(Streams, LinesAreAsLongAsTheReaderAllows) {
  const std::string longest(TextLines::longest_line, 'a');
  examples::put_bytes(world, path("limit"), longest + "\n" + longest + "b\n");
  TextLines short_lines(path("limit"));
  ASSERT_TRUE(short_lines.next());
  EXPECT_EQ(short_lines.line(), longest);
  EXPECT_THROW(short_lines.next(), std::runtime_error);
  const std::string huge(std::size_t{5} << 20, 'c');
  examples::put_bytes(world, path("huge"), "first\n" + huge + "\r\nlast");
  TextLines lines(path("huge"), huge.size() + 1);
  for (const std::string& line : {std::string("first"), huge, std::string("last")}) {
    ASSERT_TRUE(lines.next());
    EXPECT_TRUE(lines.line() == line) << lines.number();
  }
  EXPECT_FALSE(lines.next());
}

TEST_F(Streams, PlainFilesAloneAreRead) {
  EXPECT_THROW(RangeReader(path("none")), std::filesystem::filesystem_error);
  EXPECT_THROW(RangeReader(folder.string()), std::filesystem::filesystem_error);
  EXPECT_THROW(RangeReader("/dev/zero"), std::filesystem::filesystem_error);
}

TEST(LocalRangeLocal, OfAnyCountIsWhole) {
  for (const std::int64_t count :
       {std::int64_t{0}, std::int64_t{2}, std::int64_t{10}, std::int64_t{1} << 62}) {
    for (const int size : {1, 3, 7}) {
      std::int64_t next = 0;
      for (int rank = 0; rank < size; ++rank) {
        const LocalRange range = LocalRange::of(count, rank, size);
        EXPECT_EQ(range.begin, next);
        EXPECT_LE(range.count(), count / size + 1);
        next = range.end;
      }
      EXPECT_EQ(next, count);
    }
  }
}

TEST(NumbersLocal, AreWholeWords) {
  std::int64_t integer = 0;
  double real = 0;
  EXPECT_TRUE(parse_number("-12", integer) && integer == -12);
  EXPECT_TRUE(parse_number("+1.5E-3", real) && real == 1.5e-3);
  EXPECT_TRUE(parse_number("0.1", real) && real == 0.1);
  for (const char* bad : {"", "+", "-", "1x", "1.5", "9223372036854775808", "0x10", " 1"})
    EXPECT_FALSE(parse_number(bad, integer)) << bad;
  for (const char* bad : {"", "1,5", "1.5.", "e5", "1e999"}) EXPECT_FALSE(parse_number(bad, real)) << bad;
}

}  // namespace
}  // namespace aeroloom::io
