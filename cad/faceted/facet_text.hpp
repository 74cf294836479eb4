/// Reads lines, words and numbers from a text file of triangles. The locale has no influence.
#pragma once

#include "geometry/vec.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace aeroloom::cad {

/// Throws CadError for a damaged file, with the place and what is wrong there.
[[noreturn]] void refuse_facets(const std::string& file, const std::string& place, const std::string& what);

/// Reads a text in memory. '#' begins a comment; blanks, tabs and CR separate words.
class FacetText {
public:
  /// A byte-order mark at the beginning is no part of the text.
  FacetText(std::string file, std::string_view text);

  /// Goes to the next line that has a word. False at the end of the text.
  bool next_line();
  /// The next word of the line; empty if there is none.
  std::string_view word();
  /// The next word of this or a later line. Throws CadError at the end of the file; `what` is missing.
  std::string_view any_word(const char* what);
  /// The rest of the line without surrounding blanks.
  std::string_view rest();
  /// The next word of the line as a number; with `any_`, of this or a later line.
  double number(const char* what) { return to_number(word(), what); }
  double any_number(const char* what) { return to_number(any_word(what), what); }
  std::int64_t integer(const char* what) { return to_integer(word(), what); }
  std::int64_t any_integer(const char* what) { return to_integer(any_word(what), what); }
  /// A number of items. Throws CadError if the file has no room for items of `bytes` each.
  std::int64_t count(std::string_view word, const char* what, std::int64_t bytes) const;
  geometry::Vec3 point();

  double to_number(std::string_view word, const char* what) const;
  std::int64_t to_integer(std::string_view word, const char* what) const;
  std::int64_t line() const { return _line_number; }
  /// Appends the next line to this one, after a '\' at its end.
  void join_next_line();
  const std::string& file() const { return _file; }
  [[noreturn]] void fail(const std::string& what) const;

private:
  bool take_line();

  std::string _file;
  std::string_view _text, _line;
  std::size_t _at = 0;  // position in the text behind the line
  std::int64_t _line_number = 0;
};

/// Whether the words are equal, ignoring case.
bool same_word(std::string_view a, std::string_view b);

}  // namespace aeroloom::cad
