#include "io/openfoam/foam_case.hpp"

#include "io/distinct_names.hpp"
#include "io/local_file.hpp"
#include "io/openfoam/foam_settings.hpp"
#include "parallel/observation/log.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <system_error>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::io {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t longest_foam_word = 120;

bool is_digit(char letter) {
  return letter >= '0' && letter <= '9';
}

std::string word_of(const std::string& name) {
  std::string word = name.empty() ? "unnamed" : name;
  for (char& letter : word) {
    const bool stays = is_digit(letter) || (letter >= 'a' && letter <= 'z') ||
                       (letter >= 'A' && letter <= 'Z') || letter == '_' || letter == '-' || letter == '.' ||
                       static_cast<unsigned char>(letter) >= 0x80;
    if (!stays) letter = '_';
  }
  // A word that begins like a number would be read as one; patches between parts have names of their own.
  const bool like_number = is_digit(word[0]) || word[0] == '-' || word[0] == '.';
  if (like_number || word.starts_with("procBoundary")) word.insert(word.begin(), '_');
  return word;
}

/// The number of a processor folder, -1 of any other.
std::int64_t processor_of(const std::string& name) {
  const std::string prefix = "processor";
  if (!name.starts_with(prefix) || name.size() == prefix.size() || name.size() > prefix.size() + 9) return -1;
  const std::string digits = name.substr(prefix.size());
  return std::all_of(digits.begin(), digits.end(), is_digit) ? std::stoll(digits) : -1;
}

/// Removes a folder that holds nothing.
void remove_if_empty(const fs::path& folder) {
  if (fs::is_directory(folder) && fs::is_empty(folder)) fs::remove(folder);
}

/// Empty where there is no such file, or it is too large for a dictionary.
std::string dictionary_text(const fs::path& path) {
  constexpr std::uintmax_t largest = 1 << 20;
  if (!fs::is_regular_file(path) || fs::file_size(path) > largest) return {};
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Whether the file refers to a field in 0.orig/ and is as it was written here.
bool is_own_field(const fs::path& file) {
  const std::string text = dictionary_text(file);
  for (const std::string_view up : {"../", "../../"}) {
    for (const FoamField& field : foam_fields(up)) {
      if (file.filename() == field.name && text == field.link) return true;
    }
  }
  return false;
}

/// Removes what write_fields left in a time folder 0, as long as it is as it was.
void remove_own_fields(const fs::path& start) {
  if (!fs::is_directory(start)) return;
  std::vector<fs::path> own;
  for (const auto& entry : fs::directory_iterator(start)) {
    if (is_own_field(entry.path())) own.push_back(entry.path());
  }
  for (const fs::path& file : own) fs::remove(file);
  remove_if_empty(start);
}

/// The processor folders of a case, with their numbers.
std::vector<std::pair<fs::path, std::int64_t>> processors_of(const FoamCase& foam_case) {
  std::vector<std::pair<fs::path, std::int64_t>> found;
  for (const auto& entry : fs::directory_iterator(foam_case.folder)) {
    const std::int64_t number = processor_of(entry.path().filename().string());
    if (number >= 0 && entry.is_directory()) found.emplace_back(entry.path(), number);
  }
  return found;
}

/// Whether a time folder 0 has nothing but what write_fields left there.
bool is_own_start(const fs::path& start) {
  for (const auto& entry : fs::directory_iterator(start)) {
    if (!is_own_field(entry.path())) return false;
  }
  return true;
}

/// Whether there is more in a processor folder than a mesh, and what write_fields left there.
bool holds_results(const fs::path& processor) {
  for (const auto& entry : fs::directory_iterator(processor)) {
    if (entry.path().filename() == "0" && entry.is_directory() && is_own_start(entry.path())) continue;
    if (entry.path().filename() != "constant") return true;
    for (const auto& inner : fs::directory_iterator(entry.path())) {
      const fs::path name = inner.path().filename();
      if (name != "polyMesh" && name != "polyMesh.unfinished" && name != FoamCase::sharp_edges_name)
        return true;
    }
  }
  return false;
}

/// The number of subdomains that a decomposeParDict asks for; 0: none.
std::int64_t subdomains_of(const fs::path& path) {
  const std::string text = dictionary_text(path), word = "numberOfSubdomains";
  const std::size_t at = text.find(word);
  if (at == std::string::npos) return 0;
  std::istringstream rest(text.substr(at + word.size(), 100));
  std::int64_t count = 0;
  return rest >> count ? count : 0;
}

/// Written whole or not at all, and only where nothing is.
void write_once(const fs::path& path, const std::string& text) {
  if (fs::exists(path)) return;
  fs::create_directories(path.parent_path());
  const fs::path unfinished = path.string() + ".unfinished";
  LocalFile file(unfinished.string());
  file.text(text);
  file.finish();
  fs::rename(unfinished, path);
}

void write_decomposition(const FoamCase& foam_case) {
  if (foam_case.parts == 1) return;
  const fs::path old = foam_case.folder / "system" / "decomposeParDict";
  const std::int64_t subdomains = subdomains_of(old);
  if (subdomains > 0 && subdomains != foam_case.parts) {
    if (dictionary_text(old) == foam_decomposition(subdomains)) {
      fs::remove(old);
    } else {
      parallel::log_warning(
          fmt::format("'{}' has numberOfSubdomains {}, but the mesh has {} parts: change it", old.string(),
                      subdomains, foam_case.parts));
    }
  }
  write_once(old, foam_decomposition(foam_case.parts));
}

/// Replaces one that is as it was written for other parts.
void write_script(const FoamCase& foam_case) {
  const FoamSetting script = foam_script(foam_case.parts);
  const fs::path path = foam_case.folder / script.path;
  const std::string old = dictionary_text(path), parts_begin = "the mesh has parts (";
  const std::size_t at = old.find(parts_begin);
  if (at != std::string::npos) {
    std::istringstream rest(old.substr(at + parts_begin.size(), 100));
    std::int64_t parts = 0;
    if (rest >> parts && old == foam_script(parts).text) fs::remove(path);
  }
  const bool is_new = !fs::exists(path);
  write_once(path, script.text);
  if (is_new) fs::permissions(path, fs::perms::owner_exec | fs::perms::group_exec, fs::perm_options::add);
}

/// Fields that a solver left in the time folders stay, as they are its user's.
void warn_of_fields(const FoamCase& foam_case) {
  const auto is_time = [](const fs::directory_entry& entry) {
    const std::string name = entry.path().filename().string();
    return entry.is_directory() && name.find_first_not_of("0123456789.e-+") == std::string::npos &&
           is_digit(name.front()) && !fs::is_empty(entry.path());
  };
  for (std::int32_t part = 0; part < foam_case.parts; ++part) {
    if (!fs::is_directory(foam_case.root(part))) continue;
    for (const auto& entry : fs::directory_iterator(foam_case.root(part))) {
      if (!is_time(entry)) continue;
      parallel::log_warning(
          fmt::format("'{}' holds fields of another mesh, which fit no mesh of other cells. Remedy: remove "
                      "the time folders of "
                      "the case, or map them (mapFields)",
                      entry.path().string()));
      return;
    }
  }
}

/// From the time folder 0 of a part to the case.
std::string_view way_up(const FoamCase& foam_case) {
  return foam_case.parts == 1 ? "../" : "../../";
}

}  // namespace

fs::path FoamCase::root(std::int32_t part) const {
  return parts == 1 ? folder : folder / fmt::format("processor{}", part);
}

void prepare_case(const FoamCase& foam_case) {
  fs::create_directories(foam_case.folder);
  for (const auto& [processor, number] : processors_of(foam_case)) {
    fs::remove_all(processor / "constant" / "polyMesh.unfinished");
    const bool is_past = foam_case.parts == 1 || number >= foam_case.parts;
    if (is_past && holds_results(processor)) {
      throw fs::filesystem_error(
          fmt::format("the mesh has {} part(s), this folder holds results of more: remove it",
                      foam_case.parts),
          processor, std::make_error_code(std::errc::directory_not_empty));
    }
  }
  fs::remove_all(foam_case.folder / "constant" / "polyMesh.unfinished");
}

void retire_meshes(const FoamCase& foam_case) {
  const auto retire = [](const fs::path& place) {
    remove_own_fields(place / "0");
    fs::remove_all(place / "constant" / "polyMesh");
    fs::remove(place / "constant" / FoamCase::sharp_edges_name);
  };
  for (const auto& [processor, number] : processors_of(foam_case)) {
    retire(processor);
    remove_if_empty(processor / "constant");
    remove_if_empty(processor);
  }
  retire(foam_case.folder);
  warn_of_fields(foam_case);
}

bool asks_for_sharp_edges(const FoamCase& foam_case) {
  return dictionary_text(foam_case.folder / "system" / "controlDict").find(FoamCase::sharp_edges_name) !=
         std::string::npos;
}

void remove_unfit_dictionaries(const FoamCase& foam_case, bool has_fans) {
  const std::vector<FoamSetting> wanted = foam_dictionaries(has_fans), others = foam_dictionaries(!has_fans);
  std::vector<fs::path> unfit;
  std::string of_users;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const fs::path path = foam_case.folder / wanted[i].path;
    if (wanted[i].text == others[i].text || !fs::exists(path)) continue;
    const std::string text = dictionary_text(path);
    if (text == others[i].text) unfit.push_back(path);
    if (text != others[i].text && text != wanted[i].text) of_users += " '" + path.string() + "'";
  }
  if (of_users.empty()) {
    for (const fs::path& path : unfit) fs::remove(path);
  } else if (has_fans && !asks_for_sharp_edges(foam_case)) {
    parallel::log_warning(fmt::format(
        "{} stay as they are, but are not for layers with several columns at sharp edges, on which a run may "
        "die. Remedy: remove them, mesh again, and change the new ones",
        of_users.substr(1)));
  }
}

bool write_settings(const FoamCase& foam_case, const FoamFlow& flow) {
  for (const FoamSetting& setting : foam_dictionaries(flow.has_fans))
    write_once(foam_case.folder / setting.path, setting.text);
  write_decomposition(foam_case);
  write_script(foam_case);
  // Whoever has fields of an undivided case, divides them himself.
  const fs::path own = foam_case.folder / "0";
  remove_own_fields(own);
  if (foam_case.parts > 1 && fs::exists(own)) {
    parallel::log_warning(fmt::format(
        "'{}' holds fields: they are not given to the parts, decomposePar -fields does that", own.string()));
    return false;
  }
  const FoamSetting conditions = foam_conditions(flow.reference, flow.is_external);
  write_once(foam_case.folder / conditions.path, conditions.text);
  for (const FoamField& field : foam_fields(way_up(foam_case)))
    write_once(foam_case.folder / "0.orig" / field.name, field.text);
  return true;
}

void write_fields(const FoamCase& foam_case, std::int32_t part) {
  for (const FoamField& field : foam_fields(way_up(foam_case)))
    write_once(foam_case.root(part) / "0" / field.name, field.link);
}

FoamPatches foam_patches(const std::vector<mesh::Patch>& patches) {
  std::array<int, mesh::patch_type_names.size()> of_type{};
  for (const mesh::Patch& patch : patches) ++of_type[static_cast<std::size_t>(patch.type)];
  std::vector<std::string> names;
  std::vector<bool> speaks_for_type;
  for (const mesh::Patch& patch : patches) {
    names.push_back(patch.name);
    const std::optional<mesh::PatchType> meant = mesh::patch_type_of(word_of(patch.name));
    const bool is_free =
        !meant || *meant == mesh::PatchType::interior || patch.type == mesh::PatchType::interior;
    // OpenFOAM puts walls and symmetries into groups of these names by itself.
    const bool has_own_group = patch.type == mesh::PatchType::wall || patch.type == mesh::PatchType::symmetry;
    speaks_for_type.push_back(!is_free && patch.type == *meant && !has_own_group &&
                              of_type[static_cast<std::size_t>(patch.type)] == 1);
    if (!is_free && !speaks_for_type.back()) names.back() += "_patch";
  }
  FoamPatches made{foam_words(names), {}};
  for (std::size_t p = 0; p < patches.size(); ++p)
    made.groups.emplace_back(speaks_for_type[p] ? "" : mesh::name_of(patches[p].type));
  return made;
}

std::vector<std::string> foam_words(const std::vector<std::string>& names) {
  return distinct_names(names, longest_foam_word, word_of);
}

}  // namespace aeroloom::io
