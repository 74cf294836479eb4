#include "io/gmsh/msh_scanner.hpp"

#include "geometry/input_file.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <span>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::io {

namespace {

constexpr std::size_t buffer_size = std::size_t{1} << 20;
constexpr std::size_t longest_line = std::size_t{1} << 16;
constexpr std::size_t longest_token = 64;

bool is_blank_letter(int letter) {
  return letter == ' ' || letter == '\n' || letter == '\t' || letter == '\r';
}

}  // namespace

MshScanner::MshScanner(std::string path) : _file(std::make_unique<RangeReader>(std::move(path))) {
  _buffer.resize(std::min(buffer_size, static_cast<std::size_t>(size())));
  if (fill()) _next = geometry::mark_length({_buffer.data(), _end});
}

void MshScanner::fail(const std::string& what) const {
  _file->fail(position(), what);
}

bool MshScanner::fill() {
  _begin += static_cast<std::int64_t>(_end);
  _next = 0;
  _end = std::min(_buffer.size(), static_cast<std::size_t>(_file->bytes_from(_begin)));
  _file->read_bytes(_begin, std::as_writable_bytes(std::span(_buffer.data(), _end)));
  return _end > 0;
}

int MshScanner::peek() {
  if (_next == _end && !fill()) return -1;
  return static_cast<unsigned char>(_buffer[_next]);
}

void MshScanner::raw(void* to, std::int64_t bytes) {
  auto* out = static_cast<char*>(to);
  while (bytes > 0) {
    if (_next == _end && !fill()) fail("the file ends too early");
    const auto taken = std::min(static_cast<std::size_t>(bytes), _end - _next);
    std::memcpy(out, _buffer.data() + _next, taken);
    _next += taken;
    out += taken;
    bytes -= static_cast<std::int64_t>(taken);
  }
}

void MshScanner::seek(std::int64_t position) {
  if (position < 0 || position > size()) fail("the file ends too early");
  if (position >= _begin && position <= _begin + static_cast<std::int64_t>(_end)) {
    _next = static_cast<std::size_t>(position - _begin);
    return;
  }
  _begin = position;
  _next = _end = 0;
}

std::string_view MshScanner::token() {
  _token.clear();
  while (is_blank_letter(peek())) ++_next;
  while (peek() >= 0 && !is_blank_letter(peek())) {
    _token += _buffer[_next++];
    if (_token.size() > longest_token) fail("a number was expected");
  }
  if (_token.empty()) fail("the file ends too early");
  return _token;
}

std::int64_t MshScanner::int64() {
  std::int64_t value = 0;
  if (binary) {
    raw(&value, 8);
    return value;
  }
  const std::string_view text = token();
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    fail(fmt::format("'{}' where a whole number was expected", text));
  return value;
}

std::int32_t MshScanner::int32() {
  if (binary) {
    std::int32_t value = 0;
    raw(&value, 4);
    return value;
  }
  const std::int64_t value = int64();
  if (value != static_cast<std::int32_t>(value)) fail(fmt::format("{} is too large a number", value));
  return static_cast<std::int32_t>(value);
}

double MshScanner::real() {
  double value = 0;
  if (binary) {
    raw(&value, 8);
    return value;
  }
  const std::string_view text = token();
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  // A number too small for a double becomes zero, one too large infinite; assemble() refuses the latter.
  if (error == std::errc::result_out_of_range) value = std::strtod(std::string(text).c_str(), nullptr);
  if ((error != std::errc() && error != std::errc::result_out_of_range) || end != text.data() + text.size())
    fail(fmt::format("'{}' where a number was expected", text));
  return value;
}

std::int64_t MshScanner::count(std::int64_t item_bytes) {
  const std::int64_t value = int64();
  if (value < 0) fail(fmt::format("a count of {}", value));
  const std::int64_t least = binary ? item_bytes : 2;
  if (value > (size() - position()) / least + 1)
    fail(fmt::format("a count of {}, more than the rest of the file can hold", value));
  return value;
}

void MshScanner::int64s(std::int64_t* to, std::int64_t n) {
  if (binary) return raw(to, 8 * n);
  for (std::int64_t i = 0; i < n; ++i) to[i] = int64();
}

void MshScanner::reals(double* to, std::int64_t n) {
  if (binary) return raw(to, 8 * n);
  for (std::int64_t i = 0; i < n; ++i) to[i] = real();
}

void MshScanner::skip_values(std::int64_t n) {
  if (binary) {
    if (n > (size() - position()) / 8) fail("the file ends too early");
    return seek(position() + 8 * n);
  }
  for (std::int64_t i = 0; i < n; ++i) token();
}

std::string MshScanner::line() {
  std::string text;
  while (peek() >= 0 && peek() != '\n') {
    text += _buffer[_next++];
    if (text.size() > longest_line) fail("a line of text was expected");
  }
  if (peek() == '\n') ++_next;
  if (!text.empty() && text.back() == '\r') text.pop_back();
  return text;
}

bool MshScanner::line_is(std::string_view text) {
  std::size_t length = 0;
  bool same = true;
  for (; peek() >= 0 && peek() != '\n'; ++length, ++_next) {
    if (peek() == '\r') continue;
    same = same && length < text.size() && _buffer[_next] == text[length];
  }
  if (peek() == '\n') ++_next;
  return same && length >= text.size();
}

std::string MshScanner::next_line() {
  while (is_blank_letter(peek())) ++_next;
  return line();
}

}  // namespace aeroloom::io
