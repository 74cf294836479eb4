/// Bodies of the communicator's templates. Included by communicator.hpp alone.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <stdexcept>

namespace aeroloom::parallel {

template <Transferable T>
std::vector<T> from_bytes(std::span<const std::byte> bytes) {
  if (bytes.size() % sizeof(T) != 0) {
    throw std::logic_error("from_bytes: " + std::to_string(bytes.size()) +
                           " bytes are no whole number of items");
  }
  std::vector<T> items(bytes.size() / sizeof(T));
  if (!bytes.empty()) std::memcpy(items.data(), bytes.data(), bytes.size());
  return items;
}

template <Transferable T>
std::vector<T> Communicator::all_gather_items(std::span<const T> mine) const {
  const std::vector<std::uint64_t> sizes = all_sizes(mine.size_bytes());
  std::uint64_t bytes = 0;
  for (const std::uint64_t size : sizes) {
    if (size % sizeof(T) != 0) throw std::logic_error("all_gather_items: a part of an item");
    bytes += size;
  }
  std::vector<T> all(bytes / sizeof(T));
  all_gather_into(std::as_bytes(mine), sizes, reinterpret_cast<std::byte*>(all.data()));
  return all;
}

template <Transferable T>
void Communicator::broadcast_items(std::vector<T>& items, Rank root) const {
  Bytes bytes = to_bytes(std::span<const T>(items));
  broadcast(bytes, root);
  items = from_bytes<T>(bytes);
}

template <Transferable T>
void Packer::value(const T& item) {
  append(&item, sizeof(T));
}

template <Transferable T>
void Packer::array(const std::vector<T>& items) {
  value(static_cast<std::uint64_t>(items.size()));
  append(items.data(), items.size() * sizeof(T));
}

template <Transferable T>
T Unpacker::value() {
  T item;
  copy(&item, sizeof(T));
  return item;
}

template <Transferable T>
std::vector<T> Unpacker::array() {
  const auto count = value<std::uint64_t>();
  if (count > (_bytes.size() - _position) / sizeof(T)) throw std::logic_error("Unpacker: array past the end");
  std::vector<T> items(count);
  copy(items.data(), count * sizeof(T));
  return items;
}

}  // namespace aeroloom::parallel
