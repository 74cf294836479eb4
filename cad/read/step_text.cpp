#include "cad/read/step_text.hpp"

#include "geometry/name_text.hpp"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <ios>
#include <iterator>
#include <string_view>

#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

/// The content of a string, without its quotation marks, in a text.
struct StepString {
  std::size_t begin = 0, end = 0;
  bool is_data = false;  ///< in the DATA section
};

bool is_letter(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
}

/// The strings with bytes above 127. A doubled quotation mark stays in its string.
std::vector<StepString> find_8_bit_strings(std::string_view text) {
  std::vector<StepString> found;
  bool is_data = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text.substr(i, 2) == "/*") {
      const std::size_t end = text.find("*/", i + 2);
      if (end == std::string_view::npos) break;
      i = end + 1;
    } else if (text[i] == '\'') {
      std::size_t end = text.find('\'', i + 1);
      while (end != std::string_view::npos && text.substr(end, 2) == "''") end = text.find('\'', end + 2);
      if (end == std::string_view::npos) break;
      if (!geometry::is_ascii(text.substr(i + 1, end - i - 1))) found.push_back({i + 1, end, is_data});
      i = end;
    } else if (is_letter(text[i])) {
      const std::size_t begin = i;
      while (i + 1 < text.size() && is_letter(text[i + 1])) ++i;
      is_data = is_data || text.substr(begin, i + 1 - begin) == "DATA";
    }
  }
  return found;
}

/// Without ends of lines, which may stand anywhere in a string and mean nothing.
std::string content_of(std::string_view text, const StepString& place) {
  std::string content(text.substr(place.begin, place.end - place.begin));
  std::erase_if(content, [](char c) { return c == '\n' || c == '\r'; });
  return content;
}

/// One character at the begin of valid UTF-8, and its length there.
struct Character {
  std::uint32_t code;
  std::size_t length;
};

Character first_character(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return static_cast<std::uint32_t>(static_cast<unsigned char>(text[i]));
  };
  const std::uint32_t first = byte(0);
  if (first < 0x80) return {first, 1};
  const std::size_t length = first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
  std::uint32_t code = first & (0x7FU >> length);
  for (std::size_t i = 1; i < length; ++i) code = code << 6U | (byte(i) & 0x3FU);
  return {code, length};
}

/// ASCII as it is, with its escapes; other characters in UTF-16.
std::string with_escapes(std::string_view utf8) {
  std::string text;
  bool escaped = false;
  while (!utf8.empty()) {
    const Character next = first_character(utf8);
    const bool is_plain = next.code < 0x80;
    if (is_plain == escaped) text += is_plain ? "\\X0\\" : "\\X2\\";
    escaped = !is_plain;
    if (is_plain) {
      text.push_back(static_cast<char>(next.code));
    } else if (next.code < 0x10000) {
      text += fmt::format("{:04X}", next.code);
    } else {
      const std::uint32_t above = next.code - 0x10000;
      text += fmt::format("{:04X}{:04X}", 0xD800 + (above >> 10U), 0xDC00 + (above & 0x3FFU));
    }
    utf8.remove_prefix(next.length);
  }
  return escaped ? text + "\\X0\\" : text;
}

std::string without_doubled_marks(std::string text) {
  for (std::size_t at = text.find("''"); at != std::string::npos; at = text.find("''", at + 1))
    text.erase(at, 1);
  return text;
}

std::string read_bytes(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  if (!stream && bytes.empty()) throw std::ios_base::failure(fmt::format("cannot read '{}'", file));
  return bytes;
}

/// Few files have such bytes; the others are not kept in memory.
bool has_8_bit_text(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string part(1U << 20U, '\0');
  while (stream) {
    stream.read(part.data(), static_cast<std::streamsize>(part.size()));
    if (!geometry::is_ascii(std::string_view(part).substr(0, static_cast<std::size_t>(stream.gcount()))))
      return true;
  }
  return false;
}

/// Replaces strings of a text by what was decoded.
class StepDecoder {
public:
  StepDecoder(const std::string& text, const std::string& encoding)
      : _text(text), _encoding(encoding), _strings(find_8_bit_strings(text)) {}

  std::optional<StepText> decode() {
    decode_section(false);
    decode_section(true);
    if (std::ranges::all_of(_decoded, [](const auto& each) { return each.change.empty(); }))
      return std::nullopt;
    StepText result;
    std::size_t at = 0;
    for (std::size_t s = 0; s < _strings.size(); ++s) {
      if (_decoded[s].change.empty()) continue;
      result.bytes.append(_text, at, _strings[s].begin - at);
      result.bytes += with_escapes(_decoded[s].text);
      at = _strings[s].end;
      if (!_strings[s].is_data) continue;
      result.decoded.push_back({without_doubled_marks(_decoded[s].text), _decoded[s].change});
    }
    result.bytes.append(_text, at);
    return result;
  }

private:
  /// What stands in the header, as the name of who wrote the file, says nothing about names.
  void decode_section(bool is_data) {
    _decoded.resize(_strings.size());
    std::vector<std::string> names;
    for (const StepString& each : _strings)
      if (each.is_data == is_data) names.push_back(content_of(_text, each));
    const std::vector<geometry::DecodedName> decoded = geometry::decode_names(names, _encoding);
    std::size_t next = 0;
    for (std::size_t s = 0; s < _strings.size(); ++s)
      if (_strings[s].is_data == is_data) _decoded[s] = decoded[next++];
  }

  const std::string& _text;
  const std::string& _encoding;
  std::vector<StepString> _strings;
  std::vector<geometry::DecodedName> _decoded;
};

}  // namespace

std::optional<StepText> decode_step(const std::string& file, const std::string& encoding) {
  if (!has_8_bit_text(file)) return std::nullopt;
  const std::string text = read_bytes(file);
  return StepDecoder(text, encoding).decode();
}

}  // namespace aeroloom::cad
