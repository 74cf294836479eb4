/// What a user is told of a key of the case: for the reference, the schema, the template, the completion.
#pragma once

#include "pipeline/case/yaml_value.hpp"

#include <string>
#include <utility>
#include <vector>

namespace aeroloom::cases {

/// The documentation of a key, which every declaration has to bring.
struct KeyDoc {
  /// `text`: sentences in Markdown, what the key does and when to touch it; links are relative to docs/.
  /// `left_out`: what holds where the key is not given and its default is no constant, or what the default
  /// stands for. `example`: a value, as YAML, for keys without a default. Where both are the same, this is
  /// the default.
  KeyDoc(const char* text, std::string left_out = "", std::string example = "")
      : text(text), left_out(std::move(left_out)), example(std::move(example)) {}

  std::string text, left_out, example;
  std::string option;   ///< that it sets, where messages of stages name it: "SizingOptions::minimum"
  bool common = false;  ///< touched by many, and so in the short template
};

/// The text of a key that many users touch.
inline KeyDoc common(KeyDoc doc) {
  doc.common = true;
  return doc;
}

/// The text of a key that sets an option which messages of stages name.
inline KeyDoc sets(const char* option, KeyDoc doc) {
  doc.option = option;
  return doc;
}

enum class KeyKind {
  section,  ///< with keys below it
  named,    ///< as a section, but of a name that the user makes up; the path has NAME there
  number,
  integer,
  flag,       ///< true or false
  text,       ///< not empty
  texts,      ///< a list of texts, or one alone
  choice,     ///< one of names
  choices,    ///< a list of such names, or one alone
  point,      ///< a list of three numbers
  direction,  ///< the same, without a unit
  interval,   ///< a list of two numbers, the smaller one first
  box,        ///< a list of two points
  sections    ///< a list of maps of keys
};

struct KeyInfo {
  std::string path;  ///< "sizing.minimum"
  KeyKind kind = KeyKind::section;
  KeyDoc doc = "";
  Range range = {};                  ///< of numbers, with their unit
  std::vector<std::string> choices;  ///< names that are accepted, in place of a number as well
  std::string default_value;         ///< as YAML; empty where there is none
  std::vector<KeyInfo> of_each;      ///< keys of a map of `sections`, their paths from there

  std::string name() const { return path.substr(path.rfind('.') + 1); }
  bool has_keys_below() const { return kind == KeyKind::section || kind == KeyKind::named; }
};

/// Where users make up names, paths of KeyInfo have this.
inline constexpr const char* made_up_name = "NAME";

/// All keys of a case in the order of declaration, a section before what is below it.
std::vector<KeyInfo> case_keys();

}  // namespace aeroloom::cases
