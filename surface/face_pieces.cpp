#include "surface/face_pieces.hpp"

#include "partition/decompose_surface.hpp"
#include "surface/background.hpp"
#include "surface/cut_angles.hpp"
#include "surface/cut_curves.hpp"
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
/// So often the background gets twice as fine where its loops cross; a seed that is still no good stays
/// whole.
constexpr int most_halvings = 4;
/// A seed of more pieces is cut twice.
constexpr double most_pieces_at_once = 24;

/// The pieces that a seed is cut into at once.
double count_parts(const PieceSeed& seed, const SurfaceOptions& options) {
  const double pieces = std::max(1.0, std::round(seed.load / static_cast<double>(options.piece_triangles)));
  return pieces > most_pieces_at_once ? std::round(std::sqrt(pieces)) : pieces;
}

/// The background as the decomposition sees it.
partition::BackgroundSurface surface_of(const FaceMesh& mesh, const sizing::SizeField& field) {
  partition::BackgroundSurface surface{
      mesh.points, mesh.triangles, geometry::match_half_edges(mesh.triangles), {}};
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

std::vector<std::int32_t> divide(const FaceMesh& mesh, double parts, const sizing::SizeField& field,
                                 const SurfaceOptions& options) {
  const partition::BackgroundSurface surface = surface_of(mesh, field);
  if (options.divider) return options.divider(mesh.face, surface);
  const double total = std::accumulate(surface.loads.begin(), surface.loads.end(), 0.0);
  return partition::decompose_surface(surface,
                                      {.piece_load = total / parts, .smallest_angle = options.cut_angle})
      .part;
}

/// A part of a divided support as a seed; its vertices are those of the whole that it has.
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

/// Cuts a seed along the parts of its background.
SeedPieces cut_seed(const cad::Model& model, const PieceSeed& seed, Background background, std::int32_t group,
                    double parts, const sizing::SizeField& field, const SurfaceOptions& options) {
  const cad::FaceId face = seed.support.face;
  std::vector<std::int32_t> part = divide(background.mesh, parts, field, options);
  if (options.cut_angle > 0) straighten_cuts(model, field, part, options.cut_angle, background.mesh);
  CutSupport cut{support_of(model, seed, background, part), {}};
  cut.part = std::move(part);
  const FeatureEdges features(cut.support, seed.vertices);
  JoinedVertices joined = joined_vertices(cut.support);
  FaceVertices vertices = seed.vertices;
  std::vector<Support> supports = separate_at_cut(model, field, std::move(cut), vertices, joined);
  std::vector<mesh::SharedToken> tokens = vertices.tokens;
  for (std::size_t v = tokens.size(); v < vertices.points.size(); ++v) {
    tokens.push_back(mesh::cut_token(face, group, static_cast<std::int32_t>(v)));
  }
  SeedPieces pieces;
  for (Support& support : supports) {
    flip_to_delaunay(support);
    pieces.seeds.push_back(seed_of_part(std::move(support), vertices, tokens, field));
  }
  pieces.angles = measure_cut_angles(pieces.seeds, features);
  return pieces;
}

}  // namespace

const sizing::SizeField& CoarseSizes::field(int power) {
  while (static_cast<int>(_fields.size()) <= power) _fields.push_back(_fields.back().scaled(2));
  return _fields[power];
}

bool is_heavy(double load, const SurfaceOptions& options) {
  return options.decomposition == SurfaceDecomposition::pieces &&
         load >= 1.5 * static_cast<double>(options.piece_triangles);
}

SeedPieces divide_seed(const cad::Model& model, PieceSeed seed, std::int32_t group, CoarseSizes& sizes,
                       const SurfaceOptions& options) {
  const double parts = count_parts(seed, options);
  const double factor = std::sqrt(seed.load / parts / triangles_per_piece);
  const int power = std::max(0, static_cast<int>(std::round(std::log2(factor))));
  for (int at = power; at >= std::max(0, power - most_halvings); --at) {
    auto background = mesh_background(model, seed, sizes.field(at), std::ldexp(1.0, at), options);
    if (background) {
      return cut_seed(model, seed, std::move(*background), group, parts, sizes.fine(), options);
    }
  }
  SeedPieces whole;
  whole.seeds.push_back(std::move(seed));
  return whole;
}

}  // namespace aeroloom::surface
