#include "io/ugrid/ugrid_reader.hpp"

#include "io/distinct_numbers.hpp"
#include "io/streams/range_reader.hpp"
#include "io/ugrid/mapbc.hpp"
#include "io/ugrid/ugrid_format.hpp"
#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/log.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <vector>

#include <fmt/format.h>

namespace aeroloom::io {

namespace {

using mesh::GlobalIndex;

/// More are no patches.
constexpr std::size_t most_patches = 1U << 20;
/// Numbers read at a time.
constexpr std::int64_t chunk_items = 1 << 17;

constexpr std::array<const char*, face_shape_count> face_names = {"triangle", "quadrilateral"};
constexpr std::array<const char*, cell_shape_count> cell_names = {"tetrahedron", "pyramid", "prism",
                                                                  "hexahedron"};

/// The ids of the patches of the faces on this rank, by shape.
using PatchIds = std::array<std::vector<std::int64_t>, face_shape_count>;

/// Reads a file with integers of one width.
template <class Integer>
class UgridReader {
public:
  UgridReader(RangeReader& file, RawMesh& raw) : _file(file), _raw(raw) {}

  void read(PatchIds& patch_ids) {
    read_counts();
    read_points();
    for (std::size_t s = 0; s < face_shape_count; ++s) {
      const int corners = corners_of(face_shapes[s]);
      read_connectivity(_layout.faces[s], range_of(_counts.faces[s]), corners, nullptr, face_names[s],
                        _raw.faces[s]);
      read_patch_ids(_layout.patch_ids[s], range_of(_counts.faces[s]), patch_ids[s]);
    }
    for (std::size_t s = 0; s < cell_shape_count; ++s) {
      const LocalRange range = range_of(_counts.cells[s]);
      read_connectivity(_layout.cells[s], range, corners_of(cell_shapes[s]), to_ugrid[s].data(),
                        cell_names[s], _raw.cells[s]);
      _raw.cell_regions[s].assign(static_cast<std::size_t>(range.count()), 0);
    }
  }

private:
  static constexpr std::int64_t width = sizeof(Integer);

  LocalRange range_of(GlobalIndex count) const { return _raw.file.local_range(count); }

  /// Counts are held against the size of the file before anything is computed or allocated from them.
  void read_counts() {
    std::array<Integer, 7> counts{};
    _file.read(0, std::span<Integer>(counts));
    constexpr std::array<std::int64_t, 7> item_bytes = {24,        4 * width, 5 * width, 4 * width,
                                                        5 * width, 6 * width, 8 * width};
    constexpr std::array<const char*, 7> names = {"points",   "triangles", "quadrilaterals", "tetrahedra",
                                                  "pyramids", "prisms",    "hexahedra"};
    std::int64_t left = _file.bytes_from(7 * width);
    for (std::size_t i = 0; i < counts.size(); ++i) {
      if (counts[i] < 0 || counts[i] > left / item_bytes[i])
        _file.fail(static_cast<std::int64_t>(i) * width,
                   fmt::format("{} {} do not fit a file of {} bytes; is it of the kind that its name says?",
                               counts[i], names[i], _file.size()));
      left -= counts[i] * item_bytes[i];
    }
    _counts = {counts[0], {counts[1], counts[2]}, {counts[3], counts[4], counts[5], counts[6]}};
    _layout = ugrid_layout(_counts, static_cast<int>(width));
    require_known_rest();
  }

  /// After its cells a file may have the number of tetrahedra of boundary layers with an id of each cell,
  /// then one flag, then another, of each face; these are not read. Anything else means that bytes were
  /// inserted.
  void require_known_rest() {
    const std::int64_t rest = _file.bytes_from(_layout.end);
    if (rest == 0) return;
    std::int64_t cells = 0, faces = 0;
    for (const GlobalIndex count : _counts.cells) cells += count;
    for (const GlobalIndex count : _counts.faces) faces += count;
    for (int flags = 0; flags <= 2 && cells > 0; ++flags) {
      if (rest != width * (1 + cells + flags * faces)) continue;
      const auto in_layers = static_cast<std::int64_t>(_file.value<Integer>(_layout.end));
      if (in_layers >= 0 && in_layers <= _counts.cells[0]) return;
    }
    _file.fail(_layout.end,
               fmt::format("the counts of the file end here, but {} bytes follow; it is damaged, "
                           "or of another kind than its name says",
                           rest));
  }

  void read_points() {
    const LocalRange range = range_of(_counts.vertices);
    _raw.coordinates.resize(3 * static_cast<std::size_t>(range.count()));
    const std::int64_t offset = _layout.points + 24 * range.begin;
    _file.read(offset, std::span<double>(_raw.coordinates));
    for (std::size_t i = 0; i < _raw.coordinates.size(); ++i) {
      if (!std::isfinite(_raw.coordinates[i]))
        _file.fail(offset + 8 * static_cast<std::int64_t>(i),
                   fmt::format("a coordinate of point {} is no number",
                               range.begin + static_cast<std::int64_t>(i / 3) + 1));
    }
    _raw.point_ids.resize(static_cast<std::size_t>(range.count()));
    std::iota(_raw.point_ids.begin(), _raw.point_ids.end(), range.begin);
  }

  /// Calls visit(number, index) for `count` integers from `offset` on, chunk by chunk.
  template <class Visit>
  void for_each_integer(std::int64_t offset, std::int64_t count, const Visit& visit) {
    std::vector<Integer> chunk;
    for (std::int64_t begin = 0; begin < count; begin += chunk_items) {
      chunk.resize(static_cast<std::size_t>(std::min(chunk_items, count - begin)));
      _file.read(offset + begin * width, std::span<Integer>(chunk));
      for (std::size_t i = 0; i < chunk.size(); ++i)
        visit(static_cast<std::int64_t>(chunk[i]), begin + static_cast<std::int64_t>(i));
    }
  }

  /// Points of items from 0; corner k of the file becomes corner order[k].
  void read_connectivity(std::int64_t section, LocalRange range, int corners, const std::int8_t* order,
                         const char* name, std::vector<GlobalIndex>& connectivity) {
    connectivity.resize(static_cast<std::size_t>(range.count() * corners));
    const std::int64_t offset = section + range.begin * corners * width;
    for_each_integer(offset, range.count() * corners, [&](std::int64_t point, std::int64_t i) {
      if (point < 1 || point > _counts.vertices)
        _file.fail(offset + i * width, fmt::format("{} {} has point {}, of {}", name,
                                                   range.begin + i / corners + 1, point, _counts.vertices));
      const std::int64_t k = i % corners;
      connectivity[static_cast<std::size_t>(order == nullptr ? i : i - k + order[k])] = point - 1;
    });
  }

  void read_patch_ids(std::int64_t section, LocalRange range, std::vector<std::int64_t>& ids) {
    ids.resize(static_cast<std::size_t>(range.count()));
    for_each_integer(section + range.begin * width, range.count(),
                     [&](std::int64_t id, std::int64_t i) { ids[static_cast<std::size_t>(i)] = id; });
  }

  RangeReader& _file;
  RawMesh& _raw;
  ShapeCounts _counts;
  UgridLayout _layout;
};

/// Whether the table is about these ids, no fewer and no others.
bool are_keys(const std::map<std::int64_t, mesh::Patch>& table, const std::vector<std::int64_t>& ids) {
  return std::equal(table.begin(), table.end(), ids.begin(), ids.end(),
                    [](const auto& row, std::int64_t id) { return row.first == id; });
}

/// Collective.
void set_patches(const PatchIds& patch_ids, RawMesh& raw) {
  const auto& [communicator, path] = raw.file;
  const std::vector<std::int64_t> ids = distinct_numbers<std::int64_t>(
      communicator, {patch_ids[0], patch_ids[1]}, most_patches,
      fmt::format("{}: its faces have more than {} different patch ids", path, most_patches));
  std::map<std::int64_t, mesh::Patch> table = read_mapbc({communicator, mapbc_path_of(path)});
  if (!table.empty() && !are_keys(table, ids)) {
    if (communicator.is_root()) {
      parallel::log_warning(
          fmt::format("'{}' is left alone: its patches are not those of '{}', which has {} from {} to {}",
                      mapbc_path_of(path), path, ids.size(), ids.empty() ? 0 : ids.front(),
                      ids.empty() ? 0 : ids.back()));
    }
    table.clear();
  }
  std::set<std::string> taken;
  for (const std::int64_t id : ids) {
    const auto found = table.find(id);
    mesh::Patch patch = found != table.end()
                            ? found->second
                            : mesh::Patch{fmt::format("patch_{}", id), mesh::PatchType::wall};
    while (!taken.insert(patch.name).second) patch.name += fmt::format("_{}", id);
    raw.patches.push_back(std::move(patch));
  }
  for (std::size_t s = 0; s < face_shape_count; ++s) {
    for (const std::int64_t id : patch_ids[s])
      raw.face_patches[s].push_back(
          static_cast<std::int32_t>(std::lower_bound(ids.begin(), ids.end(), id) - ids.begin()));
  }
}

}  // namespace

RawMesh read_ugrid(const SharedPath& file) {
  RawMesh raw(file);
  raw.regions = {"fluid"};
  PatchIds patch_ids;
  parallel::agree(file.communicator, [&] {
    const UgridKind kind = ugrid_kind_of(file.path);
    RangeReader reader(file.path);
    reader.set_order(kind.order);
    if (kind.integer_bytes == 4) {
      UgridReader<std::int32_t>(reader, raw).read(patch_ids);
    } else {
      UgridReader<std::int64_t>(reader, raw).read(patch_ids);
    }
  });
  set_patches(patch_ids, raw);
  return raw;
}

}  // namespace aeroloom::io
