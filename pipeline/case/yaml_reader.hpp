/// Strict reading of YAML into variables. Each key is declared once, with its accepted values and its
/// variable. Reading, writing, documentation and the search for the nearest key follow from the declaration.
#pragma once

#include "geometry/vec.hpp"
#include "pipeline/case/case_error.hpp"
#include "pipeline/case/key_info.hpp"
#include "pipeline/case/yaml_value.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace YAML {
class Emitter;
}  // namespace YAML

namespace aeroloom::cases {

/// The keys of a YAML map, with nested maps. The variables must outlive the table.
class KeyTable {
public:
  KeyTable() = default;
  KeyTable(const KeyTable&) = delete;
  KeyTable& operator=(const KeyTable&) = delete;

  /// Declares a nested map. `given` (may be null) becomes true if anything is given in it; while it is false
  /// the section is not written.
  KeyTable& section(const std::string& name, const KeyDoc& doc, bool* given = nullptr);
  void number(const std::string& name, double& target, const Range& range, const KeyDoc& doc);
  /// An empty optional is not written.
  void number(const std::string& name, std::optional<double>& target, const Range& range, const KeyDoc& doc);
  /// A number or a word; for the word `is_word` is true and the number empty.
  void number_or(const std::string& word, bool& is_word, const std::string& name,
                 std::optional<double>& target, const Range& range, const KeyDoc& doc);
  void integer(const std::string& name, std::int64_t& target, const Range& range, const KeyDoc& doc);
  void integer(const std::string& name, std::optional<std::int64_t>& target, const Range& range,
               const KeyDoc& doc);
  void integer(const std::string& name, int& target, const Range& range, const KeyDoc& doc);
  void flag(const std::string& name, bool& target, const KeyDoc& doc);
  /// Empty text is refused, and not written.
  void text(const std::string& name, std::string& target, const KeyDoc& doc);
  /// A file or folder; `${NAME}` is replaced by the environment variable NAME.
  void path(const std::string& name, std::string& target, const KeyDoc& doc);
  /// A list; an empty list is not written.
  void texts(const std::string& name, std::vector<std::string>& target, const KeyDoc& doc);
  /// A list of three numbers, in the length unit of the geometry. An empty optional is not written.
  void point(const std::string& name, std::optional<geometry::Vec3>& target, const KeyDoc& doc);
  /// The same without a unit.
  void direction(const std::string& name, std::optional<geometry::Vec3>& target, const KeyDoc& doc);
  /// A list of two numbers, smaller one first; `unit` is for messages.
  void interval(const std::string& name, std::optional<std::pair<double, double>>& target,
                const std::string& unit, const KeyDoc& doc);
  /// A list of two points, in the length unit of the geometry.
  void box(const std::string& name, std::optional<std::pair<geometry::Vec3, geometry::Vec3>>& target,
           const KeyDoc& doc);
  /// A list of maps; an empty list is not written. `declare(i, table)` declares the keys of the i-th map.
  /// `count`: maps at present; `of_each` documents one map. `forget()` is called before a list is read.
  void sections(const std::string& name, std::size_t count, std::vector<KeyInfo> of_each,
                std::function<void(std::size_t, KeyTable&)> declare, std::function<void()> forget,
                const KeyDoc& doc);
  /// One of several names; each stands for a value of the enumeration.
  template <class Enum>
  void choice(const std::string& name, Enum& target, const std::vector<std::pair<std::string, Enum>>& values,
              const KeyDoc& doc);
  /// A list of such names; an empty list is not written.
  template <class Enum>
  void choices(const std::string& name, std::vector<Enum>& target,
               const std::vector<std::pair<std::string, Enum>>& values, const KeyDoc& doc);
  /// Declares a map whose keys are names chosen by the user; `doc_of_each` documents one. Each name gets a
  /// table, filled by `declare(name, table)`, when it is read or by add_named(). An empty map is not written.
  /// Returns the table of the map, for further fixed keys.
  KeyTable& named_sections(const std::string& name, const KeyDoc& doc, const KeyDoc& doc_of_each,
                           std::function<void(const std::string&, KeyTable&)> declare);
  /// Adds a name below the key `name` of named_sections() ("sizing.sources").
  void add_named(const std::string& name, const std::string& made_up);

  /// Reads a file, then overrides "a.b=value". Assigns only what is given. Throws CaseError.
  void read_file(const std::string& file);
  /// The same for a text; `name` is its name in messages.
  void read_text(const std::string& text, const std::string& name);
  void read_override(const std::string& assignment);
  /// The place where the key ("sizing.minimum") was last given; empty if it was not.
  std::string where(const std::string& path) const;
  /// All values in order of declaration, as YAML that read_file() accepts.
  std::string write() const;
  /// All declared keys in order; a section comes before its keys. Present values count as defaults. Below
  /// named_sections(): only names that were added.
  std::vector<KeyInfo> infos() const;

private:
  struct KeyEntry {
    std::string name;
    KeyInfo info;                                                 // without the default
    std::unique_ptr<KeyTable> below;                              // of a section
    bool* given = nullptr;                                        // of a section
    std::function<void(const YamlValue&)> read;                   // of a value
    std::function<std::optional<std::string>()> written;          // of a value
    std::function<std::vector<std::string>()> listed;             // of a list
    std::function<std::optional<std::string>()> written_as_yaml;  // of a list of lists
    std::vector<std::unique_ptr<KeyTable>> items;                 // of a list of maps
    std::function<void(std::size_t, KeyTable&)> declare_item;
    std::function<void()> forget_items;
    std::string where;

    std::string default_value() const;
  };
  struct Source;

  static std::string origin_in(const Source& source, const YAML::Node& node);
  KeyEntry& add(const std::string& name, KeyKind kind, const KeyDoc& doc);
  void add(const std::string& name, KeyKind kind, const KeyDoc& doc, const Range& range,
           std::function<void(const YamlValue&)> read, std::function<std::optional<std::string>()> written);
  // An empty section counts as not given.
  bool read(const YAML::Node& node, const Source& source);
  static KeyTable& add_item(KeyEntry& entry);
  static void read_items(KeyEntry& entry, const YAML::Node& node, const Source& source);
  static void write_items(const KeyEntry& entry, YAML::Emitter& emitter);
  bool read_entry(KeyEntry& entry, const YAML::Node& node, const Source& source);
  KeyEntry* find(const std::string& name);
  KeyEntry& make_named(const std::string& name);
  std::string path_of(const std::string& name) const { return _path.empty() ? name : _path + "." + name; }
  std::string advice(const std::string& unknown, const KeyTable& root) const;
  void collect_paths(std::vector<std::string>& paths) const;
  void collect_infos(std::vector<KeyInfo>& infos) const;
  void write(YAML::Emitter& emitter) const;

  std::string _path;  // of the section; empty at the top
  std::vector<KeyEntry> _entries;
  std::unordered_map<std::string, std::size_t> _places;               // index of the first entry by name
  std::function<void(const std::string&, KeyTable&)> _declare_named;  // for maps whose keys the user names
  KeyDoc _doc_of_named = "";
};

template <class Enum>
void KeyTable::choice(const std::string& name, Enum& target,
                      const std::vector<std::pair<std::string, Enum>>& values, const KeyDoc& doc) {
  KeyEntry& entry = add(name, KeyKind::choice, doc);
  std::vector<std::string>& names = entry.info.choices;
  names.reserve(values.size());
  for (const auto& value : values) names.push_back(value.first);
  entry.read = [&target, names, values](const YamlValue& value) {
    target = values[value.choice(names)].second;
  };
  entry.written = [&target, values]() -> std::optional<std::string> {
    for (const auto& value : values) {
      if (value.second == target) return value.first;
    }
    return std::nullopt;
  };
}

template <class Enum>
void KeyTable::choices(const std::string& name, std::vector<Enum>& target,
                       const std::vector<std::pair<std::string, Enum>>& values, const KeyDoc& doc) {
  KeyEntry& entry = add(name, KeyKind::choices, doc);
  std::vector<std::string>& names = entry.info.choices;
  names.reserve(values.size());
  for (const auto& value : values) names.push_back(value.first);
  entry.read = [&target, names, values](const YamlValue& value) {
    target.clear();
    for (const std::size_t i : value.choices(names)) target.push_back(values[i].second);
  };
  entry.listed = [&target, values] {
    std::vector<std::string> chosen;
    for (const Enum item : target) {
      for (const auto& value : values) {
        if (value.second == item) chosen.push_back(value.first);
      }
    }
    return chosen;
  };
}

}  // namespace aeroloom::cases
