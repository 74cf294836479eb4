#include "io/vtk/vtk_reader.hpp"

#include "geometry/sort_unique.hpp"
#include "io/vtk/joined_points.hpp"
#include "io/vtk/vtk_part.hpp"
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
std::vector<std::string> find_parts(const SharedPath& file) {
  const std::string& path = file.path;
  const std::string extension = fs::path(path).extension().string();
  std::vector<std::string> parts;
  parallel::agree(file.communicator, [&] {
    if (extension != ".pvtu" && extension != ".vtu" && extension != ".vtk")
      throw std::runtime_error(fmt::format("'{}': '{}' is not among .vtu, .pvtu and .vtk", path, extension));
    if (!file.communicator.is_root() || extension != ".pvtu") return;
    for (const std::string& source : read_vtk_sources(path))
      parts.push_back((fs::path(path).parent_path() / source).string());
  });
  if (extension != ".pvtu") return {path};
  file.communicator.broadcast_value(parts);
  return parts;
}

/// Runs what concerns one part; its index, if any, is named where that fails.
template <class Work>
auto with_index(const std::string& path, const std::string& part, const Work& work) {
  try {
    return work();
  } catch (const fs::filesystem_error& error) {
    if (part == path) throw;
    throw fs::filesystem_error(fmt::format("a part of '{}' cannot be read", path), part, error.code());
  } catch (const std::runtime_error& error) {
    if (part == path) throw;
    throw std::runtime_error(fmt::format("a part of '{}': {}", path, error.what()));
  }
}

struct PartRange {
  std::size_t begin = 0, end = 0;
};

/// Consecutive parts for this rank, by bytes; a single one is for rank 0. Each rank looks at its share of the
/// files. Collective.
PartRange deal_parts(const SharedPath& file, const std::vector<std::string>& parts) {
  const parallel::Communicator& communicator = file.communicator;
  const auto ranks = static_cast<std::size_t>(communicator.size()),
             rank = static_cast<std::size_t>(communicator.rank());
  const auto cut = [&](std::size_t r) { return r * parts.size() / ranks; };
  std::vector<std::int64_t> mine;
  parallel::agree(communicator, [&] {
    for (std::size_t p = cut(rank); p < cut(rank + 1); ++p)
      mine.push_back(with_index(file.path, parts[p], [&] { return readable_bytes(parts[p]); }));
  });
  const auto sizes = communicator.all_gather_items(std::span<const std::int64_t>(mine));
  double total = 0, before = 0;
  for (const std::int64_t size : sizes) total += static_cast<double>(size);
  PartRange range{parts.size(), parts.size()};
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

/// The share that this rank has read of several parts.
struct VtkShare {
  explicit VtkShare(const SharedPath& file) : raw(file) {}

  RawMesh raw;
  std::vector<VtkLabel> regions, patches;     ///< what labels of cells and faces refer to, so far
  GlobalIndex with_ids = 0, without_ids = 0;  ///< parts with points
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

void append_part(VtkPart part, VtkShare& share) {
  RawMesh& raw = share.raw;
  if (part.point_count() > 0) ++(part.has_ids ? share.with_ids : share.without_ids);
  const auto first_point = static_cast<GlobalIndex>(raw.point_ids.size());
  const std::int32_t first_region = label_offset(share.regions, part.regions),
                     first_patch = label_offset(share.patches, part.patches);
  if (!part.has_ids) {
    for (auto& corners : part.cells)
      for (GlobalIndex& v : corners) v += first_point;
    for (auto& corners : part.faces)
      for (GlobalIndex& v : corners) v += first_point;
    part.ids.resize(part.point_count());
    for (std::size_t i = 0; i < part.ids.size(); ++i) part.ids[i] = first_point + static_cast<GlobalIndex>(i);
  }
  for (std::size_t s = 0; s < cell_shape_count; ++s) {
    for (std::int32_t& label : part.cell_labels[s]) label += first_region;
    move_to_end(raw.cells[s], part.cells[s]);
    move_to_end(raw.cell_regions[s], part.cell_labels[s]);
  }
  for (std::size_t s = 0; s < face_shape_count; ++s) {
    for (std::int32_t& label : part.face_labels[s]) label += first_patch;
    move_to_end(raw.faces[s], part.faces[s]);
    move_to_end(raw.face_patches[s], part.face_labels[s]);
  }
  move_to_end(raw.coordinates, part.coordinates);
  move_to_end(raw.point_ids, part.ids);
  move_to_end(share.regions, part.regions);
  move_to_end(share.patches, part.patches);
}

/// Ids of points that have none in the file are their places among all. Collective.
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

void require_ids_everywhere(const VtkShare& share) {
  const auto& [communicator, path] = share.raw.file;
  const GlobalIndex with = communicator.sum(share.with_ids), without = communicator.sum(share.without_ids);
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
  const std::vector<std::string> parts = find_parts(file);
  const PartRange mine = deal_parts(file, parts);
  VtkShare share(file);
  parallel::agree(communicator, [&] {
    for (std::size_t p = mine.begin; p < mine.end; ++p)
      append_part(with_index(file.path, parts[p], [&] { return read_vtk_part(parts[p]); }), share);
  });
  require_ids_everywhere(share);
  if (communicator.sum(share.with_ids) == 0) {
    place_points(share.raw);
    if (parts.size() > 1) join_equal_points(share.raw);
  }
  for (const mesh::Patch& region : merge_labels(communicator, share.regions, share.raw.cell_regions))
    share.raw.regions.push_back(region.name);
  if (share.raw.regions.empty()) share.raw.regions = {"volume"};
  share.raw.patches = merge_labels(communicator, share.patches, share.raw.face_patches);
  return std::move(share.raw);
}

int parts_named_in_pvtu(const std::string& path) {
  if (!path.ends_with(".pvtu")) return 0;
  std::ifstream stream(path);
  int parts = 0;
  for (std::string line; std::getline(stream, line);) {
    for (std::size_t at = line.find("<Piece"); at != std::string::npos; at = line.find("<Piece", at + 1))
      ++parts;
  }
  return parts;
}

}  // namespace aeroloom::io
