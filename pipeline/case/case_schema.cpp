#include "pipeline/case/case_schema.hpp"

#include "pipeline/case/key_text.hpp"

#include <cmath>

#include <nlohmann/json.hpp>
#include <yaml-cpp/yaml.h>

namespace aeroloom::cases {

namespace {

using Json = nlohmann::ordered_json;

/// Where the schema of a key is in that of the case.
Json::json_pointer place_of(const std::string& path) {
  Json::json_pointer place;
  for (std::size_t start = 0; start <= path.size();) {
    const std::size_t dot = std::min(path.find('.', start), path.size());
    const std::string name = path.substr(start, dot - start);
    if (name == made_up_name) {
      place /= "additionalProperties";
    } else {
      place /= "properties";
      place /= name;
    }
    start = dot + 1;
  }
  return place;
}

void add_keys(Json& schema, const std::vector<KeyInfo>& keys);

Json list_of_numbers(std::size_t count) {
  return {{"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", count}, {"maxItems", count}};
}

/// A value of the key, from YAML.
Json json_value(const KeyInfo& key, const std::string& yaml) {
  const YAML::Node node = YAML::Load(yaml);
  if (key.kind == KeyKind::box) return node.as<std::vector<std::vector<double>>>();
  if (key.kind == KeyKind::point || key.kind == KeyKind::direction || key.kind == KeyKind::interval)
    return node.as<std::vector<double>>();
  if (node.IsSequence()) return node.as<std::vector<std::string>>();
  const bool bare = key.kind == KeyKind::number || key.kind == KeyKind::integer || key.kind == KeyKind::flag;
  return bare ? Json::parse(yaml) : Json(node.Scalar());
}

/// Counts without a decimal point.
Json json_number(double value) {
  if (value == std::floor(value) && std::abs(value) < 1e15) return static_cast<std::int64_t>(value);
  return value;
}

void add_range(Json& schema, const Range& range) {
  if (std::isfinite(range.low)) {
    schema[range.low_allowed ? "minimum" : "exclusiveMinimum"] = json_number(range.low);
  }
  if (std::isfinite(range.high)) schema["maximum"] = json_number(range.high);
}

/// One alone, or a list that is not empty.
void add_list_of(Json& schema, const Json& item) {
  schema["anyOf"] = Json::array({item, {{"type", "array"}, {"items", item}, {"minItems", 1}}});
}

/// Or a word in its place.
void add_number(Json& schema, const KeyInfo& key) {
  Json number = {{"type", key.kind == KeyKind::number ? "number" : "integer"}};
  add_range(number, key.range);
  if (key.choices.empty())
    schema.update(number);
  else
    schema["anyOf"] = Json::array({number, {{"enum", key.choices}}});
}

void add_type(Json& schema, const KeyInfo& key) {
  // Names of files and faces may look like numbers.
  const Json text = {{"type", {"string", "number", "boolean"}}, {"minLength", 1}};
  switch (key.kind) {
    case KeyKind::section:
    case KeyKind::named:  // what is there but empty counts as left out
      schema["type"] = {"object", "null"};
      schema["properties"] = Json::object();
      schema["additionalProperties"] = false;
      break;
    case KeyKind::number:
    case KeyKind::integer:
      add_number(schema, key);
      break;
    case KeyKind::flag:
      schema["type"] = "boolean";
      break;
    case KeyKind::text:
      schema.update(text);
      break;
    case KeyKind::texts:
      add_list_of(schema, text);
      break;
    case KeyKind::choice:
      schema["enum"] = key.choices;
      break;
    case KeyKind::choices:
      add_list_of(schema, {{"enum", key.choices}});
      break;
    case KeyKind::point:
    case KeyKind::direction:
      schema.update(list_of_numbers(3));
      break;
    case KeyKind::interval:
      schema.update(list_of_numbers(2));
      break;
    case KeyKind::box:
      schema.update({{"type", "array"}, {"items", list_of_numbers(3)}, {"minItems", 2}, {"maxItems", 2}});
      break;
    case KeyKind::sections: {
      Json item = {{"type", "object"}, {"properties", Json::object()}, {"additionalProperties", false}};
      add_keys(item, key.of_each);
      schema.update({{"type", "array"}, {"items", item}, {"minItems", 1}});
      break;
    }
  }
}

std::string description(const KeyInfo& key) {
  std::string text = without_links(key.doc.text);
  const bool number = key.kind == KeyKind::number || key.kind == KeyKind::integer;
  if (number) text += " Accepted: " + accepted_values(key) + ".";
  const std::string left_out = value_left_out(key);
  if (!left_out.empty()) text += " Left out: " + left_out + ".";
  return text;
}

void add_keys(Json& schema, const std::vector<KeyInfo>& keys) {
  for (const KeyInfo& key : keys) {
    const std::string text = description(key);
    Json one = {{"description", text}};
    // Editors that know Markdown show code as code, and not the ticks around it.
    if (text.find('`') != std::string::npos) one["markdownDescription"] = text;
    add_type(one, key);
    if (!key.default_value.empty()) one["default"] = json_value(key, key.default_value);
    const bool alone = !key.has_keys_below() && key.kind != KeyKind::sections && key.choices.empty();
    if (alone && !key.doc.example.empty()) one["examples"] = Json::array({json_value(key, key.doc.example)});
    schema[place_of(key.path)] = one;
  }
}

}  // namespace

std::string case_schema(const std::vector<KeyInfo>& keys) {
  Json schema = {{"$schema", "http://json-schema.org/draft-07/schema#"},
                 {"title", schema_title},
                 {"description", "What a run of Aeroloom depends on (docs/configuration)."},
                 {"type", "object"},
                 {"properties", Json::object()},
                 {"additionalProperties", false}};
  add_keys(schema, keys);
  return schema.dump(2) + "\n";
}

}  // namespace aeroloom::cases
