#include "pipeline/commands/plain_words.hpp"
#include "pipeline/shown_changes.hpp"

#include <filesystem>
#include <ios>

#include <gtest/gtest.h>

namespace aeroloom::pipeline {
namespace {

const std::error_code absent = std::make_error_code(std::errc::no_such_file_or_directory);

TEST(PlainWordsTest, NamesTheFileFirst) {
  const std::filesystem::filesystem_error error("cannot read", "a [1]/b", absent);
  const std::filesystem::filesystem_error simple("cannot read", "a/b", absent);
  EXPECT_EQ(plain_words(simple.what()), "cannot read 'a/b': No such file or directory");
  EXPECT_EQ(
      plain_words("stage output failed: " + std::string(simple.what()) + " (2 other ranks failed as well)"),
      "stage output failed: cannot read 'a/b': No such file or directory (2 other ranks failed as well)");
  EXPECT_NE(plain_words(error.what()).find("No such file or directory"), std::string::npos);
}

TEST(PlainWordsTest, NamesBothFiles) {
  const std::filesystem::filesystem_error error("cannot rename", "a", "b", absent);
  EXPECT_EQ(plain_words(error.what()), "cannot rename 'a' to 'b': No such file or directory");
}

TEST(PlainWordsTest, LeavesOutWhatIsNoReason) {
  EXPECT_EQ(plain_words(std::ios_base::failure("cannot write 'x'").what()), "cannot write 'x'");
}

TEST(PlainWordsTest, LeavesOtherTexts) {
  for (const char* text : {"", "patches.wing: no face [1] is like 'wing'", "filesystem error: odd",
                           "filesystem error: odd [", "filesystem error: no colon [a]"}) {
    EXPECT_EQ(plain_words(text), text);
  }
}

TEST(ShownChangesTest, ShowsThoseThatMovedMost) {
  cad::Changes changes;
  for (int i = 0; i < 7; ++i) changes.push_back({"change " + std::to_string(i), {}, i == 4 ? 9.0 : 1.0});
  const std::vector<std::string> lines = shown_changes(changes, "the list");
  ASSERT_EQ(lines.size(), 4u);
  EXPECT_EQ(lines[0], "change 4, moved by at most 9");
  EXPECT_EQ(lines[1], "change 0, moved by at most 1");
  EXPECT_EQ(lines[3], "4 more, which moved less, are in the list");
}

TEST(ShownChangesTest, ShowsAllOfAFew) {
  EXPECT_TRUE(shown_changes({}, "the list").empty());
  EXPECT_EQ(shown_changes({{"b", {}, 1}, {"a", {}, 2}}, "the list").front(), "b, moved by at most 1");
}

}  // namespace
}  // namespace aeroloom::pipeline
