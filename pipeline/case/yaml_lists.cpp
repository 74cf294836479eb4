// Keys whose values are lists of numbers, of points or of maps.
#include "pipeline/case/yaml_reader.hpp"

#include <utility>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

namespace aeroloom::cases {

namespace {

std::string point_text(const geometry::Vec3& p) {
  return fmt::format("[{}, {}, {}]", shortest(p.x), shortest(p.y), shortest(p.z));
}

}  // namespace

void KeyTable::direction(const std::string& name, std::optional<geometry::Vec3>& target, const KeyDoc& doc) {
  point(name, target, doc);
  _entries.back().info.kind = KeyKind::direction;
}

void KeyTable::interval(const std::string& name, std::optional<std::pair<double, double>>& target,
                        const std::string& unit, const KeyDoc& doc) {
  KeyEntry& entry = add(name, KeyKind::interval, doc);
  entry.info.range.unit = unit;
  entry.read = [&target](const YamlValue& value) { target = value.interval(); };
  entry.listed = [&target]() -> std::vector<std::string> {
    if (!target) return {};
    return {shortest(target->first), shortest(target->second)};
  };
}

void KeyTable::box(const std::string& name, std::optional<std::pair<geometry::Vec3, geometry::Vec3>>& target,
                   const KeyDoc& doc) {
  KeyEntry& entry = add(name, KeyKind::box, doc);
  entry.read = [&target](const YamlValue& value) { target = value.points(); };
  entry.written_as_yaml = [&target]() -> std::optional<std::string> {
    if (!target) return std::nullopt;
    return fmt::format("[{}, {}]", point_text(target->first), point_text(target->second));
  };
}

void KeyTable::sections(const std::string& name, std::size_t count, std::vector<KeyInfo> of_each,
                        std::function<void(std::size_t, KeyTable&)> declare, std::function<void()> forget,
                        const KeyDoc& doc) {
  KeyEntry& entry = add(name, KeyKind::sections, doc);
  entry.info.of_each = std::move(of_each);
  entry.declare_item = std::move(declare);
  entry.forget_items = std::move(forget);
  for (std::size_t i = 0; i < count; ++i) add_item(entry);
}

KeyTable& KeyTable::add_item(KeyEntry& entry) {
  const std::size_t index = entry.items.size();
  KeyTable& table = *entry.items.emplace_back(std::make_unique<KeyTable>());
  table._path = fmt::format("{}[{}]", entry.info.path, index);
  entry.declare_item(index, table);
  return table;
}

void KeyTable::write_items(const KeyEntry& entry, YAML::Emitter& emitter) {
  if (entry.items.empty()) return;
  emitter << YAML::Key << entry.name << YAML::Value << YAML::BeginSeq;
  for (const std::unique_ptr<KeyTable>& item : entry.items) item->write(emitter);
  emitter << YAML::EndSeq;
}

}  // namespace aeroloom::cases
