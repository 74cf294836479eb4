#include "io/vtk/vtk_reader.hpp"

#include "geometry/sort_unique.hpp"
#include "io/vtk/joined_points.hpp"
#include "io/vtk/vtk_content.hpp"
#include "parallel/communication/collective_error.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <tuple>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::io {

namespace {

namespace fs = std::filesystem;
using mesh::GlobalIndex;

/// The files that hold the mesh, the same on every rank. Collective.
std::vector<std::string> find_files(const SharedPath& file) {
  const std::string& path = file.path;
  const std::string extension = fs::path(path).extension().string();
  std::vector<std::string> files;
  parallel::agree(file.communicator, [&] {
    if (extension != ".pvtu" && extension != ".vtu" && extension != ".vtk")
      throw std::runtime_error(fmt::format("'{}': '{}' is not among .vtu, .pvtu and .vtk", path, extension));
    if (!file.communicator.is_root() || extension != ".pvtu") return;
    for (const std::string& source : read_vtk_sources(path))
      files.push_back((fs::path(path).parent_path() / source).string());
  });
  if (extension != ".pvtu") return {path};
  file.communicator.broadcast_value(files);
  return files;
}

/// Does work with one file. Errors name the index, if there is one.
template <class Work>
auto with_index(const std::string& path, const std::string& file, const Work& work) {
  try {
    return work();
  } catch (const std::system_error& error) {
    if (file == path) throw;
    throw fs::filesystem_error(fmt::format("a part of '{}' cannot be read", path), file, error.code());
  } catch (const std::runtime_error& error) {
    if (file == path) throw;
    throw std::runtime_error(fmt::format("a part of '{}': {}", path, error.what()));
  }
}

struct FileRange {
  std::size_t begin = 0, end = 0;
};

/// Consecutive files for this rank, by bytes; a single one is for rank 0. Each rank looks at a range of the
/// files. Collective.
FileRange assign_files(const SharedPath& file, const std::vector<std::string>& files) {
  const parallel::Communicator& communicator = file.communicator;
  const auto ranks = static_cast<std::size_t>(communicator.size()),
             rank = static_cast<std::size_t>(communicator.rank());
  const auto cut = [&](std::size_t r) { return r * files.size() / ranks; };
  std::vector<std::int64_t> mine;
  parallel::agree(communicator, [&] {
    for (std::size_t p = cut(rank); p < cut(rank + 1); ++p)
      mine.push_back(with_index(file.path, files[p], [&] { return readable_bytes(files[p]); }));
  });
  const auto sizes = communicator.all_gather_items(std::span<const std::int64_t>(mine));
  double total = 0, before = 0;
  for (const std::int64_t size : sizes) total += static_cast<double>(size);
  FileRange range{files.size(), files.size()};
  for (std::size_t p = 0; p < sizes.size(); ++p) {
    const auto reader = std::min(
        ranks - 1, static_cast<std::size_t>(before / std::max(total, 1.0) * static_cast<double>(ranks)));
    before += static_cast<double>(sizes[p]);
    if (reader == rank) range.begin = std::min(range.begin, p);
    if (reader > rank) range.end = std::min(range.end, p);
  }
  range.begin = std::min(range.begin, range.end);
  return range;
}

/// The mesh that this rank has read from several files.
struct LocalVtkMesh {
  explicit LocalVtkMesh(const SharedPath& file) : raw(file) {}

  RawMesh raw;
  std::vector<VtkLabel> regions, patches;     ///< what labels of cells and faces refer to, so far
  GlobalIndex with_ids = 0, without_ids = 0;  ///< files with points
};

template <class T>
void move_to_end(std::vector<T>& items, std::vector<T>& more) {
  if (items.empty()) items.swap(more);
  items.insert(items.end(), more.begin(), more.end());
  std::vector<T>().swap(more);
}

std::int32_t label_offset(const std::vector<VtkLabel>& before, const std::vector<VtkLabel>& more) {
  if (before.size() + more.size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
    throw std::runtime_error("there are more regions or patches than 32 bits can count");
  return static_cast<std::int32_t>(before.size());
}

void append_content(VtkContent content, LocalVtkMesh& local) {
  RawMesh& raw = local.raw;
  if (content.point_count() > 0) ++(content.has_ids ? local.with_ids : local.without_ids);
  const auto first_point = static_cast<GlobalIndex>(raw.point_ids.size());
  const std::int32_t first_region = label_offset(local.regions, content.regions),
                     first_patch = label_offset(local.patches, content.patches);
  if (!content.has_ids) {
    for (auto& corners : content.cells)
      for (GlobalIndex& v : corners) v += first_point;
    for (auto& corners : content.faces)
      for (GlobalIndex& v : corners) v += first_point;
    content.ids.resize(content.point_count());
    for (std::size_t i = 0; i < content.ids.size(); ++i)
      content.ids[i] = first_point + static_cast<GlobalIndex>(i);
  }
  for (std::size_t s = 0; s < cell_shape_count; ++s) {
    for (std::int32_t& label : content.cell_labels[s]) label += first_region;
    move_to_end(raw.cells[s], content.cells[s]);
    move_to_end(raw.cell_regions[s], content.cell_labels[s]);
  }
  for (std::size_t s = 0; s < face_shape_count; ++s) {
    for (std::int32_t& label : content.face_labels[s]) label += first_patch;
    move_to_end(raw.faces[s], content.faces[s]);
    move_to_end(raw.face_patches[s], content.face_labels[s]);
  }
  move_to_end(raw.coordinates, content.coordinates);
  move_to_end(raw.point_ids, content.ids);
  move_to_end(local.regions, content.regions);
  move_to_end(local.patches, content.patches);
}

/// Gives points without ids in the file their place among all points as id. Collective.
void place_points(RawMesh& raw) {
  const GlobalIndex first =
      raw.file.communicator.exclusive_scan(static_cast<std::int64_t>(raw.point_ids.size()));
  const auto move = [&](std::vector<GlobalIndex>& ids) {
    for (GlobalIndex& v : ids) v += first;
  };
  move(raw.point_ids);
  for (auto& corners : raw.cells) move(corners);
  for (auto& corners : raw.faces) move(corners);
}

auto sort_key(const VtkLabel& label) {
  return std::tie(label.value, label.named.name, label.named.type);
}
bool is_before(const VtkLabel& a, const VtkLabel& b) {
  return sort_key(a) < sort_key(b);
}
void sort_labels(std::vector<VtkLabel>& labels) {
  geometry::sort_unique(labels, is_before,
                        [](const VtkLabel& a, const VtkLabel& b) { return sort_key(a) == sort_key(b); });
}

/// One table of all ranks by value and name; `labels`, of this rank's cells, become places in it. Collective.
std::vector<mesh::Patch> merge_labels(const parallel::Communicator& communicator,
                                      const std::vector<VtkLabel>& table,
                                      std::span<std::vector<std::int32_t>> labels) {
  std::vector<VtkLabel> all = table;
  sort_labels(all);
  const auto of_ranks = communicator.all_gather_values(all);
  all.clear();
  for (const std::vector<VtkLabel>& of_rank : of_ranks) all.insert(all.end(), of_rank.begin(), of_rank.end());
  sort_labels(all);
  std::vector<std::int32_t> place;
  place.reserve(table.size());
  for (const VtkLabel& label : table)
    place.push_back(
        static_cast<std::int32_t>(std::lower_bound(all.begin(), all.end(), label, is_before) - all.begin()));
  for (auto& of_shape : labels) {
    for (std::int32_t& label : of_shape) label = place.at(static_cast<std::size_t>(label));
  }
  std::vector<mesh::Patch> named;
  named.reserve(all.size());
  for (const VtkLabel& label : all) named.push_back(label.named);
  return named;
}

void require_ids_everywhere(const LocalVtkMesh& local) {
  const auto& [communicator, path] = local.raw.file;
  const GlobalIndex with = communicator.sum(local.with_ids), without = communicator.sum(local.without_ids);
  if (with == 0 || without == 0) return;
  throw parallel::CollectiveError(
      parallel::FailureKind::input,
      fmt::format("'{}': {} of its parts have ids of points (global_id), {} have none; write them for all "
                  "parts, or for none",
                  path, with, without));
}

}  // namespace

RawMesh read_vtk(const SharedPath& file) {
  const parallel::Communicator& communicator = file.communicator;
  const std::vector<std::string> files = find_files(file);
  const FileRange mine = assign_files(file, files);
  LocalVtkMesh local(file);
  parallel::agree(communicator, [&] {
    for (std::size_t p = mine.begin; p < mine.end; ++p)
      append_content(with_index(file.path, files[p], [&] { return read_vtk_content(files[p]); }), local);
  });
  require_ids_everywhere(local);
  if (communicator.sum(local.with_ids) == 0) {
    place_points(local.raw);
    if (files.size() > 1) join_equal_points(local.raw);
  }
  for (const mesh::Patch& region : merge_labels(communicator, local.regions, local.raw.cell_regions))
    local.raw.regions.push_back(region.name);
  if (local.raw.regions.empty()) local.raw.regions = {"volume"};
  local.raw.patches = merge_labels(communicator, local.patches, local.raw.face_patches);
  return std::move(local.raw);
}

int parts_named_in_pvtu(const std::string& path) {
  if (!path.ends_with(".pvtu")) return 0;
  std::ifstream stream(path);
  int files = 0;
  for (std::string line; std::getline(stream, line);) {
    for (std::size_t at = line.find("<Piece"); at != std::string::npos; at = line.find("<Piece", at + 1))
      ++files;
  }
  return files;
}

}  // namespace aeroloom::io
