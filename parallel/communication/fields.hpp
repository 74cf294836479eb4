/// Structs that travel between ranks and into files: a struct lists its fields once, for both directions, and
/// padding stays behind.
#pragma once

#include <array>
#include <cstddef>
#include <cstring>
#include <span>
#include <tuple>
#include <type_traits>

namespace aeroloom::parallel {

/// A struct that lists its members, all of them in the order of their declaration:
///   static constexpr auto fields() { return std::tuple(&Sharer::vertex_key, &Sharer::piece); }
/// Members of a base come first. One that is forgotten does not compile, unless it fits into padding.
template <class T>
concept HasFields = requires {
  T::fields();
};

template <class T>
struct FlatTraits;

/// Types that take the same number of bytes whatever their value: numbers, enumerations, arrays of flat
/// items, and trivially copyable structs that list flat fields.
template <class T>
concept Flat = FlatTraits<T>::is_flat;

/// The bytes that travel of one item.
template <Flat T>
inline constexpr std::size_t wire_size = FlatTraits<T>::bytes;

/// Whether no byte of it is padding: such items travel as the bytes they are in memory.
template <Flat T>
inline constexpr bool is_exact = wire_size<T> == sizeof(T);

template <class T>
struct FlatTraits {
  static constexpr bool is_flat =
      (std::is_arithmetic_v<T> || std::is_enum_v<T>)&&!std::is_same_v<T, long double>;
  static constexpr std::size_t bytes = sizeof(T);
};
template <class T, std::size_t N>
struct FlatTraits<T[N]> {
  static constexpr bool is_flat = FlatTraits<T>::is_flat;
  static constexpr std::size_t bytes = N * FlatTraits<T>::bytes;
};
template <class T, std::size_t N>
struct FlatTraits<std::array<T, N>> : FlatTraits<T[N]> {};

/// The types of the members that a list names.
template <class List>
struct Members;
template <class... M, class... C>
struct Members<std::tuple<M C::*...>> {
  static constexpr bool are_flat = (FlatTraits<M>::is_flat && ...);
  static constexpr std::size_t bytes = (FlatTraits<M>::bytes + ... + 0);
  /// Of a struct that has these members and no others.
  static constexpr std::size_t size_with(std::size_t alignment) {
    const auto aligned = [](std::size_t at, std::size_t to) { return (at + to - 1) / to * to; };
    std::size_t end = 0;
    ((end = aligned(end, alignof(M)) + sizeof(M)), ...);
    return aligned(end, alignment);
  }
};

/// Whether no member is listed twice.
template <HasFields T>
constexpr bool fields_are_distinct() {
  return std::apply(
      [](const auto... members) {
        const auto same = [](const auto a, const auto b) {
          if constexpr (std::is_same_v<decltype(a), decltype(b)>) return a == b;
          return false;
        };
        const auto count = [&](const auto member) { return (int{same(member, members)} + ... + 0); };
        return ((count(members) == 1) && ...);
      },
      T::fields());
}

template <HasFields T>
struct FlatTraits<T> {
  using List = Members<decltype(T::fields())>;
  static_assert(fields_are_distinct<T>(), "fields() lists each member once");
  static_assert(List::size_with(alignof(T)) == sizeof(T), "fields() lists all members in their order");
  static constexpr bool is_flat = std::is_trivially_copyable_v<T> && List::are_flat;
  static constexpr std::size_t bytes = List::bytes;
};

/// Calls visit(member) for each field.
template <HasFields T, class Visit>
constexpr void for_each_field(T& item, const Visit& visit) {
  std::apply([&](const auto... members) { (visit(item.*members), ...); }, T::fields());
}

/// Writes wire_size<T> bytes at `to` and returns where they end.
template <Flat T>
std::byte* write_item(const T& item, std::byte* to) {
  if constexpr (is_exact<T>) {
    std::memcpy(to, &item, sizeof(T));
    return to + sizeof(T);
  } else if constexpr (HasFields<T>) {
    for_each_field(item, [&to](const auto& field) { to = write_item(field, to); });
    return to;
  } else {
    for (const auto& each : item) to = write_item(each, to);
    return to;
  }
}

/// Reads what write_item() wrote and returns where it ends.
template <Flat T>
const std::byte* read_item(const std::byte* from, T& item) {
  if constexpr (is_exact<T>) {
    std::memcpy(&item, from, sizeof(T));
    return from + sizeof(T);
  } else if constexpr (HasFields<T>) {
    for_each_field(item, [&from](auto& field) { from = read_item(from, field); });
    return from;
  } else {
    for (auto& each : item) from = read_item(from, each);
    return from;
  }
}

/// As write_item() and read_item(), for items one after another.
template <Flat T>
void write_items(std::span<const T> items, std::byte* to) {
  if constexpr (is_exact<T>) {
    if (!items.empty()) std::memcpy(to, items.data(), items.size_bytes());
  } else {
    for (const T& item : items) to = write_item(item, to);
  }
}
template <Flat T>
void read_items(const std::byte* from, std::span<T> items) {
  if constexpr (is_exact<T>) {
    if (!items.empty()) std::memcpy(items.data(), from, items.size_bytes());
  } else {
    for (T& item : items) from = read_item(from, item);
  }
}

/// Whether both are the same bits, padding aside.
template <Flat T>
bool same_bits(const T& a, const T& b) {
  std::array<std::byte, wire_size<T>> bits_of_a, bits_of_b;
  write_item(a, bits_of_a.data());
  write_item(b, bits_of_b.data());
  return bits_of_a == bits_of_b;
}

}  // namespace aeroloom::parallel
