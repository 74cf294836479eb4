#include "geometry/input_file.hpp"

#include <filesystem>
#include <fstream>
#include <ios>
#include <string>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

namespace aeroloom::geometry {
namespace {

namespace fs = std::filesystem;

class InputFileLocal : public testing::Test {
protected:
  void SetUp() override { fs::create_directories(folder); }
  void TearDown() override { fs::remove_all(folder); }
  std::string path(const std::string& name) const { return (folder / name).string(); }
  static std::string refusal(const std::string& file) {
    try {
      return read_whole(file);
    } catch (const std::ios_base::failure& error) {
      return error.what();
    }
  }

  const fs::path folder = fs::temp_directory_path() / ("aeroloom_files_" + std::to_string(getpid()));
};

TEST_F(InputFileLocal, ReadsFilesAndLinksToThem) {
  const std::string text = std::string("a\0b\n", 4);
  std::ofstream(path("file"), std::ios::binary) << text;
  fs::create_symlink("file", path("link"));
  EXPECT_EQ(read_whole(path("file")), text);
  EXPECT_EQ(read_whole(path("link")), text);
  EXPECT_EQ(read_whole("/dev/null"), "");
  EXPECT_FALSE(refusal_of(path("file")));
}

TEST_F(InputFileLocal, RefusesWithTheReason) {
  EXPECT_EQ(refusal(path("none")), "cannot read '" + path("none") + "': No such file or directory");
  EXPECT_EQ(refusal(folder.string()), "cannot read '" + folder.string() + "': Is a directory");
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  fs::create_symlink("pipe", path("link"));
  for (const std::string& file :
       {path("pipe"), path("link"), std::string("/dev/zero"), std::string("/dev/tty")})
    EXPECT_NE(refusal(file).find("'" + file + "': a device or a pipe"), std::string::npos) << refusal(file);
}

}  // namespace
}  // namespace aeroloom::geometry
