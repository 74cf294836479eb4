#include "sizing/features/face_samples.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>

namespace aeroloom::sizing {
namespace {

using geometry::Vec2;
using geometry::Vec3;

/// Distance of a sensible middle of two points from both, at most, over their distance: half of it on a
/// plane, 0.71 on half a circle. Farther away parameters have jumped. Chosen, not measured.
constexpr double farthest_middle = 0.9;
/// The area of an equilateral triangle over the square of its edge.
constexpr double triangle_over_square = 0.433;
/// Parts of facets whose corners ask for about the same size, and that are narrower than this part of it,
/// need samples along their longest edge alone, so far from each other at most; halves of slender triangles
/// would be thrice as many for each time that they are half as long.
constexpr double slender = 0.25, same_size = 0.8, spacing_along = 0.5 * spacing;
/// None are needed along an edge where the cells on its way, of a grid with edges of this part of the size at
/// most, have had another with sizes as small as that: a pipe far thinner than its elements is sampled along
/// some of its facets.
constexpr double cell_per_size = 0.5 * spacing, as_small = 1.05;
/// A grid that would have more of them along an edge is not asked.
constexpr double most_cells_along = 1e6;
/// Points, some three megabytes with what belongs to them.
constexpr std::size_t most_remembered = 30'000;
/// A size over its limit by less than one percent is on it, as nobody can tell from a mesh.
constexpr double within_rounding = 1.01;

constexpr double nowhere = std::numeric_limits<double>::infinity();

/// Of a cell of the grid with edges of 2^level, of which the point counts in edges. Cells far away from each
/// other may have the same.
std::uint64_t key_of_cell(Vec3 point, int level) {
  std::uint64_t key = static_cast<std::uint64_t>(level);
  for (int axis = 0; axis < 3; ++axis) {
    const auto cell = static_cast<std::int64_t>(std::floor(point[axis]));
    constexpr int bits = 19;  // three of them and a level in 64
    key = key << bits | (static_cast<std::uint64_t>(cell) & ((std::uint64_t{1} << bits) - 1));
  }
  return key;
}

}  // namespace

std::vector<SizeSource> FaceSamples::sources(const cad::Model& model, cad::FaceId face,
                                             const cad::Facets& facets, bool far_field,
                                             const SizingOptions& options, double coarsening) {
  Query query{
      model,     face, options, curvature_limits(far_field, options), largest_size(far_field, options),
      coarsening};
  if (_planar && query.largest >= options.maximum) return {};
  if (_points.empty()) start(query, facets);
  query.sizes.resize(_points.size(), -1);
  for (std::size_t p = 0; p < facets.points.size(); ++p) add_source(static_cast<std::int32_t>(p), query);
  for (std::size_t t = 0; t < facets.triangles.size(); ++t) {
    const auto& [a, b, c] = facets.triangles[t];
    cover(static_cast<std::int32_t>(t), {a, b, c}, 0, query);
  }
  if (_points.size() > most_remembered) *this = FaceSamples(_planar);
  return std::move(query.sources);
}

FaceSamples::Overview FaceSamples::overview(const cad::Model& model, cad::FaceId face,
                                            const cad::Facets& facets, bool far_field,
                                            const SizingOptions& options) {
  Query query{model, face, options, curvature_limits(far_field, options), largest_size(far_field, options)};
  if (_points.empty()) start(query, facets);
  Overview seen;
  for (const auto& corners : facets.triangles) {
    const auto& [a, b, c] = corners;
    const Vec3 p = facets.points[a];
    const double of_corner = norm(cross(facets.points[b] - p, facets.points[c] - p)) / 6;
    double widest = 0, longest = 0;
    for (int i = 0; i < 3; ++i)
      longest = std::max(longest, distance(facets.points[corners[i]], facets.points[corners[(i + 1) % 3]]));
    for (const auto corner : corners) {
      const Point& point = _points[corner];
      const double size = size_of(point, query), turn = point.curvature * size;
      widest = std::max(widest, size);
      seen.area += of_corner;
      seen.triangles += of_corner / (triangle_over_square * size * size);
      const bool deviates = query.limits.deviation > 0 &&
                            point.curvature * size * size > within_rounding * 3 * query.limits.deviation;
      if (turn <= within_rounding * query.limits.angle && !deviates) continue;
      seen.bounded_area += of_corner;
      seen.degrees = std::max(seen.degrees, turn * 180 / std::numbers::pi);
    }
    // A facet narrower than the size is cut along its length alone, and some of those beside it are not.
    const double height = 6 * of_corner / longest;
    seen.parts += std::max(3 * of_corner / (triangle_over_square * widest * widest),
                           longest / (spacing * widest) * std::min(1.0, height / (cell_per_size * widest)));
  }
  return seen;
}

void FaceSamples::start(const Query& query, const cad::Facets& facets) {
  for (std::size_t p = 0; p < facets.points.size(); ++p) {
    const Vec2 uv = facets.uv[p];
    add(uv, facets.points[p],
        _planar ? cad::PrincipalCurvatures{} : query.model.face_curvatures(query.face, uv));
  }
  _parts.resize(facets.triangles.size());
}

std::int32_t FaceSamples::add(Vec2 uv, Vec3 point, const cad::PrincipalCurvatures& curvatures) {
  _points.push_back({uv, point, curvatures.defined ? std::abs(curvatures.largest) : 0, {-1, -1}});
  return static_cast<std::int32_t>(_points.size()) - 1;
}

std::int32_t FaceSamples::add_between(const Query& query, std::int32_t a, std::int32_t b, double length) {
  const Vec3 from = _points[a].point, to = _points[b].point;
  const Vec2 uv = 0.5 * (_points[a].uv + _points[b].uv);
  const Vec2 of_a = _points[a].uv, of_b = _points[b].uv;
  if (query.model.sheet(query.face, of_a) == query.model.sheet(query.face, of_b)) {
    const auto [point, curvatures] = query.model.face_curved_point(query.face, uv);
    if (std::max(distance(point, from), distance(point, to)) < farthest_middle * length)
      return add(uv, point, curvatures);
  }
  // The parameters jump or are singular between the two: follow the facet instead.
  const bool a_first = std::tie(of_a.x, of_a.y) < std::tie(of_b.x, of_b.y);
  _points.push_back({a_first ? of_a : of_b, 0.5 * (from + to), 0, {a, b}});
  return static_cast<std::int32_t>(_points.size()) - 1;
}

std::int32_t FaceSamples::middle_of(const Query& query, std::int32_t a, std::int32_t b, double length) {
  const auto [low, high] = std::minmax(a, b);
  const Pair pair =
      static_cast<Pair>(static_cast<std::uint32_t>(low)) << 32 | static_cast<std::uint32_t>(high);
  const auto [known, is_new] = _middles.try_emplace(pair, -1);
  if (is_new) known->second = add_between(query, a, b, length);
  return known->second;
}

double FaceSamples::size_of(const Point& point, const Query& query) const {
  if (point.like[0] >= 0) return std::min(query.sizes[point.like[0]], query.sizes[point.like[1]]);
  return size_for_curvature(point.curvature, query.limits, query.largest, query.options);
}

void FaceSamples::add_source(std::int32_t point, Query& query) const {
  if (static_cast<std::size_t>(point) >= query.sizes.size()) query.sizes.resize(_points.size(), -1);
  if (query.sizes[point] >= 0) return;
  query.sizes[point] = size_of(_points[point], query);
  if (query.sizes[point] < query.options.maximum)
    query.sources.push_back({_points[point].point, query.sizes[point]});
}

void FaceSamples::cover(std::int32_t part, const std::array<std::int32_t, 3>& corners, int depth,
                        Query& query) {
  int longest = 0;
  double length = 0, size = query.largest;
  for (int i = 0; i < 3; ++i) {
    const double edge = distance(_points[corners[i]].point, _points[corners[(i + 1) % 3]].point);
    if (edge > length) length = edge, longest = i;
    size = std::min(size, query.sizes[corners[i]]);
  }
  if (length <= spacing * query.coarsening * size || depth >= deepest_bisection) return;
  const std::int32_t a = corners[longest], b = corners[(longest + 1) % 3], c = corners[(longest + 2) % 3];
  const Vec3 p = _points[a].point;
  const double height = norm(cross(_points[b].point - p, _points[c].point - p)) / length;
  const double largest = std::max({query.sizes[a], query.sizes[b], query.sizes[c]});
  if (height <= slender * spacing * query.coarsening * size && size >= same_size * largest) {
    if (!is_covered(a, b, query)) cover_edge(a, b, depth, query);
    return;
  }
  if (_parts[part].middle < 0) {
    const std::int32_t middle = middle_of(query, a, b, length);
    _parts[part] = {middle, static_cast<std::int32_t>(_parts.size())};
    _parts.resize(_parts.size() + 2);
  }
  const auto [middle, halves] = _parts[part];
  add_source(middle, query);
  cover(halves, {a, middle, c}, depth + 1, query);
  cover(halves + 1, {middle, b, c}, depth + 1, query);
}

void FaceSamples::cover_edge(std::int32_t a, std::int32_t b, int depth, Query& query) {
  const double length = distance(_points[a].point, _points[b].point);
  const double size = std::min(query.sizes[a], query.sizes[b]);
  if (length <= spacing_along * query.coarsening * size || depth >= deepest_bisection) return;
  const std::int32_t middle = middle_of(query, a, b, length);
  add_source(middle, query);
  cover_edge(a, middle, depth + 1, query);
  cover_edge(middle, b, depth + 1, query);
}

/// Whether another edge was sampled all along this one; notes that this one is from now on.
bool FaceSamples::is_covered(std::int32_t a, std::int32_t b, Query& query) const {
  const double size = std::min(query.sizes[a], query.sizes[b]);
  const int level = std::ilogb(cell_per_size * query.coarsening * size);
  const double edge = std::ldexp(1.0, level);
  const Vec3 from = _points[a].point, to = _points[b].point;
  const double steps = std::ceil(distance(from, to) / edge);
  if (!(steps <= most_cells_along)) return false;
  bool covered = true;
  for (int i = 0; i <= static_cast<int>(steps); ++i) {
    const Vec3 at = (1 / edge) * (from + i / steps * (to - from));
    double& smallest = query.along.try_emplace(key_of_cell(at, level), nowhere).first->second;
    covered = covered && smallest <= as_small * size;
    smallest = std::min(smallest, size);
  }
  return covered;
}

}  // namespace aeroloom::sizing
