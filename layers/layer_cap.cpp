#include "layers/layer_cap.hpp"

#include "layers/enclosed_parts.hpp"
#include "layers/good_columns.hpp"
#include "mesh/checks/intersection.hpp"
#include "mesh/exchange/delivery.hpp"
#include "parallel/communication/collective_error.hpp"

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

}  // namespace

Columns make_columns(const LocalWall& wall, const Directions& directions, const ColumnLimits& limits) {
  Columns columns;
  for (std::size_t p = 0; p < wall.mesh.pieces.size(); ++p) {
    PieceColumns& of_piece = columns.pieces.emplace_back();
    for (std::int32_t v = wall.first_vertex[p]; v < wall.first_vertex[p + 1]; ++v) {
      const Heights heights = limits.heights(v);
      of_piece.directions.push_back(directions.smoothed[v]);
      of_piece.counts.push_back(limits.count(v));
      of_piece.constant.push_back(heights.constant);
      of_piece.regular.push_back(heights.regular);
      of_piece.first.push_back(heights.first);
      of_piece.growth.push_back(heights.growth);
      of_piece.stretch.push_back(heights.stretch);
    }
  }
  return columns;
}

mesh::DistributedMesh make_cap(const mesh::DistributedMesh& wall, const Columns& columns) {
  mesh::DistributedMesh cap = wall;
  for (std::size_t p = 0; p < cap.pieces.size(); ++p) {
    mesh::Piece& piece = cap.pieces[p];
    const PieceColumns& of_piece = columns.pieces[p];
    for (mesh::LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      if (of_piece.counts[v] > 0) piece.set_point(v, node(wall.pieces[p], of_piece, v, of_piece.counts[v]));
    }
  }
  return cap;
}

/// Counts that columns of this rank fall to, if any.
class CapClearing::LoweredCounts {
public:
  LoweredCounts(const LocalWall& wall, const ColumnLimits& limits, int round)
      : _wall(wall), _limits(limits), _round(round), _counts(wall.points.size(), unchanged) {}

  void add(std::int32_t v) {
    if (_limits.count(v) == 0) return;
    if (_counts[v] == unchanged) ++_lowered;
    _counts[v] = lowered(_limits.count(v), _round);
  }
  void add_triangle(std::int32_t triangle) {
    for (const std::int32_t v : _wall.triangles[triangle]) add(v);
  }
  /// The columns over a triangle of the wall, if its piece is here.
  void add(mesh::PieceId piece, mesh::LocalIndex cell) {
    const auto& pieces = _wall.mesh.pieces;
    const std::size_t p = mesh::position_of(_wall.mesh, piece);
    if (p == pieces.size() || pieces[p].id != piece) return;
    add_triangle(_wall.first_triangle[p] + cell);
  }
  /// How many columns of all ranks fall. Collective.
  std::int64_t total() const { return _wall.mesh.communicator.sum(_lowered); }
  std::vector<std::int32_t> take() { return std::move(_counts); }

private:
  static constexpr std::int32_t unchanged = std::numeric_limits<std::int32_t>::max();

  const LocalWall& _wall;
  const ColumnLimits& _limits;
  int _round;
  std::vector<std::int32_t> _counts;
  std::int64_t _lowered = 0;
};

CapClearing::CapClearing(const LocalWall& wall, const Directions& directions,
                         const PlaneRemesher& remesh_planes)
    : _wall(wall), _directions(directions), _remesh_planes(remesh_planes) {
  std::vector<std::int32_t> on_plane;
  for (std::size_t p = 0; p < wall.mesh.pieces.size(); ++p) {
    const auto roles =
        std::span(wall.roles)
            .subspan(wall.first_triangle[p], wall.first_triangle[p + 1] - wall.first_triangle[p]);
    on_plane.push_back(std::count(roles.begin(), roles.end(), WallRole::plane) > 0);
  }
  on_plane = mesh::gather_by_piece(wall.mesh, on_plane);
  for (mesh::PieceId piece = 0; piece < wall.mesh.piece_count; ++piece) {
    if (on_plane[piece] == 0) _kept.push_back(piece);
  }
  const bool has_planes = _kept.size() < on_plane.size();
  if (has_planes && !remesh_planes)
    throw parallel::CollectiveError(parallel::FailureKind::bug,
                                    "layers end on planes, but none can be meshed again");
}

void CapClearing::lower_on_planes(const std::vector<mesh::SharedVertexKey>& at_fault,
                                  LoweredCounts& lower) const {
  _wall.shared.for_each([&](std::size_t p, mesh::LocalIndex, std::size_t copy) {
    const mesh::SharedVertexKey key = _wall.mesh.pieces[p].shared_keys[copy - _wall.shared.first(p)];
    if (std::binary_search(at_fault.begin(), at_fault.end(), key)) lower.add(_wall.vertex_of_copy[copy]);
  });
  if (lower.total() > 0) return;
  for (std::int32_t t = 0; t < _wall.triangle_count(); ++t) {
    if (_wall.roles[t] == WallRole::plane) lower.add_triangle(t);
  }
  if (lower.total() > 0) return;
  throw parallel::CollectiveError(
      parallel::FailureKind::bug,
      "layers: planes cannot be meshed again within boundaries that did not move");
}

void CapClearing::lower_around_parts(const mesh::DistributedMesh& cap, LoweredCounts& lower,
                                     LayerReport& report) const {
  std::vector<geometry::Vec3> ends = _wall.points;
  std::size_t next = 0;  // pieces that are not of planes come first in the cap, in the wall's order
  for (std::size_t p = 0; p < _wall.mesh.pieces.size(); ++p) {
    if (!std::binary_search(_kept.begin(), _kept.end(), _wall.mesh.pieces[p].id)) continue;
    const mesh::Piece& piece = cap.pieces[next++];
    for (mesh::LocalIndex v = 0; v < piece.vertex_count(); ++v)
      ends[_wall.first_vertex[p] + v] = piece.point(v);
  }
  const std::vector<std::int32_t> enclosing = find_enclosing_triangles(_wall, ends);
  for (const std::int32_t t : enclosing) lower.add_triangle(t);
  report.enclosing += _wall.mesh.communicator.sum(static_cast<std::int64_t>(enclosing.size()));
}

bool CapClearing::is_clear(mesh::DistributedMesh& cap, LoweredCounts& lower, LayerReport& report) const {
  const bool has_planes = static_cast<mesh::PieceId>(_kept.size()) < _wall.mesh.piece_count;
  std::vector<mesh::SharedVertexKey> at_fault;
  if (has_planes) at_fault = _remesh_planes(cap);
  if (!at_fault.empty()) {
    std::sort(at_fault.begin(), at_fault.end());
    lower_on_planes(at_fault, lower);
    return false;
  }
  const std::vector<mesh::TriangleHit> hits = mesh::find_intersections(cap);
  const auto add = [&](mesh::PieceId piece, mesh::LocalIndex cell) {
    if (static_cast<std::size_t>(piece) < _kept.size()) lower.add(_kept[piece], cell);
  };
  for (const mesh::TriangleHit& hit : hits) {
    add(hit.first_piece, hit.first);
    add(hit.second_piece, hit.second);
  }
  if (lower.total() == 0) lower_around_parts(cap, lower, report);
  if (lower.total() == 0) return true;
  report.crossings += static_cast<std::int64_t>(hits.size());
  return false;
}

mesh::DistributedMesh CapClearing::run(ColumnLimits& limits, LayerReport& report) const {
  for (int round = 1;; ++round) {
    mesh::DistributedMesh cap = make_cap(_wall.mesh, make_columns(_wall, _directions, limits));
    LoweredCounts lower(_wall, limits, round);
    if (is_clear(cap, lower, report)) return cap;
    report.crossing_rounds = round;
    if (round > rounds_of_thirds) report.zeroed_by_force += lower.total();
    limits.limit_counts(lower.take(), LayerLimit::crossing);
    limits.converge();
    report.validity_rounds += shrink_to_good(_wall, _directions, limits);
  }
}

}  // namespace aeroloom::layers
