// CAD files as programs write them: marks before the text, columns of IGES.
#include "cad/domain/domain.hpp"
#include "cad/model/model.hpp"
#include "cad/read/cad_facts.hpp"
#include "cad/read/iges_columns.hpp"
#include "tests/cad/real_files.hpp"
#include "tests/source_tree.hpp"

#include <algorithm>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace aeroloom::cad {
namespace {

using real::TemporaryFile;

std::string text_of(const std::string& name) {
  std::ifstream stream(source_tree() / "tests" / "data" / name, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void expect_same_facts(const CadFacts& one, const CadFacts& other) {
  EXPECT_EQ(one.format, other.format);
  EXPECT_EQ(one.unit_name, other.unit_name);
  EXPECT_EQ(one.faces, other.faces);
  EXPECT_EQ(one.edges, other.edges);
  EXPECT_EQ(one.bounds.low.x, other.bounds.low.x);
  EXPECT_EQ(one.bounds.high.z, other.bounds.high.z);
}

CadFacts facts_of(const std::string& name, const std::string& text) {
  const TemporaryFile file(name, text);
  return look_at_cad_file(file.path());
}

std::string refusal_of_text(const std::string& name, const std::string& text) {
  try {
    facts_of(name, text);
  } catch (const CadError& error) {
    EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    return error.what();
  }
  return "read";
}

/// Lines of parameters as some programs write them: the delimiter at the end of a line is in column 65.
std::string with_delimiters_in_column_65(const std::string& text) {
  std::istringstream lines(text);
  std::string result;
  for (std::string line; std::getline(lines, line);) {
    if (line.size() > 72 && line[72] == 'P') {
      const std::size_t last = line.find_last_not_of(' ', 63);
      if (line[last] == ',') {
        line[last] = ' ';
        line[64] = ',';
      }
    }
    result += line + "\n";
  }
  return result;
}

TEST(CadFiles, MarksBeforeTheTextArePassedOver) {
  const std::string mark = "\xEF\xBB\xBF";
  for (const char* name : {"bracket.igs", "wing_body.step"})
    expect_same_facts(facts_of(name, mark + text_of(name)), facts_of(name, text_of(name)));
  EXPECT_NE(
      refusal_of_text("cut.step", mark + text_of("wing_body.step").substr(0, 5000)).find("ends too early"),
      std::string::npos);
}

TEST(CadFiles, DelimitersOfIgesInColumn65AreParameters) {
  const std::string good = text_of("bracket.igs"), shifted = with_delimiters_in_column_65(good);
  ASSERT_NE(good, shifted);
  EXPECT_FALSE(with_right_columns(good));
  ASSERT_TRUE(with_right_columns(shifted));
  expect_same_facts(facts_of("shifted.igs", shifted), facts_of("good.igs", good));
  const std::string windows = with_delimiters_in_column_65(good);
  std::string with_returns;
  for (const char c : windows) with_returns += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(facts_of("windows.igs", with_returns).faces, facts_of("good.igs", good).faces);
}

std::string iges_line(const std::string& text, char section, int number) {
  return fmt::format("{:<72}{}{:>7}\n", text, section, number);
}

/// The lines of parameters of an entity, laid out anew.
std::vector<std::string> laid_out(const std::vector<std::string>& lines, const std::string& global = ",,") {
  std::string text = iges_line("", 'S', 1) + iges_line(global, 'G', 1);
  text += iges_line(fmt::format("{:>8}{:>8}", 406, 1), 'D', 1);
  text += iges_line(fmt::format("{:>8}{:>8}{:>8}{:>8}", 406, 0, 0, lines.size()), 'D', 2);
  for (std::size_t i = 0; i < lines.size(); ++i)
    text += iges_line(fmt::format("{:<65}{:>7}", lines[i], 1), 'P', static_cast<int>(i) + 1);
  text += iges_line(fmt::format("S{:>7}G{:>7}D{:>7}P{:>7}", 1, 1, 2, lines.size()), 'T', 1);
  const std::string result = with_right_columns(text).value_or("");
  std::vector<std::string> parameters;
  std::istringstream all(result);
  for (std::string line; std::getline(all, line);) {
    if (line.size() <= 72 || line[72] != 'P') continue;
    EXPECT_EQ(line[64], ' ') << line;
    EXPECT_EQ(line.substr(65), fmt::format("{:>7}P{:>7}", 1, parameters.size() + 1));
    parameters.push_back(line.substr(0, 64));
  }
  const std::string count = fmt::format("{:>8}", parameters.size());
  EXPECT_NE(result.find(fmt::format("{:>8}{:>8}{:>8}{}", 406, 0, 0, count)), std::string::npos) << result;
  EXPECT_NE(result.find(fmt::format("P{:>7}", parameters.size())), std::string::npos);
  return parameters;
}

TEST(CadFiles, FullLinesOfIgesAndTextsKeepTheirLetters) {
  // 64 columns of data and the delimiter after them: what has no room goes into a line of its own.
  const std::string number(61, '1');
  const std::vector<std::string> full = laid_out({"3," + number + ".,", "2.5;"});
  ASSERT_EQ(full.size(), 3U);
  EXPECT_EQ(full[0], fmt::format("{:<64}", "3,"));
  EXPECT_EQ(full[1], fmt::format("{:<64}", number + ".,"));
  EXPECT_EQ(full[2], fmt::format("{:<64}", "2.5;"));
  // A text with delimiters and blanks, which goes over the end of a line; other delimiters.
  const std::string words = "letters, and; blanks   , which go on in the next line  ,;";
  const std::vector<std::string> text =
      laid_out({fmt::format("{:<64}/", "406/1"), fmt::format("{:<64}/", "1.5/2.5"),
                fmt::format("{}H{}", words.size(), words) + "/", "7#"},
               "1H//1H#/");
  std::string all;
  for (const std::string& line : text) all += line;
  EXPECT_NE(all.find(fmt::format("406/1/1.5/2.5/{}H{}/7#", words.size(), words)), std::string::npos) << all;
}

/// The file whose entities that begin like this have no number as their first parameter.
std::string spoilt_iges(const std::string& begin) {
  std::istringstream lines(text_of("bracket.igs"));
  std::string text;
  int spoilt = 0;
  for (std::string line; std::getline(lines, line); text += line + '\n') {
    if (line.size() < 73 || line[72] != 'P' || line.find(',') != 3 || !line.starts_with(begin)) continue;
    line = fmt::format("{:<64}", line.substr(0, 4) + "x;") + line.substr(64);
    ++spoilt;
  }
  EXPECT_GT(spoilt, 0);
  return text;
}

TEST(CadFiles, WhatTheLibraryRefusesOfIgesIsSaid) {
  const std::string message = refusal_of_text("spoilt.igs", spoilt_iges(""));
  EXPECT_NE(message.find("; entity "), std::string::npos) << message;
  EXPECT_NE(message.find("(type "), std::string::npos) << message;
}

// One face of many: it is missed where the rest is open, and told where the rest closes.
TEST(CadFiles, AFaceThatTheLibraryLeavesOutIsSaid) {
  for (const std::string face : {"144,5,", "144,29,"}) {
    const real::TemporaryFile file("left_out.igs", spoilt_iges(face));
    DomainOptions options;
    options.file = file.path();
    std::string said;
    try {
      for (const Change& change : prepare_domain(options).report.changes) said += change.what + "\n";
    } catch (const CadError& error) {
      said = error.what();
    }
    EXPECT_NE(said.find("leaves out geometry of the file; entity "), std::string::npos) << said;
  }
}

TEST(CadFiles, TheReportedFileIsRead) {
  if (!real::has("reported/iges_column_65.igs")) GTEST_SKIP() << "no shared geometry";
  const CadFacts facts = look_at_cad_file(real::file("reported/iges_column_65.igs"));
  EXPECT_EQ(facts.unit_name, "m");
  EXPECT_GT(facts.faces, 3);
}

}  // namespace
}  // namespace aeroloom::cad
