#include "io/cgns/cgns_names.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace aeroloom::io::cgns {

namespace {

/// The longest beginning of at most `bytes` bytes that ends between two characters.
std::string cut(const std::string& name, std::size_t bytes) {
  if (name.size() <= bytes) return name;
  std::size_t end = bytes;
  const auto continues = [](char letter) { return (static_cast<unsigned char>(letter) & 0xC0U) == 0x80U; };
  while (end > 0 && continues(name[end])) --end;
  return name.substr(0, end == 0 ? bytes : end);
}

std::string made_fit(std::string name) {
  for (char& letter : name) {
    const auto code = static_cast<unsigned char>(letter);
    if (letter == '/' || code < 0x20 || code == 0x7F) letter = '_';
  }
  if (!name.empty() && name.front() == ' ') name.front() = '_';
  if (!name.empty() && name.back() == ' ') name.back() = '_';
  if (name.find_first_not_of('.') == std::string::npos) std::fill(name.begin(), name.end(), '_');
  return name;
}

/// As made_fit; a blank at which a name is cut is no end of a name.
std::string with_ending(const std::string& name, const std::string& ending) {
  return made_fit(cut(name, longest_name - std::min(ending.size(), longest_name)) + ending);
}

}  // namespace

bool is_fit(const std::string& name) {
  return !name.empty() && name.size() <= longest_name && made_fit(name) == name;
}

std::string NodeNames::take(const std::string& wanted, const std::string& stand_in,
                            const std::string& ending) {
  const std::string name = made_fit(wanted.empty() ? stand_in : wanted);
  std::string result = with_ending(name, ending);
  for (int number = 2; !_taken.insert(result).second; ++number)
    result = with_ending(name, fmt::format("_{}{}", number, ending));
  return result;
}

}  // namespace aeroloom::io::cgns
