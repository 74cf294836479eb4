/// The order of bytes in binary files.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>

namespace aeroloom::io {

enum class ByteOrder { little, big };
inline constexpr ByteOrder own_byte_order =
    std::endian::native == std::endian::little ? ByteOrder::little : ByteOrder::big;

/// A number with its bytes the other way round.
template <class T>
T with_bytes_reversed(T value) {
  auto bytes = std::bit_cast<std::array<std::byte, sizeof(T)>>(value);
  std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<T>(bytes);
}

}  // namespace aeroloom::io
