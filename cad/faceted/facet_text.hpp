/// Lines and words of a text file of facets; numbers without regard to the locale.
#pragma once

#include "geometry/vec.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace aeroloom::cad {

/// Where a file is damaged: file, place, what and what to do.
[[noreturn]] void refuse_facets(const std::string& file, const std::string& place, const std::string& what);

/// Walks through a text in memory. A '#' ends what is read of a line; CR, tabs and blanks part words.
class FacetText {
public:
  FacetText(std::string file, std::string_view text) : _file(std::move(file)), _text(text) {}

  /// Goes to the next line that has a word. False at the end of the text.
  bool next_line();
  /// The next word of the line; empty where there is none.
  std::string_view word();
  /// The next word of this or a later line. Refuses the file at its end: `what` is missing.
  std::string_view any_word(const char* what);
  /// What is left of the line, without blanks around it.
  std::string_view rest();
  /// The next word of the line, or of this or a later one, as a number.
  double number(const char* what) { return to_number(word(), what); }
  double any_number(const char* what) { return to_number(any_word(what), what); }
  std::int64_t integer(const char* what) { return to_integer(word(), what); }
  std::int64_t any_integer(const char* what) { return to_integer(any_word(what), what); }
  /// A number of items that takes at least `bytes` each: no more than the file has room for.
  std::int64_t count(std::string_view word, const char* what, std::int64_t bytes) const;
  geometry::Vec3 point();

  double to_number(std::string_view word, const char* what) const;
  std::int64_t to_integer(std::string_view word, const char* what) const;
  std::int64_t line() const { return _line_number; }
  /// Takes the next line into this one, as a '\' at its end asks for.
  void join_next_line();
  const std::string& file() const { return _file; }
  [[noreturn]] void fail(const std::string& what) const;

private:
  bool take_line();

  std::string _file;
  std::string_view _text, _line;
  std::size_t _at = 0;  // of the text behind the line
  std::int64_t _line_number = 0;
};

/// Whether the words are equal, small and capital letters alike.
bool same_word(std::string_view a, std::string_view b);

}  // namespace aeroloom::cad
