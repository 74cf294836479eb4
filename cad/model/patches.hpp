/// Patches of a model by name.
#pragma once

#include "aeroloom/cad/model/model.hpp"

#include <string>
#include <vector>

namespace aeroloom::cad {

/// Whether a name is like a pattern, in which * stands for any characters and ? for one.
bool matches_pattern(const std::string& name, const std::string& pattern);

/// The model with other patches: one name for each face, patches in the order of the faces that bring them.
/// What serialise() writes keeps the patches it had.
Model with_patches(const Model& model, const std::vector<std::string>& patch_of_face);

}  // namespace aeroloom::cad
