/// Bodies of the communicator's templates. Included by communicator.hpp alone.
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <stdexcept>

namespace aeroloom::parallel {

template <Flat T>
std::vector<T> Communicator::all_gather_items(std::span<const T> mine) const {
  const std::vector<std::uint64_t> sizes = all_sizes(mine.size() * wire_size<T>);
  for (const std::uint64_t size : sizes) {
    if (size % wire_size<T> != 0) throw std::logic_error("all_gather_items: a part of an item");
  }
  const std::uint64_t bytes = std::accumulate(sizes.begin(), sizes.end(), std::uint64_t{0});
  if constexpr (is_exact<T>) {
    std::vector<T> all(bytes / sizeof(T));
    all_gather_into(std::as_bytes(mine), sizes, reinterpret_cast<std::byte*>(all.data()));
    return all;
  } else {
    Bytes all(bytes);
    all_gather_into(to_bytes(mine), sizes, all.data());
    return from_bytes<T>(all);
  }
}

template <Flat T, class Key>
std::vector<T> Communicator::gather_sorted(const std::vector<T>& mine, const Key& key) const {
  std::vector<T> all = all_gather_items(std::span<const T>(mine));
  std::sort(all.begin(), all.end(),
            [&](const T& a, const T& b) { return std::invoke(key, a) < std::invoke(key, b); });
  return all;
}

template <Flat T>
void Communicator::broadcast_items(std::vector<T>& items, Rank root) const {
  Bytes bytes = to_bytes(std::span<const T>(items));
  broadcast(bytes, root);
  items = from_bytes<T>(bytes);
}

template <class T>
void Communicator::broadcast_value(T& value, Rank root) const {
  Bytes bytes;
  if (rank() == root) bytes = to_wire(value);
  broadcast(bytes, root);
  if (rank() != root) value = from_wire<T>(bytes);
}

template <class T>
std::vector<T> Communicator::gather_values(const T& mine, Rank root) const {
  std::vector<T> values;
  for (const Bytes& bytes : gather(to_wire(mine), root)) values.push_back(from_wire<T>(bytes));
  return values;
}

template <class T>
std::vector<T> Communicator::all_gather_values(const T& mine) const {
  std::vector<T> values;
  for (const Bytes& bytes : all_gather(to_wire(mine))) values.push_back(from_wire<T>(bytes));
  return values;
}

}  // namespace aeroloom::parallel
