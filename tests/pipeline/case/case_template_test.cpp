/// What is made of the table of keys: the template and the reference.
#include "pipeline/case/case_template.hpp"

#include "pipeline/case/case_reference.hpp"
#include "pipeline/case/key_text.hpp"
#include "pipeline/report/text_file.hpp"
#include "sizing/field/size_field.hpp"
#include "tests/pipeline/case/case_fixture.hpp"
#include "tests/source_tree.hpp"

#include <regex>
#include <sstream>

namespace aeroloom::cases {
namespace {

/// The template with keys at their defaults no longer commented out.
std::string with_defaults(const std::string& text) {
  const std::regex key(R"(^( *)#([a-z_0-9]+:.*)$)");
  std::istringstream lines(text);
  std::string result;
  for (std::string line; std::getline(lines, line);) {
    const bool example = line.ends_with("# for example");
    result += (example ? line : std::regex_replace(line, key, "$1$2")) + "\n";
  }
  return result;
}

/// The keys of the template of this name, commented out or not, with their indent.
std::size_t lines_with(const std::string& text, const std::string& beginning) {
  std::istringstream lines(text);
  std::size_t count = 0;
  for (std::string line; std::getline(lines, line);) count += line.starts_with(beginning) ? 1 : 0;
  return count;
}

/// Keys of sizes whose default is the preset's: a case has them only where they are given.
std::vector<std::string> preset_given() {
  const sizing::SizingOptions preset;
  return {"sizing.growth=" + shortest(preset.growth), "sizing.proximity=" + shortest(preset.proximity)};
}

TEST_F(CaseTest, TheTemplateIsACaseOnceTheGeometryIsSet) {
  for (const bool every_key : {false, true}) {
    const TemplateRequest request{"a b: #c.step", every_key, "aeroloom.schema.json"};
    const std::string text = case_template(case_keys(), request);
    EXPECT_TRUE(text.starts_with("# yaml-language-server: $schema=aeroloom.schema.json\n"));
    const std::string expected = resolved_yaml(read("geometry: {file: 'a b: #c.step'}\n"));
    EXPECT_EQ(resolved_yaml(read(text)), expected);
    const std::string without = case_template(case_keys(), {"", every_key, ""});
    EXPECT_EQ(without.find("language-server"), std::string::npos);
    EXPECT_EQ(resolved_yaml(read(without, {"geometry.file='a b: #c.step'"})), expected);
    EXPECT_NE(error_of(without).find("give 'geometry.file' or 'geometry.builtin'"), std::string::npos);
  }
}

TEST_F(CaseTest, DefaultsOfTheTemplateChangeNothing) {
  const std::string plain = case_template(case_keys(), {"wing.step", false, ""});
  std::vector<std::string> given = preset_given();
  given.pop_back();  // not among the keys that are often touched
  EXPECT_EQ(resolved_yaml(read(with_defaults(plain))),
            resolved_yaml(read("geometry: {file: wing.step}\nfarfield: {extent: 10}\n", given)));
  const std::string full = with_defaults(case_template(case_keys(), {"", true, ""}));
  const std::string aircraft = "geometry: {builtin: transport, dimensions: {}}\nfarfield: {extent: 10}\n";
  EXPECT_EQ(resolved_yaml(read(full, {"geometry.builtin=transport"})),
            resolved_yaml(read(aircraft, preset_given())));
}

TEST_F(CaseTest, TheTemplateHasTheKeys) {
  const std::string plain = case_template(case_keys(), {"", false, ""});
  const std::string full = case_template(case_keys(), {"", true, ""});
  for (const KeyInfo& key : case_keys()) {
    if (key.kind == KeyKind::named) continue;
    const auto depth = static_cast<std::size_t>(std::count(key.path.begin(), key.path.end(), '.'));
    const std::string indent(2 * depth, ' ');
    const std::string line = indent + (key.has_keys_below() ? "" : "#") + key.name() + ":";
    EXPECT_GE(lines_with(full, line), 1U) << key.path;
    if (key.doc.common) {
      EXPECT_GE(lines_with(plain, line), 1U) << key.path;
    }
  }
  EXPECT_LT(plain.size(), full.size() / 2);
  EXPECT_EQ(full.find("interface_angle"), std::string::npos);
  EXPECT_EQ(full.find("]("), std::string::npos) << "links";
  std::istringstream lines(full);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 110U) << line;
}

TEST(CaseReference, ThePageIsUpToDate) {
  const std::string page = report::read_text(source_tree() / "docs/configuration.md");
  EXPECT_TRUE(page == with_reference(page, case_reference(case_keys())))
      << "docs/configuration.md is stale; renew it: aeroloom schema --markdown --output "
         "docs/configuration.md";
}

TEST(CaseReference, NamesEveryKey) {
  const std::string text = case_reference(case_keys());
  for (const KeyInfo& key : case_keys()) {
    const bool as_wing = key.path.find("tail.") != std::string::npos;
    const std::string shown = as_wing ? "`" + key.name() + ": " + key.default_value + "`" : key.path;
    EXPECT_NE(text.find(shown), std::string::npos) << key.path;
  }
}

TEST(CaseReference, ReplacesItsPlaceAlone) {
  EXPECT_EQ(with_reference("before\n<!-- keys: x -->\nold\n<!-- end of keys -->\nafter\n", "new\n"),
            "before\nnew\nafter\n");
  EXPECT_THROW(with_reference("no place\n", "new\n"), std::invalid_argument);
  EXPECT_THROW(with_reference("<!-- end of keys -->\n<!-- keys: -->\n", "new\n"), std::invalid_argument);
}

TEST(KeyText, LinksBecomePages) {
  EXPECT_EQ(without_links("smoothly ([Narrow faces](real_cad.md#narrow-faces)), [zones](a.md)."),
            "smoothly (docs/real_cad.md: Narrow faces), zones (docs/a.md).");
  EXPECT_EQ(without_links("Files ([Formats](formats.md))."), "Files (docs/formats.md).");
}

TEST(KeyText, LinesAreBrokenAtSpaces) {
  EXPECT_EQ(wrapped("a bb  ccc\ndddd", 4), (std::vector<std::string>{"a bb", "ccc", "dddd"}));
  EXPECT_EQ(wrapped("longer a", 3), (std::vector<std::string>{"longer", "a"}));
  EXPECT_TRUE(wrapped("", 3).empty());
}

TEST(KeyText, SaysWhatIsAccepted) {
  KeyInfo key;
  key.kind = KeyKind::number;
  const auto text = [&](const Range& range) {
    key.range = range;
    return accepted_values(key);
  };
  EXPECT_EQ(text({}), "number");
  EXPECT_EQ(text(Range::any("m")), "number (m)");
  EXPECT_EQ(text(Range::above(0, "m")), "number above 0 m");
  EXPECT_EQ(text(Range::above(1, 3)), "number above 1, at most 3");
  EXPECT_EQ(text(Range::between(0, 90, "degrees")), "number from 0 to 90 degrees");
}

}  // namespace
}  // namespace aeroloom::cases
