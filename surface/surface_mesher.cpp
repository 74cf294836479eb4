#include "surface/surface_mesher.hpp"

#include "geometry/place_text.hpp"
#include "mesh/checks/intersection.hpp"
#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/log.hpp"
#include "parallel/observation/timers.hpp"
#include "sizing/field/closed_corners.hpp"
#include "surface/curves/curves.hpp"
#include "surface/cusps/cusps.hpp"
#include "surface/cusps/needle_remedies.hpp"
#include "surface/division/imposed_cuts.hpp"
#include "surface/piece_pool.hpp"
#include "surface/pinched_edges.hpp"
#include "surface/rows/rows_made.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <tuple>

#include <fmt/format.h>

namespace aeroloom::surface {
namespace {

using sizing::SizeField;

/// The CAD face of each piece of the whole mesh, on every rank. Collective.
std::vector<cad::FaceId> faces_of_pieces(const mesh::DistributedMesh& surface) {
  std::vector<std::array<std::int32_t, 2>> mine;
  for (const mesh::Piece& piece : surface.pieces) mine.push_back({piece.id, piece.common_face()});
  std::vector<cad::FaceId> faces(surface.piece_count, cad::no_entity);
  for (const auto& [piece, face] : surface.communicator.all_gather_items<std::array<std::int32_t, 2>>(mine))
    faces[piece] = face;
  return faces;
}

/// A triangle that another one of a face meets; both faces, the lower one first.
struct CrossedTriangle {
  std::array<cad::FaceId, 2> faces;
  std::int32_t side;  // which of the two it lies on
  mesh::PieceId piece;
  mesh::LocalIndex cell;
  double area;
  geometry::Vec3 place;  // of the hit

  auto key() const { return std::tie(faces, side, piece, cell); }
};

/// Each once, by faces and sides.
std::vector<CrossedTriangle> list_crossed(const std::vector<mesh::TriangleHit>& hits,
                                          const std::vector<cad::FaceId>& faces) {
  std::vector<CrossedTriangle> crossed;
  for (const mesh::TriangleHit& hit : hits) {
    const cad::FaceId first = faces[hit.first_piece], second = faces[hit.second_piece];
    const std::array<cad::FaceId, 2> both{std::min(first, second), std::max(first, second)};
    const std::int32_t side = first <= second ? 0 : 1;
    crossed.push_back({both, side, hit.first_piece, hit.first, hit.first_area, hit.center});
    crossed.push_back({both, 1 - side, hit.second_piece, hit.second, hit.second_area, hit.center});
  }
  std::stable_sort(crossed.begin(), crossed.end(),
                   [](const CrossedTriangle& a, const CrossedTriangle& b) { return a.key() < b.key(); });
  const auto end =
      std::unique(crossed.begin(), crossed.end(),
                  [](const CrossedTriangle& a, const CrossedTriangle& b) { return a.key() == b.key(); });
  crossed.erase(end, crossed.end());
  return crossed;
}

/// The two faces that intersect over the largest area: that of the triangles of one of them, the smaller one.
std::string describe_worst(const cad::Model& model, const SizeField& field,
                           const std::vector<mesh::TriangleHit>& hits,
                           const std::vector<cad::FaceId>& faces) {
  const std::vector<CrossedTriangle> crossed = list_crossed(hits, faces);
  const CrossedTriangle* worst = nullptr;
  double worst_area = -1;
  for (std::size_t i = 0; i < crossed.size();) {
    const CrossedTriangle& first = crossed[i];
    std::array<double, 2> areas{};
    for (; i < crossed.size() && crossed[i].faces == first.faces; ++i)
      areas[crossed[i].side] += crossed[i].area;
    const double area = std::min(areas[0], areas[1]);
    if (area > worst_area) worst = &first, worst_area = area;
  }
  return fmt::format(
      "triangles of faces '{}' and '{}' intersect near {}, over an area of about {:.3g} in all, size {:.4g} "
      "there",
      model.face(worst->faces[0]).name, model.face(worst->faces[1]).name, geometry::place_text(worst->place),
      worst_area, field(worst->place));
}

std::string describe_pinched(const cad::Model& model, const PinchedEdge& edge, cad::FaceId face) {
  return fmt::format("face '{}' pinches itself near {}: elements of {:.3g} are too long around it",
                     model.face(face).name, geometry::place_text(edge.middle), edge.length);
}

/// Where triangles of the whole surface intersect, half the size there is asked for; a face that its own
/// pieces make intersect is left whole. Collective, the same on every rank.
Conflicts find_conflicts(const cad::Model& model, const SizeField& field,
                         const mesh::DistributedMesh& surface, const PiecePool& pool) {
  Conflicts conflicts;
  const std::vector<mesh::TriangleHit> hits = mesh::find_intersections(surface);
  const std::vector<PinchedEdge> pinched = find_pinched_edges(surface);
  if (hits.empty() && pinched.empty()) return conflicts;
  const std::vector<cad::FaceId> faces = faces_of_pieces(surface);
  for (const PinchedEdge& edge : pinched)
    conflicts.remedies.push_back({edge.middle, std::min(edge.length, 0.5 * field(edge.middle))});
  if (hits.empty()) {
    conflicts.message = describe_pinched(model, pinched.front(), faces[pinched.front().piece]);
    return conflicts;
  }
  for (const mesh::TriangleHit& hit : hits) {
    const cad::FaceId first = faces[hit.first_piece], second = faces[hit.second_piece];
    if (first == second && pool.is_divided(first)) {
      conflicts.undivided.push_back(first);
    } else {
      conflicts.remedies.push_back({hit.center, 0.5 * field(hit.center)});
    }
  }
  conflicts.message = describe_worst(model, field, hits, faces);
  return conflicts;
}

/// `tried`: what was, or would have been.
[[noreturn]] void give_up(const std::string& message, const std::string& tried) {
  throw SurfaceError(fmt::format(
      "surface: {}{}. Remedy: smaller SizingOptions::minimum or "
      "SizingOptions::curvature_angle, or repair the geometry there (overlapping or self-intersecting faces "
      "cannot be meshed)",
      message, tried));
}

std::int64_t count_unforced(const std::vector<NeedleGroup>& groups) {
  std::int64_t count = 0;
  for (const NeedleGroup& group : groups) count += group.cause == NeedleCause::mesh ? group.needles : 0;
  return count;
}

std::vector<ListedCorner> list_corners(const cad::Model& model, const CurveMesh& curves) {
  std::vector<ListedCorner> corners;
  for (const SharpCorner& corner : curves.sharp_corners)
    corners.push_back({corner.face, model.vertex(corner.vertex), corner.degrees});
  return corners;
}

/// The rounds of one run: until no conflict is left, then until no more needles can be mended.
class SurfaceRounds {
public:
  SurfaceRounds(const cad::Model& model, const SizeField& field, const CutOptions& options,
                parallel::TaskStore* tasks)
      : _model(model), _options(options), _pool(field.communicator(), model, options, tasks), _field(field) {}

  SurfaceMesh run() {
    try {
      for (bool done = false; !done; ++_rounds) done = mesh_once();
    } catch (const parallel::CollectiveError& error) {
      // Sizes that fell for needles alone are no reason to fail.
      if (!_accepted || error.kind() != parallel::FailureKind::input) throw;
      parallel::log_verbose(fmt::format("surface: {}; needles stay as they are", error.what()));
    }
    return std::move(*_accepted);
  }

private:
  /// Whether this was the last round.
  bool mesh_once() {
    parallel::begin_round();
    const CurveMesh curves = discretise_curves(_model, _field, _short_legs);
    Conflicts conflicts = gather_conflicts(_pool.mesh(curves, _field));
    if (conflicts.predicted > _pool.most_triangles()) return end_early(conflicts.predicted);
    mesh::DistributedMesh surface(_field.communicator());
    if (conflicts.message.empty()) {
      surface = _pool.assemble();
      _closed_cusps = close_cusps(_model, curves, sizing::closing_gap(_field.options()), surface);
      conflicts = find_conflicts(_model, _field, surface, _pool);
    }
    if (!conflicts.message.empty()) return !mend(conflicts);
    const NeedleRemedies remedies = accept(curves, std::move(surface));
    if (remedies.empty()) return true;
    std::vector<cad::VertexId> short_legs;
    std::set_union(_short_legs.begin(), _short_legs.end(), remedies.short_legs.begin(),
                   remedies.short_legs.end(), std::back_inserter(short_legs));
    _short_legs = std::move(short_legs);
    lower_sizes(remedies.sizes);
    return false;
  }

  /// The remedies of all ranks, the same on every rank; the message of the lowest rank that has one.
  Conflicts gather_conflicts(const Conflicts& mine) const {
    const parallel::Communicator& communicator = _field.communicator();
    Conflicts all;
    all.predicted = mine.predicted;
    all.remedies = communicator.all_gather_items<sizing::SizeSource>(mine.remedies);
    all.undivided = communicator.all_gather_items<cad::FaceId>(mine.undivided);
    const auto texts = communicator.all_gather(parallel::to_bytes(std::span<const char>(mine.message)));
    for (const parallel::Bytes& text : texts) {
      if (all.message.empty()) all.message.assign(reinterpret_cast<const char*>(text.data()), text.size());
    }
    return all;
  }

  /// The sources are the same on every rank: one gives them.
  void lower_sizes(std::span<const sizing::SizeSource> sources) {
    if (sources.empty()) return;
    _lowered.insert(_lowered.end(), sources.begin(), sources.end());
    const bool gives = _field.communicator().is_root();
    _field = _field.refined(gives ? sources : std::span<const sizing::SizeSource>());
  }

  /// Nothing was meshed: sizes have fallen so far that it would be too much.
  bool end_early(double triangles) {
    const std::string tried = fmt::format(
        "; sizes that might part them would take about {:.2g} triangles, after {:.2g} in the first round; "
        "{:.2g} are allowed",
        triangles, _pool.first_triangles(), _pool.most_triangles());
    if (!_accepted) give_up(_last_message, tried);
    parallel::log_verbose(
        fmt::format("surface: needles stay as they are: without them there would be about {:.2g} triangles, "
                    "{:.2g} are allowed",
                    triangles, _pool.most_triangles()));
    return true;
  }

  /// Whether another round can help.
  bool mend(const Conflicts& conflicts) {
    const bool can_go_on = !conflicts.remedies.empty() || !conflicts.undivided.empty();
    if (_rounds >= _options.mending_rounds || !can_go_on) {
      if (_accepted) return false;
      give_up(conflicts.message,
              fmt::format(", after {} rounds of local refinement", _options.mending_rounds));
    }
    _last_message = conflicts.message;
    parallel::log_verbose(fmt::format("surface: {}; sizes fall in {} places, {} faces stay whole",
                                      conflicts.message, conflicts.remedies.size(),
                                      conflicts.undivided.size()));
    _pool.leave_whole(conflicts.undivided);
    lower_sizes(conflicts.remedies);
    return true;
  }

  /// Keeps a surface without conflicts if it has fewer needles than the one before; returns what to change
  /// for the next one, nothing at the end.
  NeedleRemedies accept(const CurveMesh& curves, mesh::DistributedMesh surface) {
    std::vector<Needle> needles;
    {
      const parallel::ScopedCpu check(parallel::ScopedCpu::As::check);
      needles = find_needles(_model, curves, surface);
      // Triangles of rows are as narrow as asked for.
      const std::vector<mesh::PieceId> rows = _pool.row_pieces();
      std::erase_if(needles, [&](const Needle& needle) {
        return std::binary_search(rows.begin(), rows.end(), surface.pieces[needle.piece].id);
      });
    }
    std::vector<NeedleGroup> groups = group_needles(surface, needles);
    const std::int64_t unforced = count_unforced(groups);
    if (_accepted && unforced >= count_unforced(_accepted->report.needles)) return {};
    NeedleRemedies remedies;
    if (unforced > 0 && _rounds < _options.mending_rounds && _needle_rounds++ < _options.needle_rounds) {
      remedies = find_needle_remedies(surface, needles, _field);
      parallel::log_verbose(
          fmt::format("surface: {} needles; sizes fall in {} places, {} corners get shorter legs", unforced,
                      remedies.sizes.size(), remedies.short_legs.size()));
    }
    SurfaceReport report = describe(curves, surface);
    report.needles = std::move(groups);
    constexpr double few_triangles = 1000;  // chosen, not measured
    const auto triangles = static_cast<double>(report.triangles);
    _pool.limit_to(std::max(_options.needle_growth * triangles, triangles + few_triangles));
    _accepted = SurfaceMesh{{mesh::number_mesh(std::move(surface)), _field}, std::move(report), _lowered};
    return remedies;
  }

  SurfaceReport describe(const CurveMesh& curves, const mesh::DistributedMesh& surface) const {
    SurfaceReport report;
    for (const mesh::Piece& piece : surface.pieces) report.triangles += piece.cell_count();
    report.triangles = surface.communicator.sum(report.triangles);
    report.curve_vertices = static_cast<std::int64_t>(curves.points.size());
    report.sharp_corners = list_corners(_model, curves);
    report.closed_cusps = _closed_cusps;
    report.rows = list_rows(_model, curves, _options.rows);
    report.pieces = surface.piece_count;
    report.divided_faces = _pool.divided_faces();
    report.cut_angles = _pool.cut_angles();
    report.load_error_90 = _pool.load_error_90();
    report.mending_rounds = _rounds;
    return report;
  }

  const cad::Model& _model;
  const CutOptions& _options;
  PiecePool _pool;
  SizeField _field;
  std::vector<sizing::SizeSource> _lowered;  // the sources that _field got in these rounds
  std::vector<cad::VertexId> _short_legs;    // ascending
  std::vector<ClosedCusp> _closed_cusps;     // of this round
  int _rounds = 0, _needle_rounds = 0;
  std::string _last_message;
  std::optional<SurfaceMesh> _accepted;  // the last one without conflicts
};

}  // namespace

SurfaceMesh mesh_surface(const cad::Model& model, const SizeField& field, const SurfaceOptions& options,
                         parallel::TaskStore* tasks) {
  return mesh_surface_with_cuts(model, field, {options}, tasks);
}

SurfaceMesh mesh_surface_with_cuts(const cad::Model& model, const SizeField& field, const CutOptions& options,
                                   parallel::TaskStore* tasks) {
  SurfaceMesh result = SurfaceRounds(model, field, options, tasks).run();
  parallel::add_pieces(static_cast<std::int64_t>(result.pieces.size()));
  return result;
}

}  // namespace aeroloom::surface
