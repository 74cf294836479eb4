/// A text file of unknown origin, line by line.
#pragma once

#include "io/streams/range_reader.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace aeroloom::io {

/// Holds one buffer of the file at a time, which grows only where a line needs it. Lines end in \n or \r\n;
/// the last one may lack it.
class TextLines {
public:
  /// Longer ones are no text of a mesh.
  static constexpr std::size_t longest_line = std::size_t{1} << 16;

  /// Lines of up to `longest` bytes. Throws as RangeReader.
  explicit TextLines(const std::string& path, std::size_t longest = longest_line);

  /// Goes to the next line; false at the end of the file. Throws std::runtime_error where a line is too long.
  bool next();
  /// The current line without its end; valid until next().
  std::string_view line() const { return _line; }
  /// Of the current line, from 1.
  std::int64_t number() const { return _number; }
  /// Bytes of the file.
  std::int64_t size() const { return _file.size(); }
  const std::string& path() const { return _file.path(); }
  /// Throws std::runtime_error: "PATH, line NUMBER: WHAT".
  [[noreturn]] void fail(const std::string& what) const;
  [[noreturn]] void fail_at(std::int64_t number, const std::string& what) const;

private:
  bool refill();

  RangeReader _file;
  std::size_t _longest;
  std::vector<char> _buffer;
  std::size_t _begin = 0, _end = 0;  ///< of what has not been given out
  std::int64_t _offset = 0;          ///< of the file, after the buffer
  std::string_view _line;
  std::int64_t _number = 0;
};

/// Cuts words, separated by blanks, from the front of a line.
class LineWords {
public:
  explicit LineWords(std::string_view line) : _rest(line) {}
  /// Empty when there is none left.
  std::string_view next();
  std::string_view rest() const { return _rest; }

private:
  std::string_view _rest;
};

/// Without blanks at both ends.
std::string_view trimmed(std::string_view text);
/// False unless all of the word is a number.
bool parse_number(std::string_view word, std::int64_t& value);
bool parse_number(std::string_view word, double& value);

}  // namespace aeroloom::io
