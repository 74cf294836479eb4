/// What is made of the table of keys: the template and the reference.
#include "pipeline/case/case_template.hpp"

#include "pipeline/case/case_keys.hpp"
#include "pipeline/case/case_reference.hpp"
#include "pipeline/case/key_text.hpp"
#include "pipeline/report/text_file.hpp"
#include "sizing/field/size_field.hpp"
#include "tests/pipeline/case/case_fixture.hpp"
#include "tests/source_tree.hpp"

#include <filesystem>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

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
  return {"sizing.growth=" + shortest(preset.growth)};
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
  EXPECT_EQ(resolved_yaml(read(with_defaults(plain))),
            resolved_yaml(read("geometry: {file: wing.step}\nfarfield: {extent: 10}\n", preset_given())));
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

TEST(CaseReference, ThePagesAreUpToDate) {
  const std::filesystem::path folder = source_tree() / "docs/configuration";
  std::set<std::string> made;
  for (const ReferencePage& page : case_reference(case_keys())) {
    const std::string text = report::read_text((folder / page.file).string());
    EXPECT_TRUE(text == with_reference(text, page.keys))
        << page.file << " is stale; renew it: aeroloom schema --markdown --output docs/configuration";
    made.insert(page.file);
  }
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    EXPECT_EQ(made.count(entry.path().filename().string()), 1U) << entry.path() << " is of no section";
}

TEST(CaseReference, NamesEveryKey) {
  std::string text;
  for (const ReferencePage& page : case_reference(case_keys())) text += page.keys;
  for (const KeyInfo& key : case_keys()) {
    const bool as_wing = key.path.find("tail.") != std::string::npos;
    const bool top = key.path.find('.') == std::string::npos;
    const std::string own = top ? "[" + key.path + "](" + key.path + ".md)" : key.path;
    const std::string shown = as_wing ? "`" + key.name() + ": " + key.default_value + "`" : own;
    EXPECT_NE(text.find(shown), std::string::npos) << key.path;
  }
}

TEST(CaseReference, HasAPageForEachSectionOfTheFirstLevel) {
  KeyInfo section{"far"}, below{"far.off"}, named{"far.off.NAME"}, other{"farther"};
  section.doc = "Text ([Head](configuration/far.md#head), [page](page.md)). More.";
  below.doc = named.doc = other.doc = "Text.";
  const std::vector<ReferencePage> pages = case_reference({section, below, named, other});
  ASSERT_EQ(pages.size(), 3U);
  EXPECT_EQ(pages[0].file, "README.md");
  EXPECT_EQ(pages[1].file, "far.md");
  EXPECT_EQ(pages[2].file, "farther.md");
  for (const std::size_t i : {0U, 1U})
    EXPECT_NE(pages[i].keys.find("Text ([Head](far.md#head), [page](../page.md))."), std::string::npos)
        << pages[i].keys;
  EXPECT_EQ(pages[0].keys.find("More."), std::string::npos) << pages[0].keys;
  EXPECT_NE(pages[1].keys.find("More."), std::string::npos) << pages[1].keys;
  EXPECT_NE(pages[1].keys.find("\n## far.off\n"), std::string::npos) << pages[1].keys;
  EXPECT_NE(pages[1].keys.find("\n## far.off.NAME\n"), std::string::npos) << pages[1].keys;
  EXPECT_EQ(pages[1].keys.find("farther"), std::string::npos) << pages[1].keys;
  EXPECT_EQ(with_reference(new_page(pages[1]), pages[1].keys), new_page(pages[1]));
}

TEST(CaseReference, LengthsAreMarkedInShort) {
  KeyInfo section{"far"}, key{"far.off", KeyKind::number};
  key.range = Range::above(0, length_unit);
  EXPECT_NE(accepted_values(key).find(length_unit), std::string::npos);
  const std::string page = case_reference({section, key}).back().keys;
  EXPECT_NE(page.find("| `far.off` | – | number above 0 (length) |"), std::string::npos) << page;
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
  EXPECT_EQ(without_links("Sizes ([Levels](configuration/sizing.md#levels))."),
            "Sizes (docs/configuration/sizing.md: Levels).");
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
