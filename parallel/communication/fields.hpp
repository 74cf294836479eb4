/// The members of structs, for structs that travel between ranks and into files. Members travel in the order
/// of their declaration, without the padding between them.
#pragma once

#include <array>
#include <cstddef>
#include <cstring>
#include <exception>
#include <optional>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>

namespace aeroloom::parallel {

/// A struct that lists all its members in the order of their declaration:
///   static constexpr auto fields() { return std::tuple(&Sharer::vertex_key, &Sharer::piece); }
/// Only structs whose members cannot be counted need it: those with more than `most_members` members, C
/// arrays, base classes (whose members come first) or constructors. A list without one of the members does
/// not compile, unless that member fits into padding.
template <class T>
concept ListsFields = requires {
  T::fields();
};

/// Converts to any type; never called. It does not convert to an optional whose constructor takes it as the
/// item: two ways would be ambiguous.
struct AnyValue {
  template <class U>
  static constexpr bool is_made_from_item = false;
  template <class U>
  requires(!is_made_from_item<U>) operator U() const { std::terminate(); }
};
template <class U>
inline constexpr bool AnyValue::is_made_from_item<std::optional<U>> = std::is_constructible_v<U, AnyValue>;

inline constexpr std::size_t most_members = 14;

/// The number of values that can initialise the struct: of its members, unless one is a C array.
template <class T, class... Values>
consteval std::size_t count_members() {
  if constexpr (sizeof...(Values) <= most_members && requires { T{Values{}..., AnyValue{}}; })
    return count_members<T, Values..., AnyValue>();
  return sizeof...(Values);
}

template <class T>
concept IsTuple = requires {
  std::tuple_size<T>::value;
};

/// An aggregate of 1 to `most_members` members, other than std::array.
template <class T>
concept HasCountedFields = std::is_class_v<T> && std::is_aggregate_v<T> && !IsTuple<T> &&
                           count_members<std::remove_const_t<T>>() - 1 < most_members;

/// A struct whose members can be reached one after another.
template <class T>
concept HasFields = ListsFields<T> || HasCountedFields<T>;

template <class T>
struct FlatTraits;

/// Types whose values all take the same number of bytes: numbers, enumerations, arrays of flat items, and
/// trivially copyable structs of flat members.
template <class T>
concept Flat = FlatTraits<T>::is_flat;

/// The bytes of one item in a message.
template <Flat T>
inline constexpr std::size_t wire_size = FlatTraits<T>::bytes;

/// Whether T has no padding. Such items travel as they lie in memory.
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

/// The members of a struct, as references that std::apply takes, in the order of their declaration.
template <HasFields T>
constexpr auto fields_of(T& item) {
  constexpr std::size_t count = count_members<std::remove_const_t<T>>();
  if constexpr (ListsFields<T>) {
    return std::apply([&](const auto... members) { return std::tie(item.*members...); }, T::fields());
  } else if constexpr (count == 1) {
    auto& [a] = item;
    return std::tie(a);
  } else if constexpr (count == 2) {
    auto& [a, b] = item;
    return std::tie(a, b);
  } else if constexpr (count == 3) {
    auto& [a, b, c] = item;
    return std::tie(a, b, c);
  } else if constexpr (count == 4) {
    auto& [a, b, c, d] = item;
    return std::tie(a, b, c, d);
  } else if constexpr (count == 5) {
    auto& [a, b, c, d, e] = item;
    return std::tie(a, b, c, d, e);
  } else if constexpr (count == 6) {
    auto& [a, b, c, d, e, f] = item;
    return std::tie(a, b, c, d, e, f);
  } else if constexpr (count == 7) {
    auto& [a, b, c, d, e, f, g] = item;
    return std::tie(a, b, c, d, e, f, g);
  } else if constexpr (count == 8) {
    auto& [a, b, c, d, e, f, g, h] = item;
    return std::tie(a, b, c, d, e, f, g, h);
  } else if constexpr (count == 9) {
    auto& [a, b, c, d, e, f, g, h, i] = item;
    return std::tie(a, b, c, d, e, f, g, h, i);
  } else if constexpr (count == 10) {
    auto& [a, b, c, d, e, f, g, h, i, j] = item;
    return std::tie(a, b, c, d, e, f, g, h, i, j);
  } else if constexpr (count == 11) {
    auto& [a, b, c, d, e, f, g, h, i, j, k] = item;
    return std::tie(a, b, c, d, e, f, g, h, i, j, k);
  } else if constexpr (count == 12) {
    auto& [a, b, c, d, e, f, g, h, i, j, k, l] = item;
    return std::tie(a, b, c, d, e, f, g, h, i, j, k, l);
  } else if constexpr (count == 13) {
    auto& [a, b, c, d, e, f, g, h, i, j, k, l, m] = item;
    return std::tie(a, b, c, d, e, f, g, h, i, j, k, l, m);
  } else if constexpr (count == 14) {
    auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n] = item;
    return std::tie(a, b, c, d, e, f, g, h, i, j, k, l, m, n);
  }
}

/// The types of members.
template <class Fields>
struct Members;
template <class... M>
struct Members<std::tuple<M&...>> {
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
template <class T>
constexpr bool fields_are_distinct() {
  return true;
}
template <ListsFields T>
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
  using List = Members<decltype(fields_of(std::declval<T&>()))>;
  static_assert(fields_are_distinct<T>(), "fields() lists each member once");
  static_assert(List::size_with(alignof(T)) == sizeof(T), "fields() lists all members in their order");
  static constexpr bool is_flat = std::is_trivially_copyable_v<T> && List::are_flat;
  static constexpr std::size_t bytes = List::bytes;
};

/// Calls visit(member) for each field.
template <HasFields T, class Visit>
constexpr void for_each_field(T& item, const Visit& visit) {
  std::apply([&](auto&... fields) { (visit(fields), ...); }, fields_of(item));
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
