/// 128 bits of bytes, to tell whether two things are the same: xxHash's XXH3. It protects against accidents,
/// not against malice.
#pragma once

#include "parallel/communication/communicator.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace aeroloom::parallel {

struct Digest {
  std::uint64_t low = 0, high = 0;
  /// 32 hexadecimal digits.
  std::string text() const;
  friend auto operator<=>(const Digest&, const Digest&) = default;
};

/// Takes in bytes piece by piece; the result does not depend on how they were divided.
class Digester {
public:
  Digester();
  ~Digester();
  Digester(const Digester&) = delete;
  Digester& operator=(const Digester&) = delete;

  Digester& bytes(std::span<const std::byte> bytes);
  /// The text and its length.
  Digester& text(std::string_view text);
  /// Their number counts too.
  template <Flat T>
  Digester& items(std::span<const T> items) {
    value(static_cast<std::uint64_t>(items.size()));
    if constexpr (is_exact<T>) {
      return bytes(std::as_bytes(items));
    } else {
      return bytes(to_bytes(items));
    }
  }
  template <Flat T>
  Digester& value(const T& item) {
    std::array<std::byte, wire_size<T>> of_item;
    write_item(item, of_item.data());
    return bytes(of_item);
  }
  Digest result() const;

private:
  struct State;
  std::unique_ptr<State> _state;
};

Digest digest_of(std::span<const std::byte> bytes);

}  // namespace aeroloom::parallel
