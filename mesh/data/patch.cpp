#include "mesh/data/patch.hpp"

#include <utility>

namespace aeroloom::mesh {

namespace {

constexpr std::array<std::pair<std::string_view, PatchType>, 12> usual_names = {
    {{"wall", PatchType::wall},
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
  const std::string letters = letters_of(name);
  for (const auto& [known, type] : usual_names) {
    if (letters == known) return type;
  }
  return std::nullopt;
}

std::vector<std::string_view> usual_names_of(PatchType type) {
  std::vector<std::string_view> names;
  for (const auto& [known, its_type] : usual_names) {
    if (its_type == type) names.push_back(known);
  }
  return names;
}

}  // namespace aeroloom::mesh
