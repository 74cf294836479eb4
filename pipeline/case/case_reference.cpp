#include "pipeline/case/case_reference.hpp"

#include "pipeline/case/key_text.hpp"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

namespace aeroloom::cases {

namespace {

const std::string begin_mark =
    "<!-- keys: made by `aeroloom schema --markdown --output docs/configuration.md`; edit the texts where "
    "the "
    "keys are declared, case/*_keys.cpp -->\n";
const std::string begin_of_mark = "<!-- keys:";
const std::string end_mark = "<!-- end of keys -->\n";

std::string in_code(const std::string& text) {
  return "`" + text + "`";
}

std::string default_cell(const KeyInfo& key) {
  if (key.default_value.empty()) return key.doc.left_out.empty() ? "–" : key.doc.left_out;
  return in_code(key.default_value) + (key.doc.left_out.empty() ? "" : ": " + key.doc.left_out);
}

std::string row(const KeyInfo& key) {
  std::string accepted = accepted_values(key);
  if (!key.choices.empty()) {
    const bool list = key.kind == KeyKind::choices;
    accepted = (list ? "one or a list of `" : "`") + fmt::format("{}", fmt::join(key.choices, "`, `")) + "`";
  } else if (key.kind == KeyKind::flag) {
    accepted = "`true`, `false`";
  }
  return fmt::format("| {} | {} | {} | {} |\n", in_code(key.path), default_cell(key), accepted, key.doc.text);
}

bool is_below(const KeyInfo& key, const KeyInfo& section) {
  return key.path == section.path + "." + key.name();
}

/// A section with the keys right below it, those with a value.
struct SectionKeys {
  KeyInfo section;
  std::vector<KeyInfo> keys;
};

std::vector<SectionKeys> sections_of(const std::vector<KeyInfo>& keys) {
  std::vector<SectionKeys> sections;
  for (const KeyInfo& section : keys) {
    if (!section.has_keys_below()) continue;
    sections.push_back({section, {}});
    for (const KeyInfo& key : keys) {
      if (!key.has_keys_below() && is_below(key, section)) sections.back().keys.push_back(key);
    }
  }
  return sections;
}

bool same_but_for_defaults(const SectionKeys& one, const SectionKeys& other) {
  return std::equal(one.keys.begin(), one.keys.end(), other.keys.begin(), other.keys.end(),
                    [](const KeyInfo& a, const KeyInfo& b) {
                      return a.name() == b.name() && a.doc.text == b.doc.text &&
                             accepted_values(a) == accepted_values(b);
                    });
}

std::string table(const std::vector<SectionKeys>& sections, std::size_t which) {
  const SectionKeys& shown = sections[which];
  for (std::size_t other = 0; other < which; ++other) {
    if (!same_but_for_defaults(sections[other], shown)) continue;
    std::string text = fmt::format("Keys as in `{}`, with the defaults", sections[other].section.path);
    for (const KeyInfo& key : shown.keys)
      text += fmt::format("{} `{}: {}`", &key == shown.keys.data() ? "" : ",", key.name(), key.default_value);
    return text + ".\n";
  }
  std::string text = "| key | default | accepts | meaning |\n|---|---|---|---|\n";
  for (const KeyInfo& key : shown.keys) text += row(key);
  return text;
}

}  // namespace

std::string case_reference(const std::vector<KeyInfo>& keys) {
  const std::vector<SectionKeys> sections = sections_of(keys);
  std::string text = begin_mark;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const KeyInfo& section = sections[i].section;
    text += fmt::format("\n### {}\n\n{}\n", section.path, section.doc.text);
    if (!sections[i].keys.empty()) text += "\n" + table(sections, i);
  }
  return text + "\n" + end_mark;
}

std::string with_reference(const std::string& page, const std::string& reference) {
  const std::size_t begin = page.find(begin_of_mark), end = page.find(end_mark);
  if (begin == std::string::npos || end == std::string::npos || end < begin) {
    throw std::invalid_argument(fmt::format(
        "there is no place for the keys; it begins with a line '{} ... -->' and ends with a line '{}'",
        begin_of_mark, end_mark.substr(0, end_mark.size() - 1)));
  }
  return page.substr(0, begin) + reference + page.substr(end + end_mark.size());
}

}  // namespace aeroloom::cases
