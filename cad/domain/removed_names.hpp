/// Names of the file that no face of the domain has. Internal to cad/.
#pragma once

#include "cad/domain/domain.hpp"
#include "cad/model/named_shape.hpp"

#include <string>
#include <vector>

namespace aeroloom::cad {

/// The names of faces and solids, and the layers, each once, in the order of the faces.
std::vector<std::string> names_of_file(const NamedShape& named);

/// Those of the names that no face and no patch of the model has, with the change that speaks of them.
std::vector<RemovedName> find_removed_names(const std::vector<std::string>& names, const Model& model,
                                            const Changes& changes);

}  // namespace aeroloom::cad
