/// Converts values to bytes for messages and files, and back: to_wire() and from_wire().
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

/// Items as bytes and back. Throws std::logic_error if the bytes are not a whole number of items.
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

/// Appends values to a byte buffer. Unpacker reads them in the same order.
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

/// Reads what Packer wrote. Reading past the end throws std::logic_error, before memory is allocated.
class Unpacker {
public:
  explicit Unpacker(std::span<const std::byte> bytes) : _bytes(bytes) {}
  template <Flat T>
  T value();
  template <Flat T>
  std::vector<T> array();
  std::string text();
  /// A number of items that take at least `bytes` each. Throws if so many bytes do not follow.
  std::size_t count(std::size_t bytes);
  bool at_end() const { return _position == _bytes.size(); }

private:
  const std::byte* advance(std::size_t count);
  std::span<const std::byte> _bytes;
  std::size_t _position = 0;
};

/// Can be packed: flat items and texts; vectors, arrays, optionals, pairs, tuples and maps of such; structs
/// whose members can be reached (fields.hpp). Spans are packed as vectors, references as their values.
template <class T>
void pack(Packer& packer, const T& item);
template <class T>
void unpack_into(Unpacker& unpacker, T& item);
/// As pack(), and frees the arrays.
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
/// As to_wire(), for large values: frees each array once it is packed, which saves half the memory.
template <class T>
Bytes hand_over_to_wire(T item) {
  Packer packer;
  hand_over(packer, item);
  return packer.take();
}
/// Throws std::logic_error unless the bytes are those of exactly one T.
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

// Bodies of the templates.

template <Flat T>
void Packer::value(const T& item) {
  write_item(item, extend(wire_size<T>));
}

template <Flat T>
void Packer::array(std::span<const T> items) {
  count(items.size());
  if constexpr (is_exact<T>) {
    append(std::as_bytes(items));
  } else {
    write_items(items, extend(items.size() * wire_size<T>));
  }
}

template <Flat T>
T Unpacker::value() {
  T item;
  read_item(advance(wire_size<T>), item);
  return item;
}

template <Flat T>
std::vector<T> Unpacker::array() {
  std::vector<T> items(count(wire_size<T>));
  read_items(advance(items.size() * wire_size<T>), std::span<T>(items));
  return items;
}

/// How a type travels. `least`: the smallest number of bytes that a value takes.
template <class T>
struct Wire;

template <class T>
inline constexpr std::size_t least_wire_size = Wire<std::remove_cvref_t<T>>::least;

template <Flat T>
struct Wire<T> {
  static constexpr std::size_t least = wire_size<T>;
  static void pack(Packer& packer, const T& item) { packer.value(item); }
  static void unpack(Unpacker& unpacker, T& item) { item = unpacker.value<T>(); }
};

template <>
struct Wire<std::string> {
  static constexpr std::size_t least = sizeof(std::uint64_t);
  static void pack(Packer& packer, const std::string& text) { packer.text(text); }
  static void unpack(Unpacker& unpacker, std::string& text) { text = unpacker.text(); }
};

template <class T, std::size_t Extent>
struct Wire<std::span<T, Extent>> {
  static constexpr std::size_t least = sizeof(std::uint64_t);
  static void pack(Packer& packer, std::span<T> items) {
    if constexpr (Flat<std::remove_const_t<T>>) {
      packer.array(std::span<const std::remove_const_t<T>>(items));
    } else {
      packer.count(items.size());
      for (const T& item : items) parallel::pack(packer, item);
    }
  }
};

template <class T>
struct Wire<std::vector<T>> {
  static constexpr std::size_t least = sizeof(std::uint64_t);
  static void pack(Packer& packer, const std::vector<T>& items) {
    Wire<std::span<const T>>::pack(packer, items);
  }
  static void unpack(Unpacker& unpacker, std::vector<T>& items) {
    if constexpr (Flat<T>) {
      items = unpacker.array<T>();
    } else {
      items = std::vector<T>(unpacker.count(least_wire_size<T>));
      for (T& item : items) unpack_into(unpacker, item);
    }
  }
};

template <class Key, class Value>
struct Wire<std::map<Key, Value>> {
  static constexpr std::size_t least = sizeof(std::uint64_t);
  static void pack(Packer& packer, const std::map<Key, Value>& items) {
    packer.count(items.size());
    for (const auto& item : items) parallel::pack(packer, item);
  }
  static void unpack(Unpacker& unpacker, std::map<Key, Value>& items) {
    items.clear();
    for (auto n = unpacker.count(least_wire_size<Key> + least_wire_size<Value>); n > 0; --n)
      items.insert(items.end(), parallel::unpack<std::pair<Key, Value>>(unpacker));
  }
};

template <class T>
struct Wire<std::optional<T>> {
  static constexpr std::size_t least = 1;
  static void pack(Packer& packer, const std::optional<T>& item) {
    packer.value(item.has_value());
    if (item) parallel::pack(packer, *item);
  }
  static void unpack(Unpacker& unpacker, std::optional<T>& item) {
    item.reset();
    if (unpacker.value<std::uint8_t>() != 0) item = parallel::unpack<T>(unpacker);
  }
};

template <class T, std::size_t N>
requires(!Flat<T>) struct Wire<std::array<T, N>> {
  static constexpr std::size_t least = N * least_wire_size<T>;
  static void pack(Packer& packer, const std::array<T, N>& items) {
    for (const T& item : items) parallel::pack(packer, item);
  }
  static void unpack(Unpacker& unpacker, std::array<T, N>& items) {
    for (T& item : items) unpack_into(unpacker, item);
  }
};

template <class... T>
struct Wire<std::tuple<T...>> {
  static constexpr std::size_t least = (least_wire_size<T> + ... + 0);
  static void pack(Packer& packer, const std::tuple<T...>& items) {
    std::apply([&](const auto&... each) { (parallel::pack(packer, each), ...); }, items);
  }
  static void unpack(Unpacker& unpacker, std::tuple<T...>& items) {
    std::apply([&](auto&... each) { (unpack_into(unpacker, each), ...); }, items);
  }
};

template <class First, class Second>
struct Wire<std::pair<First, Second>> {
  static constexpr std::size_t least = least_wire_size<First> + least_wire_size<Second>;
  static void pack(Packer& packer, const std::pair<First, Second>& items) {
    parallel::pack(packer, items.first);
    parallel::pack(packer, items.second);
  }
  static void unpack(Unpacker& unpacker, std::pair<First, Second>& items) {
    unpack_into(unpacker, items.first);
    unpack_into(unpacker, items.second);
  }
};

template <HasFields T>
requires(!Flat<T>) struct Wire<T> {
  static constexpr std::size_t least = []<class... M>(std::type_identity<std::tuple<M&...>>) {
    return (least_wire_size<M> + ... + 0);
  }(std::type_identity<decltype(fields_of(std::declval<T&>()))>());
  static void pack(Packer& packer, const T& item) {
    for_each_field(item, [&](const auto& field) { parallel::pack(packer, field); });
  }
  static void unpack(Unpacker& unpacker, T& item) {
    for_each_field(item, [&](auto& field) { unpack_into(unpacker, field); });
  }
};

template <class T>
void pack(Packer& packer, const T& item) {
  Wire<T>::pack(packer, item);
}

template <class T>
void hand_over(Packer& packer, T& item) {
  if constexpr (Flat<T>) {
    pack(packer, item);
  } else if constexpr (HasFields<T>) {
    for_each_field(item, [&](auto& field) { hand_over(packer, field); });
  } else if constexpr (IsTuple<T>) {
    std::apply([&](auto&... each) { (hand_over(packer, each), ...); }, item);
  } else {
    pack(packer, item);
    item = T();
  }
}

template <class T>
void unpack_into(Unpacker& unpacker, T& item) {
  Wire<T>::unpack(unpacker, item);
}

}  // namespace aeroloom::parallel
