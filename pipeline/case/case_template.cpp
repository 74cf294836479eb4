#include "pipeline/case/case_template.hpp"

#include "pipeline/case/key_text.hpp"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

namespace aeroloom::cases {

namespace {

constexpr std::size_t line_width = 100;

std::string comment(const std::string& text, const std::string& indent) {
  std::string lines;
  for (const std::string& line : wrapped(text, line_width - indent.size() - 2))
    lines.append(indent).append("# ").append(line).append("\n");
  return lines;
}

std::string quoted(const std::string& text) {
  YAML::Emitter emitter;
  emitter << text;
  return emitter.c_str();
}

std::string heading(const TemplateRequest& request) {
  std::string text;
  if (!request.schema.empty()) {
    text += "# yaml-language-server: $schema=" + request.schema + "\n" +
            comment(
                "The line above lets editors complete and check the keys (VS Code with the extension YAML, "
                "and all that speak to yaml-language-server; docs/usage.md).",
                "");
  }
  const char* const which =
      request.every_key ? "" : " Here are the keys that are often touched; `aeroloom init --full` has all.";
  return text + "#\n" +
         comment(
             std::string("A case of Aeroloom. A line such as `#extent: 10`, without a space, is a key at "
                         "its default: what is left out is so. Take the # away and change the value. Lines "
                         "that end in `# for example` have no default.") +
                 which + " All keys: docs/configuration.",
             "") +
         comment("Next: `aeroloom check CASE.yaml`, then `aeroloom run CASE.yaml`.", "");
}

/// What the key accepts and what holds where it is left out, as sentences; empty where both are plain.
std::string facts(const KeyInfo& key) {
  std::string text;
  if (key.kind != KeyKind::text && !key.has_keys_below()) {
    text = accepted_values(key) + ".";
    text[0] = static_cast<char>(std::toupper(text[0]));
  }
  if (key.doc.left_out.empty()) return text;
  return text + (text.empty() ? "" : " ") +
         (key.default_value.empty() ? "Left out: " : key.default_value + ": ") + key.doc.left_out + ".";
}

std::string value_line(const KeyInfo& key, const TemplateRequest& request) {
  if (key.path == "geometry.file" && !request.geometry.empty()) return "file: " + quoted(request.geometry);
  if (key.kind == KeyKind::named) return fmt::format("#{}:  # for example", key.doc.example);
  if (key.has_keys_below()) return key.name() + ":";
  // Below a name that is made up there is nothing without an example of one.
  const bool of_example = key.path.find(std::string(".") + made_up_name + ".") != std::string::npos;
  if (key.default_value.empty() || of_example)
    return fmt::format("#{}: {}  # for example", key.name(),
                       key.default_value.empty() ? key.doc.example : key.default_value);
  return fmt::format("#{}: {}", key.name(), key.default_value);
}

}  // namespace

std::string case_template(const std::vector<KeyInfo>& keys, const TemplateRequest& request) {
  std::string text = heading(request);
  for (const KeyInfo& key : keys) {
    if (!request.every_key && !key.doc.common) continue;
    const auto depth = static_cast<std::size_t>(std::count(key.path.begin(), key.path.end(), '.'));
    const std::string indent(2 * depth, ' ');
    if (key.kind == KeyKind::section) text += "\n";
    text += comment(without_links(key.doc.text), indent) + comment(facts(key), indent) + indent +
            value_line(key, request) + "\n";
  }
  return text;
}

}  // namespace aeroloom::cases
