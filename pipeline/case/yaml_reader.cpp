#include "pipeline/case/yaml_reader.hpp"

#include "geometry/input_file.hpp"
#include "pipeline/case/nearest_name.hpp"
#include "pipeline/case/other_meshers.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <set>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

namespace aeroloom::cases {

namespace {

/// Names between dots; no key of any case has so many.
constexpr std::size_t deepest_key = 20;

std::string position(const YAML::Mark& mark) {
  return mark.is_null() ? "" : fmt::format(":{}:{}", mark.line + 1, mark.column + 1);
}

/// The one document of a text; a null node when it is empty.
YAML::Node parse(const std::string& text, const std::string& name, bool positions) {
  std::vector<YAML::Node> documents;
  try {
    documents = YAML::LoadAll(text);
  } catch (const YAML::Exception& error) {
    const bool anchor = error.msg.find("anchor") != std::string::npos;
    throw CaseError(fmt::format("{}{}: not valid YAML: {}{}", name, positions ? position(error.mark) : "",
                                error.msg, anchor ? "; a text that begins with * stands in quotes" : ""));
  }
  if (documents.size() > 1) throw CaseError(name + ": several YAML documents, one is expected");
  return documents.empty() ? YAML::Node() : documents[0];
}

}  // namespace

/// What is being read.
struct KeyTable::Source {
  std::string name;  // a file, or "--set a.b=c"
  bool positions;    // whether line and column mean anything to the user
  const KeyTable& root;
};

std::string KeyTable::origin_in(const Source& source, const YAML::Node& node) {
  return source.positions ? source.name + position(node.Mark()) : source.name;
}

KeyTable::KeyEntry& KeyTable::add(const std::string& name, KeyKind kind, const KeyDoc& doc) {
  KeyEntry entry;
  entry.name = name;
  entry.info.path = path_of(name);
  entry.info.kind = kind;
  entry.info.doc = doc;
  _places.try_emplace(name, _entries.size());
  _entries.push_back(std::move(entry));
  return _entries.back();
}

void KeyTable::add(const std::string& name, KeyKind kind, const KeyDoc& doc, const Range& range,
                   std::function<void(const YamlValue&)> read,
                   std::function<std::optional<std::string>()> written) {
  KeyEntry& entry = add(name, kind, doc);
  entry.info.range = range;
  entry.read = std::move(read);
  entry.written = std::move(written);
}

KeyTable& KeyTable::section(const std::string& name, const KeyDoc& doc, bool* given) {
  KeyEntry& entry = add(name, _declare_named ? KeyKind::named : KeyKind::section, doc);
  entry.given = given;
  entry.below = std::make_unique<KeyTable>();
  entry.below->_path = entry.info.path;
  return *entry.below;
}

void KeyTable::number(const std::string& name, double& target, const Range& range, const KeyDoc& doc) {
  add(
      name, KeyKind::number, doc, range,
      [&target, range](const YamlValue& value) { target = value.number(range); },
      [&target] { return shortest(target); });
}

void KeyTable::number(const std::string& name, std::optional<double>& target, const Range& range,
                      const KeyDoc& doc) {
  add(
      name, KeyKind::number, doc, range,
      [&target, range](const YamlValue& value) { target = value.number(range); },
      [&target] { return target ? std::optional(shortest(*target)) : std::nullopt; });
}

void KeyTable::number_or(const std::string& word, bool& is_word, const std::string& name,
                         std::optional<double>& target, const Range& range, const KeyDoc& doc) {
  add(
      name, KeyKind::number, doc, range,
      [&target, &is_word, word, range](const YamlValue& value) {
        target = value.number_or(range, word);
        is_word = !target;
      },
      [&target, &is_word, word] {
        return is_word ? std::optional(word) : target ? std::optional(shortest(*target)) : std::nullopt;
      });
  _entries.back().info.choices = {word};
}

void KeyTable::integer(const std::string& name, std::int64_t& target, const Range& range, const KeyDoc& doc) {
  add(
      name, KeyKind::integer, doc, range,
      [&target, range](const YamlValue& value) { target = value.integer(range); },
      [&target] { return std::to_string(target); });
}

void KeyTable::integer(const std::string& name, std::optional<std::int64_t>& target, const Range& range,
                       const KeyDoc& doc) {
  add(
      name, KeyKind::integer, doc, range,
      [&target, range](const YamlValue& value) { target = value.integer(range); },
      [&target] { return target ? std::optional(std::to_string(*target)) : std::nullopt; });
}

void KeyTable::integer(const std::string& name, int& target, const Range& range, const KeyDoc& doc) {
  add(
      name, KeyKind::integer, doc, range,
      [&target, range](const YamlValue& value) { target = static_cast<int>(value.integer(range)); },
      [&target] { return std::to_string(target); });
}

void KeyTable::flag(const std::string& name, bool& target, const KeyDoc& doc) {
  add(
      name, KeyKind::flag, doc, {}, [&target](const YamlValue& value) { target = value.flag(); },
      [&target] { return target ? "true" : "false"; });
}

void KeyTable::text(const std::string& name, std::string& target, const KeyDoc& doc) {
  add(
      name, KeyKind::text, doc, {}, [&target](const YamlValue& value) { target = value.text(); },
      [&target] { return target.empty() ? std::nullopt : std::optional(target); });
}

void KeyTable::path(const std::string& name, std::string& target, const KeyDoc& doc) {
  text(name, target, doc);
  _entries.back().read = [&target](const YamlValue& value) { target = value.path(); };
}

void KeyTable::texts(const std::string& name, std::vector<std::string>& target, const KeyDoc& doc) {
  KeyEntry& entry = add(name, KeyKind::texts, doc);
  entry.read = [&target](const YamlValue& value) { target = value.texts(); };
  entry.listed = [&target] { return target; };
}

void KeyTable::point(const std::string& name, std::optional<geometry::Vec3>& target, const KeyDoc& doc) {
  KeyEntry& entry = add(name, KeyKind::point, doc);
  entry.read = [&target](const YamlValue& value) { target = value.point(); };
  entry.listed = [&target]() -> std::vector<std::string> {
    if (!target) return {};
    return {shortest(target->x), shortest(target->y), shortest(target->z)};
  };
}

KeyTable& KeyTable::named_sections(const std::string& name, const KeyDoc& doc, const KeyDoc& doc_of_each,
                                   std::function<void(const std::string&, KeyTable&)> declare) {
  KeyTable& below = section(name, doc);
  below._declare_named = std::move(declare);
  below._doc_of_named = doc_of_each;
  return below;
}

void KeyTable::add_named(const std::string& name, const std::string& made_up) {
  KeyTable* table = this;
  for (std::size_t at = 0; at < name.size();) {
    const std::size_t end = std::min(name.find('.', at), name.size());
    table = table->find(name.substr(at, end - at))->below.get();
    at = end + 1;
  }
  table->make_named(made_up);
}

KeyTable::KeyEntry& KeyTable::make_named(const std::string& name) {
  _declare_named(name, section(name, _doc_of_named));
  return _entries.back();
}

void KeyTable::read_file(const std::string& file) {
  if (const auto refusal = geometry::refusal_of(file)) {
    throw CaseError(
        fmt::format("{}: the case cannot be opened: {}; it must be a YAML file (`aeroloom init` writes one)",
                    file, refusal->what));
  }
  require_no_geometry(file);
  const std::string text = geometry::read_whole(file);
  require_no_settings(file, text);
  read_text(text, file);
}

void KeyTable::read_text(const std::string& text, const std::string& name) {
  read(parse(text, name, true), {name, true, *this});
}

void KeyTable::read_override(const std::string& assignment) {
  const std::string name = "--set " + assignment;
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0) throw CaseError(name + ": expected section.key=value");
  std::vector<std::string> names;
  for (std::size_t start = 0; start <= equals;) {
    const std::size_t dot = std::min(assignment.find('.', start), equals);
    if (dot == start) throw CaseError(name + ": expected section.key=value, found an empty name");
    names.push_back(assignment.substr(start, dot - start));
    if (names.size() > deepest_key) {
      throw CaseError(fmt::format("--set {}...: no key has more than {} parts",
                                  assignment.substr(0, std::min<std::size_t>(dot, 60)), deepest_key));
    }
    start = dot + 1;
  }
  YAML::Node node = parse(assignment.substr(equals + 1), name, false);
  for (auto key = names.rbegin(); key != names.rend(); ++key) {
    YAML::Node map(YAML::NodeType::Map);
    map.force_insert(*key, node);
    node.reset(map);
  }
  read(node, {name, false, *this});
}

bool KeyTable::read(const YAML::Node& node, const Source& source) {
  if (node.IsNull()) return false;  // everything below is left out
  if (!node.IsMap()) {
    const std::string place = _path.empty() ? "" : " below '" + _path + "'";
    throw CaseError(
        fmt::format("{}: expected keys{}, got {}", origin_in(source, node), place, describe(node)));
  }
  std::set<std::string> seen;
  bool given = node.size() == 0;
  for (const auto& item : node) {
    const YAML::Node& key = item.first;
    const std::string where = origin_in(source, key);
    if (!key.IsScalar()) throw CaseError(fmt::format("{}: expected a key, got {}", where, describe(key)));
    const std::string& name = key.Scalar();
    KeyEntry* entry = find(name);
    if (!entry && _declare_named) entry = &make_named(name);
    if (!entry) {
      const std::string place = _path.empty() ? "" : " in '" + _path + "'";
      throw CaseError(fmt::format("{}: unknown key '{}'{}; {}", where, shortened(name), place,
                                  advice(name, source.root)));
    }
    if (!seen.insert(name).second)
      throw CaseError(fmt::format("{}: key '{}' is given twice", where, path_of(name)));
    entry->where = where;
    if (read_entry(*entry, item.second, source)) given = true;
  }
  return given;
}

bool KeyTable::read_entry(KeyEntry& entry, const YAML::Node& node, const Source& source) {
  if (entry.declare_item) {
    read_items(entry, node, source);
    return true;
  }
  if (entry.below) {
    const bool given = entry.below->read(node, source);
    if (given && entry.given) *entry.given = true;
    return given;
  }
  // What is not there has no place of its own: the key's is shown.
  const std::string where = node.IsNull() ? entry.where : origin_in(source, node);
  entry.read(YamlValue(node, path_of(entry.name), where));
  return true;
}

void KeyTable::read_items(KeyEntry& entry, const YAML::Node& node, const Source& source) {
  const auto refuse = [&](const YAML::Node& found) {
    throw CaseError(fmt::format("{}: '{}': expected a list of keys in braces, got {}",
                                found.IsNull() ? entry.where : origin_in(source, found), entry.info.path,
                                describe(found)));
  };
  if (!node.IsSequence() || node.size() == 0) refuse(node);
  entry.items.clear();
  entry.forget_items();
  for (const auto& item : node) {
    if (!item.IsMap()) refuse(item);
    add_item(entry).read(item, source);
  }
}

KeyTable::KeyEntry* KeyTable::find(const std::string& name) {
  const auto found = _places.find(name);
  return found == _places.end() ? nullptr : &_entries[found->second];
}

std::string KeyTable::advice(const std::string& unknown, const KeyTable& root) const {
  std::vector<std::string> here, everywhere;
  for (const KeyEntry& entry : _entries) here.push_back(entry.name);
  root.collect_paths(everywhere);
  std::vector<std::string> last_names;
  last_names.reserve(everywhere.size());
  for (const std::string& path : everywhere) last_names.push_back(path.substr(path.rfind('.') + 1));
  const auto path_of_last = [&](const std::string& name) {
    const auto found = std::find(last_names.begin(), last_names.end(), name) - last_names.begin();
    return "did you mean '" + everywhere[static_cast<std::size_t>(found)] + "'?";
  };
  if (const auto answer = answer_to_path(path_of(unknown))) return *answer;
  const bool is_elsewhere = std::find(last_names.begin(), last_names.end(), unknown) != last_names.end();
  const auto answer = is_elsewhere ? std::nullopt : answer_to_key(unknown);
  if (answer) return *answer;
  if (const auto near = nearest_name(unknown, here)) return "did you mean '" + *near + "'?";
  if (const auto near = nearest_name(unknown, last_names)) return path_of_last(*near);
  return "valid keys: " + joined(here);
}

void KeyTable::collect_paths(std::vector<std::string>& paths) const {
  for (const KeyEntry& entry : _entries) paths.push_back(path_of(entry.name));
  for (const KeyEntry& entry : _entries)
    if (entry.below) entry.below->collect_paths(paths);
}

std::string KeyTable::KeyEntry::default_value() const {
  if (written_as_yaml) return written_as_yaml().value_or("");
  YAML::Emitter emitter;
  if (listed) {
    const std::vector<std::string> all = listed();
    if (all.empty()) return "";
    emitter << YAML::Flow << all;
  } else {
    const std::optional<std::string> value = written ? written() : std::nullopt;
    if (!value) return "";
    emitter << *value;
  }
  return emitter.c_str();
}

std::vector<KeyInfo> KeyTable::infos() const {
  std::vector<KeyInfo> all;
  collect_infos(all);
  return all;
}

void KeyTable::collect_infos(std::vector<KeyInfo>& infos) const {
  for (const KeyEntry& entry : _entries) {
    KeyInfo& info = infos.emplace_back(entry.info);
    info.default_value = entry.default_value();
    if (info.default_value.empty() && info.doc.example == info.doc.left_out) {  // a constant
      info.default_value = info.doc.example;
      info.doc.example = info.doc.left_out = "";
    }
    if (entry.below) entry.below->collect_infos(infos);
  }
}

std::string KeyTable::where(const std::string& path) const {
  const std::size_t dot = path.find('.');
  const auto found = _places.find(path.substr(0, dot));
  if (found == _places.end()) return "";
  const KeyEntry& entry = _entries[found->second];
  if (dot == std::string::npos) return entry.where;
  return entry.below ? entry.below->where(path.substr(dot + 1)) : "";
}

std::string KeyTable::write() const {
  YAML::Emitter emitter;
  write(emitter);
  return std::string(emitter.c_str()) + "\n";
}

void KeyTable::write(YAML::Emitter& emitter) const {
  emitter << YAML::BeginMap;
  for (const KeyEntry& entry : _entries) {
    if (entry.below) {
      if (entry.given && !*entry.given) continue;
      if (entry.below->_declare_named && entry.below->_entries.empty()) continue;
      emitter << YAML::Key << entry.name << YAML::Value;
      entry.below->write(emitter);
    } else if (entry.declare_item) {
      write_items(entry, emitter);
    } else if (entry.written_as_yaml) {
      if (const std::optional<std::string> value = entry.written_as_yaml())
        emitter << YAML::Key << entry.name << YAML::Value << YAML::Flow << YAML::Load(*value);
    } else if (entry.listed) {
      const std::vector<std::string> all = entry.listed();
      if (!all.empty()) emitter << YAML::Key << entry.name << YAML::Value << YAML::Flow << all;
    } else if (const std::optional<std::string> value = entry.written()) {
      emitter << YAML::Key << entry.name << YAML::Value << *value;
    }
  }
  emitter << YAML::EndMap;
}

}  // namespace aeroloom::cases
