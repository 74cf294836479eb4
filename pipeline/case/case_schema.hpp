/// Writes the keys of a case as a JSON Schema. Editors complete and check case files with it.
#pragma once

#include "pipeline/case/key_info.hpp"

#include <string>
#include <vector>

namespace aeroloom::cases {

inline constexpr const char* schema_title = "Aeroloom case";

/// A schema of draft 7, which YAML language servers support best. It refuses the same keys, types and ranges
/// as read_case(), but knows no conditions between keys. It also refuses quoted numbers and flags and words
/// such as `yes`, which read_case() accepts.
std::string case_schema(const std::vector<KeyInfo>& keys);

}  // namespace aeroloom::cases
