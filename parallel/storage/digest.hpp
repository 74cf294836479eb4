/// Hashes of 128 bits (XXH3 of xxHash), to compare data and to find damage. They do not protect against
/// deliberate changes.
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

/// Hashes bytes given in parts. The result does not depend on where they are divided.
class Digester {
public:
  Digester();
  ~Digester();
  Digester(const Digester&) = delete;
  Digester& operator=(const Digester&) = delete;

  Digester& bytes(std::span<const std::byte> bytes);
  /// Hashes the text and its length.
  Digester& text(std::string_view text);
  /// Hashes the number of items and the items.
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
