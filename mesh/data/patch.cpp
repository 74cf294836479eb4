#include "mesh/data/patch.hpp"

#include <utility>

namespace aeroloom::mesh {

namespace {

/// Small letters alone.
std::string letters_of(std::string_view name) {
  std::string letters;
  for (const char c : name) {
    if (c >= 'a' && c <= 'z') letters.push_back(c);
    if (c >= 'A' && c <= 'Z') letters.push_back(static_cast<char>(c - 'A' + 'a'));
  }
  return letters;
}

}  // namespace

std::optional<PatchType> patch_type_by_name(std::string_view name) {
  using Name = std::pair<std::string_view, PatchType>;
  constexpr std::array<Name, 12> names = {{{"wall", PatchType::wall},
                                           {"slip", PatchType::slip},
                                           {"symmetry", PatchType::symmetry},
                                           {"symmetryplane", PatchType::symmetry},
                                           {"sym", PatchType::symmetry},
                                           {"symm", PatchType::symmetry},
                                           {"farfield", PatchType::farfield},
                                           {"freestream", PatchType::farfield},
                                           {"inlet", PatchType::inlet},
                                           {"inflow", PatchType::inlet},
                                           {"outlet", PatchType::outlet},
                                           {"outflow", PatchType::outlet}}};
  const std::string letters = letters_of(name);
  for (const auto& [known, type] : names) {
    if (letters == known) return type;
  }
  return std::nullopt;
}

}  // namespace aeroloom::mesh
