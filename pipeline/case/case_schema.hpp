/// The keys of a case as a JSON Schema, with which editors complete and check cases.
#pragma once

#include "pipeline/case/key_info.hpp"

#include <string>
#include <vector>

namespace aeroloom::cases {

inline constexpr const char* schema_title = "Aeroloom case";

/// Draft 7, which YAML language servers know best. It refuses the keys, types and ranges that read_case
/// refuses; what keys have to do with each other is left to read_case. Numbers and flags in quotes, and words
/// such as `yes`, are refused though read_case takes them.
std::string case_schema(const std::vector<KeyInfo>& keys);

}  // namespace aeroloom::cases
