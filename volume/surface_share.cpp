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

std::array<Vec3, 3> corners_of(const Piece& piece, mesh::LocalIndex t) {
  const mesh::LocalIndex* v = piece.cell(t);
  return {piece.point(v[0]), piece.point(v[1]), piece.point(v[2])};
}

double longest_edge(const std::array<Vec3, 3>& p) {
  return std::max({distance(p[0], p[1]), distance(p[1], p[2]), distance(p[2], p[0])});
}

/// How far a triangle is from the middle of a block, in space, rounded up.
float distance_from_middle(const LatticeFrame& frame, const GridCube& block, const std::array<Vec3, 3>& p) {
  const GridBox box = GridBox::of(block);
  const Vec3 middle = frame.to_space(0.5 * (box.low + box.high));
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
  triangle.front = sides.front;
  triangle.back = sides.back;
  return triangle;
}

/// A triangle on its way.
struct Parcel {
  SurfaceTriangle triangle;
  parallel::Rank rank;

  static constexpr auto fields() { return std::tuple(&Parcel::triangle, &Parcel::rank); }
};

/// What arrives here, by number, each once, with those that are here. Collective.
std::vector<SurfaceTriangle> send(const parallel::Communicator& communicator, std::vector<Parcel> outgoing,
                                  const std::vector<SurfaceTriangle>& here) {
  const std::vector<Parcel> arrived =
      mesh::deliver(communicator, std::move(outgoing), [](const Parcel& q) { return q.rank; });
  // Triangles are large: pointers to them are sorted, and each is copied once.
  std::vector<const SurfaceTriangle*> order;
  order.reserve(here.size() + arrived.size());
  for (const SurfaceTriangle& triangle : here) order.push_back(&triangle);
  for (const Parcel& parcel : arrived) order.push_back(&parcel.triangle);
  std::sort(order.begin(), order.end(),
            [](const SurfaceTriangle* a, const SurfaceTriangle* b) { return a->number < b->number; });
  std::vector<SurfaceTriangle> result;
  result.reserve(order.size());
  for (const SurfaceTriangle* triangle : order) {
    if (result.empty() || result.back().number != triangle->number) result.push_back(*triangle);
  }
  return result;
}

/// A rank asks for what touches a box, or is less than the least reach away.
struct Question {
  GridBox box;
  double least, most;  ///< see BlockReach
  parallel::Rank to, from;

  static constexpr auto fields() {
    return std::tuple(&Question::box, &Question::least, &Question::most, &Question::to, &Question::from);
  }
};

/// Asks all other ranks that have blocks where `where` is.
void ask(const LatticeTree& tree, const GridBox& where, Question question, std::vector<Question>& questions) {
  std::vector<parallel::Rank> ranks;
  tree.for_each_rank_in(where, [&](parallel::Rank rank) { ranks.push_back(rank); });
  std::sort(ranks.begin(), ranks.end());
  ranks.erase(std::unique(ranks.begin(), ranks.end()), ranks.end());
  for (const parallel::Rank rank : ranks) {
    question.to = rank;
    if (rank != question.from) questions.push_back(question);
  }
}

/// Questions arrive rank by rank. Collective.
std::vector<Question> deliver(const parallel::Communicator& communicator, std::vector<Question> questions) {
  return mesh::deliver(communicator, std::move(questions), [](const Question& q) { return q.to; });
}

}  // namespace

GridBox grid_box(const LatticeFrame& frame, const std::array<Vec3, 3>& points) {
  geometry::Box box;
  for (const Vec3& p : points) box.add(frame.to_grid(p));
  return GridBox{box.low, box.high}.dilated(rounding);
}

std::vector<SurfaceTriangle> deliver_surface(const parallel::Communicator& communicator,
                                             const LatticeFrame& frame, const LatticeTree& tree,
                                             const mesh::DistributedMesh& surface,
                                             const mesh::Numbering& numbering, parallel::StageClock& clock) {
  std::vector<Parcel> outgoing;
  std::vector<parallel::Rank> ranks;
  {
    const parallel::ScopedCpu task(clock, parallel::ScopedCpu::As::task);
    for (std::size_t p = 0; p < surface.pieces.size(); ++p) {
      const Piece& piece = surface.pieces[p];
      for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) {
        ranks.clear();
        tree.for_each_rank_in(grid_box(frame, corners_of(piece, t)),
                              [&](parallel::Rank rank) { ranks.push_back(rank); });
        std::sort(ranks.begin(), ranks.end());
        ranks.erase(std::unique(ranks.begin(), ranks.end()), ranks.end());
        for (const parallel::Rank rank : ranks)
          outgoing.push_back(
              {describe(piece, t, numbering.vertices[p], numbering.first_cell[p], surface), rank});
      }
    }
  }
  return send(communicator, std::move(outgoing), {});
}

SurfaceTable tabulate_surface(const LatticeFrame& frame, const LatticeTree& tree,
                              std::span<const SurfaceTriangle> triangles) {
  SurfaceTable table;
  table.longest_edge.assign(tree.block_count(), 0);
  table.triangles.assign(tree.block_count(), 0);
  table.nearest.assign(tree.block_count(), std::numeric_limits<float>::infinity());
  for (const SurfaceTriangle& triangle : triangles) {
    const auto& p = triangle.points;
    const auto edge = static_cast<float>(longest_edge(p));
    const auto add = [&](BlockIndex b) {
      table.longest_edge[b] = std::max(table.longest_edge[b], edge);
      table.nearest[b] = std::min(table.nearest[b], distance_from_middle(frame, tree.cube(b), p));
    };
    const BlockIndex middle = tree.any_at(frame.cell_at(frame.to_grid((1.0 / 3.0) * (p[0] + p[1] + p[2]))));
    if (tree.is_own(middle)) {
      ++table.triangles[middle];
      add(middle);
    }
    tree.for_each_own_block_in(grid_box(frame, p), [&](BlockIndex b) {
      if (b != middle) add(b);
    });
  }
  return table;
}

void look_around(const parallel::Communicator& communicator, LatticeTree& tree, SurfaceTable& table,
                 std::span<const GridBox> boxes, parallel::StageClock& clock) {
  if (communicator.size() == 1) return;
  struct Row {
    KnownBlock block;
    float longest_edge;
    parallel::Rank to;
    static constexpr auto fields() { return std::tuple(&Row::block, &Row::longest_edge, &Row::to); }
  };
  const parallel::ScopedCpu task(clock, parallel::ScopedCpu::As::task);
  std::vector<Question> questions;
  for (const GridBox& box : boxes) {
    if (!tree.is_within_own(box)) ask(tree, box, {box, 0, 0, 0, communicator.rank()}, questions);
  }
  std::vector<parallel::Rank> told(tree.last() - tree.first(), -1);
  std::vector<Row> rows;
  for (const Question& question : deliver(communicator, std::move(questions))) {
    tree.for_each_own_block_in(question.box, [&](BlockIndex b) {
      if (std::exchange(told[b - tree.first()], question.from) != question.from)
        rows.push_back({tree.known(b), table.longest_edge[b], question.from});
    });
  }
  rows = mesh::deliver(communicator, std::move(rows), [](const Row& row) { return row.to; });
  for (BlockIndex b = 0; b < tree.block_count(); ++b) {
    if (tree.is_known(b)) rows.push_back({tree.known(b), table.longest_edge[b], 0});
  }
  const BlockIndex first = tree.first(), last = tree.last();
  std::vector<KnownBlock> blocks;
  blocks.reserve(rows.size());
  for (const Row& row : rows) blocks.push_back(row.block);
  tree.learn(std::move(blocks));
  table.longest_edge.assign(tree.block_count(), 0);
  for (const Row& row : rows) table.longest_edge[tree.index(row.block.number)] = row.longest_edge;
  const auto move = [&](auto& values) {
    auto moved = std::decay_t<decltype(values)>(tree.block_count(), values.empty() ? 0 : values[0]);
    std::copy(values.begin() + first, values.begin() + last, moved.begin() + tree.first());
    values = std::move(moved);
  };
  move(table.triangles);
  move(table.nearest);
}

std::vector<SurfaceTriangle> add_those_near(const parallel::Communicator& communicator,
                                            const LatticeFrame& frame, const LatticeTree& tree,
                                            const SurfaceReach& reach, std::vector<SurfaceTriangle> own,
                                            parallel::StageClock& clock) {
  if (communicator.size() == 1) return own;
  const parallel::ScopedCpu task(clock, parallel::ScopedCpu::As::task);
  std::vector<Question> questions;
  for (BlockIndex b = tree.first(); b < tree.last(); ++b) {
    const BlockReach& of_block = reach.of_blocks[b - tree.first()];
    const double least = std::max(of_block.least, of_block.nearest), most = std::max(of_block.most, least);
    const GridBox box = GridBox::of(tree.cube(b)), around = box.dilated(most);
    if (!tree.is_within_own(around)) ask(tree, around, {box, least, most, 0, communicator.rank()}, questions);
  }
  questions = deliver(communicator, std::move(questions));
  std::vector<Parcel> outgoing;
  for (auto first = questions.begin(), last = first; first != questions.end(); first = last) {
    NearBoxes of_all, of_large;  // triangles
    for (; last != questions.end() && last->from == first->from; ++last) {
      of_all.add(last->box.dilated(last->least));
      of_large.add(last->box.dilated(last->most));
    }
    of_all.build();
    of_large.build();
    for (const SurfaceTriangle& triangle : own) {
      const GridBox box = grid_box(frame, triangle.points);
      if (of_large.any_within(box, 0) &&
          of_all.any_within(box, reach.per_edge * longest_edge(triangle.points)))
        outgoing.push_back({triangle, first->from});
    }
  }
  return send(communicator, std::move(outgoing), own);
}

}  // namespace aeroloom::volume
