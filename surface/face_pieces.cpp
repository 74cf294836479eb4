#include "surface/face_pieces.hpp"

#include "partition/decompose_surface.hpp"
#include "surface/background.hpp"
#include "surface/cut_angles.hpp"
#include "surface/cut_curves.hpp"
#include "surface/face_mesher.hpp"
#include "surface/support_flips.hpp"
#include "surface/support_topology.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace aeroloom::surface {
namespace {

using geometry::Vec3;

/// Background triangles in a piece, about.
constexpr double triangles_per_piece = 64;
/// So often the background gets twice as fine where its curves cross; a face that is still no good stays
/// whole.
constexpr int most_halvings = 3;

/// The background as the decomposition sees it.
partition::BackgroundSurface surface_of(const FaceMesh& mesh, const sizing::SizeField& field) {
  partition::BackgroundSurface surface{mesh.points, mesh.triangles, match_half_edges(mesh.triangles), {}};
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 p = mesh.points[a], q = mesh.points[b], r = mesh.points[c];
    double density = 0;
    for (const Vec3 middle : {0.5 * (p + q), 0.5 * (q + r), 0.5 * (r + p)}) {
      density += 1 / std::pow(field(middle), 2) / 3;
    }
    surface.loads.push_back(2 / std::numbers::sqrt3 * norm(cross(q - p, r - p)) * density);
  }
  return surface;
}

std::vector<std::int32_t> divide(geometry::FaceId face, const FaceMesh& mesh, const sizing::SizeField& field,
                                 const SurfaceOptions& options) {
  const partition::BackgroundSurface surface = surface_of(mesh, field);
  if (options.divider) return options.divider(face, surface);
  const double total = std::accumulate(surface.loads.begin(), surface.loads.end(), 0.0);
  const double parts = std::max(1.0, std::round(total / static_cast<double>(options.piece_triangles)));
  return partition::decompose_surface(surface,
                                      {.piece_load = total / parts, .smallest_angle = options.cut_angle})
      .part;
}

/// A part of the face's support as a seed; its vertices are those of the face that it has.
PieceSeed seed_of_part(Support part, const FaceVertices& known, const std::vector<mesh::SharedToken>& tokens,
                       const sizing::SizeField& field) {
  PieceSeed seed;
  std::vector<std::int32_t> used;
  for (const std::int32_t v : part.mesh_vertex) {
    if (v >= 0) used.push_back(v);
  }
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  for (const std::int32_t v : used) {
    seed.vertices.points.push_back(known.points[v]);
    seed.vertices.uv.push_back(known.uv[v]);
    seed.vertices.tokens.push_back(tokens[v]);
  }
  for (std::int32_t& v : part.mesh_vertex) {
    if (v >= 0) v = static_cast<std::int32_t>(std::lower_bound(used.begin(), used.end(), v) - used.begin());
  }
  seed.support = std::move(part);
  seed.load = predict_triangles(seed.support, field);
  return seed;
}

/// Cuts the background of a face into seeds.
FacePieces cut_face(const geometry::Model& model, FaceBackground background, const CurveMesh& curves,
                    const sizing::SizeField& field, const SurfaceOptions& options) {
  const geometry::FaceId face = background.mesh.face;
  std::vector<std::int32_t> part = divide(face, background.mesh, field, options);
  if (options.cut_angle > 0) straighten_cuts(model, field, part, options.cut_angle, background.mesh);
  FaceVertices vertices;
  CutSupport cut{support_of(model, background, curves, part, vertices), {}};
  cut.part = std::move(part);
  cut.support.loop_edges = trace_loop_edges(cut.support, match_half_edges(cut.support.triangles));
  std::vector<mesh::SharedToken> tokens = vertices.tokens;
  const FeatureEdges features(cut.support, vertices);
  JoinedVertices joined = joined_vertices(cut.support);
  std::vector<Support> parts = separate_at_cut(model, field, std::move(cut), vertices, joined);
  for (std::size_t v = tokens.size(); v < vertices.points.size(); ++v) {
    tokens.push_back(cut_token(face, static_cast<std::int32_t>(v)));
  }
  FacePieces pieces;
  for (Support& support : parts) {
    flip_to_delaunay(support);
    pieces.seeds.push_back(seed_of_part(std::move(support), vertices, tokens, field));
  }
  pieces.angles = measure_cut_angles(pieces.seeds, features);
  return pieces;
}

}  // namespace

CoarseSizes::CoarseSizes(const sizing::SizeField& fine, double piece_triangles)
    : _fine(fine), _factor(std::max(2.0, std::sqrt(piece_triangles / triangles_per_piece))) {}

double CoarseSizes::factor(int halvings) const {
  return std::max(1.0, std::ldexp(_factor, -halvings));
}

const sizing::SizeField& CoarseSizes::field(int halvings) {
  for (auto next = static_cast<int>(_fields.size()); next <= halvings; ++next) {
    _fields.push_back(_fine.scaled(factor(next)));
  }
  return _fields[halvings];
}

FacePieces divide_face(const geometry::Model& model, geometry::FaceId face, const CurveMesh& curves,
                       CoarseSizes& sizes, const SurfaceOptions& options) {
  const geometry::Facets facets = support_facets(model, face, options);
  FacePieces whole;
  PieceSeed seed;
  seed.support = build_support(model, face, curves, facets, seed.vertices);
  seed.load = predict_triangles(seed.support, sizes.fine());
  const bool heavy = options.decomposition == SurfaceDecomposition::pieces &&
                     seed.load >= 1.5 * static_cast<double>(options.piece_triangles);
  for (int halvings = 0; (heavy || options.divider) && halvings <= most_halvings; ++halvings) {
    auto background = mesh_background(model, face, curves, facets, sizes.field(halvings),
                                      sizes.factor(halvings), options);
    if (background) return cut_face(model, std::move(*background), curves, sizes.fine(), options);
  }
  whole.seeds.push_back(std::move(seed));
  return whole;
}

}  // namespace aeroloom::surface
