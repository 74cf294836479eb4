#include "volume/filling/core_pieces.hpp"

#include "geometry/predicates.hpp"
#include "geometry/sort_unique.hpp"
#include "mesh/data/piece_room.hpp"
#include "parallel/observation/timers.hpp"
#include "volume/filling/core_parcels.hpp"
#include "volume/filling/core_ranges.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace aeroloom::volume {

using mesh::LocalIndex;
using mesh::Piece;
using mesh::RegionId;
using parallel::ScopedCpu;

namespace {

/// A cell by numbers of lattice points.
struct NumberedCell {
  std::array<std::int64_t, 4> points;
  std::uint8_t shared;  ///< points that other pieces may have, as bits
};

void add_cell(const std::array<LocalIndex, 4>& cell, Piece& piece) {
  if (!geometry::has_positive_volume(piece.point(cell[0]), piece.point(cell[1]), piece.point(cell[2]),
                                     piece.point(cell[3])))
    throw std::logic_error("a tetrahedron of the core is flat or inverted");
  piece.cells.insert(piece.cells.end(), cell.begin(), cell.end());
}

/// The lattice points of a piece by number, and their local indices.
class PieceNumbers {
public:
  /// Numbers from `low` to before `high` are in a table, the few others in a sorted list.
  PieceNumbers(std::span<const NumberedCell> cells, std::int64_t low, std::int64_t high)
      : _low(low),
        _high(high),
        _local(static_cast<std::size_t>(high - low), unused),
        _shared(_local.size(), 0) {
    for (const NumberedCell& cell : cells) {
      for (int k = 0; k < 4; ++k) note(cell.points[k], cell.shared >> k & 1);
    }
    geometry::sort_unique(
        _others,
        [](const Other& a, const Other& b) {
          return a.number != b.number ? a.number < b.number : a.shared > b.shared;
        },
        [](const Other& a, const Other& b) { return a.number == b.number; });
  }

  /// Calls add(number, whether other pieces may have it) for each point, ascending. It returns the local
  /// index.
  template <class Add>
  void name(const Add& add) {
    std::size_t next = 0;
    for (; next < _others.size() && _others[next].number < _low; ++next)
      _others[next].local = add(_others[next].number, _others[next].shared);
    for (std::size_t i = 0; i < _local.size(); ++i) {
      if (_local[i] == used) _local[i] = add(_low + static_cast<std::int64_t>(i), _shared[i] != 0);
    }
    for (; next < _others.size(); ++next)
      _others[next].local = add(_others[next].number, _others[next].shared);
  }
  LocalIndex operator()(std::int64_t number) const {
    if (number >= _low && number < _high) return _local[number - _low];
    return std::lower_bound(_others.begin(), _others.end(), number,
                            [](const Other& other, std::int64_t wanted) { return other.number < wanted; })
        ->local;
  }

private:
  static constexpr LocalIndex unused = -1, used = 0;
  struct Other {
    std::int64_t number;
    bool shared;
    LocalIndex local;
  };
  void note(std::int64_t number, bool is_shared) {
    if (number < _low || number >= _high) return _others.push_back({number, is_shared, unused});
    _local[number - _low] = used;
    _shared[number - _low] |= static_cast<std::uint8_t>(is_shared);
  }

  std::int64_t _low, _high;
  std::vector<LocalIndex> _local;
  std::vector<std::uint8_t> _shared;
  std::vector<Other> _others;
};

/// Makes a piece of the core from its cells. Vertices are in the order of their numbers.
Piece make_piece(const CorePoints& points, RegionId region, std::span<const NumberedCell> cells,
                 BlockIndex first, BlockIndex last) {
  const std::int64_t low = lattice_number(points.tree(), first, 0);
  PieceNumbers numbers(cells, low, low + std::int64_t{last - first} * slots_per_block);
  Piece piece;
  piece.region = region;
  numbers.name([&](std::int64_t number, bool is_shared) {
    const LocalIndex v = piece.vertex_count();
    points.add_vertex(number, region, piece);
    if (is_shared) {
      piece.shared_vertices.push_back(v);
      piece.shared_keys.push_back(points.vertex_key(number));
    }
    return v;
  });
  piece.cells.reserve(4 * cells.size());
  for (const NumberedCell& cell : cells) {
    std::array<LocalIndex, 4> corners;
    for (int k = 0; k < 4; ++k) corners[k] = numbers(cell.points[k]);
    add_cell(corners, piece);
  }
  mesh::shrink_to_fit(piece);
  return piece;
}

/// Remembers the local indices of recent lattice points: cells next to each other on the curve share most.
class RecentNumbers {
public:
  /// The result of `find(number)`, remembered if the last call for it was recent.
  template <class Find>
  LocalIndex operator()(std::int64_t number, const Find& find) {
    Slot& slot = _slots[static_cast<std::size_t>(number) % slot_count];
    if (slot.number != number) slot = {number, find(number)};
    return slot.local;
  }

private:
  static constexpr std::size_t slot_count = 1 << 12;  // chosen, not measured
  struct Slot {
    std::int64_t number = -1;
    LocalIndex local = -1;
  };
  std::vector<Slot> _slots = std::vector<Slot>(slot_count);
};

/// Which vertices have a face that occurs only once.
std::vector<std::uint8_t> find_open_vertices(std::vector<LocalTriangle> faces, LocalIndex vertex_count) {
  // Faces are grouped by the lowest vertex; the other two are packed into one number.
  std::vector<std::int64_t> starts(static_cast<std::size_t>(vertex_count) + 1, 0);
  for (LocalTriangle& face : faces) {
    std::sort(face.begin(), face.end());
    ++starts[face[0] + 1];
  }
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  std::vector<std::uint64_t> others(faces.size());
  std::vector<std::int64_t> next(starts.begin(), starts.end() - 1);
  for (const LocalTriangle& face : faces)
    others[next[face[0]]++] = static_cast<std::uint64_t>(face[1]) << 32 | static_cast<std::uint32_t>(face[2]);
  std::vector<std::uint8_t> open(vertex_count, 0);
  for (LocalIndex v = 0; v < vertex_count; ++v) {
    const auto first = others.begin() + starts[v], last = others.begin() + starts[v + 1];
    std::sort(first, last);
    for (auto at = first; at != last;) {
      const auto end = std::find_if(at, last, [&](std::uint64_t other) { return other != *at; });
      if (end - at == 1) open[v] = open[*at >> 32] = open[static_cast<std::uint32_t>(*at)] = 1;
      at = end;
    }
  }
  return open;
}

/// Adds cells of the core to a zone's piece. Vertices of faces without a neighbour become shared.
void extend_piece(const CorePoints& points, std::span<const CoreParcel> cells, CoreSide& side, Piece& piece) {
  const auto find = [](const std::vector<std::int64_t>& numbers, std::int64_t n) {
    const auto at = std::lower_bound(numbers.begin(), numbers.end(), n);
    return at != numbers.end() && *at == n ? static_cast<LocalIndex>(at - numbers.begin()) : -1;
  };
  std::vector<std::int64_t> added;
  RecentNumbers met;
  for (const CoreParcel& cell : cells) {
    for (const std::int64_t n : cell.points) {
      met(n, [&](std::int64_t number) {
        const LocalIndex known = find(side.lattice, number);
        if (known < 0) added.push_back(number);
        return known;
      });
    }
  }
  geometry::sort_unique(added);
  const LocalIndex first_added = piece.vertex_count();
  for (const std::int64_t n : added) points.add_vertex(n, piece.region, piece);
  const auto local_of = [&](std::int64_t n) {
    const LocalIndex known = find(side.lattice, n);
    return known >= 0 ? side.first_lattice + known : first_added + find(added, n);
  };
  std::vector<LocalTriangle> faces = std::move(side.borders);
  faces.reserve(faces.size() + 4 * cells.size());
  piece.cells.reserve(piece.cells.size() + 4 * cells.size());
  RecentNumbers locals;
  for (const CoreParcel& parcel : cells) {
    std::array<LocalIndex, 4> cell;
    for (int k = 0; k < 4; ++k) cell[k] = locals(parcel.points[k], local_of);
    add_cell(cell, piece);
    for (int face = 0; face < 4; ++face) faces.push_back(face_of(cell, face));
  }
  const std::vector<std::uint8_t> shared = find_open_vertices(std::move(faces), piece.vertex_count());
  std::vector<LocalIndex> vertices;
  std::vector<mesh::SharedVertexKey> vertex_keys;
  std::size_t known = 0;
  for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
    const bool was = known < piece.shared_vertices.size() && piece.shared_vertices[known] == v;
    if (was || shared[v]) {
      vertices.push_back(v);
      vertex_keys.push_back(was ? piece.shared_keys[known]
                                : points.vertex_key(v >= first_added ? added[v - first_added]
                                                                     : side.lattice[v - side.first_lattice]));
    }
    known += was;
  }
  piece.shared_vertices = std::move(vertices);
  piece.shared_keys = std::move(vertex_keys);
  mesh::shrink_to_fit(piece);
}

/// The piece of a zone in a region, and where it meets the core.
std::pair<Piece*, CoreSide*> piece_in(RegionId region, ZoneResult& result) {
  const auto at = std::lower_bound(result.pieces.begin(), result.pieces.end(), region,
                                   [](const Piece& piece, RegionId wanted) { return piece.region < wanted; });
  const auto place = at - result.pieces.begin();
  if (at == result.pieces.end() || at->region != region) {
    Piece piece;
    piece.id = piece.region = region;
    result.pieces.insert(at, std::move(piece));
    result.core_sides.insert(result.core_sides.begin() + place, CoreSide{});
  }
  return {&result.pieces[place], &result.core_sides[place]};
}

/// Makes the pieces of the core.
class CoreMaker {
public:
  CoreMaker(const Lattice& lattice, const Shell& shell, std::map<ZoneIndex, ZoneResult>& results)
      : _communicator(lattice.tree.communicator()),
        _lattice(lattice),
        _shell(shell),
        _results(results),
        _points(lattice, shell.local.changes),
        _ranges(lattice.tree, shell),
        _cells(lattice.tree, shell.local.core, shell.local.squares) {}

  CoreMesh run() {
    std::vector<CoreParcel> parcels = make_parcels(ranks_of_zones());
    _points.send_points(parcels);
    parcels = mesh::deliver(_communicator, std::move(parcels), [](const CoreParcel& p) { return p.rank; });
    const ScopedCpu task(ScopedCpu::As::task);
    std::stable_sort(parcels.begin(), parcels.end(), [](const CoreParcel& a, const CoreParcel& b) {
      return a.target != b.target ? a.target < b.target : a.region < b.region;
    });
    auto at = parcels.begin();
    while (at != parcels.end() && at->target < _shell.zones.count()) {
      const auto end = end_of_group(at, parcels.end());
      const auto [piece, side] = piece_in(at->region, _results.at(at->target));
      extend_piece(_points, std::span(at, end), *side, *piece);
      *side = {};
      _mesh.tetrahedra += end - at;
      at = end;
    }
    // Pieces at the border whose neighbours in the core all belong to lower zones.
    for (auto& [zone, result] : _results) {
      for (std::size_t i = 0; i < result.pieces.size(); ++i) {
        if (!result.core_sides[i].borders.empty())
          extend_piece(_points, {}, result.core_sides[i], result.pieces[i]);
      }
    }
    parcels.erase(parcels.begin(), at);
    parcels.shrink_to_fit();
    make_pieces(parcels);
    for (auto& [zone, result] : _results) result.core_sides.clear();
    return std::move(_mesh);
  }

private:
  using Parcels = std::vector<CoreParcel>::iterator;
  static Parcels end_of_group(Parcels at, Parcels last) {
    return std::find_if(
        at, last, [&](const CoreParcel& p) { return p.target != at->target || p.region != at->region; });
  }

  std::vector<parallel::Rank> ranks_of_zones() const {
    struct ZoneRank {
      ZoneIndex zone;
      parallel::Rank rank;
    };
    std::vector<ZoneRank> rows;
    for (const auto& [zone, result] : _results) rows.push_back({zone, _communicator.rank()});
    std::vector<parallel::Rank> ranks(_shell.zones.count(), -1);
    for (const ZoneRank& row : _communicator.all_gather_items<ZoneRank>(rows)) ranks[row.zone] = row.rank;
    return ranks;
  }

  /// The cells that go to zones, and to ranges of other ranks.
  std::vector<CoreParcel> make_parcels(const std::vector<parallel::Rank>& ranks_of_zones) {
    const ScopedCpu task(ScopedCpu::As::task);
    std::vector<CoreParcel> parcels;
    const GhostLayer& ghosts = _shell.local.core.ghosts();
    for (std::size_t i = 0; i < ghosts.own_count(); ++i) {
      const BlockIndex b = ghosts.first() + static_cast<BlockIndex>(i);
      if (_shell.local.core.of(b) == 0) continue;
      const std::int32_t range = _ranges.of(b);
      const bool goes = range >= 0 && _ranges.rank(range) != _communicator.rank();
      if (!goes && _shell.local.border_cells[i] == 0) continue;
      const RegionId region = _shell.local.core.region(b);
      _cells.make(b);
      for (const CoreCell& cell : _cells.cells()) {
        if (cell.of_shell != 0) {
          const ZoneIndex zone = lowest_zone(cell);
          parcels.push_back({zone, ranks_of_zones[zone], region, 0, cell.points});
        } else if (goes) {
          parcels.push_back({_shell.zones.count() + range, _ranges.rank(range), region,
                             _ranges.shared_of(b, cell), cell.points});
        }
      }
    }
    return parcels;
  }

  ZoneIndex lowest_zone(const CoreCell& cell) const {
    ZoneIndex lowest = _shell.zones.count();
    for (int k = 0; k < 4; ++k) {
      if (cell.of_shell >> k & 1)
        lowest = std::min(lowest, _shell.zones.of(leaf_of_lattice(_lattice.tree, cell.points[k])));
    }
    return lowest;
  }

  /// Records the task of a range, whose pieces are those from `first` on.
  void note_range(std::int32_t range, std::size_t first, double seconds) {
    double cells = 0;
    std::int64_t bytes = 0;
    for (std::size_t i = first; i < _mesh.pieces.size(); ++i) {
      cells += _mesh.pieces[i].cell_count();
      bytes += mesh::bytes_at_rest(_mesh.pieces[i]);
    }
    parallel::note_task({parallel::TaskKind::core_piece, range, cells, seconds, bytes});
  }

  /// Makes the pieces of this rank's ranges. Cells from other ranks follow the own ones along the curve.
  void make_pieces(std::span<const CoreParcel> arrived) {
    const GhostLayer& ghosts = _shell.local.core.ghosts();
    std::size_t next = 0;
    for (std::size_t i = 0; i < ghosts.own_count();) {
      const std::size_t first = i, made = _mesh.pieces.size();
      const double begin = parallel::cpu_seconds();
      const std::int32_t range = _ranges.of(ghosts.first() + static_cast<BlockIndex>(i));
      std::map<RegionId, std::vector<NumberedCell>> cells;
      const bool is_mine = range >= 0 && _ranges.rank(range) == _communicator.rank();
      for (; i < ghosts.own_count(); ++i) {
        const BlockIndex b = ghosts.first() + static_cast<BlockIndex>(i);
        if (_ranges.of(b) != range) break;
        if (!is_mine || _shell.local.inner_cells[i] == 0) continue;
        _cells.make(b);
        std::vector<NumberedCell>& of_region = cells[_shell.local.core.region(b)];
        for (const CoreCell& cell : _cells.cells()) {
          if (cell.of_shell == 0) of_region.push_back({cell.points, _ranges.shared_of(b, cell)});
        }
      }
      if (!is_mine) continue;
      for (; next < arrived.size() && arrived[next].target == _shell.zones.count() + range; ++next)
        cells[arrived[next].region].push_back({arrived[next].points, arrived[next].shared});
      for (auto& [region, of_region] : cells) {
        if (of_region.empty()) continue;
        Piece piece = make_piece(_points, region, of_region, ghosts.first() + static_cast<BlockIndex>(first),
                                 ghosts.first() + static_cast<BlockIndex>(i));
        piece.id = range;
        _mesh.tetrahedra += piece.cell_count();
        _mesh.pieces.push_back(std::move(piece));
      }
      note_range(range, made, parallel::cpu_seconds() - begin);
    }
  }

  const parallel::Communicator& _communicator;
  const Lattice& _lattice;
  const Shell& _shell;
  std::map<ZoneIndex, ZoneResult>& _results;
  CorePoints _points;
  CoreRanges _ranges;
  CoreCells _cells;
  CoreMesh _mesh;
};

}  // namespace

CoreMesh make_core(const Lattice& lattice, const Shell& shell, std::map<ZoneIndex, ZoneResult>& results) {
  return CoreMaker(lattice, shell, results).run();
}

}  // namespace aeroloom::volume
