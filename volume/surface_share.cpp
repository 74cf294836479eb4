#include "volume/surface_share.hpp"

#include "mesh/delivery.hpp"
#include "volume/near_boxes.hpp"

#include <algorithm>
#include <numeric>
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
};

/// Rows of the same block become one.
void unite_rows(std::vector<BlockRow>& rows) {
  std::sort(rows.begin(), rows.end(), [](const BlockRow& a, const BlockRow& b) { return a.block < b.block; });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (kept > 0 && rows[kept - 1].block == rows[i].block) {
      BlockRow& row = rows[kept - 1];
      row.longest_edge = std::max(row.longest_edge, rows[i].longest_edge);
      row.triangles += rows[i].triangles;
    } else {
      rows[kept++] = rows[i];
    }
  }
  rows.resize(kept);
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

/// Which ranks want what meets a block, beside the one that has the block.
class Fringe {
public:
  Fringe(const parallel::Communicator& communicator, const LatticeTree& tree, const SurfaceTable& table,
         std::span<const BlockIndex> shares, std::span<const double> reach, parallel::StageClock& clock) {
    if (communicator.size() == 1) return;
    std::vector<Want> mine = list_wants(communicator.rank(), tree, table, shares, reach, clock);
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
  struct Want {
    BlockIndex block;
    parallel::Rank rank;
  };

  static std::vector<Want> list_wants(parallel::Rank rank, const LatticeTree& tree, const SurfaceTable& table,
                                      std::span<const BlockIndex> shares, std::span<const double> reach,
                                      parallel::StageClock& clock) {
    const parallel::ScopedCpu task(clock, parallel::ScopedCpu::As::task);
    const BlockIndex first = shares[rank], last = shares[rank + 1];
    NearBoxes within_reach;
    for (BlockIndex b = first; b < last; ++b) {
      const GridBox box = GridBox::of(tree.cube(b)).dilated(reach[b - first]);
      const auto [lowest, highest] = tree.range_of(box);
      if (lowest < first || highest >= last) within_reach.add(box);
    }
    within_reach.build();
    std::vector<Want> wants;
    for (BlockIndex n = 0; n < tree.block_count(); ++n) {
      const bool is_own = n >= first && n < last;
      if (!is_own && table.is_met(n) && within_reach.any_within(GridBox::of(tree.cube(n)), 0))
        wants.push_back({n, rank});
    }
    return wants;
  }

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
  std::vector<BlockRow> rows;
  {
    const parallel::ScopedCpu task(clock, parallel::ScopedCpu::As::task);
    for (const Piece& piece : surface.pieces) {
      for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) {
        const std::array<Vec3, 3> p = corners_of(piece, t);
        const auto edge = static_cast<float>(longest_edge(p));
        tree.for_each_block_in(grid_box(frame, p), [&](BlockIndex b) { rows.push_back({b, edge, 0}); });
        const Vec3 center = frame.to_grid((1.0 / 3.0) * (p[0] + p[1] + p[2]));
        rows.push_back({tree.block_at(frame.cell_at(center)), edge, 1});
      }
    }
    unite_rows(rows);
  }
  rows = communicator.all_gather_items<BlockRow>(rows);
  SurfaceTable table;
  table.longest_edge.assign(tree.block_count(), 0);
  table.triangles.assign(tree.block_count(), 0);
  for (const BlockRow& row : rows) {
    table.longest_edge[row.block] = std::max(table.longest_edge[row.block], row.longest_edge);
    table.triangles[row.block] += row.triangles;
  }
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
                                             std::span<const double> reach,
                                             const mesh::DistributedMesh& surface,
                                             const mesh::Numbering& numbering, parallel::StageClock& clock) {
  const Fringe fringe(communicator, tree, table, shares, reach, clock);
  struct Parcel {
    SurfaceTriangle triangle;
    std::int64_t rank;
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
  std::vector<SurfaceTriangle> result;
  for (const Parcel& parcel :
       mesh::deliver(communicator, std::move(outgoing), [](const Parcel& q) { return q.rank; }))
    result.push_back(parcel.triangle);
  std::sort(result.begin(), result.end(),
            [](const SurfaceTriangle& a, const SurfaceTriangle& b) { return a.number < b.number; });
  return result;
}

TrianglesOfBlocks::TrianglesOfBlocks(const LatticeFrame& frame, const LatticeTree& tree, BlockIndex first,
                                     BlockIndex last, std::span<const SurfaceTriangle> triangles)
    : _first(first), _starts(last - first + 1, 0) {
  struct Meeting {
    BlockIndex block;
    std::int32_t triangle;
  };
  std::vector<Meeting> meetings;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    tree.for_each_block_in(grid_box(frame, triangles[t].points), [&](BlockIndex b) {
      if (b < first || b >= last) return;
      meetings.push_back({b, static_cast<std::int32_t>(t)});
      ++_starts[b - first + 1];
    });
  }
  std::partial_sum(_starts.begin(), _starts.end(), _starts.begin());
  _triangles.resize(meetings.size());
  std::vector<std::size_t> next(_starts.begin(), _starts.end() - 1);
  for (const Meeting& meeting : meetings) _triangles[next[meeting.block - first]++] = meeting.triangle;
}

}  // namespace aeroloom::volume
