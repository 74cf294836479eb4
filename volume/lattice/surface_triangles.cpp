#include "volume/lattice/surface_triangles.hpp"

#include "geometry/sort_unique.hpp"
#include "mesh/exchange/delivery.hpp"
#include "parallel/observation/timers.hpp"
#include "volume/lattice/boundary_distance.hpp"
#include "volume/lattice/fetch_ghosts.hpp"
#include "volume/lattice/grid_box_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace aeroloom::volume {

using geometry::Vec3;
using mesh::Piece;

namespace {

/// Rounding of grid coordinates is far below this, in finest cells.
constexpr double rounding = 1e-3;

std::array<Vec3, 3> corners_of(const Piece& piece, mesh::LocalIndex t) {
  const mesh::LocalIndex* v = piece.cell(t);
  return {piece.point(v[0]), piece.point(v[1]), piece.point(v[2])};
}

double longest_edge(const std::array<Vec3, 3>& p) {
  return std::max({distance(p[0], p[1]), distance(p[1], p[2]), distance(p[2], p[0])});
}

/// The distance in space from the middle of a block to a triangle, rounded up.
float distance_from_middle(const LatticeFrame& frame, const GridCube& block, const std::array<Vec3, 3>& p) {
  const Vec3 middle = frame.middle_of(block);
  const double distance = std::sqrt(BoundaryDistance::squared_distance(middle, {p[0], p[1], p[2]}).squared);
  return std::nextafter(static_cast<float>(distance), std::numeric_limits<float>::infinity());
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
  triangle.inside = sides.front;
  triangle.outside = sides.back;
  return triangle;
}

/// A triangle and the rank that it is sent to.
struct Parcel {
  SurfaceTriangle triangle;
  parallel::Rank rank;
};

/// Sends triangles. Returns those that arrive and those of `here`, by number, each once. Collective.
std::vector<SurfaceTriangle> send(const LatticeTree& tree, std::vector<Parcel> outgoing,
                                  const std::vector<SurfaceTriangle>& here) {
  const std::vector<Parcel> arrived =
      mesh::deliver(tree.communicator(), std::move(outgoing), [](const Parcel& q) { return q.rank; });
  // Triangles are large: pointers to them are sorted, and each is copied once.
  std::vector<const SurfaceTriangle*> order;
  order.reserve(here.size() + arrived.size());
  for (const SurfaceTriangle& triangle : here) order.push_back(&triangle);
  for (const Parcel& parcel : arrived) order.push_back(&parcel.triangle);
  const auto by_number = [](const SurfaceTriangle* a, const SurfaceTriangle* b) {
    return a->number < b->number;
  };
  const auto middle = order.begin() + static_cast<std::ptrdiff_t>(here.size());
  std::sort(middle, order.end(), by_number);
  std::inplace_merge(order.begin(), middle, order.end(), by_number);
  std::vector<SurfaceTriangle> result;
  result.reserve(order.size());
  for (const SurfaceTriangle* triangle : order) {
    if (result.empty() || result.back().number != triangle->number) result.push_back(*triangle);
  }
  return result;
}

}  // namespace

GridBox grid_box(const LatticeFrame& frame, const std::array<Vec3, 3>& points) {
  geometry::Box box;
  for (const Vec3& p : points) box.add(frame.to_grid(p));
  return GridBox{box.low, box.high}.dilated(rounding);
}

std::vector<SurfaceTriangle> deliver_surface(const LatticeFrame& frame, const LatticeTree& tree,
                                             const mesh::NumberedMesh& surface) {
  std::vector<Parcel> outgoing;
  std::vector<parallel::Rank> ranks;
  {
    const parallel::ScopedCpu task(parallel::ScopedCpu::As::task);
    for (std::size_t p = 0; p < surface.pieces.size(); ++p) {
      const Piece& piece = surface.pieces[p];
      for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) {
        ranks.clear();
        tree.for_each_rank_in(grid_box(frame, corners_of(piece, t)),
                              [&](parallel::Rank rank) { ranks.push_back(rank); });
        geometry::sort_unique(ranks);
        for (const parallel::Rank rank : ranks)
          outgoing.push_back(
              {describe(piece, t, surface.numbering.vertices[p], surface.numbering.first_cell[p], surface),
               rank});
      }
    }
  }
  return send(tree, std::move(outgoing), {});
}

void SurfaceTable::note_levels_met(const LatticeTree& tree) {
  std::vector<std::uint8_t> levels(longest_edge.size(), 0);
  for (BlockIndex b = 0; b < tree.block_count(); ++b) {
    if (is_met(b)) levels[b] = static_cast<std::uint8_t>(tree.level(b) + 1);
  }
  levels_met = RangeMaximum(std::move(levels));
}

SurfaceTable tabulate_surface(const LatticeFrame& frame, const LatticeTree& tree,
                              std::span<const SurfaceTriangle> triangles) {
  SurfaceTable table;
  table.longest_edge.assign(tree.block_count(), 0);
  table.triangles.assign(tree.last() - tree.first(), 0);
  table.nearest.assign(table.triangles.size(), std::numeric_limits<float>::infinity());
  for (const SurfaceTriangle& triangle : triangles) {
    const auto& p = triangle.points;
    const auto edge = static_cast<float>(longest_edge(p));
    const auto add = [&](BlockIndex b) {
      table.longest_edge[b] = std::max(table.longest_edge[b], edge);
      float& nearest = table.nearest[b - tree.first()];
      nearest = std::min(nearest, distance_from_middle(frame, tree.cube(b), p));
    };
    const BlockIndex middle = tree.any_at(frame.cell_at(frame.to_grid((1.0 / 3.0) * (p[0] + p[1] + p[2]))));
    if (tree.is_own(middle)) {
      ++table.triangles[middle - tree.first()];
      add(middle);
    }
    tree.for_each_own_block_in(grid_box(frame, p), [&](BlockIndex b) {
      if (b != middle) add(b);
    });
  }
  table.note_levels_met(tree);
  return table;
}

std::vector<SurfaceTriangle> add_ghost_triangles(const LatticeFrame& frame, const LatticeTree& tree,
                                                 const SearchRadii& radii, std::vector<SurfaceTriangle> own) {
  if (tree.communicator().size() == 1) return own;
  const parallel::ScopedCpu task(parallel::ScopedCpu::As::task);
  BlockQueries queries(tree);
  for (BlockIndex b = tree.first(); b < tree.last(); ++b) {
    const BlockSearchRadii& of_block = radii.of_blocks[b - tree.first()];
    const double least = std::max(of_block.least, of_block.nearest), most = std::max(of_block.most, least);
    const GridBox box = GridBox::of(tree.cube(b));
    queries.add(box.dilated(most), {box, least, most});
  }
  std::vector<Parcel> outgoing;
  constexpr std::size_t batch = 32;  // triangles, near each other; chosen, not measured
  queries.exchange([&](std::span<const BlockQuery> of_rank) {
    GridBoxTree of_all, of_large;  // triangles
    for (const BlockQuery& query : of_rank) {
      of_all.add(query.box.dilated(query.least));
      of_large.add(query.box.dilated(query.most));
    }
    of_all.build();
    of_large.build();
    for (std::size_t first = 0; first < own.size(); first += batch) {
      const auto some = std::span(own).subspan(first, std::min(batch, own.size() - first));
      geometry::Box around;
      double longest = 0;
      for (const SurfaceTriangle& triangle : some) {
        for (const Vec3& p : triangle.points) around.add(frame.to_grid(p));
        longest = std::max(longest, longest_edge(triangle.points));
      }
      const GridBox whole = GridBox{around.low, around.high}.dilated(rounding);
      if (!of_large.any_within(whole, 0) || !of_all.any_within(whole, radii.per_edge * longest)) continue;
      for (const SurfaceTriangle& triangle : some) {
        const GridBox box = grid_box(frame, triangle.points);
        if (of_large.any_within(box, 0) &&
            of_all.any_within(box, radii.per_edge * longest_edge(triangle.points)))
          outgoing.push_back({triangle, of_rank.front().from});
      }
    }
  });
  return send(tree, std::move(outgoing), own);
}

}  // namespace aeroloom::volume
