#include "cad/model/patches.hpp"

#include "cad/model/model_data.hpp"

#include <algorithm>
#include <memory>
#include <stdexcept>

#include <fmt/format.h>

namespace aeroloom::cad {

namespace {

const std::string expression_mark = "re:";

/// Patterns with * and ?.
bool matches_glob(const std::string& name, const std::string& pattern) {
  // Where the last star was, and where in the name what follows it was tried.
  std::size_t n = 0, p = 0, star = std::string::npos, tried = 0;
  while (n < name.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++, tried = n;
    } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == name[n])) {
      ++p, ++n;
    } else if (star != std::string::npos) {
      p = star + 1, n = ++tried;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', p) == std::string::npos;
}

}  // namespace

NamePattern::NamePattern(const std::string& text) : _text(text) {
  if (!text.starts_with(expression_mark)) return;
  if (text == expression_mark)
    throw std::invalid_argument(fmt::format("'{}' has no regular expression, and would match all", text));
  auto options = std::regex::ECMAScript | std::regex::optimize;
#ifdef __GLIBCXX__
  // In time that grows with the name alone; refuses back references.
  options |= std::regex_constants::__polynomial;
#endif
  try {
    _expression.emplace(text.substr(expression_mark.size()), options);
  } catch (const std::regex_error& error) {
    throw std::invalid_argument(fmt::format("'{}' is no regular expression: {}", text, error.what()));
  }
}

bool NamePattern::matches(const std::string& name) const {
  return _expression ? std::regex_search(name, *_expression) : matches_glob(name, _text);
}

bool matches_pattern(const std::string& name, const std::string& pattern) {
  return NamePattern(pattern).matches(name);
}

std::int32_t patch_number(std::vector<std::string>& patches, const std::string& name) {
  const auto found = std::find(patches.begin(), patches.end(), name);
  const auto number = static_cast<std::int32_t>(found - patches.begin());
  if (found == patches.end()) patches.push_back(name);
  return number;
}

bool is_around_bodies(const Model& model) {
  for (FaceId f = 0; f < model.face_count(); ++f)
    if (model.is_far_field(f)) return true;
  return false;
}

Model with_patches(const Model& model, const std::vector<std::string>& patch_of_face) {
  auto data = std::make_shared<Model::Data>(model.data());
  if (patch_of_face.size() != data->faces.size())
    throw std::logic_error("patches and faces differ in number");
  data->patches.clear();
  for (std::size_t f = 0; f < patch_of_face.size(); ++f)
    data->faces[f].patch = patch_number(data->patches, patch_of_face[f]);
  return Model(std::move(data));
}

}  // namespace aeroloom::cad
