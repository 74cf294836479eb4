/// Tetrahedra of the core as they are sent to the pieces they belong to, and their points.
#pragma once

#include "geometry/sort_by_key.hpp"
#include "geometry/sort_unique.hpp"
#include "mesh/exchange/delivery.hpp"
#include "parallel/observation/timers.hpp"
#include "volume/filling/core_pieces.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace aeroloom::volume {

/// A tetrahedron of the core and the piece it belongs to.
struct CoreParcel {
  std::int32_t target;  ///< a zone, or the number of zones plus a core range
  parallel::Rank rank;
  mesh::RegionId region;
  std::uint8_t shared;
  std::array<std::int64_t, 4> points;
};

/// A point of a tetrahedron that is sent to another rank.
struct SentPoint {
  parallel::Rank rank;
  std::int64_t number;
  geometry::Vec3 point;
};

/// Places and keys of lattice points for the pieces of the core.
class CorePoints {
public:
  /// `changes` has one per block index. Refers to both.
  CorePoints(const Lattice& lattice, std::span<const BlockChange> changes)
      : _lattice(lattice), _changes(changes) {}
  const LatticeTree& tree() const { return _lattice.tree; }
  geometry::Vec3 place(std::int64_t number) const {
    if (tree().has(leaf_number_of_lattice(number) / 8)) return lattice_point(_lattice, _changes, number);
    return std::lower_bound(_arrived.begin(), _arrived.end(), number,
                            [](const SentPoint& p, std::int64_t wanted) { return p.number < wanted; })
        ->point;
  }
  /// Sends the points of cells that go to other ranks, where their blocks may not be local. Collective.
  void send_points(std::span<const CoreParcel> cells) {
    const parallel::Communicator& communicator = tree().communicator();
    const parallel::ScopedCpu task(parallel::ScopedCpu::As::task);
    for (const auto& [rank, number] : wanted_by_others(communicator.rank(), cells))
      _arrived.push_back({rank, number, place(number)});
    _arrived = mesh::deliver(communicator, std::move(_arrived), [](const SentPoint& p) { return p.rank; });
    geometry::sort_by_key(_arrived, [](const SentPoint& p) { return static_cast<std::uint64_t>(p.number); });
  }
  void add_vertex(std::int64_t number, mesh::RegionId region, mesh::Piece& piece) const {
    const geometry::Vec3 p = place(number);
    piece.coordinates.insert(piece.coordinates.end(), {p.x, p.y, p.z});
    piece.vertex_dimension.push_back(mesh::CadDimension::region);
    piece.vertex_entity.push_back(region);
    if (!piece.surface_numbers.empty()) piece.surface_numbers.push_back(-1);
  }
  mesh::SharedVertexKey vertex_key(std::int64_t number) const { return _lattice.vertex_key(number); }

private:
  using Wanted = std::pair<parallel::Rank, std::int64_t>;
  /// The points of cells that go to other ranks, each once, by rank and number.
  static std::vector<Wanted> wanted_by_others(parallel::Rank here, std::span<const CoreParcel> cells) {
    std::vector<Wanted> wanted, met(1 << 12, Wanted{-1, -1});  // adjacent cells share most points
    for (const CoreParcel& cell : cells) {
      if (cell.rank == here) continue;
      for (const std::int64_t number : cell.points) {
        Wanted& lately = met[static_cast<std::size_t>(number) % met.size()];
        if (std::exchange(lately, {cell.rank, number}) != Wanted{cell.rank, number})
          wanted.emplace_back(cell.rank, number);
      }
    }
    geometry::sort_unique(wanted);
    return wanted;
  }

  const Lattice& _lattice;
  std::span<const BlockChange> _changes;
  std::vector<SentPoint> _arrived;
};

}  // namespace aeroloom::volume
