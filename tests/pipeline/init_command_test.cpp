// The commands init and schema: what they write, what they leave alone, and what a case from them comes to.
#include "tests/pipeline/command_line.hpp"
#include "tests/source_tree.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace aeroloom::pipeline {
namespace {

class InitCommand : public CommandLine {};

TEST_F(InitCommand, WritesACaseAndItsSchemaOnce) {
  write("wing.step", "");
  const CommandResult ended = expect(0, "init --geometry wing.step", {"aeroloom check case.yaml"});
  EXPECT_EQ(count_of("wrote", ended.out), 1) << ended;
  const std::string text = read("case.yaml");
  EXPECT_TRUE(text.starts_with("# yaml-language-server: $schema=aeroloom.schema.json\n")) << text;
  EXPECT_EQ(read("aeroloom.schema.json"), expect(0, "schema").out);
  EXPECT_NE(text.find("file: wing.step"), std::string::npos) << text;

  const CommandResult again = expect(2, "init");
  EXPECT_NE(again.err.find("--force"), std::string::npos) << again;
  EXPECT_EQ(read("case.yaml"), text);
  expect(0, "init --force --full", {"geometry.file"});
  EXPECT_GT(read("case.yaml").size(), 2 * text.size());
}

TEST_F(InitCommand, ReplacesNothingThatIsNotItsOwn) {
  write("aeroloom.schema.json", "{}");
  write("wing.step", "");
  expect(2, "init other.yaml", {"no schema of Aeroloom"});
  EXPECT_FALSE(exists("other.yaml"));
  const CommandResult ended = expect(0, "init sub/other.yaml --no-schema --geometry no.step");
  EXPECT_NE(ended.err.find("no.step is not there"), std::string::npos) << ended;
  EXPECT_FALSE(exists("sub/aeroloom.schema.json"));
  EXPECT_EQ(read("sub/other.yaml").find("language-server"), std::string::npos);
  expect(2, "init sub", {"is a folder"});
  expect(7, "init wing.step/case.yaml");
}

TEST_F(InitCommand, KnowsWhichGeometryIsRead) {
  expect(2, "init new.yaml --geometry plane.vtp", {"are not read"});
  EXPECT_FALSE(exists("new.yaml"));
  expect(0, "init new.yaml --geometry plane.STL", {"is not there yet"});
  EXPECT_NE(read("new.yaml").find("plane.STL"), std::string::npos);
}

// From init to check without touching the file, but for the geometry.
TEST_F(InitCommand, ItsCaseCanBeChecked) {
  expect(0, "init");
  expect(2, "check case.yaml", {"geometry.file"});
  const std::string sphere = (source_tree() / "configs" / "geometry" / "sphere.brep").string();
  expect(0, "check case.yaml --set sizing.target_tetrahedra=2000 --set geometry.file=" + sphere,
         {"a volume can be meshed"});
}

TEST_F(InitCommand, SchemaIsTheSameInAFile) {
  const CommandResult printed = expect(0, "schema");
  EXPECT_EQ(count_of("wrote", expect(0, "schema --output sub/s.json").out), 1);
  EXPECT_EQ(read("sub/s.json"), printed.out);
  EXPECT_TRUE(nlohmann::json::parse(printed.out).contains("properties"));
}

// Pages go into a folder; of those that exist the keys alone are renewed.
TEST_F(InitCommand, MarkdownRenewsTheKeysOfPagesAlone) {
  const std::filesystem::path docs = source_tree() / "docs" / "configuration";
  std::map<std::string, std::string> pages;
  for (const auto& entry : std::filesystem::directory_iterator(docs)) {
    std::ifstream stream(entry.path());
    pages[entry.path().filename().string()] = {std::istreambuf_iterator<char>(stream), {}};
  }
  expect(0, "schema --markdown --output pages");
  std::map<std::string, std::string> old;
  for (const auto& [name, text] : pages) {
    const std::string made = read("pages/" + name);
    const std::string keys = made.substr(made.find('\n', made.find('\n') + 1) + 1);  // after the heading
    const std::size_t place = text.find(keys);
    ASSERT_NE(place, std::string::npos) << name;
    old[name] = text.substr(0, place) + "<!-- keys: old -->\n<!-- end of keys -->\n" +
                text.substr(place + keys.size());
  }
  EXPECT_FALSE(pages.empty());
  at_root([&] {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder / "pages")) ++count;
    EXPECT_EQ(count, pages.size());
  });
  for (const auto& [name, text] : old) write("pages/" + name, text);
  expect(0, "schema --markdown --output pages");
  for (const auto& [name, text] : pages) EXPECT_EQ(read("pages/" + name), text) << name;
}

TEST_F(InitCommand, MarkdownRefusesPagesWithoutMarks) {
  write("pages/sizing.md", "no marks\n");
  write("pages/volume.md", "<!-- keys: old -->\n<!-- end of keys -->\n");
  expect(2, "schema --markdown --output pages", {"sizing.md"});
  EXPECT_EQ(read("pages/sizing.md"), "no marks\n");
  EXPECT_NE(read("pages/volume.md").find("old"), std::string::npos) << "written before the refusal";
  expect(2, "schema --markdown --output pages/sizing.md", {"is a file"});
  const CommandResult printed = expect(0, "schema --markdown");
  EXPECT_NE(printed.out.find("# sizing\n"), std::string::npos);
  EXPECT_NE(printed.out.find("# layers\n"), std::string::npos);
}

}  // namespace
}  // namespace aeroloom::pipeline
