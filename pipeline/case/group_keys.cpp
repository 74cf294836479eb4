#include "pipeline/case/group_keys.hpp"

#include "cad/model/patches.hpp"
#include "pipeline/case/case_keys.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::cases {

namespace {

void declare_conditions(KeyTable& keys, FaceConditions& c) {
  keys.texts("faces", c.faces,
             common({"Patterns of names of faces or patches: a name, with `*` for any characters and `?` for "
                     "one, or `re:` and a regular expression that occurs in the name.",
                     "any; of a group without any condition: its own name", "'re:^Wing.*'"}));
  keys.texts("part", c.parts,
             {"Patterns of the part (solid, product) in the CAD file.", "any", "'nacelle*'"});
  keys.texts("layer", c.layers, {"Patterns of the layer in the CAD file.", "any", "inlet"});
  keys.texts("color", c.colors,
             {"Colours in the CAD file, in quotes; `aeroloom info FILE` lists them.", "any", "'#ff0000'"});
  keys.box("box", c.box,
           {"Box that holds the whole face, by two opposite corners.", "any", "[[0, 0, 0], [1, 1, 1]]"});
  keys.direction(
      "normal", c.normal,
      {"Mean normal of the face, out of the solid of the CAD file: away from a body, out of a fluid.", "any",
       "[1, 0, 0]"});
  keys.number("within", c.within, Range::above(0, 180, "degrees"),
              {"Largest angle between the mean normal and `normal`.", shortest(default_within),
               shortest(default_within)});
  keys.interval("area", c.area, "(square of the length unit)",
                {"Area of the face in the CAD: from, to.", "any", "[0, 0.1]"});
  keys.texts(
      "adjacent_to", c.adjacent_to,
      {"Groups, or patterns as in `faces`: the face shares an edge with one of theirs and is none of them.",
       "any", "wing"});
  keys.texts("ids", c.ids,
             {"Numbers of faces in the file, from 0, and ranges of them; 12 is `face_12`. `check.json` and "
              "the report list them.",
              "any", "[3, 17-20]"});
}

const std::vector<KeyInfo>& infos_of_conditions() {
  static const std::vector<KeyInfo> infos = [] {
    FaceConditions sample;
    KeyTable keys;
    declare_conditions(keys, sample);
    return keys.infos();
  }();
  return infos;
}

void declare_lists(KeyTable& keys, const char* name, std::deque<FaceConditions>& list, const KeyDoc& doc) {
  keys.sections(
      name, list.size(), infos_of_conditions(),
      [&list](std::size_t index, KeyTable& table) {
        if (list.size() <= index) list.resize(index + 1);
        declare_conditions(table, list[index]);
      },
      [&list] { list.clear(); }, doc);
}

void declare_group_rule(KeyTable& keys, GroupRule& rule) {
  declare_conditions(keys, rule.all);
  declare_lists(keys, "any", rule.any,
                {"Selections with the keys above: the face must meet at least one.", "any",
                 "[{faces: 'wing_*'}, {color: '#ff0000'}]"});
  declare_lists(keys, "except", rule.except,
                {"Selections with the keys above: the face must meet none.", "none", "[{faces: '*_tip'}]"});
  keys.flag("optional", rule.optional,
            "Whether the group may select nothing, as in a case for several geometries. Otherwise this is an "
            "error.");
  keys.number(
      "size", rule.size, Range::above(0, length_unit),
      common({"Largest size of elements on the group, as `patches.NAME.size`.", "that of `sizing`", "0.05"}));
  declare_patch_type(keys, rule.type);
}

}  // namespace

void declare_patch_type(KeyTable& keys, std::optional<mesh::PatchType>& type) {
  using mesh::PatchType;
  std::vector<std::pair<std::string, std::optional<PatchType>>> types;
  for (const PatchType each : {PatchType::wall, PatchType::slip, PatchType::symmetry, PatchType::farfield,
                               PatchType::inlet, PatchType::outlet})
    types.emplace_back(mesh::name_of(each), each);
  keys.choice(
      "type", type, types,
      common({"Boundary condition in solver files ([Formats](formats.md)).",
              "`farfield` for the far field of the program; of others what their name says, or else `wall`",
              "wall"}));
}

void declare_groups(KeyTable& root, std::deque<GroupRule>& rules, bool& strict) {
  KeyTable& groups = root.named_sections(
      "groups",
      common("Groups of CAD faces by name, colour, layer, place, direction, area or neighbours. Each is a "
             "patch, with a size and a condition of its own ([Selection and "
             "groups](configuration/groups.md#selection-and-groups))."),
      common({"A group of a name that you choose. A face has to meet all its conditions. It belongs to the "
              "first group that selects it; groups come before `patches`.",
              "", "nacelle"}),
      [&rules](const std::string& name, KeyTable& keys) {
        const auto known = std::find_if(rules.begin(), rules.end(),
                                        [&](const GroupRule& rule) { return rule.name == name; });
        GroupRule& rule = known != rules.end() ? *known : rules.emplace_back();
        rule.name = name;
        declare_group_rule(keys, rule);
      });
  groups.flag("strict", strict,
              "Whether every boundary face has to be in a group or in `patches`; others are then an error. "
              "The far field and the plane of symmetry of the program need no group.");
}

void check_patterns(const KeyTable& keys, const std::string& path, const std::vector<std::string>& patterns) {
  for (const std::string& pattern : patterns) {
    try {
      const cad::NamePattern known(pattern);
    } catch (const std::invalid_argument& error) {
      throw CaseError(fmt::format("{}: '{}': {}", keys.where(path), path, error.what()));
    }
  }
}

void check_groups(const KeyTable& keys, const std::deque<GroupRule>& rules,
                  const std::deque<PatchRule>& patches) {
  for (const GroupRule& rule : rules) {
    const std::string path = "groups." + rule.name, where = keys.where(path) + ": ";
    try {
      check_conditions(rule.all, path);
      for (const FaceConditions& each : rule.any) check_conditions(each, path + ".any");
      for (const FaceConditions& each : rule.except) check_conditions(each, path + ".except");
    } catch (const std::invalid_argument& error) {
      throw CaseError(where + error.what());
    }
    for (const auto* list : {&rule.any, &rule.except}) {
      if (std::any_of(list->begin(), list->end(), [](const FaceConditions& each) { return each.empty(); }))
        throw CaseError(fmt::format("{}'{}.{}': a selection without a condition has all faces", where, path,
                                    list == &rule.any ? "any" : "except"));
    }
    const bool is_patch = std::any_of(patches.begin(), patches.end(),
                                      [&](const PatchRule& patch) { return patch.name == rule.name; });
    if (is_patch)
      throw CaseError(
          fmt::format("{}'{}' makes a patch of this name, and so does 'patches.{}' ({}). Remedy: "
                      "size and type in the group",
                      where, path, rule.name, keys.where("patches." + rule.name)));
  }
}

}  // namespace aeroloom::cases
