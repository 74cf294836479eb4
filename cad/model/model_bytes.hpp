/// Writes numbers and texts to bytes and reads them, between ranks of the same program. Internal to cad/.
#pragma once

#include "cad/model/model.hpp"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace aeroloom::cad {

class ByteWriter {
public:
  template <class T>
  void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto* begin = reinterpret_cast<const std::byte*>(&value);
    bytes.insert(bytes.end(), begin, begin + sizeof(T));
  }
  void put_text(const std::string& text) {
    put<std::uint64_t>(text.size());
    const auto* begin = reinterpret_cast<const std::byte*>(text.data());
    bytes.insert(bytes.end(), begin, begin + text.size());
  }
  void put_texts(const std::vector<std::string>& texts) {
    put<std::uint64_t>(texts.size());
    for (const std::string& text : texts) put_text(text);
  }
  template <class T>
  void put_all(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    put<std::uint64_t>(values.size());
    const auto* begin = reinterpret_cast<const std::byte*>(values.data());
    bytes.insert(bytes.end(), begin, begin + values.size() * sizeof(T));
  }

  std::vector<std::byte> bytes;
};

class ByteReader {
public:
  explicit ByteReader(std::span<const std::byte> bytes) : _bytes(bytes) {}
  template <class T>
  T get() {
    T value;
    std::memcpy(&value, take(sizeof(T)), sizeof(T));
    return value;
  }
  std::string get_text() {
    const auto size = get<std::uint64_t>();
    return {reinterpret_cast<const char*>(take(size)), static_cast<std::size_t>(size)};
  }
  std::vector<std::string> get_texts() {
    std::vector<std::string> texts;
    for (auto left = get<std::uint64_t>(); left > 0; --left) texts.push_back(get_text());
    return texts;
  }
  template <class T>
  std::vector<T> get_all() {
    const auto size = get<std::uint64_t>();
    if (size > _bytes.size() / sizeof(T)) take(_bytes.size() + 1);
    std::vector<T> values(size);
    if (size > 0) std::memcpy(values.data(), take(size * sizeof(T)), size * sizeof(T));
    return values;
  }

private:
  const std::byte* take(std::uint64_t size) {
    if (size > _bytes.size() - _at) throw CadError("the model's bytes are truncated");
    const std::byte* begin = _bytes.data() + _at;
    _at += size;
    return begin;
  }

  std::span<const std::byte> _bytes;
  std::size_t _at = 0;
};

}  // namespace aeroloom::cad
