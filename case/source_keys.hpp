/// The keys below sizing.sources.
#pragma once

#include "aeroloom/case/source_rules.hpp"
#include "case/yaml_reader.hpp"

#include <deque>

namespace aeroloom::cases {

/// Declares `sources` in the section of sizes; rules that are read are added to `rules`, which must outlive
/// the table.
void declare_sources(KeyTable& sizing, std::deque<SourceRule>& rules);

/// Throws CaseError where a rule lacks what its shape needs, or has what it has no place for.
void check_sources(const KeyTable& keys, const std::deque<SourceRule>& rules);

}  // namespace aeroloom::cases
