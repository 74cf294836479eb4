#include "geometry/long_names.hpp"

#include <cstdint>

#include <fmt/format.h>

namespace aeroloom::geometry {

namespace {

/// FNV-1a (Fowler, Noll and Vo), 64 bits: the same on every machine.
std::uint64_t sign_of(const std::string& name) {
  std::uint64_t sign = 14695981039346656037ULL;
  for (const char c : name) sign = (sign ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return sign;
}

}  // namespace

bool cut_long_name(std::string& name) {
  if (name.size() <= longest_name) return false;
  const std::string sign = fmt::format("~{:016x}", sign_of(name));
  std::size_t length = longest_name - sign.size();
  while (length > 0 && (static_cast<unsigned char>(name[length]) & 0xC0U) == 0x80U) --length;
  name.resize(length);
  name += sign;
  return true;
}

std::string long_names_text(std::size_t names) {
  return fmt::format("{} names are longer than {} bytes: only their beginnings are read", names,
                     longest_name);
}

}  // namespace aeroloom::geometry
