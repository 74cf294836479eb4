#include "improve/borders/cavity_improver.hpp"

#include "improve/borders/perturbation.hpp"
#include "improve/improver.hpp"
#include "improve/limits/examination.hpp"
#include "improve/limits/local_target.hpp"
#include "mesh/data/mixing.hpp"
#include "mesh/data/shared_vertex_keys.hpp"
#include "mesh/data/tet_faces.hpp"

#include <algorithm>
#include <limits>

namespace aeroloom::improve {
namespace {

using geometry::Vec3;
using mesh::LocalIndex;
using mesh::Piece;

/// Width of the grid's cells, in edges of the bad tetrahedron in them, at least: the star of its neighbours
/// fits in four times over. Chosen, not measured.
constexpr double cell_width = 8;

/// Per vertex: whether it is shared, or a neighbour of one that is.
std::vector<char> near_borders(const Piece& piece) {
  std::vector<char> shared(piece.vertex_count(), 0);
  for (const LocalIndex v : piece.shared_vertices) shared[v] = 1;
  std::vector<char> near = shared;
  for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
    const LocalIndex* c = piece.cell(t);
    if (std::none_of(c, c + 4, [&](LocalIndex v) { return shared[v] != 0; })) continue;
    for (int k = 0; k < 4; ++k) near[c[k]] = 1;
  }
  return near;
}

}  // namespace

std::int64_t claim_for_bad(const mesh::DistributedMesh& mesh, const BadCells& bad,
                           const mesh::TetQuality& measure, int shift, Effort effort,
                           cavities::CavityClaims& claims) {
  std::int64_t count = 0;
  claims.clear();
  for (std::size_t i = 0; i < mesh.pieces.size(); ++i) {
    const Piece& piece = mesh.pieces[i];
    std::vector<cavities::CavityId>& mine = claims.emplace_back(piece.vertex_count(), cavities::no_cavity);
    if (bad.of_piece(i).empty()) continue;
    const LocalTarget local_target =
        effort == Effort::full ? LocalTarget(measure) : LocalTarget(piece, measure);
    std::vector<char> beside;  // a border, once needed
    for (const LocalIndex t : bad.of_piece(i)) {
      const LocalIndex* v = piece.cell(t);
      const std::array<Vec3, 4> p = points_of(piece, t);
      const double quality = measure(p[0], p[1], p[2], p[3]);
      if (quality >= local_target(v)) continue;
      // In narrow regions what was tried inside a piece is not tried again.
      if (local_target.is_limited(v) && !local_target.is_severe(quality)) {
        if (shift > 0) continue;
        if (beside.empty()) beside = near_borders(piece);
        if (std::none_of(v, v + 4, [&](LocalIndex k) { return beside[k] != 0; })) continue;
      }
      ++count;
      const cavities::CavityId id =
          cavities::cavity_at(0.25 * (p[0] + p[1] + p[2] + p[3]), mesh::mean_edge(p), cell_width, shift);
      for (int k = 0; k < 4; ++k) mine[v[k]] = std::max(mine[v[k]], id);
    }
  }
  return count;
}

// Other tetrahedra share faces with the cavity that are not on the surface mesh; their vertices stay. So do
// vertices on CAD curves, which other pieces may have.
void CavityImprover::order_vertices(const cavities::Cavity& cavity) {
  std::vector<mesh::TetFace> walls = mesh::boundary_faces(cavity.tets);
  std::vector<std::array<LocalIndex, 3>> free;
  for (const cavities::CavityTriangle& triangle : cavity.triangles) {
    if (_mesh.sides_of(triangle.face).is_inner()) continue;
    free.push_back(triangle.vertices);
    std::sort(free.back().begin(), free.back().end());
  }
  std::sort(free.begin(), free.end());
  std::erase_if(walls, [&](const mesh::TetFace& face) {
    return std::binary_search(free.begin(), free.end(), face.key);
  });
  std::vector<char> stays(cavity.points.size(), 0);
  for (const mesh::TetFace& face : walls) {
    for (const LocalIndex v : face.vertices) stays[v] = 1;
  }
  for (std::size_t v = 0; v < stays.size(); ++v) stays[v] = stays[v] || is_on_curve(cavity.dimension[v]);
  _order.clear();
  for (const char wanted : {1, 0}) {
    for (std::size_t v = 0; v < stays.size(); ++v) {
      if (stays[v] == wanted) _order.push_back(static_cast<LocalIndex>(v));
    }
    if (wanted) _staying = static_cast<LocalIndex>(_order.size());
  }
  _number.resize(_order.size());
  for (std::size_t i = 0; i < _order.size(); ++i) _number[_order[i]] = static_cast<LocalIndex>(i);
}

void CavityImprover::build_piece(const cavities::Cavity& cavity) {
  _piece = {};
  for (const LocalIndex v : _order) {
    const Vec3 p = cavity.points[v];
    _piece.coordinates.insert(_piece.coordinates.end(), {p.x, p.y, p.z});
    _piece.vertex_dimension.push_back(cavity.dimension[v]);
    _piece.vertex_entity.push_back(cavity.entity[v]);
  }
  for (const auto& tet : cavity.tets) {
    for (const LocalIndex v : tet) _piece.cells.push_back(_number[v]);
  }
  for (const cavities::CavityTriangle& triangle : cavity.triangles) {
    for (const LocalIndex v : triangle.vertices) _piece.boundary.push_back(_number[v]);
    _piece.triangle_face.push_back(triangle.face);
    _piece.triangle_patch.push_back(triangle.patch);
  }
  for (LocalIndex v = 0; v < _staying; ++v) {
    _piece.shared_vertices.push_back(v);
    _piece.shared_keys.push_back(mesh::running_key(v));
  }
}

// Interior vertices count as new ones. Vertices on the CAD keep their names while they stay in place.
cavities::CavityContent CavityImprover::build_content(const cavities::Cavity& cavity) const {
  cavities::CavityContent result;
  std::vector<LocalIndex> named(_piece.vertex_count());
  for (LocalIndex v = 0; v < _piece.vertex_count(); ++v) {
    const auto before = static_cast<std::size_t>(_numbered[v]);
    const bool known = before < _order.size() &&
                       (_numbered[v] < _staying || (is_on_boundary(_piece.vertex_dimension[v]) &&
                                                    _piece.point(v) == cavity.points[_order[before]]));
    if (known) {
      named[v] = _order[before];
      continue;
    }
    named[v] = static_cast<LocalIndex>(cavity.points.size() + result.added.size());
    result.added.push_back({_piece.point(v), _piece.vertex_dimension[v], _piece.vertex_entity[v]});
  }
  for (LocalIndex t = 0; t < _piece.cell_count(); ++t) {
    const LocalIndex* c = _piece.cell(t);
    result.tets.push_back({named[c[0]], named[c[1]], named[c[2]], named[c[3]]});
  }
  std::vector<cavities::CavityTriangle>& triangles = result.triangles.emplace();
  for (LocalIndex i = 0; i < _piece.boundary_count(); ++i) {
    const LocalIndex* c = _piece.boundary_triangle(i);
    triangles.push_back(
        {{named[c[0]], named[c[1]], named[c[2]]}, _piece.triangle_face[i], _piece.triangle_patch[i]});
  }
  return result;
}

bool CavityImprover::is_worse_than(const cavities::Cavity& cavity) const {
  double before = std::numeric_limits<double>::max(), after = before;
  for (const auto& t : cavity.tets) {
    before = std::min(
        before, _measure(cavity.points[t[0]], cavity.points[t[1]], cavity.points[t[2]], cavity.points[t[3]]));
  }
  for (LocalIndex t = 0; t < _piece.cell_count(); ++t)
    after = std::min(after, quality_of(_piece, t, _measure));
  constexpr double rounding =
      1e-12;  // vertices of a tetrahedron may come in another order, with other last bits
  return after < before - rounding;
}

namespace {

/// The worst quality, then how many miss the target: what is greater is better.
std::pair<double, std::int64_t> score(const Piece& piece, const mesh::TetQuality& measure) {
  std::pair<double, std::int64_t> result{std::numeric_limits<double>::max(), 0};
  for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
    const double quality = quality_of(piece, t, measure);
    result.first = std::min(result.first, quality);
    if (quality < measure.target()) --result.second;
  }
  return result;
}

}  // namespace

std::optional<cavities::CavityContent> CavityImprover::improve(const cavities::Cavity& cavity,
                                                               ImproveReport& report) {
  order_vertices(cavity);
  build_piece(cavity);
  ImproveOptions options = _options;
  options.over_constrained_trials = 0;  // were done piece by piece
  const ImproveReport mine = improve_piece(_piece, options, _source, &_numbered);
  if (mine.smoothed + mine.slid + mine.replaced == 0 || is_worse_than(cavity)) return std::nullopt;
  report.add_changes(mine);
  return build_content(cavity);
}

std::optional<cavities::CavityContent> CavityImprover::improve_by_trials(const cavities::Cavity& cavity,
                                                                         int trials, std::uint64_t seed,
                                                                         ImproveReport& report) {
  // Of the vertices' shortest edges; the only value that was tried.
  constexpr double fraction = 0.3;
  order_vertices(cavity);
  build_piece(cavity);
  const Piece start = _piece;
  auto best = score(start, _measure);
  std::optional<cavities::CavityContent> result;
  ImproveReport changes;
  for (int trial = 0; trial < trials && best.second < 0; ++trial) {
    _piece = start;
    if (trial > 0) perturb(_piece, fraction, mesh::mix_in(seed, static_cast<std::uint64_t>(trial)));
    const ImproveReport mine = improve_piece(_piece, _options, _source, &_numbered, Effort::full);
    const auto now = score(_piece, _measure);
    if (now <= best) continue;
    best = now;
    changes = mine;
    result = build_content(cavity);
  }
  if (result) report.add_changes(changes);
  return result;
}

}  // namespace aeroloom::improve
