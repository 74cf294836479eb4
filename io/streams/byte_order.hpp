/// The byte order of binary files.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>

namespace aeroloom::io {

enum class ByteOrder { little, big };
inline constexpr ByteOrder own_byte_order =
    std::endian::native == std::endian::little ? ByteOrder::little : ByteOrder::big;

/// A number with its bytes in reverse order.
template <class T>
T with_bytes_reversed(T value) {
  auto bytes = std::bit_cast<std::array<std::byte, sizeof(T)>>(value);
  std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<T>(bytes);
}

/// Appends the bytes of a number, in the byte order of this machine.
template <class T>
void append_bytes(std::string& text, T value) {
  text.append(reinterpret_cast<const char*>(&value), sizeof(T));
}
inline void append_sizes(std::string& text, std::initializer_list<std::int64_t> values) {
  for (const std::int64_t value : values) append_bytes(text, value);
}

}  // namespace aeroloom::io
