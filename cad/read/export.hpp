/// Writes shapes to files. Internal to cad/.
#pragma once

#include "cad/model/named_shape.hpp"

#include <string>

namespace aeroloom::cad {

/// Writes a STEP file in the shape's unit, with the names of solids and faces. Faces inside of solids stand
/// beside them there. Throws CadError, and std::ios_base::failure if the file cannot be written.
void write_step(NamedShape named, const std::string& file);

}  // namespace aeroloom::cad
