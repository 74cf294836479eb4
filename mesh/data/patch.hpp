/// Types of patches of the boundary, as solvers know them.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace aeroloom::mesh {

/// `interior` is no condition: faces between two regions.
enum class PatchType : unsigned char { wall, slip, symmetry, farfield, inlet, outlet, interior };
inline constexpr std::array<std::string_view, 7> patch_type_names = {
    "wall", "slip", "symmetry", "farfield", "inlet", "outlet", "interior"};

inline std::string_view name_of(PatchType type) {
  return patch_type_names[static_cast<std::size_t>(type)];
}
/// Empty where no type has this name.
inline std::optional<PatchType> patch_type_of(std::string_view name) {
  for (std::size_t i = 0; i < patch_type_names.size(); ++i) {
    if (patch_type_names[i] == name) return static_cast<PatchType>(i);
  }
  return std::nullopt;
}

/// The type of a patch by its name alone, whatever else than letters is in it: that of a type ("far_field"),
/// or one of its usual other names ("symmetry plane", "Inflow 2"). Empty: nothing to tell. Never `interior`.
std::optional<PatchType> patch_type_by_name(std::string_view name);

/// The names, in small letters alone, that patch_type_by_name() takes for this type.
std::vector<std::string_view> usual_names_of(PatchType type);

/// A patch as solvers know it.
struct Patch {
  std::string name;
  PatchType type = PatchType::wall;
  friend bool operator==(const Patch&, const Patch&) = default;
};

}  // namespace aeroloom::mesh
