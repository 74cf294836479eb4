#include "io/su2/su2_markers.hpp"

#include "io/streams/text_lines.hpp"
#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/log.hpp"
#include "parallel/storage/shared_file.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <set>
#include <span>
#include <string_view>

#include <fmt/format.h>

namespace aeroloom::io {

namespace {

constexpr std::array<std::string_view, 2> reserved = {"SEND_RECEIVE", "NONE"};
/// All markers of an option stand on one line: room for a million of the longest with their values.
constexpr std::size_t longest_list = std::size_t{1} << 27;

/// An option and what follows each name in its list.
struct MarkerOption {
  std::string_view name;
  mesh::PatchType type;
  std::string_view values;
  std::size_t value_count;
  std::string_view remark;  ///< where values must be filled in
};
constexpr std::array<MarkerOption, 6> written_options = {{
    {"MARKER_HEATFLUX", mesh::PatchType::wall, ", 0.0", 1, ""},
    {"MARKER_EULER", mesh::PatchType::slip, "", 0, ""},
    {"MARKER_SYM", mesh::PatchType::symmetry, "", 0, ""},
    {"MARKER_FAR", mesh::PatchType::farfield, "", 0, ""},
    {"MARKER_INLET", mesh::PatchType::inlet, ", TEMPERATURE, PRESSURE, NX, NY, NZ", 5,
     "total temperature, total pressure, direction of the flow"},
    {"MARKER_OUTLET", mesh::PatchType::outlet, ", PRESSURE", 1, "static pressure"},
}};
/// Understood beside the former.
constexpr std::array<MarkerOption, 1> read_options = {
    {{"MARKER_ISOTHERMAL", mesh::PatchType::wall, "", 1, ""}}};

std::string list_of(const FileMesh& mesh, const BoundaryPatches& patches,
                    const std::vector<std::string>& names, mesh::PatchType type, std::string_view values) {
  std::string list;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    if (mesh.patches[patches.ids[i]].type != type) continue;
    list += (list.empty() ? "" : ", ") + names[i] + std::string(values);
  }
  return list;
}

const MarkerOption* find_option(std::string_view name) {
  for (const MarkerOption& option : written_options) {
    if (option.name == name) return &option;
  }
  return name == read_options[0].name ? read_options.data() : nullptr;
}

/// Adds the markers of a list: names, each with some values behind it.
void add_markers(std::string_view list, const MarkerOption& option,
                 std::map<std::string, mesh::PatchType>& types) {
  std::string words(list);
  for (char& c : words) {
    if (c == '(' || c == ')' || c == ',') c = ' ';
  }
  LineWords items(words);
  for (std::size_t i = 0;; ++i) {
    const std::string_view word = items.next();
    if (word.empty()) return;
    if (i % (option.value_count + 1) == 0 && word != "NONE")
      types.try_emplace(std::string(word), option.type);
  }
}

std::string markers_text(const std::string& mesh_path, const FileMesh& mesh, const BoundaryPatches& patches,
                         const std::vector<std::string>& names) {
  std::string text = "% Markers of a mesh by condition, for an SU2 configuration.\n";
  text += fmt::format("MESH_FILENAME= {}\n", std::filesystem::path(mesh_path).filename().string());
  for (const MarkerOption& option : written_options) {
    const std::string list = list_of(mesh, patches, names, option.type, option.values);
    if (list.empty()) continue;
    if (!option.remark.empty()) text += fmt::format("% To be filled in for each: {}.\n", option.remark);
    text += fmt::format("{}{}= ( {} )\n", option.remark.empty() ? "" : "% ", option.name, list);
    if (option.type != mesh::PatchType::wall) continue;
    text += "% Without viscosity: MARKER_EULER instead.\n";
    const std::string walls = list_of(mesh, patches, names, option.type, "");
    text += fmt::format("MARKER_PLOTTING= ( {0} )\nMARKER_MONITORING= ( {0} )\n", walls);
  }
  return text;
}

std::map<std::string, mesh::PatchType> read_markers(const std::string& path) {
  std::map<std::string, mesh::PatchType> types;
  std::error_code none;
  if (!std::filesystem::exists(path, none)) return types;
  TextLines lines(path, longest_list);
  while (lines.next()) {
    std::string_view line = trimmed(lines.line());
    if (line.starts_with("% MARKER_")) line.remove_prefix(2);
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos) continue;
    const MarkerOption* const option = find_option(trimmed(line.substr(0, equals)));
    if (option == nullptr) continue;
    const std::string_view list = line.substr(equals + 1);
    add_markers(list.substr(0, list.find('%')), *option, types);
  }
  return types;
}

/// The type of each patch. Lines for markers that the mesh does not have are those of another mesh.
std::vector<mesh::PatchType> types_of_markers(const std::string& path,
                                              const std::vector<mesh::Patch>& patches) {
  std::map<std::string, mesh::PatchType> markers = read_markers(path);
  std::set<std::string_view> known;
  for (const mesh::Patch& patch : patches) known.insert(patch.name);
  const auto stranger = std::find_if(markers.begin(), markers.end(),
                                     [&](const auto& marker) { return !known.contains(marker.first); });
  if (stranger != markers.end()) {
    parallel::log_warning(
        fmt::format("'{}' is left alone: it has conditions for the marker '{}', which the "
                    "mesh does not have",
                    path, stranger->first));
    markers.clear();
  }
  std::vector<mesh::PatchType> types;
  for (const mesh::Patch& patch : patches) {
    const auto found = markers.find(patch.name);
    types.push_back(found != markers.end() ? found->second
                                           : mesh::patch_type_by_name(patch.name).value_or(patch.type));
  }
  return types;
}

}  // namespace

std::vector<std::string> marker_names(const FileMesh& mesh, const BoundaryPatches& patches) {
  std::vector<std::string> names;
  for (const std::int32_t id : patches.ids) names.push_back(mesh.patches[id].name);
  return plain_names(names, {.signs = "_-+.", .most_bytes = most_marker_bytes, .reserved = reserved});
}

std::string markers_path_of(const std::string& path) {
  const std::filesystem::path file(path);
  return (file.parent_path() / file.stem()).string() + "_markers.cfg";
}

void remove_markers(const SharedPath& mesh_file) {
  parallel::on_root(mesh_file.communicator,
                    [&] { std::filesystem::remove(markers_path_of(mesh_file.path)); });
}

void write_markers(const std::string& mesh_path, const FileMesh& mesh, const BoundaryPatches& patches,
                   const std::vector<std::string>& names) {
  const std::string text = markers_text(mesh_path, mesh, patches, names);
  parallel::write_shared_file(mesh.communicator(), markers_path_of(mesh_path),
                              [&](parallel::SharedFile& file) {
                                if (mesh.communicator().is_root())
                                  file.write_items(0, std::span<const char>(text));
                              });
}

void set_marker_types(const SharedPath& mesh_file, std::vector<mesh::Patch>& patches) {
  std::vector<mesh::PatchType> types;
  parallel::on_root(mesh_file.communicator,
                    [&] { types = types_of_markers(markers_path_of(mesh_file.path), patches); });
  mesh_file.communicator.broadcast_items(types);
  for (std::size_t p = 0; p < patches.size(); ++p) patches[p].type = types[p];
}

}  // namespace aeroloom::io
