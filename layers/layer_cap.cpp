#include "layers/layer_cap.hpp"

#include "layers/cap_layout.hpp"
#include "layers/column_source.hpp"
#include "layers/enclosed_parts.hpp"
#include "layers/glued_cap.hpp"
#include "layers/good_columns.hpp"
#include "layers/layer_validity.hpp"
#include "layers/opened_wall.hpp"
#include "mesh/checks/intersection.hpp"
#include "mesh/data/shared_vertex_keys.hpp"
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

/// Adds the nodes of those columns of a vertex that are not straight. `first`: column of the piece.
void add_curved(const ColumnSource& from, std::int32_t v, std::int32_t first, PieceColumns& columns) {
  for (std::int32_t c = from.fans.first[v]; c < from.fans.first[v + 1]; ++c) {
    const CornerColumn column = from.at(v, c);
    if (column.is_straight()) continue;
    columns.curved.push_back({c - first, static_cast<std::int32_t>(columns.curved_nodes.size())});
    column.heights.for_each_node(column.count, [&](std::int32_t, double height) {
      columns.curved_nodes.push_back(column.at(height));
    });
  }
}

}  // namespace

Columns make_columns(const LocalWall& wall, const Fans& fans, const Directions& directions,
                     const ColumnLimits& limits) {
  Columns columns;
  std::size_t next_face = 0, next_rim = 0;
  for (std::size_t p = 0; p < wall.mesh.pieces.size(); ++p) {
    PieceColumns& of_piece = columns.pieces.emplace_back();
    const std::int32_t first = fans.first[wall.first_vertex[p]];
    of_piece.first_column.push_back(0);
    for (std::int32_t v = wall.first_vertex[p]; v < wall.first_vertex[p + 1]; ++v) {
      const Heights heights = limits.heights(v);
      for (std::int32_t c = fans.first[v]; c < fans.first[v + 1]; ++c)
        of_piece.directions.push_back(directions.smoothed[c]);
      of_piece.first_column.push_back(fans.first[v + 1] - first);
      of_piece.vertices.resize(of_piece.directions.size(), v - wall.first_vertex[p]);
      of_piece.counts.push_back(limits.count(v));
      of_piece.constant.push_back(heights.constant);
      of_piece.regular.push_back(heights.regular);
      of_piece.first.push_back(heights.first);
      of_piece.growth.push_back(heights.growth);
      of_piece.stretch.push_back(heights.stretch);
      add_curved({wall, fans, directions, limits}, v, first, of_piece);
    }
    if (of_piece.vertices.size() == of_piece.counts.size()) of_piece.vertices.clear();
    for (std::int32_t t = wall.first_triangle[p]; t < wall.first_triangle[p + 1]; ++t) {
      const auto& [a, b, c] = fans.columns[t];  // counter-clockwise seen from the fluid
      of_piece.corner_columns.push_back({a - first, c - first, b - first});
    }
    const auto is_here = [&](std::int32_t triangle) { return triangle < wall.first_triangle[p + 1]; };
    for (; next_face < fans.faces.size() && is_here(fans.faces[next_face].triangle); ++next_face) {
      FanFace face = fans.faces[next_face];
      for (std::int32_t& column : face.columns) column -= column < 0 ? 0 : first;
      face.triangle -= wall.first_triangle[p];
      of_piece.fan_faces.push_back(face);
    }
    for (; next_rim < fans.rims.size() && is_here(fans.rims[next_rim].triangle); ++next_rim) {
      RimTriangle rim = fans.rims[next_rim];
      for (std::int32_t& column : rim.columns) column -= first;
      rim.triangle -= wall.first_triangle[p];
      of_piece.rims.push_back(rim);
    }
  }
  return columns;
}

namespace {

/// The apex over a sector.
geometry::Vec3 apex_over(const mesh::Piece& wall, const PieceColumns& columns, const FanFace& face) {
  std::array<geometry::Vec3, 4> top, directions;
  for (int i = 0; i < 4; ++i) {
    const std::int32_t column = face.columns[i];
    top[i] = node(wall, columns, column, columns.counts[columns.vertex_of(column)]);
    directions[i] = columns.directions[column];
  }
  return sector_apex(top, directions);
}

/// Keys of the further columns of vertices that other pieces know.
void name_columns(const PieceColumns& columns, const CapLayout& layout, mesh::Piece& cap) {
  std::vector<std::pair<mesh::LocalIndex, mesh::SharedVertexKey>> keys;
  for (std::size_t s = 0; s < cap.shared_vertices.size(); ++s) {
    const mesh::LocalIndex v = cap.shared_vertices[s];
    const std::int32_t first = columns.first_column[v];
    for (std::int32_t c = first; c < columns.first_column[v + 1]; ++c) {
      const mesh::LocalIndex at = layout.vertex_of_column[c];
      if (at < 0) continue;
      const bool first_key = c == first || columns.counts[v] == 0;
      keys.emplace_back(at,
                        first_key ? cap.shared_keys[s] : mesh::fan_vertex_key(cap.shared_keys[s], c - first));
      if (columns.counts[v] == 0) break;
    }
  }
  std::sort(keys.begin(), keys.end());
  cap.shared_vertices.clear(), cap.shared_keys.clear();
  for (const auto& [vertex, key] : keys)
    cap.shared_vertices.push_back(vertex), cap.shared_keys.push_back(key);
}

void move_to_cap(const mesh::Piece& wall, const PieceColumns& columns, mesh::Piece& cap) {
  const CapLayout layout = lay_out_cap(wall, columns);
  const auto count = static_cast<std::size_t>(layout.vertex_count);
  cap.coordinates.resize(3 * count);
  cap.vertex_dimension.resize(count), cap.vertex_entity.resize(count);
  for (mesh::LocalIndex v = 0; v < layout.vertex_count; ++v) {
    const std::int32_t column = layout.column_of_vertex[v];
    if (column < 0) continue;
    const mesh::LocalIndex of = columns.vertex_of(column);
    cap.set_point(v,
                  columns.counts[of] > 0 ? node(wall, columns, column, columns.counts[of]) : wall.point(of));
    cap.vertex_dimension[v] = wall.vertex_dimension[of], cap.vertex_entity[v] = wall.vertex_entity[of];
  }
  for (std::size_t f = 0; f < columns.fan_faces.size(); ++f) {
    const mesh::LocalIndex apex = layout.apex_of_face[f];
    if (apex < 0) continue;
    cap.set_point(apex, apex_over(wall, columns, columns.fan_faces[f]));
    cap.vertex_dimension[apex] = mesh::CadDimension::face;
    cap.vertex_entity[apex] = wall.triangle_face[columns.fan_faces[f].triangle];
  }
  cap.cells.clear();
  for (const auto& corners : layout.triangles)
    cap.cells.insert(cap.cells.end(), corners.begin(), corners.end());
  std::size_t rim = 0;
  std::vector<const RimTriangle*> live_rims;
  for (const RimTriangle& each : columns.rims) {
    if (columns.counts[columns.vertex_of(each.columns[0])] > 0) live_rims.push_back(&each);
  }
  for (const std::int32_t origin : layout.origins) {
    const std::int32_t beside = origin >= 0 ? columns.fan_faces[origin].triangle : live_rims[rim++]->triangle;
    cap.triangle_face.push_back(wall.triangle_face[beside]);
    cap.triangle_patch.push_back(wall.triangle_patch[beside]);
  }
  name_columns(columns, layout, cap);
}

}  // namespace

mesh::DistributedMesh make_cap(const mesh::DistributedMesh& wall, const Columns& columns) {
  mesh::DistributedMesh cap = wall;
  for (std::size_t p = 0; p < cap.pieces.size(); ++p)
    move_to_cap(wall.pieces[p], columns.pieces[p], cap.pieces[p]);
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
  /// The columns under a triangle of the cap, if its piece of the wall is here.
  void add(mesh::PieceId piece, mesh::LocalIndex cell, const Columns& columns, const OpenedWall* opened) {
    const auto& pieces = _wall.mesh.pieces;
    const std::size_t p = mesh::position_of(_wall.mesh, piece);
    if (p == pieces.size() || pieces[p].id != piece) return;
    if (opened != nullptr) cell = triangle_before_gluing(*opened, columns, p, cell);
    if (cell < pieces[p].cell_count()) return add_triangle(_wall.first_triangle[p] + cell);
    const CapLayout layout = lay_out_cap(pieces[p], columns.pieces[p]);
    const std::int32_t face = layout.origins[cell - pieces[p].cell_count()];
    if (face < 0) return;
    const FanFace& of_fan = columns.pieces[p].fan_faces[face];
    for (const int end : {0, 2})
      add(_wall.first_vertex[p] + columns.pieces[p].vertex_of(of_fan.columns[end]));
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

CapClearing::CapClearing(const LocalWall& wall, const Fans& fans, const Directions& directions,
                         const CapChanges& changes)
    : _wall(wall),
      _fans(fans),
      _directions(directions),
      _remesh_planes(changes.remesh_planes),
      _opened(changes.opened) {
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
  if (has_planes && !_remesh_planes)
    throw parallel::CollectiveError(parallel::FailureKind::bug,
                                    "layers end on planes, but none can be meshed again");
}

void CapClearing::lower_on_planes(const std::vector<mesh::SharedVertexKey>& at_fault,
                                  LoweredCounts& lower) const {
  _wall.shared.for_each([&](std::size_t p, mesh::LocalIndex, std::size_t copy) {
    const mesh::SharedVertexKey key = _wall.mesh.pieces[p].shared_keys[copy - _wall.shared.first(p)];
    const std::int32_t v = _wall.vertex_of_copy[copy];
    bool found = std::binary_search(at_fault.begin(), at_fault.end(), key);
    for (std::int32_t c = 1; !found && c < _fans.count_at(v); ++c)
      found = std::binary_search(at_fault.begin(), at_fault.end(), mesh::fan_vertex_key(key, c));
    if (found) lower.add(v);
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

void CapClearing::lower_around_parts(const Columns& columns, LoweredCounts& lower,
                                     LayerReport& report) const {
  std::vector<geometry::Vec3> ends;
  for (std::size_t p = 0; p < _wall.mesh.pieces.size(); ++p) {
    const PieceColumns& of_piece = columns.pieces[p];
    for (std::int32_t c = 0; c < of_piece.column_count(); ++c) {
      const mesh::LocalIndex v = of_piece.vertex_of(c);
      ends.push_back(of_piece.counts[v] > 0 ? node(_wall.mesh.pieces[p], of_piece, c, of_piece.counts[v])
                                            : _wall.mesh.pieces[p].point(v));
    }
  }
  const std::vector<std::int32_t> enclosing = find_enclosing_triangles(_wall, _fans, ends);
  for (const std::int32_t t : enclosing) lower.add_triangle(t);
  report.enclosing += _wall.mesh.communicator.sum(static_cast<std::int64_t>(enclosing.size()));
}

bool CapClearing::is_clear(const Columns& columns, mesh::DistributedMesh& cap, LoweredCounts& lower,
                           LayerReport& report) const {
  const bool has_planes = static_cast<mesh::PieceId>(_kept.size()) < _wall.mesh.piece_count;
  std::vector<mesh::SharedVertexKey> at_fault;
  if (has_planes) at_fault = _remesh_planes(_wall.mesh, cap);
  if (!at_fault.empty()) {
    std::sort(at_fault.begin(), at_fault.end());
    lower_on_planes(at_fault, lower);
    return false;
  }
  const std::vector<mesh::TriangleHit> hits = mesh::find_intersections(cap);
  const auto add = [&](mesh::PieceId piece, mesh::LocalIndex cell) {
    if (static_cast<std::size_t>(piece) < _kept.size()) lower.add(_kept[piece], cell, columns, _opened);
  };
  for (const mesh::TriangleHit& hit : hits) {
    add(hit.first_piece, hit.first);
    add(hit.second_piece, hit.second);
  }
  if (lower.total() == 0) lower_around_parts(columns, lower, report);
  if (lower.total() == 0) return true;
  report.crossings += static_cast<std::int64_t>(hits.size());
  return false;
}

mesh::DistributedMesh CapClearing::run(ColumnLimits& limits, LayerReport& report) const {
  for (int round = 1;; ++round) {
    const Columns columns = make_columns(_wall, _fans, _directions, limits);
    mesh::DistributedMesh cap = make_cap(_wall.mesh, columns);
    if (_opened != nullptr) glue_cap(*_opened, columns, cap);
    LoweredCounts lower(_wall, limits, round);
    if (is_clear(columns, cap, lower, report)) return cap;
    report.crossing_rounds = round;
    if (round > rounds_of_thirds) report.zeroed_by_force += lower.total();
    limits.limit_counts(lower.take(), LayerLimit::crossing);
    limits.converge();
    report.validity_rounds += shrink_to_good(_wall, _fans, _directions, limits);
  }
}

}  // namespace aeroloom::layers
