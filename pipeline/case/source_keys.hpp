/// The keys of sizes in space: sizing.sources, sizing.expression.
#pragma once

#include "pipeline/case/case.hpp"
#include "pipeline/case/yaml_reader.hpp"

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace aeroloom::cases {

/// Declares `reference_length` in the section `sizing`.
void declare_reference_length(KeyTable& sizing, std::optional<double>& length);

/// Declares `expression` in the section `sizing`.
void declare_expression(KeyTable& sizing, std::string& expression);

/// Throws CaseError with the place for an invalid formula.
void check_expression(const KeyTable& keys, const std::string& expression);

/// The keys of one source while they are read. A shape is made once all are known.
struct SourceDraft {
  std::string name;
  std::string shape;  ///< name of the shape; empty: not given
  std::optional<double> size;
  std::map<std::string, std::optional<geometry::Vec3>> points = {};
  std::map<std::string, std::optional<double>> lengths = {};
  std::map<std::string, std::vector<std::string>> patterns = {};
};

/// Declares `sources` in the section `sizing`. Sources that are read are appended to `sources`, which must
/// outlive the table.
void declare_sources(KeyTable& sizing, std::deque<SourceDraft>& sources);

/// Throws CaseError if a source lacks a key of its shape or has one that its shape does not know.
void check_sources(const KeyTable& keys, const std::deque<SourceDraft>& sources);

/// Converts checked sources to rules, and back.
std::vector<SourceRule> rules_of(const std::deque<SourceDraft>& sources);
std::deque<SourceDraft> drafts_of(const std::vector<SourceRule>& rules);

}  // namespace aeroloom::cases
