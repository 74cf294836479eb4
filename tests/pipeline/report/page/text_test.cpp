#include "pipeline/report/page/base64.hpp"
#include "pipeline/report/page/html_text.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::page {
namespace {

TEST(Text, NumbersAreForPeople) {
  EXPECT_EQ(count(1384540), "1,384,540");
  EXPECT_EQ(count(-1234), "-1,234");
  EXPECT_EQ(count(999), "999");
  EXPECT_EQ(count(Json()), "–");
  EXPECT_EQ(degrees(28.0004), "28.0°");
  EXPECT_EQ(degrees(0.0243), "0.024°");
  EXPECT_EQ(seconds(7.42), "7.4 s");
  EXPECT_EQ(seconds(59.99), "60.0 s");
  EXPECT_EQ(seconds(723.4), "12 min 3 s");
  EXPECT_EQ(seconds(7500), "2 h 5 min");
  EXPECT_EQ(memory(466.0 * 1024 * 1024), "466 MiB");
  EXPECT_EQ(memory(1.5 * (1LL << 40)), "1.5 TiB");
  EXPECT_EQ(quantity(387.73735), "387.7");
  EXPECT_EQ(quantity(12345.6), "12,346");
  EXPECT_EQ(quantity(848255.99), "848,256");
  EXPECT_EQ(quantity(8.5e-7), "8.5·10⁻⁷");
  EXPECT_EQ(quantity(-0.0), "0");
  EXPECT_EQ(percent(-0.0015), "-0.15 %");
  EXPECT_EQ(percent(1e-16), "0 %");
  EXPECT_EQ(place(Json::array({1.0, 1e-13, -2.5})), "<span class=\"place\">(1, 0, -2.5)</span>");
  EXPECT_EQ(name(std::string(199, 'a') + "é"), "<bdi>" + std::string(199, 'a') + " …</bdi>");
}

TEST(Base64, PadsWhatIsNoMultipleOfThree) {
  const auto encoded = [](const std::string& text) {
    return base64(std::vector<std::uint8_t>(text.begin(), text.end()));
  };
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64(std::vector<std::uint8_t>{0xFF, 0xFE, 0xFD}), "//79");
}

TEST(Text, WhatIsAbsentIsADash) {
  const Json report = {{"mesh", {{"volume", 2.5}, {"name", "wing"}}}};
  EXPECT_EQ(find(report, "/mesh/volume"), 2.5);
  EXPECT_TRUE(find(report, "/mesh/area").is_null());
  EXPECT_TRUE(find(report, "/mesh/volume/unit").is_null());
  EXPECT_EQ(number(find(report, "/mesh/name"), 7), 7);
  EXPECT_EQ(text(find(report, "/mesh/volume")), "");
  for (const auto& shown : {count, quantity, degrees, ratio, seconds, memory, place})
    EXPECT_EQ(shown(find(report, "/mesh/name")), "–");
  EXPECT_EQ(name(find(report, "/mesh/volume")), "–");
}

TEST(Text, IsNoMarkup) {
  EXPECT_EQ(escaped("<a href='x'>&\"</a>"), "&lt;a href=&#39;x&#39;&gt;&amp;&quot;&lt;/a&gt;");
  EXPECT_EQ(escaped("a\tb\nc"), "a\tb\nc");
  EXPECT_EQ(escaped(std::string("\x01\x7f", 2)), "\xEF\xBF\xBD\xEF\xBF\xBD");
  EXPECT_EQ(as_utf8("wing\xff"), "wing\xEF\xBF\xBD");
}

TEST(Text, IsCutBeforeALetterAndNotWithinIt) {
  EXPECT_EQ(long_text("äöü", 6), "äöü");
  EXPECT_EQ(long_text("äöü", 5), "äö …");
  EXPECT_EQ(long_text("äöü", 4), "äö …");
  EXPECT_EQ(long_text("<<<<", 2), "&lt;&lt; …");
}

TEST(Text, UnitsAreTheLargestThatFit) {
  EXPECT_EQ(memory(1024), "1.0 KiB");
  EXPECT_EQ(memory(999.6 * 1024), "1.0 MiB");
  EXPECT_EQ(seconds(0.004), "0 s");
  EXPECT_EQ(seconds(0.42), "0.42 s");
  EXPECT_EQ(ratio(0.862), "0.862");
  EXPECT_EQ(ratio(0.001234), "0.001234");
  EXPECT_EQ(percent(0.5), "50.0 %");
  EXPECT_EQ(percent(0.0001), "0.010 %");
}

TEST(Text, OneIsNotMany) {
  EXPECT_EQ(counted(1, "limit"), "1 limit");
  EXPECT_EQ(counted(2, "limit"), "2 limits");
  EXPECT_EQ(counted(2000, "tetrahedron", "tetrahedra"), "2,000 tetrahedra");
}

}  // namespace
}  // namespace aeroloom::page
