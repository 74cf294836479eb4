/// Reads CAD files with their names, layers, colours and units. Internal to cad/.
#pragma once

#include "cad/model/named_shape.hpp"

#include <string>

namespace aeroloom::cad {

/// The shape of a STEP, IGES or BREP file. Its unit is that of library_unit() for its extent. The content
/// decides about the format, not the extension. Names that are not UTF-8 are in `encoding`
/// (geometry::decode_names). Throws CadError for files that are damaged, empty or of another format, and
/// std::ios_base::failure if the file cannot be opened.
NamedShape read_cad_file(const std::string& file, const std::string& encoding = "");

/// "STEP", "IGES" or "BREP", recognised by content; empty for other files. Throws std::ios_base::failure if
/// the file cannot be opened.
std::string format_of_cad_file(const std::string& file);

/// The shapes come in `unit` of the file's, at most 1.
NamedShape read_step(const std::string& file, const std::string& encoding, double unit);
NamedShape read_iges(const std::string& file, const std::string& encoding);

}  // namespace aeroloom::cad
