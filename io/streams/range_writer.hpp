/// Writes numbers and text into a file that all ranks write, from any offset on.
#pragma once

#include "io/streams/byte_order.hpp"
#include "parallel/storage/shared_file.hpp"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string_view>

namespace aeroloom::io {

/// A buffer of fixed size: the only memory that a writer needs besides the mesh. Only flush() and move_to()
/// write it to the file. Fails as SharedFile::write.
class RangeWriter {
public:
  static constexpr std::size_t buffer_bytes = std::size_t{1} << 20;

  explicit RangeWriter(parallel::SharedFile& file, ByteOrder order = own_byte_order)
      : _file(file), _reverses(order != own_byte_order) {}
  /// Begins at `offset` bytes.
  RangeWriter(parallel::SharedFile& file, std::int64_t offset) : RangeWriter(file) { _begin = offset; }

  /// Writes the buffer, and continues at `offset` bytes from the beginning of the file.
  void move_to(std::int64_t offset) {
    flush();
    _begin = offset;
  }

  template <parallel::Flat T>
  void put(T value) {
    if (_reverses) value = with_bytes_reversed(value);
    if (_used + sizeof(T) > buffer_bytes) flush();
    std::memcpy(_buffer.get() + _used, &value, sizeof(T));
    _used += sizeof(T);
  }

  void put_text(std::string_view text) {
    while (!text.empty()) {
      if (_used == buffer_bytes) flush();
      const std::size_t count = std::min(text.size(), buffer_bytes - _used);
      std::memcpy(_buffer.get() + _used, text.data(), count);
      _used += count;
      text.remove_prefix(count);
    }
  }

  void flush() {
    if (_used == 0) return;
    _file.write(_begin, std::span<const std::byte>(_buffer.get(), _used));
    _begin += static_cast<std::int64_t>(_used);
    _used = 0;
  }

private:
  parallel::SharedFile& _file;
  bool _reverses;
  std::unique_ptr<std::byte[]> _buffer = std::make_unique_for_overwrite<std::byte[]>(buffer_bytes);
  std::size_t _used = 0;
  std::int64_t _begin = 0;
};

}  // namespace aeroloom::io
