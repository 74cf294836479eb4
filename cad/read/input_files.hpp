/// The files that a geometry comes from.
#pragma once

#include "cad/domain/domain.hpp"

#include <string>
#include <vector>

namespace aeroloom::cad {

/// All files that prepare_domain() reads for a case, in this order: its file, and those of its parts, each
/// followed by the file of points beside it that it refers to (.node beside .poly and .smesh). They need not
/// exist. Not collective.
std::vector<std::string> input_files_of(const DomainOptions& options);

}  // namespace aeroloom::cad
