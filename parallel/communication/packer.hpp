/// Values of any shape as bytes and back: to_wire() and from_wire(), pack() and unpack().
#pragma once

#include "parallel/communication/fields.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace aeroloom::parallel {

using Bytes = std::vector<std::byte>;

/// Items as bytes and back; sizes that do not divide throw std::logic_error.
template <Flat T>
Bytes to_bytes(std::span<const T> items) {
  if constexpr (is_exact<T>) {
    const auto raw = std::as_bytes(items);
    return {raw.begin(), raw.end()};
  } else {
    Bytes bytes(items.size() * wire_size<T>);
    write_items(items, bytes.data());
    return bytes;
  }
}
template <Flat T>
std::vector<T> from_bytes(std::span<const std::byte> bytes) {
  if (bytes.size() % wire_size<T> != 0) {
    throw std::logic_error("from_bytes: " + std::to_string(bytes.size()) +
                           " bytes are no whole number of items");
  }
  std::vector<T> items(bytes.size() / wire_size<T>);
  read_items(bytes.data(), std::span<T>(items));
  return items;
}

/// Writes one after another into a byte buffer; Unpacker reads it back in order.
class Packer {
public:
  template <Flat T>
  void value(const T& item);
  /// The number of items and the items, as one block.
  template <Flat T>
  void array(std::span<const T> items);
  template <Flat T>
  void array(const std::vector<T>& items) {
    array(std::span<const T>(items));
  }
  void text(const std::string& text);
  void count(std::size_t count) { value(static_cast<std::uint64_t>(count)); }
  Bytes take() { return std::move(_bytes); }

private:
  void append(std::span<const std::byte> bytes);
  std::byte* extend(std::size_t count);
  Bytes _bytes;
};

/// Reads what Packer wrote. Reading past the end throws std::logic_error, before memory is taken for it.
class Unpacker {
public:
  explicit Unpacker(std::span<const std::byte> bytes) : _bytes(bytes) {}
  template <Flat T>
  T value();
  template <Flat T>
  std::vector<T> array();
  std::string text();
  /// Of things that take at least `bytes` each.
  std::size_t count(std::size_t bytes);
  bool at_end() const { return _position == _bytes.size(); }

private:
  const std::byte* advance(std::size_t count);
  std::span<const std::byte> _bytes;
  std::size_t _position = 0;
};

/// Flat items, texts, and of what can be packed: vectors (packed also from spans), arrays, optionals, pairs,
/// tuples (packed also from references), maps, and structs that list their fields.
template <class T>
void pack(Packer& packer, const T& item);
template <class T>
void unpack_into(Unpacker& unpacker, T& item);
/// As pack(), and empties the arrays.
template <class T>
void hand_over(Packer& packer, T& item);
template <class T>
T unpack(Unpacker& unpacker) {
  T item{};
  unpack_into(unpacker, item);
  return item;
}

template <class T>
Bytes to_wire(const T& item) {
  Packer packer;
  pack(packer, item);
  return packer.take();
}
/// As to_wire(), for what is large: each array goes once it is packed, so the whole is never there twice.
template <class T>
Bytes hand_over_to_wire(T item) {
  Packer packer;
  hand_over(packer, item);
  return packer.take();
}
/// Throws std::logic_error where there are not just the bytes of one T.
template <class T>
void from_wire_into(std::span<const std::byte> bytes, T& item) {
  Unpacker unpacker(bytes);
  unpack_into(unpacker, item);
  if (!unpacker.at_end()) throw std::logic_error("from_wire: bytes left over");
}
template <class T>
T from_wire(std::span<const std::byte> bytes) {
  T item{};
  from_wire_into(bytes, item);
  return item;
}

}  // namespace aeroloom::parallel

#include "parallel/communication/packer_items.hpp"
