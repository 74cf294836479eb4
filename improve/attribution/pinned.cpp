#include "improve/attribution/pinned.hpp"

#include "geometry/angle.hpp"
#include "geometry/sort_unique.hpp"
#include "improve/attribution/curve_wedges.hpp"
#include "improve/attribution/layer_vertices.hpp"
#include "improve/attribution/narrow_regions.hpp"
#include "improve/attribution/sharp_curves.hpp"
#include "improve/attribution/wall_pairs.hpp"
#include "mesh/data/cad_dimension.hpp"
#include "mesh/quality/quality.hpp"
#include "mesh/quality/tet_quality.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <tuple>
#include <utility>

namespace aeroloom::attribution {
namespace {

using geometry::Vec3;
using mesh::GlobalIndex;
using mesh::LocalIndex;
using mesh::Piece;

/// Estimates for wedges hold up to this factor, since curves and faces are curved. Chosen, not measured.
constexpr double wedge_slack = 2;
/// Degrees; the two measures of an angle differ by less, from rounding.
constexpr double angle_slack = 1e-6;

/// The largest angle that goes with a target for the smallest one, 138 degrees with 28 (docs/improvement.md).
double largest_allowed(double target) {
  constexpr double straight = 180, weight = 1.5;
  return straight - weight * target;
}

double corner_angle(Vec3 apex, Vec3 a, Vec3 b) {
  return geometry::degrees_per_radian * angle_between(a - apex, b - apex);
}

class PinnedSearch {
public:
  PinnedSearch(const mesh::NumberedMesh& mesh, double target, const mesh::CellsOutside& suspects,
               bool surface_may_change)
      : _mesh(mesh),
        _suspects(suspects),
        _target(target),
        _surface_may_change(surface_may_change),
        _measure(target),
        _vertex_faces(mesh),
        _walls(_vertex_faces) {
    _report.smallest_angle = target;
    _report.largest_angle = largest_allowed(target);
    for (MissedTarget* kind : all_kinds()) *kind = {0, target, largest_allowed(target)};
  }

  PinnedReport run() {
    collect_edges();
    _wedges = measure_wedges(_mesh, _edges);
    list_sharp_curves();
    _narrow = find_narrow_edges(_mesh, _edges);
    if (!_surface_may_change) _on_layers = find_layer_vertices(_mesh);
    for (std::size_t i = 0; i < _mesh.pieces.size(); ++i) classify(i);
    tell_apart_the_rest();
    return merge();
  }

private:
  struct BadTet {
    LocalIndex tet;
    mesh::DihedralRange angles;
  };

  std::array<Vec3, 4> points(const Piece& piece, LocalIndex t) const {
    const LocalIndex* c = piece.cell(t);
    return {piece.point(c[0]), piece.point(c[1]), piece.point(c[2]), piece.point(c[3])};
  }
  EdgeName name(std::size_t piece, LocalIndex a, LocalIndex b) const {
    return name_edge(_mesh.pieces[piece], _mesh.numbering.vertices[piece], a, b);
  }
  /// The number of an edge among those looked at, -1 for others.
  std::int64_t find(const EdgeName& edge) const { return find_edge(_edges, edge); }

  void collect_edges();
  void list_sharp_curves();
  void classify(std::size_t piece);
  void tell_apart_the_rest();
  std::array<MissedTarget*, 5> all_kinds() {
    return {&_report.pinned, &_report.at_features, &_report.held, &_report.beside, &_report.rest};
  }
  bool pinned_by_faces(std::size_t piece, const BadTet& bad);
  bool pinned_by_curves(std::size_t piece, const BadTet& bad,
                        const std::vector<std::array<LocalIndex, 4>>& corners);
  std::vector<std::array<LocalIndex, 4>> sharp_corners(const Piece& piece) const;
  bool pinned_by_wedge(std::size_t piece, const BadTet& bad, const WallPair& walls);
  bool is_in_narrow_region(std::size_t piece, const BadTet& bad);
  bool is_held(std::size_t piece, const BadTet& bad) const;
  bool is_in_gap(std::size_t piece, const BadTet& bad, const WallPair& walls);
  MissedTarget& kind_of(std::size_t piece, const BadTet& bad,
                        const std::vector<std::array<LocalIndex, 4>>& corners);
  static void count(MissedTarget& kind, const mesh::DihedralRange& angles);
  void merge_features();
  void total(MissedTarget& kind) const;
  PinnedReport merge();

  const mesh::NumberedMesh& _mesh;
  const mesh::CellsOutside& _suspects;
  double _target;
  bool _surface_may_change;
  mesh::TetQuality _measure;
  VertexFaces _vertex_faces;
  WallFinder _walls;
  SharpCurves _sharp_curves;
  std::vector<std::vector<BadTet>> _bad;              // per piece
  std::vector<std::pair<std::size_t, BadTet>> _left;  // with their pieces: those that nothing explains yet
  std::vector<GlobalIndex> _explained;                // vertices of those that the CAD explains
  std::vector<std::vector<std::uint8_t>> _on_layers;  // per piece and vertex, where surfaces may not change
  std::vector<EdgeName> _edges;                       // of bad tetrahedra on all ranks, ascending
  std::vector<EdgeWedge> _wedges;                     // per edge
  std::vector<NarrowEdge> _narrow;                    // those of them across narrow regions
  std::vector<PinningEntity> _entities;
  std::vector<UnresolvedFeature> _features;
  PinnedReport _report;
};

void PinnedSearch::collect_edges() {
  std::vector<EdgeName> mine;
  for (std::size_t i = 0; i < _mesh.pieces.size(); ++i) {
    const Piece& piece = _mesh.pieces[i];
    std::vector<BadTet>& bad = _bad.emplace_back();
    for (const LocalIndex t : _suspects.cells[i]) {
      const auto p = points(piece, t);
      const double quality = _measure(p[0], p[1], p[2], p[3]);
      if (quality >= _measure.target()) continue;
      bad.push_back({t, mesh::dihedral_range(p[0], p[1], p[2], p[3])});
      const LocalIndex* c = piece.cell(t);
      for (const auto& [a, b] : mesh::tetrahedron_edges) {
        if (is_on_curve(piece.vertex_dimension[c[a]]) && is_on_curve(piece.vertex_dimension[c[b]]))
          mine.push_back(name(i, c[a], c[b]));
      }
    }
  }
  _edges = _mesh.communicator.all_gather_items<EdgeName>(mine);
  geometry::sort_unique(_edges);
}

/// Edges of bad tetrahedra suffice: what fills less than the target angle is bad.
void PinnedSearch::list_sharp_curves() {
  std::vector<SharpSegment> mine;
  std::vector<std::int32_t> of_a, of_b, both;
  for (std::size_t i = 0; i < _mesh.pieces.size(); ++i) {
    const Piece& piece = _mesh.pieces[i];
    for (const BadTet& bad : _bad[i]) {
      for (const auto& [from, to] : mesh::tetrahedron_edges) {
        LocalIndex a = piece.cell(bad.tet)[from], b = piece.cell(bad.tet)[to];
        const std::int64_t edge = find(name(i, a, b));
        if (edge < 0 || _wedges[edge].angle >= _target) continue;
        if (_mesh.numbering.vertices[i][a] > _mesh.numbering.vertices[i][b]) std::swap(a, b);
        of_a.clear(), of_b.clear(), both.clear();
        _vertex_faces.list(piece, a, of_a), _vertex_faces.list(piece, b, of_b);
        std::set_intersection(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(), std::back_inserter(both));
        for (auto low = both.begin(); low != both.end(); ++low) {
          for (auto high = low + 1; high != both.end(); ++high) {
            mine.push_back(
                {edge, piece.region, *low, *high, _wedges[edge].angle, piece.point(a), piece.point(b)});
          }
        }
      }
    }
  }
  _sharp_curves = SharpCurves(_mesh, mine);
}

bool PinnedSearch::pinned_by_faces(std::size_t i, const BadTet& bad) {
  const Piece& piece = _mesh.pieces[i];
  const LocalIndex* c = piece.cell(bad.tet);
  PinningEntity entity;
  entity.angle = _target;
  for (const auto& [a, b] : mesh::tetrahedron_edges) {
    if (!is_on_curve(piece.vertex_dimension[c[a]]) || !is_on_curve(piece.vertex_dimension[c[b]])) continue;
    const std::int64_t edge = find(name(i, c[a], c[b]));
    if (edge < 0 || _wedges[edge].angle >= entity.angle) continue;
    entity.angle = _wedges[edge].angle;
    entity.faces = _wedges[edge].faces;
    entity.at = 0.5 * (piece.point(c[a]) + piece.point(c[b]));
  }
  if (entity.angle >= _target) return false;
  if (entity.faces[1] < 0) entity.faces[1] = entity.faces[0];
  entity.tetrahedra = 1;
  entity.smallest_dihedral = bad.angles.smallest;
  _entities.push_back(entity);
  return true;
}

/// Boundary triangles in a corner between two curves that is smaller than the target: corner first, then the
/// others, then the triangle.
std::vector<std::array<LocalIndex, 4>> PinnedSearch::sharp_corners(const Piece& piece) const {
  std::vector<std::array<LocalIndex, 4>> corners;
  for (LocalIndex t = 0; t < piece.boundary_count(); ++t) {
    const LocalIndex* v = piece.boundary_triangle(t);
    for (int k = 0; k < 3; ++k) {
      const LocalIndex apex = v[k], a = v[(k + 1) % 3], b = v[(k + 2) % 3];
      if (piece.vertex_dimension[apex] != mesh::CadDimension::vertex ||
          !is_on_curve(piece.vertex_dimension[a]) || !is_on_curve(piece.vertex_dimension[b])) {
        continue;
      }
      if (corner_angle(piece.point(apex), piece.point(a), piece.point(b)) < _target)
        corners.push_back({apex, a, b, t});
    }
  }
  return corners;
}

bool PinnedSearch::pinned_by_curves(std::size_t i, const BadTet& bad,
                                    const std::vector<std::array<LocalIndex, 4>>& corners) {
  const Piece& piece = _mesh.pieces[i];
  const LocalIndex* c = piece.cell(bad.tet);
  const auto has = [c](LocalIndex v) { return c[0] == v || c[1] == v || c[2] == v || c[3] == v; };
  for (const auto& [apex, a, b, triangle] : corners) {
    if (!has(apex) || !has(a) || !has(b)) continue;
    const std::int32_t face = piece.triangle_face[triangle];
    _entities.push_back({.kind = PinningEntity::Kind::curves,
                         .faces = {face, face},
                         .vertex = piece.vertex_entity[apex],
                         .angle = corner_angle(piece.point(apex), piece.point(a), piece.point(b)),
                         .smallest_dihedral = bad.angles.smallest,
                         .at = piece.point(apex),
                         .tetrahedra = 1});
    return true;
  }
  return false;
}

/// In later rows of a wedge: about as narrow as the wedge at that distance from its curve, and no flatter.
bool PinnedSearch::pinned_by_wedge(std::size_t i, const BadTet& bad, const WallPair& walls) {
  const Piece& piece = _mesh.pieces[i];
  const auto p = points(piece, bad.tet);
  const auto curve =
      _sharp_curves.nearest(piece.region, walls.low, walls.high, 0.25 * (p[0] + p[1] + p[2] + p[3]));
  if (!curve || wedge_slack * bad.angles.smallest < curve->angle) return false;
  if (wedge_slack * walls.gap < curve->distance * std::tan(curve->angle / geometry::degrees_per_radian))
    return false;
  _entities.push_back({.faces = {walls.low, walls.high},
                       .angle = curve->angle,
                       .smallest_dihedral = bad.angles.smallest,
                       .at = curve->at,
                       .tetrahedra = 1});
  return true;
}

bool PinnedSearch::is_in_gap(std::size_t i, const BadTet& bad, const WallPair& walls) {
  if (walls.touching) return false;
  const auto p = points(_mesh.pieces[i], bad.tet);
  _features.push_back(
      {walls.low, walls.high, walls.gap, bad.angles.smallest, 0.25 * (p[0] + p[1] + p[2] + p[3]), 1});
  return true;
}

/// The narrowest region that the tetrahedron reaches across counts.
bool PinnedSearch::is_in_narrow_region(std::size_t i, const BadTet& bad) {
  const LocalIndex* c = _mesh.pieces[i].cell(bad.tet);
  const NarrowEdge* narrowest = nullptr;
  for (const auto& [a, b] : mesh::tetrahedron_edges) {
    const std::int64_t edge = find(name(i, c[a], c[b]));
    const NarrowEdge* found = edge < 0 ? nullptr : find_narrow_edge(_narrow, edge);
    if (!found) continue;
    if (!narrowest || std::tie(found->width, found->face) < std::tie(narrowest->width, narrowest->face))
      narrowest = found;
  }
  if (!narrowest) return false;
  _features.push_back({narrowest->face, -1, narrowest->width, bad.angles.smallest, narrowest->at, 1});
  return true;
}

bool PinnedSearch::is_held(std::size_t i, const BadTet& bad) const {
  if (_surface_may_change) return false;
  const Piece& piece = _mesh.pieces[i];
  const LocalIndex* c = piece.cell(bad.tet);
  return std::count_if(c, c + 4, [&](LocalIndex v) {
           return is_on_boundary(piece.vertex_dimension[v]) || _on_layers[i][v] != 0;
         }) >= 3;
}

void PinnedSearch::count(MissedTarget& kind, const mesh::DihedralRange& angles) {
  ++kind.tetrahedra;
  kind.smallest_angle = std::min(kind.smallest_angle, angles.smallest);
  kind.largest_angle = std::max(kind.largest_angle, angles.largest);
}

MissedTarget& PinnedSearch::kind_of(std::size_t i, const BadTet& bad,
                                    const std::vector<std::array<LocalIndex, 4>>& corners) {
  if (pinned_by_faces(i, bad) || pinned_by_curves(i, bad, corners)) return _report.pinned;
  const std::optional<WallPair> walls = _walls.find(_mesh.pieces[i], bad.tet);
  if (walls && pinned_by_wedge(i, bad, *walls)) return _report.pinned;
  if (is_in_narrow_region(i, bad) || (walls && is_in_gap(i, bad, *walls))) return _report.at_features;
  if (is_held(i, bad)) return _report.held;
  return _report.rest;
}

void PinnedSearch::classify(std::size_t i) {
  const std::vector<std::array<LocalIndex, 4>> corners = sharp_corners(_mesh.pieces[i]);
  const std::vector<GlobalIndex>& names = _mesh.numbering.vertices[i];
  for (const BadTet& bad : _bad[i]) {
    MissedTarget& kind = kind_of(i, bad, corners);
    if (&kind == &_report.rest) {
      _left.emplace_back(i, bad);
      continue;
    }
    count(kind, bad.angles);
    const LocalIndex* c = _mesh.pieces[i].cell(bad.tet);
    if (&kind != &_report.held)
      for (int k = 0; k < 4; ++k) _explained.push_back(names[c[k]]);
  }
}

/// Those beside others that the CAD explains, and the rest.
void PinnedSearch::tell_apart_the_rest() {
  geometry::sort_unique(_explained);
  _explained = _mesh.communicator.all_gather_items<GlobalIndex>(_explained);
  geometry::sort_unique(_explained);
  for (const auto& [i, bad] : _left) {
    const LocalIndex* c = _mesh.pieces[i].cell(bad.tet);
    const std::vector<GlobalIndex>& names = _mesh.numbering.vertices[i];
    const bool is_beside = std::any_of(c, c + 4, [&](LocalIndex v) {
      return std::binary_search(_explained.begin(), _explained.end(), names[v]);
    });
    count(is_beside ? _report.beside : _report.rest, bad.angles);
  }
}

void PinnedSearch::total(MissedTarget& kind) const {
  kind.tetrahedra = _mesh.communicator.sum(kind.tetrahedra);
  kind.smallest_angle = _mesh.communicator.minimum(kind.smallest_angle);
  kind.largest_angle = _mesh.communicator.maximum(kind.largest_angle);
}

/// Merges tetrahedra of the same faces into one entry, on each rank before they are sent.
void PinnedSearch::merge_features() {
  const auto merge = [](std::vector<UnresolvedFeature> rows) {
    std::sort(rows.begin(), rows.end(), [](const UnresolvedFeature& a, const UnresolvedFeature& b) {
      return std::tie(a.face, a.opposite, a.width, a.at.x, a.at.y, a.at.z) <
             std::tie(b.face, b.opposite, b.width, b.at.x, b.at.y, b.at.z);
    });
    std::vector<UnresolvedFeature> merged;
    for (const UnresolvedFeature& row : rows) {
      if (merged.empty() ||
          std::tie(merged.back().face, merged.back().opposite) != std::tie(row.face, row.opposite)) {
        merged.push_back(row);
        continue;
      }
      merged.back().tetrahedra += row.tetrahedra;
      merged.back().smallest_dihedral = std::min(merged.back().smallest_dihedral, row.smallest_dihedral);
    }
    return merged;
  };
  _report.features =
      merge(_mesh.communicator.all_gather_items<UnresolvedFeature>(merge(std::move(_features))));
}

PinnedReport PinnedSearch::merge() {
  const auto key = [](const PinningEntity& e) { return std::tuple(e.kind, e.faces, e.vertex); };
  const std::vector<PinningEntity> all = _mesh.communicator.gather_sorted(
      _entities, [&](const PinningEntity& e) { return std::tuple(key(e), e.angle, e.at.x, e.at.y, e.at.z); });
  for (const PinningEntity& entity : all) {
    if (_report.entities.empty() || key(_report.entities.back()) != key(entity)) {
      _report.entities.push_back(entity);
      continue;
    }
    PinningEntity& known = _report.entities.back();
    ++known.tetrahedra;
    known.smallest_dihedral = std::min(known.smallest_dihedral, entity.smallest_dihedral);
  }
  merge_features();
  for (MissedTarget* kind : all_kinds()) total(*kind);
  _report.tetrahedra = _report.pinned.tetrahedra;
  for (const MissedTarget* kind : all_kinds()) {
    if (kind == &_report.pinned) continue;
    _report.others += kind->tetrahedra;
    _report.smallest_angle = std::min(_report.smallest_angle, kind->smallest_angle);
    _report.largest_angle = std::max(_report.largest_angle, kind->largest_angle);
  }
  return std::move(_report);
}

}  // namespace

mesh::DihedralRange suspect_angles(double target_angle) {
  return {target_angle + angle_slack, largest_allowed(target_angle) - angle_slack};
}

PinnedReport find_pinned(const mesh::NumberedMesh& mesh, double target_angle,
                         const mesh::CellsOutside& suspects, bool surface_may_change) {
  return PinnedSearch(mesh, target_angle, suspects, surface_may_change).run();
}

}  // namespace aeroloom::attribution
