#include "surface/surface_mesher.hpp"

#include "parallel/collective_error.hpp"
#include "parallel/log.hpp"
#include "sizing/closed_corners.hpp"
#include "surface/curves.hpp"
#include "surface/cusp_tips.hpp"
#include "surface/intersection.hpp"
#include "surface/piece_pool.hpp"
#include "surface/surface_error.hpp"

#include <fmt/format.h>

namespace aeroloom::surface {
namespace {

using sizing::SizeField;
using sizing::SizeSource;

/// The CAD face of each piece of the whole mesh, on every rank. Collective.
std::vector<cad::FaceId> faces_of_pieces(const parallel::Communicator& communicator,
                                         const mesh::DistributedMesh& surface) {
  std::vector<std::array<std::int32_t, 2>> mine;
  for (const mesh::Piece& piece : surface.pieces) mine.push_back({piece.id, piece.common_face()});
  std::vector<cad::FaceId> faces(surface.piece_count, cad::no_entity);
  for (const auto& [piece, face] : communicator.all_gather_items<std::array<std::int32_t, 2>>(mine)) {
    faces[piece] = face;
  }
  return faces;
}

/// Where triangles of the whole surface intersect, half the size there is asked for; a face that its own
/// pieces make intersect is left whole. Collective, the same on every rank.
Conflicts find_conflicts(const parallel::Communicator& communicator, const cad::Model& model,
                         const SizeField& field, const mesh::DistributedMesh& surface, const PiecePool& pool,
                         parallel::StageClock& clock) {
  Conflicts conflicts;
  const std::vector<TriangleHit> hits = find_intersections(communicator, surface, clock);
  if (hits.empty()) return conflicts;
  const std::vector<cad::FaceId> faces = faces_of_pieces(communicator, surface);
  for (const TriangleHit& hit : hits) {
    const cad::FaceId first = faces[hit.first_piece], second = faces[hit.second_piece];
    if (first == second && pool.is_divided(first)) {
      conflicts.undivided.push_back(first);
    } else {
      conflicts.remedies.push_back({hit.center, 0.5 * field(hit.center)});
    }
  }
  const TriangleHit& first = hits.front();
  conflicts.complaint = fmt::format(
      "triangles of faces '{}' and '{}' intersect near ({:.6g}, {:.6g}, {:.6g}), size {:.4g} there",
      model.face(faces[first.first_piece]).name, model.face(faces[first.second_piece]).name, first.center.x,
      first.center.y, first.center.z, field(first.center));
  return conflicts;
}

/// The remedies of all ranks, the same on every rank; the complaint of the lowest rank that has one.
Conflicts share(const parallel::Communicator& communicator, const Conflicts& mine) {
  Conflicts all;
  all.remedies = communicator.all_gather_items<SizeSource>(mine.remedies);
  all.undivided = communicator.all_gather_items<cad::FaceId>(mine.undivided);
  const auto texts = communicator.all_gather(parallel::to_bytes(std::span<const char>(mine.complaint)));
  for (const parallel::Bytes& text : texts) {
    if (all.complaint.empty()) all.complaint.assign(reinterpret_cast<const char*>(text.data()), text.size());
  }
  return all;
}

[[noreturn]] void give_up(const Conflicts& conflicts, const SurfaceOptions& options) {
  throw SurfaceError(fmt::format(
      "surface: {} after {} rounds of local refinement. Remedy: smaller SizingOptions::minimum or "
      "SizingOptions::curvature_angle, or repair the geometry there (overlapping or self-intersecting faces "
      "cannot be meshed)",
      conflicts.complaint, options.mending_rounds));
}

std::vector<ListedCorner> list_corners(const cad::Model& model, const CurveMesh& curves) {
  std::vector<ListedCorner> corners;
  for (const SharpCorner& corner : curves.sharp_corners) {
    corners.push_back({corner.face, model.vertex(corner.vertex), corner.degrees});
  }
  return corners;
}

}  // namespace

SurfaceMesh mesh_surface(const parallel::Communicator& communicator, const cad::Model& model,
                         const SizeField& field, const SurfaceOptions& options, parallel::StageClock& clock) {
  SurfaceMesh result{{}, {}, field};
  PiecePool pool(communicator, model, options, clock);
  for (;; ++result.report.mending_rounds) {
    const CurveMesh curves = discretise_curves(communicator, model, result.field, clock);
    Conflicts conflicts = share(communicator, pool.mesh(curves, result.field));
    if (conflicts.complaint.empty()) {
      result.mesh = pool.assemble();
      result.report.closed_tips = close_cusp_tips(communicator, model, curves,
                                                  sizing::closing_gap(field.options()), result.mesh, clock);
      result.report.curve_vertices = static_cast<std::int64_t>(curves.points.size());
      result.report.sharp_corners = list_corners(model, curves);
      conflicts = find_conflicts(communicator, model, result.field, result.mesh, pool, clock);
    }
    if (conflicts.complaint.empty()) break;
    const bool can_go_on = !conflicts.remedies.empty() || !conflicts.undivided.empty();
    if (result.report.mending_rounds == options.mending_rounds || !can_go_on) give_up(conflicts, options);
    parallel::log_verbose(fmt::format("surface: {}; sizes fall in {} places, {} faces stay whole",
                                      conflicts.complaint, conflicts.remedies.size(),
                                      conflicts.undivided.size()));
    pool.leave_whole(conflicts.undivided);
    if (!conflicts.remedies.empty())
      result.field = result.field.refined(communicator, conflicts.remedies, clock);
  }
  for (const mesh::Piece& piece : result.mesh.pieces) result.report.triangles += piece.cell_count();
  result.report.triangles = communicator.sum(result.report.triangles);
  result.report.pieces = result.mesh.piece_count;
  result.report.divided_faces = pool.divided_faces();
  result.report.cut_angles = pool.cut_angles();
  result.report.load_error_90 = pool.load_error_90();
  clock.add_pieces(static_cast<std::int64_t>(result.mesh.pieces.size()));
  return result;
}

}  // namespace aeroloom::surface
