#include "geometry/name_text.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include <fmt/format.h>
#include <iconv.h>

namespace aeroloom::geometry {
namespace {

bool is_continuation(unsigned char byte) {
  return (byte & 0xC0U) == 0x80U;
}

/// The length of the character of UTF-8 at the begin of a text; 0 where there is none.
std::size_t utf8_length(std::string_view text) {
  const auto at = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : static_cast<unsigned char>(0);
  };
  const unsigned char first = at(0), second = at(1);
  if (first < 0x80) return 1;
  if (first >= 0xC2 && first <= 0xDF) return is_continuation(second) ? 2 : 0;
  if (first >= 0xE0 && first <= 0xEF) {
    // Nothing that fits in two bytes, and no halves of pairs of UTF-16.
    if ((first == 0xE0 && second < 0xA0) || (first == 0xED && second > 0x9F)) return 0;
    return is_continuation(second) && is_continuation(at(2)) ? 3 : 0;
  }
  if (first >= 0xF0 && first <= 0xF4) {
    if ((first == 0xF0 && second < 0x90) || (first == 0xF4 && second > 0x8F)) return 0;
    return is_continuation(second) && is_continuation(at(2)) && is_continuation(at(3)) ? 4 : 0;
  }
  return 0;
}

/// The length of the longest character of a valid text.
std::size_t longest_character(std::string_view text) {
  std::size_t longest = 0;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8_length(text.substr(i));
    longest = std::max(longest, length);
    i += length;
  }
  return longest;
}

std::size_t character_count(std::string_view text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return !is_continuation(static_cast<unsigned char>(c)); }));
}

std::string utf8_of_latin1(std::string_view bytes) {
  std::string text;
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80) {
      text.push_back(c);
      continue;
    }
    text.push_back(static_cast<char>(0xC0U | (byte >> 6U)));
    text.push_back(static_cast<char>(0x80U | (byte & 0x3FU)));
  }
  return text;
}

std::string letters_of(const std::string& encoding) {
  std::string letters;
  for (const char c : encoding)
    if (std::isalnum(static_cast<unsigned char>(c)) != 0)
      letters.push_back(static_cast<char>(std::tolower(static_cast<unsigned char>(c))));
  return letters;
}

/// From one encoding to UTF-8, by the C library.
class Conversion {
public:
  explicit Conversion(const std::string& encoding) {
    const std::string letters = letters_of(encoding);
    // The variant of Microsoft keeps the backslash, which files mean.
    const bool is_shift_jis = letters == "shiftjis" || letters == "sjis" || letters == "xsjis";
    for (const std::string& name : {is_shift_jis ? std::string("CP932") : encoding, letters}) {
      _state = ::iconv_open("UTF-8", name.c_str());
      if (is_open()) return;
    }
  }
  ~Conversion() {
    if (is_open()) ::iconv_close(_state);
  }
  Conversion(const Conversion&) = delete;
  Conversion& operator=(const Conversion&) = delete;

  bool is_open() const {
    // NOLINTNEXTLINE(performance-no-int-to-ptr): POSIX says so
    return _state != reinterpret_cast<iconv_t>(std::intptr_t{-1});
  }

  /// Nothing where the bytes are invalid in the encoding.
  std::optional<std::string> operator()(std::string_view bytes) const {
    ::iconv(_state, nullptr, nullptr, nullptr, nullptr);
    constexpr std::size_t longest = 8;  // bytes of UTF-8 that one byte can become, with room
    std::string input(bytes), output(longest * bytes.size() + longest, '\0');
    char* from = input.data();
    char* to = output.data();
    std::size_t left = input.size(), room = output.size();
    if (::iconv(_state, &from, &left, &to, &room) == static_cast<std::size_t>(-1) || left > 0)
      return std::nullopt;
    if (::iconv(_state, nullptr, nullptr, &to, &room) == static_cast<std::size_t>(-1)) return std::nullopt;
    output.resize(output.size() - room);
    if (!is_utf8(output)) return std::nullopt;
    return output;
  }

private:
  iconv_t _state{};
};

/// All of ASCII that can be printed.
std::string printable_ascii() {
  std::string text;
  for (char c = ' '; c <= '~'; ++c) text.push_back(c);
  return text;
}

/// Decodes the names of a file, one after the other.
class NameReader {
public:
  NameReader(std::string encoding, bool all_utf8) : _encoding(std::move(encoding)), _all_utf8(all_utf8) {
    if (!_encoding.empty()) _conversion.emplace(_encoding);
  }

  DecodedName read(const std::string& name) const {
    const bool is_valid = is_utf8(name);
    if (is_valid && (_all_utf8 || !_conversion || is_ascii(name))) return {name, ""};
    const std::optional<std::string> converted = _conversion ? (*_conversion)(name) : std::nullopt;
    if (is_valid && !(converted && may_be_chance(name, *converted))) return {name, ""};
    if (converted) return {*converted, read_as(name, "is no UTF-8", _encoding, *converted)};
    const std::string text = utf8_of_latin1(name);
    const std::string fault =
        _conversion ? fmt::format("is neither UTF-8 nor {}", _encoding) : std::string("is no UTF-8");
    return {text, read_as(name, fault, "latin-1", text)};
  }

private:
  static bool may_be_chance(const std::string& name, const std::string& converted) {
    return longest_character(name) < 3 && character_count(converted) < name.size();
  }
  static std::string read_as(const std::string& name, const std::string& fault, const std::string& encoding,
                             const std::string& text) {
    return fmt::format("name '{}' {}: read as {}, '{}'", shown_bytes(name), fault, encoding, text);
  }

  std::string _encoding;
  bool _all_utf8;
  std::optional<Conversion> _conversion;
};

}  // namespace

bool is_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8_length(text.substr(i, 4));
    if (length == 0) return false;
    i += length;
  }
  return true;
}

bool is_ascii(std::string_view text) {
  return std::ranges::all_of(text, [](char c) { return static_cast<unsigned char>(c) < 0x80; });
}

std::string shown_bytes(std::string_view text) {
  std::string shown;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    byte < 0x80 ? shown.push_back(c) : static_cast<void>(shown += fmt::format("\\x{:02X}", byte));
  }
  return shown;
}

void require_encoding(const std::string& encoding) {
  if (encoding.empty()) return;
  const Conversion conversion(encoding);
  if (!conversion.is_open())
    throw std::invalid_argument(
        fmt::format("the C library knows no encoding '{}'; known are such as latin-1, windows-1252, "
                    "GB18030, Shift-JIS (`iconv -l` lists them)",
                    encoding));
  const std::string ascii = printable_ascii();
  if (conversion(ascii) != ascii)
    throw std::invalid_argument(
        fmt::format("'{}' is no encoding of names: it has other bytes for ASCII. Known are such as latin-1, "
                    "windows-1252, GB18030, Shift-JIS",
                    encoding));
}

std::vector<DecodedName> decode_names(const std::vector<std::string>& names, const std::string& encoding) {
  require_encoding(encoding);
  const NameReader reader(encoding,
                          std::ranges::all_of(names, [](const auto& name) { return is_utf8(name); }));
  std::unordered_map<std::string, DecodedName> known;
  std::unordered_set<std::string> used;
  // What is UTF-8 keeps its name, whatever comes before it.
  for (const std::string& name : names) {
    DecodedName decoded = reader.read(name);
    if (decoded.change.empty() && used.insert(decoded.text).second) known.emplace(name, std::move(decoded));
  }
  std::vector<DecodedName> result;
  result.reserve(names.size());
  for (const std::string& name : names) {
    auto found = known.find(name);
    if (found == known.end()) {
      DecodedName decoded = reader.read(name);
      const std::string plain = decoded.text;
      for (int k = 2; !used.insert(decoded.text).second; ++k) decoded.text = fmt::format("{}_{}", plain, k);
      if (decoded.text != plain)
        decoded.change += fmt::format(", which another name is: called '{}'", decoded.text);
      found = known.emplace(name, std::move(decoded)).first;
    }
    result.push_back(found->second);
  }
  return result;
}

}  // namespace aeroloom::geometry
