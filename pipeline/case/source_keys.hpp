/// The keys of sizes at places: sizing.sources, sizing.expression.
#pragma once

#include "pipeline/case/case.hpp"
#include "pipeline/case/yaml_reader.hpp"

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace aeroloom::cases {

/// Declares `reference_length` in the section of sizes.
void declare_reference_length(KeyTable& sizing, std::optional<double>& length);

/// Declares `expression` in the section of sizes.
void declare_expression(KeyTable& sizing, std::string& expression);

/// Throws CaseError, with place and what is wrong, for what is no formula.
void check_expression(const KeyTable& keys, const std::string& expression);

/// Values of the keys of a source by key. Keys are read one by one, so that only all of them make a shape.
struct SourceDraft {
  std::string name;
  std::string shape;  ///< name of the shape; empty: not given
  std::optional<double> size;
  std::map<std::string, std::optional<geometry::Vec3>> points = {};
  std::map<std::string, std::optional<double>> lengths = {};
  std::map<std::string, std::vector<std::string>> patterns = {};
};

/// Declares `sources` in the section of sizes; those that are read are added to `sources`, which must outlive
/// the table.
void declare_sources(KeyTable& sizing, std::deque<SourceDraft>& sources);

/// Throws CaseError where a source lacks what its shape needs, or has what it has no place for.
void check_sources(const KeyTable& keys, const std::deque<SourceDraft>& sources);

/// The rules that checked sources make, and back.
std::vector<SourceRule> rules_of(const std::deque<SourceDraft>& sources);
std::deque<SourceDraft> drafts_of(const std::vector<SourceRule>& rules);

}  // namespace aeroloom::cases
