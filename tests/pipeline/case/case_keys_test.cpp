/// The table of keys: every key is documented, and what is told of it holds.
#include "io/file_formats.hpp"
#include "pipeline/case/case.hpp"
#include "pipeline/case/key_info.hpp"
#include "tests/source_tree.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <map>
#include <regex>

#include <gtest/gtest.h>

namespace aeroloom::cases {
namespace {

std::map<std::string, KeyInfo> by_path() {
  std::map<std::string, KeyInfo> keys;
  for (const KeyInfo& key : case_keys()) EXPECT_TRUE(keys.emplace(key.path, key).second) << key.path;
  return keys;
}

TEST(CaseKeys, EveryKeyIsDocumented) {
  const std::vector<KeyInfo> keys = case_keys();
  EXPECT_GT(keys.size(), 100U);
  for (const KeyInfo& key : keys) {
    const std::string& text = key.doc.text;
    EXPECT_GE(text.size(), 8U) << key.path;
    EXPECT_TRUE(text.ends_with(".")) << key.path << ": " << text;
    EXPECT_TRUE(text[0] == '`' || std::isupper(text[0]) != 0) << key.path << ": " << text;
    EXPECT_EQ(text.find("  "), std::string::npos) << key.path << ": " << text;
    EXPECT_FALSE(key.doc.left_out.ends_with(".")) << key.path;
  }
}

TEST(CaseKeys, WhatHasNoDefaultSaysWhatIsTakenOrIsLeftOut) {
  for (const KeyInfo& key : case_keys()) {
    if (key.has_keys_below()) continue;
    EXPECT_NE(key.default_value.empty(), key.doc.example.empty()) << key.path;
    const bool geometry = key.path == "geometry.file" || key.path == "geometry.builtin" ||
                          key.path == "geometry.parts.NAME.file";
    EXPECT_EQ(geometry, key.default_value.empty() && key.doc.left_out.empty()) << key.path;
  }
}

TEST(CaseKeys, DefaultsAndExamplesAreAccepted) {
  for (const KeyInfo& key : case_keys()) {
    if (key.has_keys_below()) continue;
    for (const std::string& value : {key.default_value, key.doc.example}) {
      if (value.empty()) continue;
      const std::string assignment = key.path + "=" + value;
      EXPECT_NO_THROW(case_of_overrides({assignment})) << assignment;
    }
  }
}

TEST(CaseKeys, TellsWhatIsDeclared) {
  const std::map<std::string, KeyInfo> keys = by_path();
  const KeyInfo& growth = keys.at("sizing.growth");
  EXPECT_EQ(growth.kind, KeyKind::number);
  EXPECT_EQ(growth.range.low, 1.01);
  EXPECT_TRUE(growth.range.low_allowed);
  EXPECT_EQ(growth.default_value, "1.3");
  EXPECT_EQ(keys.at("sizing.target_tetrahedra").default_value, "");  // depends on what else is given
  EXPECT_EQ(keys.at("output.formats").default_value, "[vtu]");
  EXPECT_EQ(keys.at("output.formats").choices.size(), io::file_formats().size());
  EXPECT_EQ(keys.at("output.pictures").default_value, "true");
  EXPECT_EQ(keys.at("patches.NAME").kind, KeyKind::named);
  EXPECT_EQ(keys.at("patches.NAME.type").choices.front(), "wall");
  EXPECT_EQ(keys.at("geometry.dimensions.wing.taper").range.high, 1);
  EXPECT_EQ(keys.at("improve.gate").kind, KeyKind::section);
  EXPECT_EQ(keys.at("improve.gate").name(), "gate");
}

TEST(CaseKeys, SectionsStandBeforeTheirKeys) {
  std::vector<std::string> seen, common;
  for (const KeyInfo& key : case_keys()) {
    const std::size_t dot = key.path.rfind('.');
    if (dot != std::string::npos) {
      EXPECT_EQ(std::count(seen.begin(), seen.end(), key.path.substr(0, dot)), 1) << key.path;
    }
    if (key.has_keys_below()) seen.push_back(key.path);
    if (key.has_keys_below() && key.doc.common) common.push_back(key.path);
    if (dot != std::string::npos && key.doc.common) {
      EXPECT_EQ(std::count(common.begin(), common.end(), key.path.substr(0, dot)), 1) << key.path;
    }
  }
}

/// The page has a heading that a link with this anchor leads to.
bool has_heading(const std::string& page, const std::string& anchor) {
  std::ifstream stream(page);
  for (std::string line; std::getline(stream, line);) {
    if (!line.starts_with("#")) continue;
    std::string slug;
    for (const char letter : line.substr(line.find_first_not_of("# "))) {
      if (letter == ' ' || letter == '-') slug += '-';
      if (std::isalnum(static_cast<unsigned char>(letter)) != 0)
        slug += static_cast<char>(std::tolower(letter));
    }
    if (slug == anchor) return true;
  }
  return false;
}

TEST(CaseKeys, LinksLeadToPagesAndHeadingsThatAreThere) {
  const std::regex link(R"(\]\(([^)#]+)(#([^)]*))?\))");
  for (const KeyInfo& key : case_keys()) {
    const std::string& text = key.doc.text;
    for (std::sregex_iterator found(text.begin(), text.end(), link), end; found != end; ++found) {
      const std::string page = source_tree() / "docs" / (*found)[1].str();
      EXPECT_TRUE(std::ifstream(page).good()) << key.path << ": " << page;
      const std::string anchor = (*found)[3].str();
      EXPECT_TRUE(anchor.empty() || has_heading(page, anchor)) << key.path << ": " << page << "#" << anchor;
    }
  }
}

}  // namespace
}  // namespace aeroloom::cases
