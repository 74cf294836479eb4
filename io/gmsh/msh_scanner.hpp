/// Reads the values of an MSH file one after another, from text or binary.
#pragma once

#include "io/streams/range_reader.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace aeroloom::io {

class MshScanner {
public:
  /// Throws std::filesystem::filesystem_error where the path is no plain file, or cannot be read.
  explicit MshScanner(std::string path);

  bool binary = false;  ///< the encoding of int32(), int64() and real()

  std::int32_t int32();
  std::int64_t int64();
  double real();
  /// A number of items that follow, each of at least `item_bytes` bytes (two in text). Fails where the rest
  /// of the file is too short for so many items.
  std::int64_t count(std::int64_t item_bytes);
  /// `n` values, of 8 bytes each in binary.
  void int64s(std::int64_t* to, std::int64_t n);
  void reals(double* to, std::int64_t n);
  void skip_values(std::int64_t n);

  /// The rest of this line, without the line break.
  std::string line();
  /// Skips a line of any length; true if it is `text`.
  bool line_is(std::string_view text);
  /// The next line that is not blank; empty at the end of the file.
  std::string next_line();

  std::int64_t position() const { return _begin + static_cast<std::int64_t>(_next); }
  std::int64_t size() const { return _file->size(); }
  void seek(std::int64_t position);
  /// Throws std::runtime_error with the file, the byte and `what`.
  [[noreturn]] void fail(const std::string& what) const;

private:
  bool fill();
  int peek();
  void raw(void* to, std::int64_t bytes);
  std::string_view token();

  std::unique_ptr<RangeReader> _file;  ///< never null; a pointer, so that scanners can move
  std::int64_t _begin = 0;             ///< offset of the buffer in the file
  std::vector<char> _buffer;
  std::size_t _next = 0, _end = 0;
  std::string _token;
};

}  // namespace aeroloom::io
