#include "io/streams/text_lines.hpp"

#include "geometry/input_file.hpp"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <span>
#include <stdexcept>
#include <system_error>

#include <fmt/format.h>

namespace aeroloom::io {

namespace {

constexpr std::size_t buffer_bytes = std::size_t{1} << 20;
static_assert(buffer_bytes >= 2 * TextLines::longest_line);

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

template <class T>
bool parse(std::string_view word, T& value) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size();
}

}  // namespace

TextLines::TextLines(const std::string& path, std::size_t longest)
    : _file(path), _longest(longest), _buffer(buffer_bytes) {
  refill();
  _begin = geometry::mark_length({_buffer.data(), _end});
}

bool TextLines::refill() {
  std::memmove(_buffer.data(), _buffer.data() + _begin, _end - _begin);
  _end -= _begin;
  _begin = 0;
  if (_end == _buffer.size()) _buffer.resize(2 * _buffer.size());
  const auto count = static_cast<std::size_t>(
      std::min(static_cast<std::int64_t>(_buffer.size() - _end), _file.bytes_from(_offset)));
  _file.read_bytes(_offset, std::as_writable_bytes(std::span(_buffer.data() + _end, count)));
  _offset += static_cast<std::int64_t>(count);
  _end += count;
  return count > 0;
}

bool TextLines::next() {
  ++_number;
  const auto find_end = [&] {
    return static_cast<const char*>(std::memchr(_buffer.data() + _begin, '\n', _end - _begin));
  };
  const char* end = find_end();
  while (end == nullptr && _end - _begin <= _longest && refill()) end = find_end();
  const std::size_t length =
      end == nullptr ? _end - _begin : static_cast<std::size_t>(end - (_buffer.data() + _begin));
  if (length > _longest) fail("the line is too long for a text file of a mesh");
  if (end == nullptr && length == 0) return false;
  _line = {_buffer.data() + _begin, length};
  _begin += length + (end == nullptr ? 0 : 1);
  if (!_line.empty() && _line.back() == '\r') _line.remove_suffix(1);
  return true;
}

void TextLines::fail(const std::string& what) const {
  fail_at(_number, what);
}

void TextLines::fail_at(std::int64_t number, const std::string& what) const {
  throw std::runtime_error(fmt::format("{}, line {}: {}", _file.path(), number, what));
}

std::string_view LineWords::next() {
  while (!_rest.empty() && is_blank(_rest.front())) _rest.remove_prefix(1);
  std::size_t length = 0;
  while (length < _rest.size() && !is_blank(_rest[length])) ++length;
  const std::string_view word = _rest.substr(0, length);
  _rest.remove_prefix(length);
  return word;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

bool parse_number(std::string_view word, std::int64_t& value) {
  return parse(word, value);
}

bool parse_number(std::string_view word, double& value) {
  return parse(word, value);
}

}  // namespace aeroloom::io
