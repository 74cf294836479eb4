#include "parallel/communication/packer.hpp"

namespace aeroloom::parallel {

void Packer::text(const std::string& text) {
  array(std::span<const char>(text));
}

void Packer::append(std::span<const std::byte> bytes) {
  _bytes.insert(_bytes.end(), bytes.begin(), bytes.end());
}

std::byte* Packer::extend(std::size_t count) {
  _bytes.resize(_bytes.size() + count);
  return _bytes.data() + (_bytes.size() - count);
}

std::string Unpacker::text() {
  std::string text(count(1), '\0');
  read_items(advance(text.size()), std::span<char>(text));
  return text;
}

std::size_t Unpacker::count(std::size_t bytes) {
  const auto count = value<std::uint64_t>();
  if (bytes > 0 && count > (_bytes.size() - _position) / bytes)
    throw std::logic_error("Unpacker: a count past the end");
  return count;
}

const std::byte* Unpacker::advance(std::size_t count) {
  if (count > _bytes.size() - _position) throw std::logic_error("Unpacker: past the end");
  _position += count;
  return _bytes.data() + (_position - count);
}

}  // namespace aeroloom::parallel
