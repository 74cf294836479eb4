#include "pipeline/report/page/html_table.hpp"
#include "tests/pipeline/report/page/occurrences.hpp"

#include <string>

#include <gtest/gtest.h>

namespace aeroloom::page {
namespace {

TEST(Table, ShowsWhatItGetsInItsColumns) {
  Table table({{"patch"}, {"faces", Align::right, "of \"all\" ranks"}});
  EXPECT_TRUE(table.empty());
  EXPECT_EQ(table.html(), "");
  table.add({"wing", "12"});
  const std::string html = table.html();
  EXPECT_EQ(occurrences(html, "<tr><td>wing</td><td class=\"number\">12</td></tr>"), 1);
  EXPECT_EQ(occurrences(html, "<th scope=\"col\">patch</th>"), 1);
  EXPECT_EQ(
      occurrences(html, "<th scope=\"col\" class=\"number\" title=\"of &quot;all&quot; ranks\">faces</th>"),
      1);
}

TEST(Table, RowsBeyondFiftyAreInAFile) {
  Table table({{"patch"}}, "study.json");
  for (int row = 0; row < 50; ++row) table.add({std::to_string(row)});
  EXPECT_EQ(occurrences(table.html(), "<td>"), 50);
  EXPECT_EQ(occurrences(table.html(), "more"), 0);
  for (int row = 50; row < 1234; ++row) table.add({std::to_string(row)});
  EXPECT_EQ(occurrences(table.html(), "<td>"), 50);
  EXPECT_EQ(occurrences(table.html(), "<td>49</td>"), 1);
  EXPECT_EQ(occurrences(table.html(), "and 1,184 more, see study.json"), 1);
}

TEST(Elements, AreNotThereWithoutABody) {
  EXPECT_EQ(section("mesh", "The mesh", ""), "");
  EXPECT_EQ(part("Angles", ""), "");
  EXPECT_EQ(facts({}), "");
  EXPECT_EQ(section("mesh", "The mesh", paragraph("fine")),
            "<section id=\"mesh\">\n<h2>The mesh</h2>\n<p>fine</p>\n</section>\n");
  EXPECT_EQ(facts({{"name", "wing"}, {"faces", "3"}}),
            "<dl>\n<div><dt>name</dt><dd>wing</dd></div>\n<div><dt>faces</dt><dd>3</dd></div>\n</dl>\n");
}

TEST(Elements, BarsStayWithinTheirTrough) {
  const auto filled = [](const char* part) {
    return "<rect class=\"filled\" width=\"" + std::string(part) + "\"";
  };
  EXPECT_EQ(occurrences(bar(0.25), filled("25.0")), 1);
  EXPECT_EQ(occurrences(bar(-1), filled("0.0")), 1);
  EXPECT_EQ(occurrences(bar(3), filled("100.0")), 1);
}

TEST(Elements, BadgesDifferWithoutColour) {
  EXPECT_EQ(badge("good", "valid"), "<span class=\"badge good\">✓ valid</span>");
  EXPECT_EQ(badge("poor", "valid"), "<span class=\"badge poor\">✗ valid</span>");
  EXPECT_EQ(badge("plain", "valid"), "<span class=\"badge plain\">valid</span>");
}

}  // namespace
}  // namespace aeroloom::page
