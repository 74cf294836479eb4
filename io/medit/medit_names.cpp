#include "io/medit/medit_names.hpp"

#include "io/streams/text_lines.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>

namespace aeroloom::io {

namespace {

constexpr std::array<std::string_view, cell_shape_count> cell_words = {"tetrahedra", "pyramids", "prisms",
                                                                       "hexahedra"};
constexpr std::array<std::string_view, face_shape_count> face_words = {"triangles", "quadrilaterals"};

bool is_control(char c) {
  return static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
}

std::string escaped_name(const std::string& name) {
  std::string text;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const bool end_blank = name[i] == ' ' && (i == 0 || i + 1 == name.size());
    if (name[i] == '\\') {
      text += "\\\\";
    } else if (is_control(name[i]) || end_blank) {
      text += fmt::format("\\x{:02x}", static_cast<unsigned char>(name[i]));
    } else {
      text += name[i];
    }
  }
  return text;
}

/// Nothing where an escape is none of ours.
std::optional<std::string> unescaped_name(std::string_view text) {
  std::string name;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '\\') {
      name += text[i];
      continue;
    }
    if (text.substr(i, 2) == "\\\\") {
      name += '\\', ++i;
      continue;
    }
    unsigned value = 0;
    const char* const digits = text.data() + i + 2;
    if (i + 4 > text.size() || text[i + 1] != 'x' ||
        std::from_chars(digits, digits + 2, value, 16).ptr != digits + 2)
      return std::nullopt;
    name += static_cast<char>(value), i += 3;
  }
  return name;
}

/// The first shape of which there are some.
template <class Counts, class Words>
std::string_view word_for(const Counts& counts, const Words& words) {
  for (std::size_t s = 0; s < words.size(); ++s) {
    if (counts[s] > 0) return words[s];
  }
  return words[0];
}

std::string_view take_word(std::string_view& text) {
  const std::size_t end = std::min(text.find_first_of(" \t"), text.size());
  const std::string_view word = text.substr(0, end);
  text = trimmed(text.substr(end));
  return word;
}

std::string_view take_last_word(std::string_view& text) {
  const std::size_t blank = text.find_last_of(" \t");
  const std::size_t begin = blank == std::string_view::npos ? 0 : blank + 1;
  const std::string_view word = text.substr(begin);
  text = trimmed(text.substr(0, begin));
  return word;
}

template <class Words>
bool is_among(std::string_view word, const Words& words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// Reads one line into `names`; what is wrong with it, or nothing.
std::string parse_line(std::string_view line, MeditNames& names) {
  const std::string_view word = take_word(line);
  const bool of_cells = is_among(word, cell_words);
  if (!of_cells && !is_among(word, face_words))
    return fmt::format("'{}' is none of tetrahedra, pyramids, prisms, hexahedra, triangles, quadrilaterals",
                       word);
  const std::string_view number = take_word(line);
  std::int64_t reference = 0;
  if (!parse_number(number, reference)) return fmt::format("'{}' is no reference", number);
  std::optional<mesh::PatchType> type;
  if (!of_cells) {
    const std::string_view type_word = take_last_word(line);
    type = mesh::patch_type_of(type_word);
    if (!type) return fmt::format("'{}' is no type of a patch", type_word);
  }
  const std::optional<std::string> name = unescaped_name(line);
  if (!name) return fmt::format("the name '{}' has a backslash with neither \\ nor xHH behind it", line);
  const bool is_new = of_cells ? names.regions.emplace(reference, *name).second
                               : names.patches.emplace(reference, mesh::Patch{*name, *type}).second;
  return is_new ? "" : fmt::format("the reference {} has a name already", reference);
}

}  // namespace

std::string medit_names_path(const std::string& mesh_path) {
  return std::filesystem::path(mesh_path).replace_extension(".names").string();
}

std::string medit_names_text(const FileMesh& mesh) {
  std::string text = "# shape, reference, name, and the type of patches; references hold for all shapes\n";
  for (std::size_t r = 0; r < mesh.regions.size(); ++r) {
    text += fmt::format("{} {} {}\n", word_for(mesh.region_cells[r], cell_words), r + 1,
                        escaped_name(mesh.regions[r]));
  }
  for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
    text += fmt::format("{} {} {} {}\n", word_for(mesh.patch_faces[p], face_words), p + 1,
                        escaped_name(mesh.patches[p].name), mesh::name_of(mesh.patches[p].type));
  }
  return text;
}

MeditNames parse_medit_names(const std::string& text, const std::string& path) {
  MeditNames names;
  std::size_t number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = trimmed(std::string_view(text).substr(begin, end - begin));
    begin = end + 1, ++number;
    if (line.empty() || line.front() == '#') continue;
    const std::string problem = parse_line(line, names);
    if (!problem.empty()) throw std::runtime_error(fmt::format("{}, line {}: {}", path, number, problem));
  }
  return names;
}

}  // namespace aeroloom::io
