/// Writing of shapes. Seen by this folder only.
#pragma once

#include "cad/model/named_shape.hpp"

#include <string>

namespace aeroloom::cad {

/// Writes a STEP file in the shape's unit, with the names of solids and faces. Throws CadError, or
/// std::ios_base::failure when the file cannot be written.
void write_step(const NamedShape& named, const std::string& file);

}  // namespace aeroloom::cad
