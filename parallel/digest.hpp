/// 128 bits of bytes, to tell whether two things are the same: xxHash's XXH3. It protects against accidents,
/// not against malice.
#pragma once

#include "parallel/communicator.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <tuple>

namespace aeroloom::parallel {

struct Digest {
  std::uint64_t low = 0, high = 0;

  static constexpr auto fields() { return std::tuple(&Digest::low, &Digest::high); }
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
  /// Items without padding; their number counts too.
  template <Transferable T>
  Digester& items(std::span<const T> items) {
    return value(static_cast<std::uint64_t>(items.size())).bytes(std::as_bytes(items));
  }
  template <Transferable T>
  requires(std::has_unique_object_representations_v<T> ||
           std::is_floating_point_v<T>) Digester& value(const T& item) {
    return bytes(std::as_bytes(std::span<const T>(&item, 1)));
  }
  Digest result() const;

private:
  struct State;
  std::unique_ptr<State> _state;
};

Digest digest_of(std::span<const std::byte> bytes);

}  // namespace aeroloom::parallel
