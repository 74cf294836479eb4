#include "surface/division/face_division.hpp"

#include "geometry/sort_unique.hpp"
#include "mesh/data/shared_vertex_keys.hpp"
#include "surface/charts/cut_curves.hpp"
#include "surface/charts/delaunay_flips.hpp"
#include "surface/division/background.hpp"
#include "surface/division/cut_angles.hpp"
#include "surface/division/cut_straightening.hpp"
#include "surface/division/partition_clusters.hpp"
#include "surface/division/repair_parts.hpp"
#include "surface/division/simplify_dual_graph.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

namespace aeroloom::surface {
namespace {

/// Background triangles in a part of a division, about: chosen, not measured.
constexpr double triangles_per_part = 64;
/// How often the background gets twice as fine where its loops cross; a piece problem that is still no good
/// stays whole.
constexpr int most_halvings = 4;
/// No cluster is heavier than this fraction of a part, so that parts can be balanced to about as much.
constexpr double largest_cluster = 0.15;
/// A face of more pieces is cut twice, so that ranks divide its parts side by side. Chosen, not measured.
constexpr double most_pieces_at_once = 24;

/// The pieces that a piece problem is cut into at once: a part of a face (group > 0) is not cut again.
double count_parts(double load, std::int32_t group, const SurfaceOptions& options) {
  const double pieces = std::max(1.0, std::round(load / static_cast<double>(options.piece_triangles)));
  return group == 0 && pieces > most_pieces_at_once ? std::round(std::sqrt(pieces)) : pieces;
}

/// The background as the decomposition sees it.
partition::BackgroundSurface weigh(const FaceMesh& mesh, const sizing::SizeField& field) {
  partition::BackgroundSurface surface{mesh.points, mesh.triangles, open_half_edges(mesh), {}};
  for (const auto& [a, b, c] : mesh.triangles) {
    const geometry::Vec3 p = mesh.points[a], q = mesh.points[b], r = mesh.points[c];
    double density = 0;
    for (const geometry::Vec3 middle : {0.5 * (p + q), 0.5 * (q + r), 0.5 * (r + p)})
      density += 1 / std::pow(field(middle), 2) / 3;
    surface.loads.push_back(2 / std::numbers::sqrt3 * norm(cross(q - p, r - p)) * density);
  }
  return surface;
}

/// A part of a divided chart surface as a piece problem; its vertices are those of the whole that it has.
PieceProblem problem_of_part(ChartSurface part, const FaceVertices& known,
                             const std::vector<mesh::SharedVertexKey>& vertex_keys,
                             const sizing::SizeField& field) {
  PieceProblem problem;
  std::vector<std::int32_t> used;
  for (const std::int32_t v : part.mesh_vertex) {
    if (v >= 0) used.push_back(v);
  }
  geometry::sort_unique(used);
  for (const std::int32_t v : used) {
    problem.vertices.points.push_back(known.points[v]);
    problem.vertices.uv.push_back(known.uv[v]);
    problem.vertices.vertex_keys.push_back(vertex_keys[v]);
  }
  for (std::int32_t& v : part.mesh_vertex) {
    if (v >= 0) v = static_cast<std::int32_t>(std::lower_bound(used.begin(), used.end(), v) - used.begin());
  }
  problem.surface = std::move(part);
  problem.load = predict_triangles(problem.surface, field);
  return problem;
}

/// The parts of a background beside each other, the cuts between them discretised once.
struct CutFace {
  std::vector<ChartSurface> surfaces;              ///< of the parts
  FaceVertices vertices;                           ///< those of the piece problem, then those on cuts
  std::vector<mesh::SharedVertexKey> vertex_keys;  ///< per vertex
  FeatureEdges features;                           ///< fine edges that are no cuts
};

CutFace discretise_cuts(const cad::Model& model, const PieceProblem& problem, const Background& background,
                        std::vector<partition::PartIndex> part, std::int32_t group,
                        const sizing::SizeField& field) {
  ChartSurface whole = chart_surface_of(model, problem, background, part);
  CutFace cut{{}, problem.vertices, {}, FeatureEdges(whole, problem.vertices)};
  JoinedVertices joined = joined_vertices(whole);
  cut.surfaces = discretise_cuts(model, field, {std::move(whole), std::move(part)}, cut.vertices, joined);
  cut.vertex_keys = cut.vertices.vertex_keys;
  for (std::size_t v = cut.vertex_keys.size(); v < cut.vertices.points.size(); ++v)
    cut.vertex_keys.push_back(
        mesh::cut_vertex_key(problem.surface.face, group, static_cast<std::int32_t>(v)));
  return cut;
}

DividedProblem make_pieces(CutFace cut, const sizing::SizeField& field) {
  DividedProblem pieces;
  for (ChartSurface& surface : cut.surfaces) {
    flip_to_delaunay(surface);
    pieces.problems.push_back(problem_of_part(std::move(surface), cut.vertices, cut.vertex_keys, field));
  }
  pieces.angles = measure_cut_angles(pieces.problems, cut.features);
  return pieces;
}

/// The arguments of divide_problem(), which its attempts share.
struct DivisionRequest {
  const cad::Model& model;
  const PieceProblem& problem;
  std::int32_t group;
  partition::PartIndex parts;
  const CutOptions& options;
};

/// The method of Chen, Zhao, Zheng et al., a verb each. Nothing where there is no background mesh as coarse
/// as 2^power fine sizes.
std::optional<DividedProblem> divide(const DivisionRequest& wanted, int power, CoarseSizes& sizes) {
  const auto& [model, problem, group, parts, options] = wanted;
  const sizing::SizeField& fine = sizes.fine();
  const DivisionSteps& steps = options.division;
  const double cut_angle = options.cut_angle;
  const auto angle_for = [cut_angle](bool step) { return step ? cut_angle : 0; };

  std::optional<Background> background =
      mesh_background(model, problem, sizes.field(power), std::ldexp(1.0, power), options);
  if (!background) return std::nullopt;
  const partition::BackgroundSurface surface = weigh(background->mesh, fine);

  std::vector<partition::PartIndex> part;
  if (options.divider) {
    part = options.divider(problem.surface.face, surface);
  } else {
    const double total = std::accumulate(surface.loads.begin(), surface.loads.end(), 0.0);
    const partition::VertexFans fans = partition::gather_fans(surface);
    const partition::Clusters clusters = partition::simplify_dual_graph(
        surface, fans, {angle_for(steps.contraction), largest_cluster * total / parts});
    part = partition::partition_clusters(surface, clusters, parts);
    partition::repair_parts(surface, fans, {angle_for(steps.widening), steps.repair}, part);
  }

  if (angle_for(steps.straightening) > 0)
    straighten_cuts(model, fine, part, options.cut_angle, background->mesh);
  CutFace cut = discretise_cuts(model, problem, *background, std::move(part), group, fine);

  return make_pieces(std::move(cut), fine);
}

}  // namespace

const sizing::SizeField& CoarseSizes::field(int power) {
  while (static_cast<int>(_fields.size()) <= power) _fields.push_back(_fields.back().scaled(2));
  return _fields[power];
}

double division_cost(double triangles, double facets, std::int32_t group, const SurfaceOptions& options) {
  // A part costs its background triangles; the cuts of so many parts have about so many edges.
  // Facets of a face, as the CAD library made them, cost more than those of parts.
  // In triangles to mesh. No mesh depends on it, only who makes what.
  constexpr double per_part = 400, per_cut_edge = 2, per_facet = 1.5, of_face = 1.6;
  constexpr double cut_edges =
      1.3;  // over the root of triangles times parts: of square parts half as many borders
  const double parts = count_parts(triangles, group, options);
  return (group == 0 ? of_face : 1) *
         (per_part * parts + per_cut_edge * cut_edges * std::sqrt(triangles * parts) + per_facet * facets);
}

bool is_heavy(double load, const SurfaceOptions& options) {
  constexpr double least_pieces = 1.5;  // from here on two parts are nearer to the piece wanted than one
  return options.decomposition == SurfaceDecomposition::pieces &&
         load >= least_pieces * static_cast<double>(options.piece_triangles);
}

DividedProblem divide_problem(const cad::Model& model, PieceProblem problem, std::int32_t group,
                              CoarseSizes& sizes, const CutOptions& options) {
  const double parts = count_parts(problem.load, group, options);
  const double factor = std::sqrt(problem.load / parts / triangles_per_part);
  const int power = std::max(0, static_cast<int>(std::round(std::log2(factor))));
  const DivisionRequest wanted{model, problem, group, static_cast<partition::PartIndex>(parts), options};
  for (int at = power; at >= std::max(0, power - most_halvings); --at) {
    if (std::optional<DividedProblem> pieces = divide(wanted, at, sizes)) return std::move(*pieces);
  }
  DividedProblem whole;
  whole.problems.push_back(std::move(problem));
  return whole;
}

}  // namespace aeroloom::surface
