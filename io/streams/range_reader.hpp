/// Reads a binary file of any origin at any offset. Every rank opens the file for itself.
#pragma once

#include "io/streams/byte_order.hpp"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>

namespace aeroloom::io {

class RangeReader {
public:
  /// Throws std::filesystem::filesystem_error where the path is no plain file, or cannot be read.
  explicit RangeReader(std::string path);
  ~RangeReader();
  RangeReader(const RangeReader&) = delete;
  RangeReader& operator=(const RangeReader&) = delete;

  const std::string& path() const { return _path; }
  std::int64_t size() const { return _size; }
  /// Sets the byte order of the file. Without it the file is little-endian.
  void set_order(ByteOrder order) { _reverses = order != own_byte_order; }

  /// Offsets are bytes from the beginning. Throws std::runtime_error with the byte where the file is too
  /// short, and filesystem_error where it cannot be read.
  void read_bytes(std::int64_t offset, std::span<std::byte> to);
  template <class T>
  void read(std::int64_t offset, std::span<T> to) {
    read_bytes(offset, std::as_writable_bytes(to));
    if (_reverses && sizeof(T) > 1) {
      for (T& item : to) item = with_bytes_reversed(item);
    }
  }
  template <class T>
  T value(std::int64_t offset) {
    T item;
    read(offset, std::span<T>(&item, 1));
    return item;
  }

  /// A number from bytes that read_bytes() has read.
  template <class T>
  T decoded(const std::byte* bytes) const {
    T item;
    std::memcpy(&item, bytes, sizeof(T));
    return _reverses ? with_bytes_reversed(item) : item;
  }

  /// The number of bytes after `offset`; 0 beyond the end.
  std::int64_t bytes_from(std::int64_t offset) const { return offset < _size ? _size - offset : 0; }
  /// Throws std::runtime_error: "PATH, byte OFFSET: WHAT".
  [[noreturn]] void fail(std::int64_t offset, const std::string& what) const;

private:
  std::string _path;
  int _descriptor = -1;
  std::int64_t _size = 0;
  bool _reverses = own_byte_order != ByteOrder::little;
};

}  // namespace aeroloom::io
