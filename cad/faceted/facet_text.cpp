#include "cad/faceted/facet_text.hpp"

#include "cad/model/model.hpp"
#include "geometry/input_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

bool parts_words(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

char small_letter(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

/// A word for a message: short, and nothing but what can be printed.
std::string shown(std::string_view word) {
  std::string text(word.substr(0, 24));
  for (char& c : text) {
    if (c < ' ' || c > '~') c = '?';
  }
  return word.size() > 24 ? text + "..." : text;
}

template <class Value>
bool parse_word(std::string_view word, Value& value) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size();
}

}  // namespace

void refuse_facets(const std::string& file, const std::string& place, const std::string& what) {
  throw CadError(fmt::format("{}, {}: {}; export the file again", file, place, what));
}

bool same_word(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return small_letter(x) == small_letter(y); });
}

FacetText::FacetText(std::string file, std::string_view text)
    : _file(std::move(file)), _text(text.substr(geometry::mark_length(text))) {}

void FacetText::fail(const std::string& what) const {
  refuse_facets(_file, fmt::format("line {}", _line_number), what);
}

bool FacetText::take_line() {
  if (_at >= _text.size()) return false;
  const std::size_t end = std::min(_text.find('\n', _at), _text.size());
  _line = _text.substr(_at, end - _at);
  _at = end + 1;
  ++_line_number;
  _line = _line.substr(0, std::min(_line.find('#'), _line.size()));
  while (!_line.empty() && parts_words(_line.back())) _line.remove_suffix(1);
  while (!_line.empty() && parts_words(_line.front())) _line.remove_prefix(1);
  return true;
}

bool FacetText::next_line() {
  while (take_line()) {
    if (!_line.empty()) return true;
  }
  _line = {};
  return false;
}

void FacetText::join_next_line() {
  if (!take_line()) _line = {};
}

std::string_view FacetText::word() {
  std::size_t length = 0;
  while (length < _line.size() && !parts_words(_line[length])) ++length;
  const std::string_view word = _line.substr(0, length);
  _line.remove_prefix(length);
  while (!_line.empty() && parts_words(_line.front())) _line.remove_prefix(1);
  return word;
}

std::string_view FacetText::any_word(const char* what) {
  std::string_view found = word();
  if (!found.empty()) return found;
  if (!next_line()) fail(fmt::format("the file ends where {} should stand", what));
  return word();
}

std::string_view FacetText::rest() {
  return std::exchange(_line, {});
}

double FacetText::to_number(std::string_view word, const char* what) const {
  double value = 0;
  if (!parse_word(word, value)) fail(fmt::format("'{}' stands where {} should", shown(word), what));
  if (!std::isfinite(value)) fail(fmt::format("'{}' is no finite number", shown(word)));
  return value;
}

std::int64_t FacetText::to_integer(std::string_view word, const char* what) const {
  std::int64_t value = 0;
  if (!parse_word(word, value)) fail(fmt::format("'{}' stands where {} should", shown(word), what));
  return value;
}

std::int64_t FacetText::count(std::string_view word, const char* what, std::int64_t bytes) const {
  const std::int64_t value = to_integer(word, what);
  if (value < 0 || value > static_cast<std::int64_t>(_text.size()) / bytes) {
    fail(fmt::format("{} is {}, more than the file has room for", what, shown(word)));
  }
  return value;
}

geometry::Vec3 FacetText::point() {
  const double x = number("a coordinate"), y = number("a coordinate");
  return {x, y, number("a coordinate")};
}

}  // namespace aeroloom::cad
