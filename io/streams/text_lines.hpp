/// Reads a text file of any origin line by line.
#pragma once

#include "io/streams/range_reader.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace aeroloom::io {

/// Holds one buffer of the file, which grows only for a longer line. Lines end in \n or \r\n; the last line
/// may have no end.
class TextLines {
public:
  /// A longer line is an error: the file is no text file of a mesh.
  static constexpr std::size_t longest_line = std::size_t{1} << 16;

  /// `longest`: the largest length of a line in bytes. Throws as RangeReader.
  explicit TextLines(const std::string& path, std::size_t longest = longest_line);

  /// Goes to the next line; false at the end of the file. Throws std::runtime_error where a line is too long.
  bool next();
  /// The current line without its end; valid until next().
  std::string_view line() const { return _line; }
  /// The number of the current line, from 1.
  std::int64_t number() const { return _number; }
  /// The length of the file in bytes.
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
  std::size_t _begin = 0, _end = 0;  ///< the rest of the buffer
  std::int64_t _offset = 0;          ///< of the end of the buffer in the file
  std::string_view _line;
  std::int64_t _number = 0;
};

/// Cuts words from the front of a line. Blanks separate words.
class LineWords {
public:
  explicit LineWords(std::string_view line) : _rest(line) {}
  /// The next word; empty at the end.
  std::string_view next();
  std::string_view rest() const { return _rest; }

private:
  std::string_view _rest;
};

/// The text without blanks at both ends.
std::string_view trimmed(std::string_view text);
/// Whether the whole word is a number.
bool parse_number(std::string_view word, std::int64_t& value);
bool parse_number(std::string_view word, double& value);

}  // namespace aeroloom::io
