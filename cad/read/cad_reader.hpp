/// Reading of CAD files with what they say about names, layers, colours and units. Seen by this folder only.
#pragma once

#include "cad/model/named_shape.hpp"

#include <string>

namespace aeroloom::cad {

/// The shape of a STEP, IGES or BREP file (by content; the extension is only mentioned in messages), in the
/// file's declared unit. Throws CadError for files that are none of these, damaged or empty,
/// std::ios_base::failure when the file cannot be opened.
NamedShape read_cad_file(const std::string& file);

/// "STEP", "IGES" or "BREP", by content; empty for others. Throws std::ios_base::failure when the file
/// cannot be opened.
std::string format_of_cad_file(const std::string& file);

NamedShape read_step(const std::string& file);
NamedShape read_iges(const std::string& file);

}  // namespace aeroloom::cad
