/// Rules of the case for patches: names, the faces they join, and their boundary conditions.
#pragma once

#include "cad/domain/domain.hpp"
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
  /// Name patterns (cad::NamePattern) of faces or patches; none: the patch of this name.
  std::vector<std::string> faces;
  std::optional<mesh::PatchType> type;  ///< boundary condition; empty: the default one
  std::optional<double> size = {};      ///< largest element size on it, in the model's unit
  bool optional = false;                ///< it may match nothing
  std::string where = {};               ///< place in the case, for messages: "case.yaml:7:3"
};

/// The patch of each face.
struct FacePatches {
  std::vector<std::string> patch_of_face;
  std::vector<char> taken;  ///< by face: 1 if the case assigns the patch, 0 if the model does
};

/// A model with the patches of the case and their boundary conditions.
struct TypedPatches {
  cad::Model model;
  std::vector<mesh::PatchType> types;  ///< by patch of the model
  std::vector<std::string> warnings;   ///< rules without effect, and unexpected effects
};

/// Assigns faces to patches: by the first group that selects them, else by the first rule that matches a
/// name; others keep their patch. Throws std::invalid_argument as find_groups(), for a pattern that matches
/// no face (with the nearest names, or with the reason if it names a face in `removed`), for a rule that
/// loses all faces to others, and for faces that strict groups leave out. Optional rules may match nothing.
FacePatches choose_patches(const cad::Model& model, const FaceGroups& groups,
                           const std::vector<PatchRule>& rules,
                           const std::vector<cad::RemovedName>& removed = {});

/// Applies the patches to the model. Groups and rules give boundary conditions. Defaults: a patch named as a
/// type, or as one of its usual synonyms ("symmetry_plane", "inflow"), has that type; far-field faces added
/// by the program are `farfield`; a patch of only inner faces is `interior`; others are walls.
TypedPatches apply_patches(const cad::Model& model, const FacePatches& chosen, const FaceGroups& groups,
                           const std::vector<PatchRule>& rules);

/// choose_patches(), then apply_patches().
TypedPatches apply_patch_rules(const cad::Model& model, const std::vector<PatchRule>& rules,
                               const FaceGroups& groups = {});

}  // namespace aeroloom::cases
