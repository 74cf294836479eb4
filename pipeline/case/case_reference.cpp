#include "pipeline/case/case_reference.hpp"

#include "pipeline/case/case_keys.hpp"
#include "pipeline/case/key_text.hpp"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

namespace aeroloom::cases {

namespace {

const std::string begin_mark =
    "<!-- keys: written by `aeroloom schema --markdown --output docs/configuration` -->\n";
const std::string begin_of_mark = "<!-- keys:";
const std::string end_mark = "<!-- end of keys -->\n";

std::string in_code(const std::string& text) {
  return "`" + text + "`";
}

/// Links relative to docs/ as links relative to docs/configuration/.
std::string with_links_from_pages(const std::string& markdown) {
  const std::string start = "](", of_pages = "configuration/";
  std::string text;
  std::size_t from = 0;
  for (std::size_t at = markdown.find(start); at != std::string::npos; at = markdown.find(start, from)) {
    text += markdown.substr(from, at + start.size() - from);
    from = at + start.size();
    if (markdown.compare(from, of_pages.size(), of_pages) == 0) {
      from += of_pages.size();
    } else {
      text += "../";
    }
  }
  return text + markdown.substr(from);
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
  const std::string in_full = length_unit, in_short = "(length)";  // as the list of sections explains
  if (const std::size_t at = accepted.find(in_full); at != std::string::npos)
    accepted.replace(at, in_full.size(), in_short);
  return fmt::format("| {} | {} | {} | {} |\n", in_code(key.path), default_cell(key), accepted,
                     with_links_from_pages(key.doc.text));
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

bool is_in(const KeyInfo& section, const KeyInfo& page) {
  return section.path == page.path || section.path.starts_with(page.path + ".");
}

std::string first_sentence(const std::string& text) {
  return text.substr(0, text.find(". ")) + (text.find(". ") == std::string::npos ? "" : ".");
}

/// The list of sections.
ReferencePage index_of(const std::vector<KeyInfo>& keys) {
  std::string text = "\n| section | holds |\n|---|---|\n";
  for (const KeyInfo& section : keys) {
    if (section.path.find('.') != std::string::npos) continue;
    text += fmt::format("| [{0}]({0}.md) | {1} |\n", section.path,
                        with_links_from_pages(first_sentence(section.doc.text)));
  }
  return {"README.md", "Configuration", begin_mark + text + "\n" + end_mark};
}

/// A section of the first level with all sections in it.
ReferencePage page_of(const std::vector<SectionKeys>& sections, const KeyInfo& page) {
  std::string text = begin_mark;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const KeyInfo& section = sections[i].section;
    if (!is_in(section, page)) continue;
    if (section.path != page.path) text += fmt::format("\n## {}\n", section.path);
    text += "\n" + with_links_from_pages(section.doc.text) + "\n";
    if (!sections[i].keys.empty()) text += "\n" + table(sections, i);
  }
  return {page.path + ".md", page.path, text + "\n" + end_mark};
}

}  // namespace

std::vector<ReferencePage> case_reference(const std::vector<KeyInfo>& keys) {
  const std::vector<SectionKeys> sections = sections_of(keys);
  std::vector<ReferencePage> pages{index_of(keys)};
  for (const SectionKeys& each : sections) {
    if (each.section.path.find('.') == std::string::npos) pages.push_back(page_of(sections, each.section));
  }
  return pages;
}

std::string new_page(const ReferencePage& page) {
  return "# " + page.title + "\n\n" + page.keys;
}

std::string with_reference(const std::string& text, const std::string& keys) {
  const std::size_t begin = text.find(begin_of_mark), end = text.find(end_mark);
  if (begin == std::string::npos || end == std::string::npos || end < begin) {
    throw std::invalid_argument(fmt::format(
        "there is no place for the keys; it begins with a line '{} ... -->' and ends with a line '{}'",
        begin_of_mark, end_mark.substr(0, end_mark.size() - 1)));
  }
  return text.substr(0, begin) + keys + text.substr(end + end_mark.size());
}

}  // namespace aeroloom::cases
