#include "geometry/long_names.hpp"
#include "geometry/predicates.hpp"
#include "io/raw_faces.hpp"
#include "io/raw_mesh.hpp"
#include "mesh/quality/cell_measures.hpp"
#include "mesh/transfer/build_pieces.hpp"
#include "mesh/transfer/id_table.hpp"
#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/log.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::io {

namespace {

using mesh::GlobalIndex;
using mesh::IdTable;
using mesh::LocalIndex;
using mesh::PieceItems;
using mesh::PointTable;

/// Cells of a part where nothing else decides.
constexpr GlobalIndex suitable_part_cells = 250'000;

[[noreturn]] void refuse(const SharedPath& file, const std::string& what) {
  throw parallel::CollectiveError(parallel::FailureKind::input, fmt::format("'{}': {}", file.path, what));
}

void require_ids(const std::vector<GlobalIndex>& ids, const char* whose) {
  for (const GlobalIndex id : ids) {
    if (id < 0 || id > largest_id) throw std::runtime_error(fmt::format("{} refers to point {}", whose, id));
  }
}

template <class Ids>
void require_names(const Ids& ids, std::size_t count, const char* what) {
  for (const std::int32_t id : ids) {
    if (id < 0 || static_cast<std::size_t>(id) >= count)
      throw std::logic_error(fmt::format("{} {}", what, id));
  }
}

/// Checks of the items of this rank that need no other rank.
void require_sound(const RawMesh& raw) {
  if (raw.coordinates.size() != 3 * raw.point_ids.size()) throw std::logic_error("points and ids differ");
  require_ids(raw.point_ids, "a point");
  for (std::size_t i = 0; i < raw.coordinates.size(); ++i) {
    if (!std::isfinite(raw.coordinates[i]))
      throw std::runtime_error(fmt::format("a coordinate of point {} is no number", raw.point_ids[i / 3]));
  }
  for (const CellShape shape : cell_shapes) {
    const auto s = static_cast<std::size_t>(shape);
    const auto n = static_cast<std::size_t>(corners_of(shape));
    if (raw.cells[s].size() != n * raw.cell_regions[s].size())
      throw std::logic_error("cells and regions differ");
    require_ids(raw.cells[s], "a cell");
    require_names(raw.cell_regions[s], raw.regions.size(), "there is no region");
    for (std::size_t c = 0; c < raw.cells[s].size(); c += n) {
      for (std::size_t i = 0; i < n * n; ++i) {
        if (i / n < i % n && raw.cells[s][c + i / n] == raw.cells[s][c + i % n])
          throw std::runtime_error(fmt::format("a cell has point {} twice", raw.cells[s][c + i / n]));
      }
    }
  }
  for (const FaceShape shape : face_shapes) {
    const auto s = static_cast<std::size_t>(shape);
    if (raw.faces[s].size() != static_cast<std::size_t>(corners_of(shape)) * raw.face_patches[s].size())
      throw std::logic_error("faces and patches differ");
    require_ids(raw.faces[s], "a boundary face");
    require_names(raw.face_patches[s], raw.patches.size(), "there is no patch");
  }
}

/// Counts before the cells of this rank, and totals.
struct CellPlaces {
  std::array<GlobalIndex, cell_shape_count> first{};  ///< among all cells, which come by shape
  GlobalIndex total = 0;
};

CellPlaces place_cells(const RawMesh& raw) {
  CellPlaces places;
  for (std::size_t s = 0; s < cell_shape_count; ++s) {
    const auto mine = static_cast<std::int64_t>(raw.cell_regions[s].size());
    places.first[s] = places.total + raw.file.communicator.exclusive_scan(mine);
    places.total += raw.file.communicator.sum(mine);
  }
  return places;
}

/// The ids that cells on this rank use.
IdTable used_ids(const RawMesh& raw) {
  std::vector<GlobalIndex> used;
  for (const auto& cells : raw.cells) used.insert(used.end(), cells.begin(), cells.end());
  return IdTable(std::move(used));
}

template <std::size_t N>
geometry::Vec3 at(const std::vector<std::array<double, 3>>& points, const std::array<LocalIndex, N>& corners,
                  std::size_t k) {
  const auto& p = points[static_cast<std::size_t>(corners[k])];
  return {p[0], p[1], p[2]};
}

/// The sign of the volume: of tetrahedra exact, as the program's own checks have it.
template <std::size_t N>
int volume_sign(CellShape shape, const std::vector<std::array<double, 3>>& points,
                const std::array<LocalIndex, N>& corners) {
  std::array<geometry::Vec3, N> p;
  for (std::size_t k = 0; k < N; ++k) p[k] = at(points, corners, k);
  if constexpr (N == 4) {
    return geometry::has_positive_volume(p[0], p[1], p[2], p[3]) ? 1
                                                                 : geometry::orient3d(p[0], p[1], p[2], p[3]);
  }
  const double volume = mesh::cell_volume(shape, p.data());
  return volume > 0 ? 1 : volume < 0 ? -1 : 0;
}

/// The corners of the mirror image.
template <std::size_t N>
void reverse_orientation(std::array<LocalIndex, N>& c) {
  if constexpr (N == 4) std::swap(c[0], c[1]);
  if constexpr (N == 5) std::swap(c[1], c[3]);
  if constexpr (N == 6) std::swap(c[1], c[2]), std::swap(c[4], c[5]);
  if constexpr (N == 8) std::swap(c[1], c[3]), std::swap(c[5], c[7]);
}

/// Builds the mesh of this rank with numbers in place of ids.
class LocalMeshBuilder {
public:
  LocalMeshBuilder(const RawMesh& raw, const IdTable& ids, const std::vector<std::array<double, 3>>& points)
      : _raw(raw), _ids(ids), _points(points) {}

  void add_cells(const CellPlaces& places, std::int32_t parts, LocalMesh& local, PieceItems& items) {
    mesh::for_each_cell_shape([&](auto s) {
      constexpr auto n = static_cast<std::size_t>(corners_of(cell_shapes[s]));
      const std::vector<GlobalIndex>& ids = _raw.cells[s];
      auto& out = std::get<s>(items.cells);
      out.reserve(ids.size() / n);
      local.cells[s].reserve(ids.size());
      for (std::size_t c = 0; c < ids.size(); c += n) {
        std::array<LocalIndex, n> corners;
        for (std::size_t k = 0; k < n; ++k) corners[k] = _ids.place(ids[c + k]);
        require_volume<n>(cell_shapes[s], corners, ids[c]);
        local.cells[s].insert(local.cells[s].end(), corners.begin(), corners.end());
        const GlobalIndex order = places.first[s] + static_cast<GlobalIndex>(c / n);
        const auto part =
            static_cast<std::int32_t>(static_cast<double>(order) / static_cast<double>(places.total) * parts);
        const std::int32_t region = _raw.cell_regions[s][c / n];
        local.pieces[s].push_back(std::min(part, parts - 1));
        mesh::CellItem<n>& item = out.emplace_back();
        for (std::size_t k = 0; k < n; ++k) item.corners[k] = local.numbers[corners[k]];
        item.order = order;
        item.piece = local.pieces[s].back();
        item.group = region;
      }
      local.regions[s] = _raw.cell_regions[s];
    });
  }

  GlobalIndex turned = 0;

private:
  template <std::size_t N>
  void require_volume(CellShape shape, std::array<LocalIndex, N>& corners, GlobalIndex first) {
    const int sign = volume_sign(shape, _points, corners);
    if (sign < 0) reverse_orientation(corners), ++turned;
    if (sign != 0) return;
    const geometry::Vec3 p = at(_points, corners, 0);
    throw std::runtime_error(
        fmt::format("a cell at point {} ({:.10g}, {:.10g}, {:.10g}) has no volume", first, p.x, p.y, p.z));
  }

  const RawMesh& _raw;
  const IdTable& _ids;
  const std::vector<std::array<double, 3>>& _points;
};

/// The ids that faces on this rank use.
IdTable face_ids(const RawMesh& raw) {
  std::vector<GlobalIndex> ids;
  for (const auto& faces : raw.faces) ids.insert(ids.end(), faces.begin(), faces.end());
  return IdTable(std::move(ids));
}

/// The faces of the file by numbers. Those with a point that no cell uses belong to no cell: they are left
/// out, and counted.
GlobalIndex number_faces(const RawMesh& raw, const IdTable& ids, const std::vector<GlobalIndex>& numbers,
                         LocalMesh& local) {
  GlobalIndex left_out = 0;
  for (const FaceShape shape : face_shapes) {
    const auto s = static_cast<std::size_t>(shape);
    const auto n = static_cast<std::size_t>(corners_of(shape));
    for (std::size_t f = 0; f < raw.face_patches[s].size(); ++f) {
      const std::size_t before = local.faces[s].size();
      bool complete = true;
      for (std::size_t k = 0; k < n; ++k) {
        const LocalIndex at = ids.place(raw.faces[s][n * f + k]);
        local.faces[s].push_back(numbers[at]);
        complete = complete && numbers[at] >= 0;
      }
      if (complete) {
        local.patches[s].push_back(raw.face_patches[s][f]);
      } else {
        local.faces[s].resize(before);
        ++left_out;
      }
    }
  }
  return left_out;
}

PointTable store_points(RawMesh& raw) {
  const parallel::Communicator& communicator = raw.file.communicator;
  GlobalIndex limit = 0;
  for (const GlobalIndex id : raw.point_ids) limit = std::max(limit, id + 1);
  for (const auto& cells : raw.cells) {
    for (const GlobalIndex id : cells) limit = std::max(limit, id + 1);
  }
  limit = communicator.maximum(limit);
  std::vector<PointTable::KeyedValue> points(raw.point_ids.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double* p = raw.coordinates.data() + 3 * i;
    points[i] = {raw.point_ids[i], {p[0], p[1], p[2]}};
  }
  std::vector<double>().swap(raw.coordinates);
  mesh::KeyRanges ranges = mesh::fair_ranges(communicator, std::move(raw.point_ids), limit);
  PointTable store(communicator, std::move(ranges), std::move(points));
  if (store.clash() >= 0)
    refuse(raw.file, fmt::format("point {} comes with different coordinates", store.clash()));
  return store;
}

std::int32_t suitable_parts(GlobalIndex cells) {
  return static_cast<std::int32_t>(
      std::max<GlobalIndex>(1, (cells + suitable_part_cells / 2) / suitable_part_cells));
}

/// Runs checks of one rank alone, and adds the path to their errors. Collective.
template <class Work>
void agree_on(const SharedPath& file, const Work& work) {
  parallel::agree(file.communicator, [&] {
    try {
      work();
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(fmt::format("'{}': {}", file.path, error.what()));
    }
  });
}

/// All ranks have the same names.
void bound_names(RawMesh& raw) {
  std::size_t cut = 0;
  for (mesh::Patch& patch : raw.patches) cut += geometry::cut_long_name(patch.name) ? 1 : 0;
  for (std::string& region : raw.regions) cut += geometry::cut_long_name(region) ? 1 : 0;
  if (cut > 0 && raw.file.communicator.is_root())
    parallel::log_warning(fmt::format("'{}': {}", raw.file.path, geometry::long_names_text(cut)));
}

}  // namespace

Assembled assemble(RawMesh raw, std::int32_t parts) {
  const parallel::Communicator& communicator = raw.file.communicator;
  agree_on(raw.file, [&] { require_sound(raw); });
  bound_names(raw);
  const CellPlaces places = place_cells(raw);
  if (places.total == 0) refuse(raw.file, "there are no tetrahedra, pyramids, prisms or hexahedra in it");
  if (parts <= 0) parts = suitable_parts(places.total);
  Assembled result;
  PointTable store = store_points(raw);
  const GlobalIndex in_file = store.count();
  const IdTable ids = used_ids(raw);
  PieceItems items;
  LocalMesh local;
  local.file = raw.file;
  {
    const PointTable::Fetched found = store.fetch(ids.numbers());
    if (found.missing >= 0)
      refuse(raw.file, fmt::format("a cell refers to point {}, which there is not", found.missing));
    const IdTable of_faces = face_ids(raw);
    PointTable::Numbers numbers = store.number(ids.numbers(), of_faces.numbers());
    local.numbers = std::move(numbers.used);
    local.shared = std::move(numbers.shared);
    result.left_out_faces = communicator.sum(number_faces(raw, of_faces, numbers.others, local));
    LocalMeshBuilder builder(raw, ids, found.values);
    agree_on(raw.file, [&] { builder.add_cells(places, parts, local, items); });
    result.turned_cells = communicator.sum(builder.turned);
  }
  result.dropped_points = in_file - store.count();
  raw.cells = {}, raw.faces = {};
  MatchedFaces matched = match_boundary(local, std::move(raw.patches), raw.regions);
  local = {};
  result.unnamed_faces = matched.unnamed;
  result.left_out_faces += matched.left_out;
  items.faces = std::move(matched.items);
  matched.names.communicator = communicator;
  matched.names.piece_count = parts;
  result.mesh = file_mesh_of(
      mesh::build_pieces(std::move(items), {store}, mesh::Ownership::by_number, std::move(matched.names)));
  return result;
}

}  // namespace aeroloom::io
