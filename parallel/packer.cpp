#include "parallel/communicator.hpp"

#include <stdexcept>

namespace aeroloom::parallel {

void Packer::text(const std::string& text) {
  value(static_cast<std::uint64_t>(text.size()));
  append(text.data(), text.size());
}

void Packer::append(const void* data, std::size_t count) {
  const auto* first = static_cast<const std::byte*>(data);
  _bytes.insert(_bytes.end(), first, first + count);
}

std::string Unpacker::text() {
  const auto count = value<std::uint64_t>();
  if (count > _bytes.size() - _position) throw std::logic_error("Unpacker: text past the end");
  std::string text(count, '\0');
  copy(text.data(), count);
  return text;
}

void Unpacker::copy(void* to, std::size_t count) {
  if (count > _bytes.size() - _position) throw std::logic_error("Unpacker: value past the end");
  if (count > 0) std::memcpy(to, _bytes.data() + _position, count);
  _position += count;
}

}  // namespace aeroloom::parallel
