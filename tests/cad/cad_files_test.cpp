// CAD files as programs write them: marks before the text.
#include "cad/model/model.hpp"
#include "cad/read/cad_facts.hpp"
#include "tests/cad/real_files.hpp"
#include "tests/source_tree.hpp"

#include <iterator>
#include <string>

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

TEST(CadFiles, MarksBeforeTheTextArePassedOver) {
  const std::string mark = "\xEF\xBB\xBF";
  for (const char* name : {"bracket.igs", "wing_body.step"})
    expect_same_facts(facts_of(name, mark + text_of(name)), facts_of(name, text_of(name)));
  EXPECT_NE(
      refusal_of_text("cut.step", mark + text_of("wing_body.step").substr(0, 5000)).find("ends too early"),
      std::string::npos);
}

}  // namespace
}  // namespace aeroloom::cad
