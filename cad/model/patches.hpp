/// Name patterns, and patches of a model by name.
#pragma once

#include "cad/model/model.hpp"

#include <optional>
#include <regex>
#include <string>
#include <vector>

namespace aeroloom::cad {

/// A pattern for names. * stands for any characters, ? for one. After "re:" follows a regular expression
/// (ECMAScript), which may match anywhere in the name.
class NamePattern {
public:
  /// Throws std::invalid_argument if the text after "re:" is not a valid expression.
  explicit NamePattern(const std::string& text);
  bool matches(const std::string& name) const;

private:
  std::string _text;
  std::optional<std::regex> _expression;
};

/// Whether a name matches a pattern.
bool matches_pattern(const std::string& name, const std::string& pattern);

/// Whether the program has added a far field to it.
bool is_around_bodies(const Model& model);

/// The model with other patches. One name per face; patches are numbered in the order of faces. serialise()
/// still writes the old patches.
Model with_patches(const Model& model, const std::vector<std::string>& patch_of_face);

}  // namespace aeroloom::cad
