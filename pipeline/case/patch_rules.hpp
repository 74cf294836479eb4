/// Rules of the case for patches: names, which faces they join, and what they are to a solver.
#pragma once

#include "cad/model/model.hpp"
#include "mesh/data/patch.hpp"
#include "pipeline/case/face_groups.hpp"

#include <optional>
#include <string>
#include <vector>

namespace aeroloom::cases {

/// A patch of the case.
struct PatchRule {
  std::string name;
  /// Patterns (cad::NamePattern) of faces' or patches' names; none: the patch of this name.
  std::vector<std::string> faces;
  std::optional<mesh::PatchType> type;  ///< empty: what suits it by default
  std::optional<double> size = {};      ///< largest size of elements on it, in the model's unit
};

/// Which patch each face belongs to.
struct FacePatches {
  std::vector<std::string> patch_of_face;
  std::vector<char> taken;  ///< by face: whether the case says so, and not the model alone
};

/// A model with the patches of the case, and what each of them is.
struct TypedPatches {
  cad::Model model;
  std::vector<mesh::PatchType> types;  ///< by patch of the model
  std::vector<std::string> warnings;   ///< what the rules ask for and do not get, or get and may not expect
};

/// Joins faces into patches: by the first group that selects them, else by the first rule that one of their
/// names matches; others keep their patch. Throws std::invalid_argument as find_groups(); with the nearest
/// names for a pattern that matches no face, and for a rule whose faces others have all taken; for faces that
/// strict groups leave out.
FacePatches choose_patches(const cad::Model& model, const FaceGroups& groups,
                           const std::vector<PatchRule>& rules);

/// The model with these patches, and what each of them is: what groups and rules say. By
/// default a patch called as its type or one of its usual other names ("symmetry_plane", "inflow") is that,
/// what the program added around a body is `farfield`, all others are walls; a patch with faces between
/// regions alone is `interior`.
TypedPatches apply_patches(const cad::Model& model, const FacePatches& chosen, const FaceGroups& groups,
                           const std::vector<PatchRule>& rules);

/// Both, one after the other.
TypedPatches apply_patch_rules(const cad::Model& model, const std::vector<PatchRule>& rules,
                               const FaceGroups& groups = {});

}  // namespace aeroloom::cases
