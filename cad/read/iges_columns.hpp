/// The columns of IGES files. Internal to cad/.
#pragma once

#include <optional>
#include <string>

namespace aeroloom::cad {

/// The text of an IGES file with all parameters in columns 1 to 64, where the format has them and the CAD
/// library looks for them. Some programs put the delimiter that ends a line into column 65, and the library
/// then takes two numbers for one. Parameters of such entities are laid out anew; the directory and the last
/// line count the new lines. Nothing where column 65 is blank everywhere, or where the directory does not
/// agree with the lines of parameters.
std::optional<std::string> with_right_columns(const std::string& text);

}  // namespace aeroloom::cad
