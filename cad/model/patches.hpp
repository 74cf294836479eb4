/// Patches of a model by name.
#pragma once

#include "cad/model/model.hpp"

#include <optional>
#include <regex>
#include <string>
#include <vector>

namespace aeroloom::cad {

/// What names may be like: a name, in which * stands for any characters and ? for one, or behind "re:" a
/// regular expression (ECMAScript) that is found anywhere in the name unless ^ and $ tie it to the ends.
class NamePattern {
public:
  /// Throws std::invalid_argument where what follows "re:" is no regular expression.
  explicit NamePattern(const std::string& text);
  bool matches(const std::string& name) const;

private:
  std::string _text;
  std::optional<std::regex> _expression;
};

/// Whether a name is like a pattern.
bool matches_pattern(const std::string& name, const std::string& pattern);

/// The model with other patches: one name for each face, patches in the order of the faces that bring them.
/// What serialise() writes keeps the patches it had.
Model with_patches(const Model& model, const std::vector<std::string>& patch_of_face);

}  // namespace aeroloom::cad
