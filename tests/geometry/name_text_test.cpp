#include "geometry/name_text.hpp"

#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::geometry {
namespace {

std::string text_of(const std::string& bytes, const std::string& encoding = "") {
  return decode_names({bytes}, encoding).front().text;
}

TEST(NameText, KnowsUtf8) {
  for (const char* text : {"", "plain", "T\xC3\xBCr", "\xE6\x9C\xBA\xE7\xBF\xBC", "\xF0\x9F\x9B\xA9"})
    EXPECT_TRUE(is_utf8(text)) << text;
  // A byte alone, overlong, half of a pair of UTF-16, beyond Unicode, cut.
  for (const char* text :
       {"T\xFCr", "\xC0\xAF", "\xE0\x80\xAF", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xE6\x9C", "\x80"})
    EXPECT_FALSE(is_utf8(text)) << shown_bytes(text);
}

TEST(NameText, BytesOfNoEncodingAreLatin1AndComeBack) {
  EXPECT_EQ(text_of("T\xFCr"), "T\xC3\xBCr");
  std::string all, back;
  for (int byte = 1; byte < 256; ++byte) all.push_back(static_cast<char>(byte));
  const std::string text = text_of(all);
  ASSERT_TRUE(is_utf8(text));
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto first = static_cast<unsigned char>(text[i]);
    back.push_back(first < 0x80 ? text[i] : static_cast<char>((first & 3U) << 6U | (text[++i] & 0x3FU)));
  }
  EXPECT_EQ(back, all);
}

TEST(NameText, EncodingsOfTheCaseHold) {
  EXPECT_EQ(text_of("\xBB\xFA\xD2\xED", "GB18030"), "\xE6\x9C\xBA\xE7\xBF\xBC");
  EXPECT_EQ(text_of("\x97\x83", "Shift-JIS"), "\xE7\xBF\xBC");
  EXPECT_EQ(text_of("\x83\x5C", "shift_jis"), "\xE3\x82\xBD") << "its second byte is that of a backslash";
  EXPECT_EQ(text_of("\x80", "windows-1252"), "\xE2\x82\xAC");
  EXPECT_EQ(text_of("\xF8", "windows-1251"), "\xD1\x88");
  EXPECT_EQ(text_of("\xE9", "latin-1"), "\xC3\xA9");
  EXPECT_EQ(text_of("T\xC3\xBCr", "latin-1"), "T\xC3\xBCr") << "UTF-8 comes first";
}

// "mo" of "moxing" is valid UTF-8 by chance in GB18030.
TEST(NameText, ChanceIsNotTakenForUtf8) {
  const std::string chance = "\xC4\xA3", wing = "\xBB\xFA\xD2\xED";
  EXPECT_EQ(decode_names({chance, wing}, "GB18030")[0].text, "\xE6\xA8\xA1");
  EXPECT_EQ(decode_names({"\xE7\xBF\xBC", wing}, "GB18030")[0].text, "\xE7\xBF\xBC")
      << "three bytes are no chance";
}

TEST(NameText, SaysWhatWasChanged) {
  EXPECT_EQ(decode_names({"plain", "T\xC3\xBCr"})[1].change, "");
  EXPECT_EQ(decode_names({"T\xFCr"})[0].change, "name 'T\\xFCr' is no UTF-8: read as latin-1, 'T\xC3\xBCr'");
  EXPECT_NE(decode_names({"T\xFC"}, "GB18030")[0].change.find("neither UTF-8 nor GB18030"),
            std::string::npos);
}

TEST(NameText, DifferentNamesStayDifferent) {
  const std::vector<std::string> names{"T\xFCr", "T\xC3\xBCr", "T\xC3\xBCr_2", "T\xFCr", "T\xEAr"};
  const std::vector<DecodedName> decoded = decode_names(names);
  EXPECT_EQ(decoded[1].text, names[1]);
  EXPECT_EQ(decoded[2].text, names[2]);
  EXPECT_EQ(decoded[0].text, decoded[3].text);
  std::set<std::string> texts;
  for (const DecodedName& each : decoded) texts.insert(each.text);
  EXPECT_EQ(texts.size(), 4U);
}

TEST(NameText, RefusesWhatIsNoEncodingOfNames) {
  EXPECT_NO_THROW(require_encoding(""));
  EXPECT_NO_THROW(require_encoding("ISO-8859-15"));
  EXPECT_THROW(require_encoding("no such encoding"), std::invalid_argument);
  EXPECT_THROW(require_encoding("UTF-16"), std::invalid_argument);
}

}  // namespace
}  // namespace aeroloom::geometry
