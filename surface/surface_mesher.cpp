#include "surface/surface_mesher.hpp"

#include "parallel/collective_error.hpp"
#include "parallel/log.hpp"
#include "parallel/schedule.hpp"
#include "surface/curves.hpp"
#include "surface/face_mesher.hpp"
#include "surface/intersection.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include <fmt/format.h>

namespace aeroloom::surface {
namespace {

using geometry::FaceId;
using geometry::Vec3;
using sizing::SizeField;
using sizing::SizeSource;

/// Everything the passes of the stage share.
struct Stage {
  const parallel::Communicator& communicator;
  const geometry::Model& model;
  const SurfaceOptions& options;
  parallel::StageClock& clock;
};

/// Predicted triangles of a face: the integral of 4 / (sqrt(3) h^2) over its facets.
double predict_face(const Stage& stage, const SizeField& field, FaceId face) {
  const geometry::Facets facets = support_facets(stage.model, face, stage.options);
  double count = 0;
  for (const auto& t : facets.triangles) {
    const Vec3 &a = facets.points[t[0]], &b = facets.points[t[1]], &c = facets.points[t[2]];
    const double area = 0.5 * norm(cross(b - a, c - a));
    // Sizes vary inside a facet that spans many elements: the corners' halves stand for it.
    double density = 0;
    for (const Vec3& p : {0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)})
      density += 1 / std::pow(field(p), 2) / 3;
    count += 4 / std::numbers::sqrt3 * area * density;
  }
  return std::max(count, 1.0);
}

struct FaceLoad {
  FaceId face;
  double triangles;
};

/// Loads of all faces, on every rank. Faces are dealt round, which no result depends on.
std::vector<double> predict_loads(const Stage& stage, const SizeField& field) {
  std::vector<FaceLoad> mine;
  parallel::agree(stage.communicator, [&] {
    const parallel::ScopedCpu cpu(stage.clock, parallel::ScopedCpu::As::task);
    for (FaceId f = stage.communicator.rank(); f < stage.model.face_count(); f += stage.communicator.size()) {
      mine.push_back({f, predict_face(stage, field, f)});
    }
  });
  std::vector<double> loads(stage.model.face_count());
  for (const FaceLoad& load : stage.communicator.all_gather_items<FaceLoad>(mine))
    loads[load.face] = load.triangles;
  return loads;
}

/// A meshed face with what it was made from, to see whether it has to be made again.
struct MeshedFace {
  mesh::Piece piece;
  std::vector<double> vertex_sizes;
};

std::vector<double> sizes_at_vertices(const SizeField& field, const mesh::Piece& piece) {
  std::vector<double> sizes(piece.vertex_count());
  for (mesh::LocalIndex v = 0; v < piece.vertex_count(); ++v) sizes[v] = field(piece.point(v));
  return sizes;
}

/// The curve vertices of a face, ascending.
std::vector<CurveVertex> curve_vertices(const geometry::Model& model, const CurveMesh& curves, FaceId face) {
  std::vector<CurveVertex> vertices;
  for (const auto& loop : model.face(face).loops) {
    for (const geometry::EdgeUse& use : loop) {
      const auto chain = curves.chain(model, use.edge);
      vertices.insert(vertices.end(), chain.begin(), chain.end());
    }
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

/// Curve numbers move when another curve gets more vertices; a face that is kept takes the new ones.
bool take_over(const Stage& stage, const SizeField& field, const CurveMesh& curves, MeshedFace& meshed) {
  mesh::Piece& piece = meshed.piece;
  const std::vector<CurveVertex> now = curve_vertices(stage.model, curves, piece.id);
  if (now.size() != piece.shared_vertices.size()) return false;
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (!(curves.points[now[i]] == piece.point(piece.shared_vertices[i]))) return false;
  }
  if (sizes_at_vertices(field, piece) != meshed.vertex_sizes) return false;
  for (std::size_t i = 0; i < now.size(); ++i)
    piece.shared_tokens[i] = static_cast<mesh::SharedToken>(now[i]);
  return true;
}

/// One pass over the faces of this rank: meshes what is not meshed yet, collects where sizes have to fall.
struct Pass {
  std::vector<SizeSource> remedies;
  std::string complaint;  // of the first face in conflict
};

Pass mesh_faces(const Stage& stage, const SizeField& field, const CurveMesh& curves,
                const std::vector<int>& tasks, std::map<FaceId, MeshedFace>& faces) {
  Pass pass;
  parallel::Progress progress("surface", static_cast<std::int64_t>(tasks.size()));
  for (const FaceId face : tasks) {
    const parallel::ScopedCpu cpu(stage.clock, parallel::ScopedCpu::As::task);
    const auto known = faces.find(face);
    if (known != faces.end() && take_over(stage, field, curves, known->second)) {
      progress.advance();
      continue;
    }
    faces.erase(face);
    try {
      MeshedFace meshed{mesh_face(stage.model, face, curves, field, stage.options), {}};
      meshed.vertex_sizes = sizes_at_vertices(field, meshed.piece);
      faces.emplace(face, std::move(meshed));
    } catch (const FaceConflict& conflict) {
      if (pass.complaint.empty()) pass.complaint = conflict.what();
      pass.remedies.insert(pass.remedies.end(), conflict.remedy().begin(), conflict.remedy().end());
    }
    progress.advance();
  }
  return pass;
}

mesh::DistributedMesh assemble(const geometry::Model& model, const std::map<FaceId, MeshedFace>& faces) {
  mesh::DistributedMesh surface;
  surface.kind = mesh::CellKind::triangle;
  surface.piece_count = model.face_count();
  surface.patches = model.patches();
  for (FaceId f = 0; f < model.face_count(); ++f) {
    const geometry::Face& face = model.face(f);
    surface.faces.push_back(face.name);
    surface.sides.push_back({face.front, face.back});
  }
  for (geometry::RegionId r = 0; r < model.region_count(); ++r) {
    surface.regions.push_back(model.region_name(r));
  }
  for (const auto& [face, meshed] : faces) surface.pieces.push_back(meshed.piece);
  return surface;
}

std::string describe(const geometry::Model& model, const TriangleHit& hit, const SizeField& field) {
  return fmt::format(
      "triangles of faces '{}' and '{}' intersect near ({:.6g}, {:.6g}, {:.6g}), size {:.4g} there",
      model.face(hit.first_piece).name, model.face(hit.second_piece).name, hit.center.x, hit.center.y,
      hit.center.z, field(hit.center));
}

/// Where triangles of the whole surface intersect, half the size there is asked for.
Pass find_conflicts(const Stage& stage, const SizeField& field, const mesh::DistributedMesh& surface) {
  Pass pass;
  const std::vector<TriangleHit> hits = find_intersections(stage.communicator, surface);
  for (const TriangleHit& hit : hits) pass.remedies.push_back({hit.center, 0.5 * field(hit.center)});
  if (!hits.empty()) pass.complaint = describe(stage.model, hits.front(), field);
  return pass;
}

/// The remedies of all ranks, the same on every rank; the complaint of the lowest rank that has one.
Pass share(const parallel::Communicator& communicator, const Pass& mine) {
  Pass all;
  all.remedies = communicator.all_gather_items<SizeSource>(mine.remedies);
  const auto texts = communicator.all_gather(parallel::to_bytes(std::span<const char>(mine.complaint)));
  for (const parallel::Bytes& text : texts) {
    if (all.complaint.empty()) all.complaint.assign(reinterpret_cast<const char*>(text.data()), text.size());
  }
  return all;
}

[[noreturn]] void give_up(const Stage& stage, const Pass& pass) {
  throw SurfaceError(
      fmt::format("surface: {} after {} rounds of local refinement. Remedy: smaller sizing.minimum or "
                  "curvature_angle, or repair the "
                  "geometry there (overlapping or self-intersecting faces cannot be meshed)",
                  pass.complaint, stage.options.mending_rounds));
}

/// The relative error that 90 % of the predictions stay below.
double prediction_error(const Stage& stage, const std::vector<double>& predicted,
                        const mesh::DistributedMesh& surface) {
  std::vector<FaceLoad> real;
  for (const mesh::Piece& piece : surface.pieces) real.push_back({piece.id, double(piece.cell_count())});
  std::vector<double> errors;
  for (const FaceLoad& face : stage.communicator.all_gather_items<FaceLoad>(real)) {
    errors.push_back(std::abs(predicted[face.face] - face.triangles) / face.triangles);
  }
  std::sort(errors.begin(), errors.end());
  return errors.empty() ? 0 : errors[errors.size() * 9 / 10];
}

}  // namespace

SurfaceMesh mesh_surface(const parallel::Communicator& communicator, const geometry::Model& model,
                         const SizeField& field, const SurfaceOptions& options, parallel::StageClock& clock) {
  const Stage stage{communicator, model, options, clock};
  SurfaceMesh result{{}, {}, field};
  const std::vector<double> loads = predict_loads(stage, field);
  const auto owners = parallel::assign_largest_first(loads, communicator.size());
  const auto tasks = parallel::tasks_of_rank(owners, loads, communicator.rank());
  std::map<FaceId, MeshedFace> faces;
  for (;; ++result.report.mending_rounds) {
    const CurveMesh curves = discretise_curves(communicator, model, result.field, clock);
    Pass pass;
    parallel::agree(communicator, [&] { pass = mesh_faces(stage, result.field, curves, tasks, faces); });
    pass = share(communicator, pass);
    if (pass.remedies.empty() && pass.complaint.empty()) {
      result.mesh = assemble(model, faces);
      result.report.curve_vertices = static_cast<std::int64_t>(curves.points.size());
      pass = find_conflicts(stage, result.field, result.mesh);
    }
    if (pass.complaint.empty()) break;
    if (result.report.mending_rounds == options.mending_rounds || pass.remedies.empty()) give_up(stage, pass);
    parallel::log_verbose(
        fmt::format("surface: {}; sizes fall there ({} places)", pass.complaint, pass.remedies.size()));
    result.field = result.field.refined(pass.remedies);
  }
  for (const mesh::Piece& piece : result.mesh.pieces) result.report.triangles += piece.cell_count();
  result.report.triangles = communicator.sum(result.report.triangles);
  result.report.load_error_90 = prediction_error(stage, loads, result.mesh);
  clock.add_pieces(static_cast<std::int64_t>(result.mesh.pieces.size()));
  return result;
}

}  // namespace aeroloom::surface
