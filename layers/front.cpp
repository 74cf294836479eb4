#include "layers/front.hpp"

#include "aeroloom/mesh/delivery.hpp"
#include "layers/good_columns.hpp"
#include "mesh/intersection.hpp"

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

namespace aeroloom::layers {
namespace {

/// Rounds in which counts fall by a third; in those after them columns are emptied. Chosen, not measured:
/// from 79 layers it takes ten to zero.
constexpr int rounds_of_thirds = 10;

std::int32_t lowered(std::int32_t count, int round) {
  return round <= rounds_of_thirds ? 2 * count / 3 : 0;
}

/// Counts that the columns of triangles of this rank fall to, if any.
class LoweredCounts {
public:
  LoweredCounts(const WallShare& wall, const ColumnLimits& limits, int round)
      : _wall(wall), _limits(limits), _round(round), _counts(wall.points.size(), unchanged) {}

  void add(mesh::PieceId piece, mesh::LocalIndex cell) {
    const auto& pieces = _wall.mesh.pieces;
    const std::size_t p = mesh::position_of(_wall.mesh, piece);
    if (p == pieces.size() || pieces[p].id != piece) return;
    for (const std::int32_t v : _wall.triangles[_wall.first_triangle[p] + cell]) {
      if (_limits.count(v) == 0) continue;
      if (_counts[v] == unchanged) ++_lowered;
      _counts[v] = lowered(_limits.count(v), _round);
    }
  }
  std::int64_t lowered_here() const { return _lowered; }
  std::vector<std::int32_t> take() { return std::move(_counts); }

private:
  static constexpr std::int32_t unchanged = std::numeric_limits<std::int32_t>::max();

  const WallShare& _wall;
  const ColumnLimits& _limits;
  int _round;
  std::vector<std::int32_t> _counts;
  std::int64_t _lowered = 0;
};

}  // namespace

Columns make_columns(const WallShare& wall, const Directions& directions, const ColumnLimits& limits) {
  Columns columns;
  for (std::size_t p = 0; p < wall.mesh.pieces.size(); ++p) {
    PieceColumns& of_piece = columns.pieces.emplace_back();
    for (std::int32_t v = wall.first_vertex[p]; v < wall.first_vertex[p + 1]; ++v) {
      const Heights heights = limits.heights(v);
      of_piece.directions.push_back(directions.smoothed[v]);
      of_piece.counts.push_back(limits.count(v));
      of_piece.constant.push_back(heights.constant);
      of_piece.first.push_back(heights.first);
      of_piece.growth.push_back(heights.growth);
    }
  }
  return columns;
}

mesh::DistributedMesh make_front(const mesh::DistributedMesh& wall, const Columns& columns) {
  mesh::DistributedMesh front = wall;
  for (std::size_t p = 0; p < front.pieces.size(); ++p) {
    mesh::Piece& piece = front.pieces[p];
    const PieceColumns& of_piece = columns.pieces[p];
    for (mesh::LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      if (of_piece.counts[v] == 0) continue;
      piece.set_point(v, node(wall.pieces[p], of_piece, v, of_piece.counts[v]));
      if (piece.vertex_dimension.empty()) continue;
      piece.vertex_dimension[v] = mesh::CadDimension::region;
      piece.vertex_entity[v] = -1;
    }
  }
  return front;
}

void shrink_to_clear(const parallel::Communicator& communicator, const WallShare& wall,
                     const Directions& directions, ColumnLimits& limits, LayerReport& report,
                     parallel::StageClock& clock) {
  for (int round = 1;; ++round) {
    const mesh::DistributedMesh front = make_front(wall.mesh, make_columns(wall, directions, limits));
    const std::vector<mesh::TriangleHit> hits = mesh::find_intersections(communicator, front, clock);
    LoweredCounts lower(wall, limits, round);
    for (const mesh::TriangleHit& hit : hits) {
      lower.add(hit.first_piece, hit.first);
      lower.add(hit.second_piece, hit.second);
    }
    const std::int64_t lowered = communicator.sum(lower.lowered_here());
    if (lowered == 0) return;
    report.crossing_rounds = round;
    report.crossings += static_cast<std::int64_t>(hits.size());
    if (round > rounds_of_thirds) report.zeroed_by_force += lowered;
    limits.limit_counts(lower.take(), LayerLimit::crossing);
    limits.converge(communicator);
    report.validity_rounds += shrink_to_good(communicator, wall, directions, limits);
  }
}

}  // namespace aeroloom::layers
