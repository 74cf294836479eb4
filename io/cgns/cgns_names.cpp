#include "io/cgns/cgns_names.hpp"

#include <algorithm>

namespace aeroloom::io::cgns {

namespace {

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
  return made_fit(cut_name(name, longest_name - std::min(ending.size(), longest_name)) + ending);
}

}  // namespace

bool is_fit(const std::string& name) {
  return !name.empty() && name.size() <= longest_name && made_fit(name) == name;
}

std::string NodeNames::take(const std::string& wanted, const std::string& stand_in,
                            const std::string& ending) {
  const std::string name = made_fit(wanted.empty() ? stand_in : wanted);
  return _taken.take(name + '/' + ending,
                     [&](const std::string& number) { return with_ending(name, number + ending); });
}

}  // namespace aeroloom::io::cgns
