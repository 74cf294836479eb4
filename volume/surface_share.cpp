#include "volume/surface_share.hpp"

#include "mesh/delivery.hpp"
#include "volume/boundary_distance.hpp"
#include "volume/near_boxes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

namespace aeroloom::volume {

using geometry::Vec3;
using mesh::Piece;

namespace {

/// Rounding of grid coordinates is far below this, in finest cells.
constexpr double rounding = 1e-3;
/// Expected work on a leaf and on a triangle, and on a block that the surface meets.
constexpr double leaf_work = 1, triangle_work = 4, met_work = 8;

std::array<Vec3, 3> corners_of(const Piece& piece, mesh::LocalIndex t) {
  const mesh::LocalIndex* v = piece.cell(t);
  return {piece.point(v[0]), piece.point(v[1]), piece.point(v[2])};
}

double longest_edge(const std::array<Vec3, 3>& p) {
  return std::max({distance(p[0], p[1]), distance(p[1], p[2]), distance(p[2], p[0])});
}

/// What one rank knows about a block.
struct BlockRow {
  BlockIndex block;
  float longest_edge;
  std::int32_t triangles;
  float nearest;

  static constexpr auto fields() {
    return std::tuple(&BlockRow::block, &BlockRow::longest_edge, &BlockRow::triangles, &BlockRow::nearest);
  }
};

/// How far a triangle is from the middle of a block, in space, rounded up.
float distance_from_middle(const LatticeFrame& frame, const GridCube& block, const std::array<Vec3, 3>& p) {
  const GridBox box = GridBox::of(block);
  const Vec3 middle = frame.to_space(0.5 * (box.low + box.high));
  const double distance = std::sqrt(BoundaryDistance::squared_distance(middle, {p[0], p[1], p[2]}).squared);
  return std::nextafter(static_cast<float>(distance), std::numeric_limits<float>::infinity());
}

/// Calls add(row) for what a triangle adds to the rows of blocks.
template <class Add>
void tabulate(const LatticeFrame& frame, const LatticeTree& tree, const std::array<Vec3, 3>& p,
              const Add& add) {
  const auto edge = static_cast<float>(longest_edge(p));
  const BlockIndex middle = tree.block_at(frame.cell_at(frame.to_grid((1.0 / 3.0) * (p[0] + p[1] + p[2]))));
  add(BlockRow{middle, edge, 1, distance_from_middle(frame, tree.cube(middle), p)});
  tree.for_each_block_in(grid_box(frame, p), [&](BlockIndex b) {
    if (b != middle) add(BlockRow{b, edge, 0, distance_from_middle(frame, tree.cube(b), p)});
  });
}

SurfaceTriangle describe(const Piece& piece, mesh::LocalIndex t, std::span<const mesh::GlobalIndex> numbers,
                         mesh::GlobalIndex first_cell, const mesh::DistributedMesh& surface) {
  SurfaceTriangle triangle{};
  triangle.number = first_cell + t;
  triangle.points = corners_of(piece, t);
  for (int k = 0; k < 3; ++k) {
    const mesh::LocalIndex v = piece.cell(t)[k];
    triangle.vertices[k] = numbers[v];
    triangle.dimension[k] = piece.vertex_dimension[v];
    triangle.entity[k] = piece.vertex_entity[v];
  }
  triangle.face = piece.triangle_face[t];
  triangle.patch = piece.triangle_patch[t];
  const mesh::FaceSides sides = surface.sides_of(triangle.face);
  triangle.front = sides.front;
  triangle.back = sides.back;
  return triangle;
}

/// A rank wants what meets a block.
struct Want {
  BlockIndex block;
  parallel::Rank rank;

  static constexpr auto fields() { return std::tuple(&Want::block, &Want::rank); }
};

/// The blocks of others that a rank wants the triangles of.
class WantedBlocks {
public:
  WantedBlocks(const LatticeFrame& frame, const LatticeTree& tree, const SurfaceTable& table,
               std::span<const BlockIndex> shares, const SurfaceReach& reach, parallel::Rank rank)
      : _frame(frame),
        _tree(tree),
        _table(table),
        _reach(reach),
        _rank(rank),
        _first(shares[rank]),
        _last(shares[rank + 1]) {}

  std::vector<Want> list() {
    for (BlockIndex b = _first; b < _last; ++b) look_from(b);
    _of_all.build();
    _of_large.build();
    std::vector<Want> wants;
    for (BlockIndex n = 0; n < _tree.block_count(); ++n) {
      const bool is_own = n >= _first && n < _last;
      if (!is_own && _table.is_met(n) && is_within_reach(n)) wants.push_back({n, _rank});
    }
    return wants;
  }

private:
  void look_from(BlockIndex b) {
    BlockReach reach = _reach.of_blocks[b - _first];
    const GridBox box = GridBox::of(_tree.cube(b));
    const double farthest = std::max(reach.most, reach.nearest);
    const auto [lowest, highest] = _tree.range_of(box.dilated(farthest));
    if (lowest >= _first && highest < _last) return;
    reach.least = std::max(reach.least, reach.nearest);
    reach.most = farthest;
    _of_all.add(box.dilated(reach.least));
    _of_large.add(box.dilated(reach.most));
  }

  bool is_within_reach(BlockIndex n) const {
    const GridBox box = GridBox::of(_tree.cube(n));
    return _of_all.any_within(box, _reach.per_edge * _table.longest_edge[n]) && _of_large.any_within(box, 0);
  }

  const LatticeFrame& _frame;
  const LatticeTree& _tree;
  const SurfaceTable& _table;
  const SurfaceReach& _reach;
  parallel::Rank _rank;
  BlockIndex _first, _last;
  NearBoxes _of_all, _of_large;  // triangles
};

/// Which ranks want what meets a block, beside the one that has the block.
class Fringe {
public:
  Fringe(const parallel::Communicator& communicator, const LatticeTree& tree, const SurfaceTable& table,
         const LatticeFrame& frame, std::span<const BlockIndex> shares, const SurfaceReach& reach,
         parallel::StageClock& clock) {
    if (communicator.size() == 1) return;
    std::vector<Want> mine;
    {
      const parallel::ScopedCpu task(clock, parallel::ScopedCpu::As::task);
      mine = WantedBlocks(frame, tree, table, shares, reach, communicator.rank()).list();
    }
    _wants = communicator.all_gather_items<Want>(mine);
    std::sort(_wants.begin(), _wants.end(), [](const Want& a, const Want& b) { return a.block < b.block; });
  }

  template <class Visit>
  void for_each_rank(BlockIndex b, const Visit& visit) const {
    auto at = std::lower_bound(_wants.begin(), _wants.end(), b,
                               [](const Want& want, BlockIndex block) { return want.block < block; });
    for (; at != _wants.end() && at->block == b; ++at) visit(at->rank);
  }

private:
  std::vector<Want> _wants;
};

}  // namespace

GridBox grid_box(const LatticeFrame& frame, const std::array<Vec3, 3>& points) {
  geometry::Box box;
  for (const Vec3& p : points) box.add(frame.to_grid(p));
  return GridBox{box.low, box.high}.dilated(rounding);
}

SurfaceTable tabulate_surface(const parallel::Communicator& communicator, const LatticeFrame& frame,
                              const LatticeTree& tree, const mesh::DistributedMesh& surface,
                              parallel::StageClock& clock) {
  SurfaceTable table;
  table.longest_edge.assign(tree.block_count(), 0);
  table.triangles.assign(tree.block_count(), 0);
  table.nearest.assign(tree.block_count(), std::numeric_limits<float>::infinity());
  const auto add = [&table](const BlockRow& row) {
    table.longest_edge[row.block] = std::max(table.longest_edge[row.block], row.longest_edge);
    table.triangles[row.block] += row.triangles;
    table.nearest[row.block] = std::min(table.nearest[row.block], row.nearest);
  };
  std::vector<BlockRow> rows;
  {
    const parallel::ScopedCpu task(clock, parallel::ScopedCpu::As::task);
    for (const Piece& piece : surface.pieces) {
      for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t)
        tabulate(frame, tree, corners_of(piece, t), add);
    }
    if (communicator.size() == 1) return table;
    for (BlockIndex b = 0; b < tree.block_count(); ++b) {
      if (table.is_met(b)) rows.push_back({b, table.longest_edge[b], table.triangles[b], table.nearest[b]});
    }
    for (const BlockRow& row : rows) table.triangles[row.block] = 0;  // or they would count twice
  }
  rows = communicator.all_gather_items<BlockRow>(rows);
  for (const BlockRow& row : rows) add(row);
  return table;
}

std::vector<BlockIndex> share_blocks(const LatticeTree& tree, const SurfaceTable& table, int ranks) {
  const auto work = [&](BlockIndex b) {
    return leaf_work * tree.leaf_count(b) + triangle_work * table.triangles[b] +
           (table.is_met(b) ? met_work : 0);
  };
  double total = 0, sum = 0;
  for (BlockIndex b = 0; b < tree.block_count(); ++b) total += work(b);
  std::vector<BlockIndex> shares{0};
  for (BlockIndex b = 0; b < tree.block_count(); ++b) {
    while (static_cast<int>(shares.size()) < ranks &&
           sum >= total * static_cast<double>(shares.size()) / ranks)
      shares.push_back(b);
    sum += work(b);
  }
  shares.resize(ranks + 1, tree.block_count());
  return shares;
}

std::vector<SurfaceTriangle> deliver_surface(const parallel::Communicator& communicator,
                                             const LatticeFrame& frame, const LatticeTree& tree,
                                             const SurfaceTable& table, std::span<const BlockIndex> shares,
                                             const SurfaceReach& reach, const mesh::DistributedMesh& surface,
                                             const mesh::Numbering& numbering, parallel::StageClock& clock) {
  const Fringe fringe(communicator, tree, table, frame, shares, reach, clock);
  struct Parcel {
    SurfaceTriangle triangle;
    std::int64_t rank;

    static constexpr auto fields() { return std::tuple(&Parcel::triangle, &Parcel::rank); }
  };
  std::vector<Parcel> outgoing;
  std::vector<parallel::Rank> ranks;
  {
    const parallel::ScopedCpu task(clock, parallel::ScopedCpu::As::task);
    for (std::size_t p = 0; p < surface.pieces.size(); ++p) {
      const Piece& piece = surface.pieces[p];
      for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) {
        ranks.clear();
        if (communicator.size() == 1)
          ranks.push_back(0);
        else
          tree.for_each_block_in(grid_box(frame, corners_of(piece, t)), [&](BlockIndex b) {
            ranks.push_back(static_cast<parallel::Rank>(
                std::upper_bound(shares.begin(), shares.end() - 1, b) - shares.begin() - 1));
            fringe.for_each_rank(b, [&](parallel::Rank rank) { ranks.push_back(rank); });
          });
        std::sort(ranks.begin(), ranks.end());
        ranks.erase(std::unique(ranks.begin(), ranks.end()), ranks.end());
        for (const parallel::Rank rank : ranks)
          outgoing.push_back(
              {describe(piece, t, numbering.vertices[p], numbering.first_cell[p], surface), rank});
      }
    }
  }
  const std::vector<Parcel> arrived =
      mesh::deliver(communicator, std::move(outgoing), [](const Parcel& q) { return q.rank; });
  // Triangles are large: their numbers are sorted, and each triangle is moved once.
  struct Arrival {
    mesh::GlobalIndex number;
    std::size_t place;
  };
  std::vector<Arrival> order;
  order.reserve(arrived.size());
  for (const Parcel& parcel : arrived) order.push_back({parcel.triangle.number, order.size()});
  std::sort(order.begin(), order.end(),
            [](const Arrival& a, const Arrival& b) { return a.number < b.number; });
  std::vector<SurfaceTriangle> result;
  result.reserve(arrived.size());
  for (const Arrival& arrival : order) result.push_back(arrived[arrival.place].triangle);
  return result;
}

}  // namespace aeroloom::volume
