#include "mesh/checks/intersection.hpp"

#include "geometry/box_tree.hpp"
#include "geometry/runs.hpp"

#include <algorithm>
#include <compare>
#include <map>
#include <span>
#include <stdexcept>
#include <tuple>

namespace aeroloom::mesh {
namespace {

using geometry::Box;
using geometry::Vec3;

/// Triangles whose box travels as one: tables of boxes stay short, and few triangles travel in vain. Chosen,
/// not measured.
constexpr int batch_triangles = 256;
constexpr int boxes_per_leaf = 4;  // chosen, not measured

/// A spatially compact part of a piece; the table of all batches is known to every rank, by piece, then by
/// order in the piece.
struct Batch {
  Box box;
  PieceId piece;
  std::int32_t order;
  parallel::Rank rank;
};

struct BatchTriangle {
  NamedTriangle corners;
  Box box;
  LocalIndex cell;
};

using Triangles = std::vector<BatchTriangle>;

/// A triangle on its way: its box follows from its corners.
struct SentTriangle {
  NamedTriangle corners;
  LocalIndex cell;
};

/// Two batches, lower first, tested on one rank.
struct BatchPair {
  std::int32_t lower, upper;
};

Box box_of(const NamedTriangle& triangle) {
  Box box;
  for (const Vec3& point : triangle.points) box.add(point);
  return box;
}

Triangles name_triangles(const Piece& piece) {
  const std::vector<VertexName> names = name_vertices(piece);
  Triangles triangles(piece.cell_count());
  for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
    triangles[t].cell = t;
    for (int i = 0; i < 3; ++i) {
      const LocalIndex v = piece.cell(t)[i];
      triangles[t].corners.points[i] = piece.point(v);
      triangles[t].corners.names[i] = names[v];
    }
    triangles[t].box = box_of(triangles[t].corners);
  }
  return triangles;
}

/// The batches of this rank's pieces and their triangles.
void cut_into_batches(const DistributedMesh& surface, parallel::Rank rank, std::vector<Batch>& batches,
                      std::vector<Triangles>& contents) {
  if (surface.kind != CellKind::triangle)
    throw std::logic_error("find_intersections: the mesh is no surface");
  for (const Piece& piece : surface.pieces) {
    const Triangles triangles = name_triangles(piece);
    std::vector<Box> boxes;
    boxes.reserve(triangles.size());
    for (const BatchTriangle& t : triangles) boxes.push_back(t.box);
    const geometry::BoxTree tree(boxes, batch_triangles);
    std::int32_t order = 0;
    for (const auto leaf : tree.leaves()) {
      Batch& batch = batches.emplace_back(Batch{{}, piece.id, order++, rank});
      Triangles& content = contents.emplace_back();
      for (const std::int32_t t : leaf) {
        content.push_back(triangles[t]);
        batch.box.add(triangles[t].box);
      }
    }
  }
}

/// The rank that tests a pair: the owner of the far smaller batch, or either owner in turn. A batch of the
/// far field has all of a body in its box, but hardly a triangle in the box of a batch there.
parallel::Rank tester(const std::vector<Batch>& table, BatchPair pair) {
  constexpr double far_smaller = 0.25;  // of the other's box; chosen, not measured
  const double lower = table[pair.lower].box.diagonal(), upper = table[pair.upper].box.diagonal();
  if (lower < far_smaller * upper) return table[pair.lower].rank;
  if (upper < far_smaller * lower) return table[pair.upper].rank;
  return table[(pair.lower + pair.upper) % 2 == 0 ? pair.lower : pair.upper].rank;
}

/// Pairs of overlapping batches in which this rank has a part, ascending.
std::vector<BatchPair> find_batch_pairs(const std::vector<Batch>& table, parallel::Rank rank) {
  std::vector<Box> boxes;
  boxes.reserve(table.size());
  for (const Batch& batch : table) boxes.push_back(batch.box);
  const geometry::BoxTree tree(boxes, boxes_per_leaf);
  std::vector<BatchPair> pairs;
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(table.size()); ++i) {
    if (table[i].rank != rank) continue;
    geometry::for_each_overlap(tree, boxes, boxes[i], [&](std::int32_t j) {
      if (table[j].rank != rank || i <= j) pairs.push_back({std::min(i, j), std::max(i, j)});
    });
  }
  std::sort(pairs.begin(), pairs.end(),
            [](BatchPair a, BatchPair b) { return std::tie(a.lower, a.upper) < std::tie(b.lower, b.upper); });
  return pairs;
}

/// A batch of this rank that another one tests with one of its own.
struct Claim {
  parallel::Rank rank;
  std::int32_t mine, theirs;

  friend auto operator<=>(const Claim&, const Claim&) = default;
};

/// Pairs of batches that other ranks test, ascending.
std::vector<Claim> find_claims(const std::vector<Batch>& table, const std::vector<BatchPair>& pairs,
                               parallel::Rank self) {
  std::vector<Claim> claims;
  for (const BatchPair pair : pairs) {
    const parallel::Rank rank = tester(table, pair);
    if (rank == self) continue;
    const bool lower_is_mine = table[pair.lower].rank == self;
    claims.push_back(
        {rank, lower_is_mine ? pair.lower : pair.upper, lower_is_mine ? pair.upper : pair.lower});
  }
  std::sort(claims.begin(), claims.end());
  return claims;
}

/// Triangles of a batch whose boxes overlap one of the batches of its claims: no others can meet their
/// triangles.
std::vector<SentTriangle> near_claims(const Triangles& triangles, std::span<const Claim> claims,
                                      const std::vector<Batch>& table) {
  std::vector<SentTriangle> near;
  for (const BatchTriangle& t : triangles) {
    const auto overlaps = [&](const Claim& claim) { return t.box.overlaps(table[claim.theirs].box); };
    if (std::any_of(claims.begin(), claims.end(), overlaps)) near.push_back({t.corners, t.cell});
  }
  return near;
}

/// All batches this rank needs for the pairs it tests, by number in the table: its own, and of those of
/// others the triangles near its own.
std::map<std::int32_t, Triangles> fetch_batches(const parallel::Communicator& communicator,
                                                const std::vector<Batch>& table,
                                                const std::vector<BatchPair>& pairs,
                                                std::vector<Triangles> contents) {
  std::map<std::int32_t, Triangles> at_hand;
  std::size_t mine = 0;
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(table.size()); ++i) {
    if (table[i].rank == communicator.rank()) at_hand[i] = std::move(contents[mine++]);
  }
  const std::vector<Claim> claims = find_claims(table, pairs, communicator.rank());
  std::map<parallel::Rank, parallel::Packer> packers;
  geometry::for_each_run(
      std::span<const Claim>(claims),
      [](const Claim& a, const Claim& b) { return a.rank == b.rank && a.mine == b.mine; },
      [&](std::size_t first, std::size_t last) {
        const std::int32_t batch = claims[first].mine;
        const std::span<const Claim> of_batch(claims.data() + first, last - first);
        const std::vector<SentTriangle> near = near_claims(at_hand[batch], of_batch, table);
        parallel::pack(packers[claims[first].rank], std::tie(batch, near));
      });
  std::vector<parallel::Parcel> parcels;
  parcels.reserve(packers.size());
  for (auto& [rank, packer] : packers) parcels.push_back({rank, packer.take()});
  for (const parallel::Parcel& parcel : communicator.exchange(std::move(parcels))) {
    parallel::Unpacker unpacker(parcel.content);
    while (!unpacker.at_end()) {
      Triangles& triangles = at_hand[parallel::unpack<std::int32_t>(unpacker)];
      const auto sent = parallel::unpack<std::vector<SentTriangle>>(unpacker);
      triangles.reserve(triangles.size() + sent.size());
      for (const SentTriangle& t : sent) triangles.push_back({t.corners, box_of(t.corners), t.cell});
    }
  }
  return at_hand;
}

double shortest_side(const NamedTriangle& t) {
  return std::min({distance(t.points[0], t.points[1]), distance(t.points[1], t.points[2]),
                   distance(t.points[2], t.points[0])});
}

double area(const NamedTriangle& t) {
  return 0.5 * norm(cross(t.points[1] - t.points[0], t.points[2] - t.points[0]));
}

TriangleHit make_hit(PieceId piece_a, const BatchTriangle& a, PieceId piece_b, const BatchTriangle& b) {
  const auto& [p, q, r] = a.corners.points;
  if (std::tie(piece_b, b.cell) < std::tie(piece_a, a.cell)) return make_hit(piece_b, b, piece_a, a);
  const double shortest = std::min(shortest_side(a.corners), shortest_side(b.corners));
  return {piece_a, piece_b, a.cell, b.cell, (p + q + r) / 3.0, shortest, area(a.corners), area(b.corners)};
}

/// The triangles that overlap a box, by their low end along an axis.
void select_triangles(const Triangles& triangles, const Box& box, int axis,
                      std::vector<const BatchTriangle*>& selected) {
  selected.clear();
  for (const BatchTriangle& t : triangles) {
    if (t.box.overlaps(box)) selected.push_back(&t);
  }
  std::sort(selected.begin(), selected.end(), [axis](const BatchTriangle* a, const BatchTriangle* b) {
    const double left = a->box.low[axis], right = b->box.low[axis];
    return left != right ? left < right : a->cell < b->cell;
  });
}

/// Tests the triangles of two batches (or of one with itself) against each other.
class BatchTest {
public:
  explicit BatchTest(const std::vector<Batch>& table) : _table(table) {}

  void run(BatchPair pair, const Triangles& lower, const Triangles& upper, std::vector<TriangleHit>& hits) {
    const Box &a = _table[pair.lower].box, &b = _table[pair.upper].box;
    const Box common{
        {std::max(a.low.x, b.low.x), std::max(a.low.y, b.low.y), std::max(a.low.z, b.low.z)},
        {std::min(a.high.x, b.high.x), std::min(a.high.y, b.high.y), std::min(a.high.z, b.high.z)}};
    const Vec3 size = common.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    select_triangles(lower, common, axis, _lower);
    if (pair.lower == pair.upper) {
      sweep(_lower, 0, _lower, pair, axis, hits);
      return;
    }
    select_triangles(upper, common, axis, _upper);
    sweep(_lower, 1, _upper, pair, axis, hits);
    sweep(_upper, 2, _lower, {pair.upper, pair.lower}, axis, hits);
  }

private:
  using Selection = std::vector<const BatchTriangle*>;

  // Meets each triangle with those of `others` that begin within its extent: after it in its own list (part
  // 0), not before it (part 1), strictly after it (part 2), so that the parts 1 and 2 of two lists find each
  // pair once.
  void sweep(const Selection& list, int part, const Selection& others, BatchPair pair, int axis,
             std::vector<TriangleHit>& hits) const {
    std::size_t first = 0;
    for (std::size_t i = 0; i < list.size(); ++i) {
      const BatchTriangle& t = *list[i];
      const double low = t.box.low[axis], high = t.box.high[axis];
      const auto is_before = [&](const BatchTriangle& o) {
        return part == 2 ? o.box.low[axis] <= low : o.box.low[axis] < low;
      };
      if (part == 0) {
        first = i + 1;
      } else {
        while (first < others.size() && is_before(*others[first])) ++first;
      }
      for (std::size_t j = first; j < others.size() && others[j]->box.low[axis] <= high; ++j) {
        const BatchTriangle& o = *others[j];
        if (!t.box.overlaps(o.box) || !meet_wrongly(t.corners, o.corners)) continue;
        hits.push_back(make_hit(_table[pair.lower].piece, t, _table[pair.upper].piece, o));
      }
    }
  }

  const std::vector<Batch>& _table;
  Selection _lower, _upper;
};

}  // namespace

std::vector<VertexName> name_vertices(const Piece& piece) {
  std::vector<VertexName> names(piece.vertex_count());
  for (std::size_t v = 0; v < names.size(); ++v) names[v] = {piece.id, v};
  for (std::size_t s = 0; s < piece.shared_vertices.size(); ++s) {
    names[piece.shared_vertices[s]] = {-1, piece.shared_keys[s]};
  }
  return names;
}

std::vector<TriangleHit> find_intersections(const DistributedMesh& surface) {
  const parallel::Communicator& communicator = surface.communicator;
  using parallel::ScopedCpu;
  std::vector<Batch> batches;
  std::vector<Triangles> contents;
  parallel::collectively(communicator, ScopedCpu::As::task,
                         [&] { cut_into_batches(surface, communicator.rank(), batches, contents); });
  std::vector<Batch> table =
      communicator.gather_sorted(batches, [](const Batch& each) { return std::tie(each.piece, each.order); });
  const std::vector<BatchPair> pairs = [&] {
    const ScopedCpu cpu(ScopedCpu::As::repeated);
    return find_batch_pairs(table, communicator.rank());
  }();
  const auto at_hand = fetch_batches(communicator, table, pairs, std::move(contents));

  std::vector<TriangleHit> hits;
  {
    const ScopedCpu cpu(ScopedCpu::As::task);
    BatchTest test(table);
    for (const BatchPair pair : pairs) {
      if (tester(table, pair) == communicator.rank())
        test.run(pair, at_hand.at(pair.lower), at_hand.at(pair.upper), hits);
    }
  }
  hits = communicator.gather_sorted(hits, [](const TriangleHit& each) {
    return std::tie(each.first_piece, each.first, each.second_piece, each.second);
  });
  return hits;
}

}  // namespace aeroloom::mesh
