#include "io/medit/medit_reader.hpp"

#include "geometry/sort_unique.hpp"
#include "io/distinct_numbers.hpp"
#include "io/medit/local_medit_mesh.hpp"
#include "io/medit/medit_names.hpp"
#include "io/streams/range_reader.hpp"
#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/log.hpp"

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <optional>
#include <span>
#include <stdexcept>

#include <fmt/format.h>

namespace aeroloom::io {

namespace {

using mesh::GlobalIndex;

constexpr std::size_t most_references = 65'536;
constexpr std::int64_t largest_names_file = std::int64_t{64} << 20;

/// The different references of items over all ranks, ascending. Collective.
template <class Shapes>
std::vector<std::int64_t> all_references(const SharedPath& file, const Shapes& shapes) {
  std::vector<std::span<const std::int64_t>> lists;
  lists.reserve(shapes.size());
  for (const MeditItems& items : shapes) lists.emplace_back(items.references);
  return distinct_numbers(
      file.communicator, lists, most_references,
      fmt::format("'{}': there are more than {} different references", file.path, most_references));
}

/// The first reference in use that has no name, though others have; nothing where there is none.
template <class Names>
std::optional<std::int64_t> first_nameless(const std::vector<std::int64_t>& references, const Names& names) {
  if (names.empty()) return std::nullopt;
  const auto found = std::find_if(references.begin(), references.end(),
                                  [&](std::int64_t reference) { return !names.contains(reference); });
  return found == references.end() ? std::nullopt : std::optional(*found);
}

/// References in use and those that have a name: a patch without faces keeps its place.
template <class Names>
void add_named(const Names& names, std::vector<std::int64_t>& references) {
  for (const auto& [reference, name] : names) references.push_back(reference);
  geometry::sort_unique(references);
}

std::vector<std::int32_t> ids_of(const MeditItems& items, const std::vector<std::int64_t>& references) {
  std::vector<std::int32_t> ids;
  ids.reserve(items.references.size());
  for (const std::int64_t reference : items.references) {
    const auto at = std::lower_bound(references.begin(), references.end(), reference);
    ids.push_back(static_cast<std::int32_t>(at - references.begin()));
  }
  return ids;
}

std::string read_names_file(const std::string& path) {
  std::error_code none;
  if (!std::filesystem::exists(path, none)) return {};
  RangeReader file(path);
  if (file.size() > largest_names_file) throw std::runtime_error(fmt::format("'{}' is too large", path));
  std::string text(static_cast<std::size_t>(file.size()), '\0');
  file.read_bytes(0, std::as_writable_bytes(std::span(text)));
  return text;
}

/// Reads the names on one rank for all. Collective.
MeditNames read_names(const SharedPath& file) {
  const std::string path = medit_names_path(file.path);
  std::string text;
  parallel::on_root(file.communicator, [&] { text = read_names_file(path); });
  file.communicator.broadcast_value(text);
  MeditNames names;
  parallel::agree(file.communicator, [&] { names = parse_medit_names(text, path); });
  return names;
}

/// Whether the file is text. Collective.
bool is_text(const SharedPath& file) {
  std::int64_t text = 0;
  parallel::on_root(file.communicator, [&] {
    RangeReader reader(file.path);
    // A binary file begins with the bytes 0 or 1.
    text = reader.size() > 0 && reader.value<std::uint8_t>(0) >= '\t' ? 1 : 0;
  });
  return file.communicator.sum(text) > 0;
}

LocalMeditMesh read_local_mesh(const SharedPath& file) {
  if (!is_text(file)) return read_medit_binary(file);
  LocalMeditMesh local;
  parallel::on_root(file.communicator, [&] { local = read_medit_text(file.path); });
  return local;
}

}  // namespace

RawMesh read_medit(const SharedPath& file) {
  LocalMeditMesh local = read_local_mesh(file);
  MeditNames names = read_names(file);
  std::vector<std::int64_t> regions = all_references(file, local.cells),
                            patches = all_references(file, local.faces);
  std::optional<std::int64_t> nameless = first_nameless(regions, names.regions);
  if (!nameless) nameless = first_nameless(patches, names.patches);
  if (nameless) {
    if (file.communicator.is_root()) {
      parallel::log_warning(fmt::format("'{}' is left alone: it has no name for the reference {} of '{}'",
                                        medit_names_path(file.path), *nameless, file.path));
    }
    names = {};
  }
  add_named(names.regions, regions);
  add_named(names.patches, patches);
  RawMesh raw(file);
  for (const std::int64_t reference : regions) {
    const auto named = names.regions.find(reference);
    raw.regions.push_back(named == names.regions.end() ? fmt::format("region_{}", reference) : named->second);
  }
  if (raw.regions.empty()) raw.regions.push_back("fluid");
  for (const std::int64_t reference : patches) {
    const auto named = names.patches.find(reference);
    raw.patches.push_back(named == names.patches.end()
                              ? mesh::Patch{fmt::format("patch_{}", reference), mesh::PatchType::wall}
                              : named->second);
  }
  raw.point_ids.resize(local.coordinates.size() / 3);
  std::iota(raw.point_ids.begin(), raw.point_ids.end(), local.first_point);
  raw.coordinates = std::move(local.coordinates);
  for (std::size_t s = 0; s < cell_shape_count; ++s) {
    raw.cell_regions[s] = ids_of(local.cells[s], regions);
    raw.cells[s] = std::move(local.cells[s].corners);
    local.cells[s] = {};
  }
  for (std::size_t s = 0; s < face_shape_count; ++s) {
    raw.face_patches[s] = ids_of(local.faces[s], patches);
    raw.faces[s] = std::move(local.faces[s].corners);
    local.faces[s] = {};
  }
  return raw;
}

}  // namespace aeroloom::io
