/// Documentation of a key: for the reference, the schema, the template and the completion.
#pragma once

#include "pipeline/case/yaml_value.hpp"

#include <string>
#include <utility>
#include <vector>

namespace aeroloom::cases {

/// The texts that every declaration of a key must give.
struct KeyDoc {
  /// `text`: Markdown sentences: what the key does and when to change it; links relative to docs/.
  /// `left_out`: what holds without the key, if its default is no constant or needs explanation. `example`: a
  /// YAML value for keys without a default. Where `left_out` and `example` are equal, that is the default.
  KeyDoc(const char* text, std::string left_out = "", std::string example = "")
      : text(text), left_out(std::move(left_out)), example(std::move(example)) {}

  std::string text, left_out, example;
  std::string option;   ///< option set by the key, as messages of stages name it: "SizingOptions::minimum"
  bool common = false;  ///< often used: the key is in the short template
};

/// Documentation of a key that many users set.
inline KeyDoc common(KeyDoc doc) {
  doc.common = true;
  return doc;
}

/// Documentation of a key whose option is named in messages of stages.
inline KeyDoc sets(const char* option, KeyDoc doc) {
  doc.option = option;
  return doc;
}

enum class KeyKind {
  section,  ///< a map with further keys
  named,    ///< a section whose name the user chooses; NAME in the path
  number,
  integer,
  flag,       ///< true or false
  text,       ///< not empty
  texts,      ///< a list of texts, or a single text
  choice,     ///< one of several names
  choices,    ///< a list of such names, or a single one
  point,      ///< a list of three numbers
  direction,  ///< a point without a unit
  interval,   ///< a list of two numbers, smaller one first
  box,        ///< a list of two points
  sections    ///< a list of maps of keys
};

struct KeyInfo {
  std::string path;  ///< "sizing.minimum"
  KeyKind kind = KeyKind::section;
  KeyDoc doc = "";
  Range range = {};                  ///< accepted numbers, with their unit
  std::vector<std::string> choices;  ///< accepted names; also as alternatives to a number
  std::string default_value;         ///< as YAML; empty: no default
  std::vector<KeyInfo> of_each;      ///< keys of one map of `sections`, with paths relative to it

  std::string name() const { return path.substr(path.rfind('.') + 1); }
  bool has_keys_below() const { return kind == KeyKind::section || kind == KeyKind::named; }
};

/// Stands in paths where the user chooses the name.
inline constexpr const char* made_up_name = "NAME";

/// All keys of a case in order of declaration; a section comes before its keys.
std::vector<KeyInfo> case_keys();

}  // namespace aeroloom::cases
