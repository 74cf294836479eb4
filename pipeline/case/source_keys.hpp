/// The keys of sizes at places: sizing.sources, sizing.expression.
#pragma once

#include "pipeline/case/source_rules.hpp"
#include "pipeline/case/yaml_reader.hpp"

#include <deque>
#include <optional>
#include <string>

namespace aeroloom::cases {

/// Declares `reference_length` in the section of sizes.
void declare_reference_length(KeyTable& sizing, std::optional<double>& length);

/// Declares `expression` in the section of sizes.
void declare_expression(KeyTable& sizing, std::string& expression);

/// Throws CaseError, with place and what is wrong, for what is no formula.
void check_expression(const KeyTable& keys, const std::string& expression);

/// Declares `sources` in the section of sizes; rules that are read are added to `rules`, which must outlive
/// the table.
void declare_sources(KeyTable& sizing, std::deque<SourceRule>& rules);

/// Throws CaseError where a rule lacks what its shape needs, or has what it has no place for.
void check_sources(const KeyTable& keys, const std::deque<SourceRule>& rules);

}  // namespace aeroloom::cases
