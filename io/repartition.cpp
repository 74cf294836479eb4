#include "io/file_mesh.hpp"
#include "io/hilbert.hpp"
#include "io/part_faces.hpp"
#include "io/part_items.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace aeroloom::io {

namespace {

using mesh::GlobalIndex;
using mesh::LocalIndex;

/// Places along the curve, over the box of the whole mesh.
class Curve {
public:
  Curve(const parallel::Communicator& communicator, const FileMesh& mesh) {
    constexpr double huge = std::numeric_limits<double>::infinity();
    std::array<double, 3> low{huge, huge, huge}, high{-huge, -huge, -huge};
    for (const FilePart& part : mesh.parts) {
      for (std::size_t i = 0; i < part.coordinates.size(); ++i) {
        low[i % 3] = std::min(low[i % 3], part.coordinates[i]);
        high[i % 3] = std::max(high[i % 3], part.coordinates[i]);
      }
    }
    double widest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      _low[k] = communicator.minimum(low[k]);
      widest = std::max(widest, communicator.maximum(high[k]) - _low[k]);
    }
    _cells_per_length = widest > 0 ? ((1U << hilbert_bits) - 1) / widest : 0;
  }

  std::uint64_t key(const FilePart& part, const Block& block, LocalIndex cell) const {
    std::array<double, 3> middle{};
    const LocalIndex* v = block.item(cell);
    for (int k = 0; k < block.corners; ++k) {
      for (std::size_t axis = 0; axis < 3; ++axis)
        middle[axis] += part.coordinates[3 * static_cast<std::size_t>(v[k]) + axis];
    }
    std::array<std::uint32_t, 3> at{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      at[axis] = place((middle[axis] / block.corners - _low[axis]) * _cells_per_length);
    return hilbert_key(at);
  }

private:
  /// Rounding may lead a little, sums of huge coordinates far, beyond the box.
  static std::uint32_t place(double along) {
    constexpr double last = (1U << hilbert_bits) - 1;
    return along > 0 ? static_cast<std::uint32_t>(std::min(along, last)) : 0;
  }

  std::array<double, 3> _low{};
  double _cells_per_length = 0;
};

/// Where to cut a spread set of keys: `shares` parts as equal as keys allow.
class Cuts {
public:
  Cuts(const parallel::Communicator& communicator, std::vector<std::uint64_t> keys, std::int32_t shares) {
    std::sort(keys.begin(), keys.end());
    const GlobalIndex total = communicator.sum(static_cast<std::int64_t>(keys.size()));
    // The highest key with no more than so many keys below it, bit by bit for all cuts at a time.
    const auto cuts = static_cast<std::size_t>(shares - 1);
    std::vector<GlobalIndex> wanted(cuts), below(cuts);
    for (std::size_t i = 0; i < cuts; ++i) {
      const auto k = static_cast<GlobalIndex>(i) + 1;
      wanted[i] = total / shares * k + total % shares * k / shares;
    }
    _first.assign(cuts, 0);
    for (int bit = 3 * hilbert_bits - 1; bit >= 0; --bit) {
      for (std::size_t i = 0; i < cuts; ++i) {
        const std::uint64_t tried = _first[i] | std::uint64_t{1} << bit;
        below[i] = std::lower_bound(keys.begin(), keys.end(), tried) - keys.begin();
      }
      const auto all = communicator.all_gather_items(std::span<const GlobalIndex>(below));
      std::fill(below.begin(), below.end(), 0);
      for (std::size_t i = 0; i < all.size(); ++i) below[i % cuts] += all[i];
      for (std::size_t i = 0; i < cuts; ++i) {
        if (below[i] <= wanted[i]) _first[i] |= std::uint64_t{1} << bit;
      }
    }
  }

  std::int32_t share(std::uint64_t key) const {
    return static_cast<std::int32_t>(std::upper_bound(_first.begin(), _first.end(), key) - _first.begin());
  }

private:
  std::vector<std::uint64_t> _first;  // key of each share but the first
};

/// The parts that each region gets.
struct RegionShare {
  std::int32_t first = 0, count = 1;
};

std::vector<RegionShare> share_out(const FileMesh& mesh, std::int32_t parts, bool by_region) {
  if (!by_region) return {{0, parts}};
  std::vector<RegionShare> shares;
  std::int32_t next = 0;
  const auto all = static_cast<double>(std::max<GlobalIndex>(1, mesh.cell_count()));
  for (const auto& shapes : mesh.region_cells) {
    const GlobalIndex cells = std::accumulate(shapes.begin(), shapes.end(), GlobalIndex{0});
    const auto fair = static_cast<std::int32_t>(std::lround(static_cast<double>(cells) / all * parts));
    shares.push_back({next, cells == 0 ? 0 : std::max(1, fair)});
    next += shares.back().count;
  }
  return shares;
}

/// The new part of each cell on this rank, by local part and cell.
class Cutter {
public:
  Cutter(const parallel::Communicator& communicator, const FileMesh& mesh, std::int32_t parts, bool by_region)
      : _mesh(mesh), _shares(share_out(mesh, parts, by_region)), _parts_of(mesh.parts.size()) {
    const Curve curve(communicator, mesh);
    std::vector<std::vector<std::uint64_t>> keys(_shares.size());
    std::vector<std::vector<std::uint64_t>> of_part(mesh.parts.size());
    for_each_cell([&](std::size_t p, const Block& block, const Run& run, LocalIndex cell) {
      of_part[p].push_back(curve.key(_mesh.parts[p], block, cell));
      keys[group(run)].push_back(of_part[p].back());
    });
    std::vector<Cuts> cuts;
    for (std::size_t g = 0; g < _shares.size(); ++g)
      cuts.emplace_back(communicator, std::move(keys[g]), std::max(1, _shares[g].count));
    for_each_cell([&](std::size_t p, const Block&, const Run& run, LocalIndex) {
      const std::uint64_t key = of_part[p][_parts_of[p].size()];
      _parts_of[p].push_back(_shares[group(run)].first + cuts[group(run)].share(key));
    });
  }

  std::int32_t part_count() const { return std::max(1, _shares.back().first + _shares.back().count); }
  /// By number of cell (face_links.hpp).
  const std::vector<std::int32_t>& parts_of(std::size_t local_part) const { return _parts_of[local_part]; }

private:
  std::size_t group(const Run& run) const {
    return _shares.size() == 1 ? 0 : static_cast<std::size_t>(run.id);
  }

  template <class Visit>
  void for_each_cell(const Visit& visit) const {
    for (std::size_t p = 0; p < _mesh.parts.size(); ++p) {
      for (const Block& block : _mesh.parts[p].cells) {
        for (const Run& run : block.runs) {
          for (LocalIndex cell = run.begin; cell < run.end; ++cell) visit(p, block, run, cell);
        }
      }
    }
  }

  const FileMesh& _mesh;
  std::vector<RegionShare> _shares;
  std::vector<std::vector<std::int32_t>> _parts_of;
};

/// New parts of the boundary faces of a part: those of the cells that they are seen from outside of.
std::vector<std::int32_t> parts_of_faces(const FilePart& part,
                                         const std::vector<std::int32_t>& parts_of_cells) {
  std::vector<std::int32_t> result(part.face_count(), 0);
  const PartFaces faces(part);
  match_faces(
      static_cast<std::size_t>(part.vertex_count()), faces,
      [&](const FaceKey<LocalIndex>&, std::span<const FaceUser> users) {
        for (const FaceUser& user : users) {
          if (user.is_cell()) continue;
          for (const FaceUser& other : users) {
            if (other.is_cell() && same_direction(faces.face(user.item), faces.side(other.item, other.side)))
              result[user.item] = parts_of_cells[other.item];
          }
        }
      });
  return result;
}

template <std::size_t N>
void append(const FilePart& part, const Block& block, const std::int32_t* parts,
            std::vector<PartItem<N>>& items) {
  items.reserve(items.size() + static_cast<std::size_t>(block.count()));
  for (const Run& run : block.runs) {
    for (LocalIndex i = run.begin; i < run.end; ++i) {
      PartItem<N>& item = items.emplace_back();
      const LocalIndex* v = block.item(i);
      for (std::size_t k = 0; k < N; ++k) item.corners[k] = part.numbers[v[k]];
      item.order = run.before + (i - run.begin);
      item.part = parts[i];
      item.id = run.id;
    }
  }
}

}  // namespace

FileMesh repartition(const parallel::Communicator& communicator, const FileMesh& mesh, std::int32_t parts,
                     bool by_region) {
  PartItems items;
  std::int32_t part_count = 0;
  {
    const Cutter cutter(communicator, mesh, std::max(1, parts), by_region);
    part_count = cutter.part_count();
    for (std::size_t p = 0; p < mesh.parts.size(); ++p) {
      const FilePart& part = mesh.parts[p];
      const std::int32_t* of_cells = cutter.parts_of(p).data();
      for_each_cell_shape([&](auto s) {
        append(part, part.cells[s], of_cells, std::get<s>(items.cells));
        of_cells += part.cells[s].count();
      });
      const std::vector<std::int32_t> face_parts = parts_of_faces(part, cutter.parts_of(p));
      const std::int32_t* of_faces = face_parts.data();
      for_each_face_shape([&](auto s) {
        append(part, part.faces[s], of_faces, std::get<s>(items.faces));
        of_faces += part.faces[s].count();
      });
    }
  }
  std::vector<PointStore::Row> points;
  for (const FilePart& part : mesh.parts) {
    for (LocalIndex v = 0; v < part.vertex_count(); ++v) {
      if (part.owned[v])
        points.push_back({part.numbers[v], {part.point(v).x, part.point(v).y, part.point(v).z}});
    }
  }
  const PointStore store(communicator, mesh::even_ranges(communicator.size(), mesh.vertex_count),
                         std::move(points));
  return build_parts(communicator, std::move(items), store, part_count, Ownership::by_part, mesh.patches,
                     mesh.regions);
}

}  // namespace aeroloom::io
