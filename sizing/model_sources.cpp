#include "sizing/model_sources.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace aeroloom::sizing {
namespace {

using geometry::Vec2;
using geometry::Vec3;

/// How far samples are apart, at most, over the size asked for there.
constexpr double spacing = 1.0;
/// Facets that samples start from: a fillet that turns less than this is seen by its neighbours.
constexpr double facet_angle = 20 * std::numbers::pi / 180;
constexpr double facet_deflection = 1e-3;      ///< over the diagonal of the body
constexpr double far_facet_deflection = 5e-3;  ///< over the diagonal of everything
/// Distance of a sensible middle of two points from both, at most, over their distance.
constexpr double farthest_middle = 0.9;
/// Bisections of one facet or curve interval, at most: what is still too long then is singular.
constexpr int deepest_bisection = 40;
constexpr int first_intervals = 8;  ///< of each smooth part of an edge

double radians_per_element(bool far_field, const SizingOptions& options) {
  const double degrees =
      far_field ? std::max(options.curvature_angle, far_field_angle) : options.curvature_angle;
  return degrees * std::numbers::pi / 180;
}

/// A triangle with edges l leaves a surface of curvature k by k R^2 / 2 in its middle, R = l / sqrt(3); edges
/// may be 1.4 times as long as the size.
double size_for_deviation(double curvature, const SizingOptions& options) {
  return std::max(std::sqrt(3 * options.chordal_deviation / curvature), smallest_feature_size(options));
}

double size_for_curvature(double curvature, double angle, double largest, const SizingOptions& options) {
  const double k = std::abs(curvature);
  const double size = k * largest > angle ? std::max(angle / k, options.minimum) : largest;
  return options.chordal_deviation > 0 && k > 0 ? std::min(size, size_for_deviation(k, options)) : size;
}

/// On a face of the body or of the far field.
double largest_size(bool far_field, const SizingOptions& options) {
  return far_field || options.surface_maximum == 0 ? options.maximum
                                                   : std::min(options.maximum, options.surface_maximum);
}

struct FaceSample {
  Vec2 uv;
  Vec3 point;
  double size;
};

/// Samples one face by bisecting the longest edges of its facets until they are as short as the sizes asked
/// for.
class FaceSampler {
public:
  FaceSampler(const cad::Model& model, cad::FaceId face, bool far_field, const SizingOptions& options)
      : _model(model),
        _face(face),
        _options(options),
        _planar(model.is_planar(face)),
        _angle(radians_per_element(far_field, options)),
        _largest(largest_size(far_field, options)) {}

  std::vector<SizeSource> run(const cad::Facets& facets) {
    if (_planar && _largest >= _options.maximum) return {};
    std::vector<FaceSample> nodes;
    nodes.reserve(facets.points.size());
    for (std::size_t i = 0; i < facets.points.size(); ++i)
      nodes.push_back(sample(facets.uv[i], facets.points[i]));
    for (const auto& t : facets.triangles) cover({nodes[t[0]], nodes[t[1]], nodes[t[2]]}, 0);
    return std::move(_sources);
  }

private:
  FaceSample sample(Vec2 uv, Vec3 point) {
    double size = _largest;
    if (!_planar) {
      const auto curvatures = _model.face_curvatures(_face, uv);
      if (curvatures.defined) size = size_for_curvature(curvatures.largest, _angle, _largest, _options);
    }
    if (size < _options.maximum) _sources.push_back({point, size});
    return {uv, point, size};
  }

  FaceSample sample_between(const FaceSample& a, const FaceSample& b, double length) {
    const Vec2 uv = 0.5 * (a.uv + b.uv);
    const Vec3 point = _model.face_point(_face, uv);
    if (std::max(distance(point, a.point), distance(point, b.point)) < farthest_middle * length)
      return sample(uv, point);
    // The parameters jump or are singular between the two: follow the facet instead.
    const FaceSample middle{a.uv, 0.5 * (a.point + b.point), std::min(a.size, b.size)};
    if (middle.size < _options.maximum) _sources.push_back({middle.point, middle.size});
    return middle;
  }

  void cover(const std::array<FaceSample, 3>& corners, int depth) {
    int longest = 0;
    double length = 0, size = _largest;
    for (int i = 0; i < 3; ++i) {
      const double edge = distance(corners[i].point, corners[(i + 1) % 3].point);
      if (edge > length) length = edge, longest = i;
      size = std::min(size, corners[i].size);
    }
    if (length <= spacing * size || depth >= deepest_bisection) return;
    const FaceSample &a = corners[longest], &b = corners[(longest + 1) % 3], &c = corners[(longest + 2) % 3];
    const FaceSample middle = sample_between(a, b, length);
    cover({a, middle, c}, depth + 1);
    cover({middle, b, c}, depth + 1);
  }

  const cad::Model& _model;
  cad::FaceId _face;
  const SizingOptions& _options;
  bool _planar;
  double _angle, _largest;
  std::vector<SizeSource> _sources;
};

struct EdgeSample {
  double parameter;
  Vec3 point;
  double size;
};

/// Samples one edge by bisection, adds up its length on the way.
class EdgeSampler {
public:
  EdgeSampler(const cad::Model& model, cad::EdgeId edge, bool far_field, const SizingOptions& options)
      : _model(model), _edge(edge), _options(options), _angle(radians_per_element(far_field, options)) {}

  std::vector<SizeSource> run() {
    const std::vector<double> breaks = _model.edge_breaks(_edge);
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
      EdgeSample last = sample(breaks[i]);
      for (int part = 1; part <= first_intervals; ++part) {
        const double t = breaks[i] + (breaks[i + 1] - breaks[i]) * part / first_intervals;
        const EdgeSample next = sample(t);
        cover(last, next, 0);
        last = next;
      }
    }
    ask_for_own_length();
    return std::move(_sources);
  }

private:
  EdgeSample sample(double t) {
    const EdgeSample result{
        t, _model.edge_point(_edge, t),
        size_for_curvature(_model.edge_curvature(_edge, t), _angle, _options.maximum, _options)};
    if (result.size < _options.maximum) _sources.push_back({result.point, result.size});
    return result;
  }

  void cover(const EdgeSample& a, const EdgeSample& b, int depth) {
    const double length = distance(a.point, b.point);
    if (length <= spacing * std::min(a.size, b.size) || depth >= deepest_bisection) {
      _length += length;
      return;
    }
    const EdgeSample middle = sample(0.5 * (a.parameter + b.parameter));
    cover(a, middle, depth + 1);
    cover(middle, b, depth + 1);
  }

  void ask_for_own_length() {
    const cad::Edge& edge = _model.edge(_edge);
    if (_length >= _options.maximum) return;
    const double size = std::max(_length, smallest_feature_size(_options));
    _sources.push_back({_model.edge_point(_edge, 0.5 * (edge.first_parameter + edge.last_parameter)), size});
  }

  const cad::Model& _model;
  cad::EdgeId _edge;
  const SizingOptions& _options;
  double _angle, _length = 0;
  std::vector<SizeSource> _sources;
};

/// Whether the face lies in one side of the box.
bool lies_on_side(const cad::Facets& facets, const geometry::Box& box) {
  geometry::Box own;
  for (const Vec3 p : facets.points) own.add(p);
  const double tolerance = 1e-6 * box.diagonal();
  for (int axis = 0; axis < 3; ++axis) {
    if (own.high[axis] <= box.low[axis] + tolerance || own.low[axis] >= box.high[axis] - tolerance)
      return true;
  }
  return false;
}

}  // namespace

std::vector<bool> find_far_field(const cad::Model& model) {
  std::vector<bool> far(model.face_count(), false);
  bool flagged = false;
  for (cad::FaceId f = 0; f < model.face_count(); ++f) {
    far[f] = model.is_far_field(f);
    flagged = flagged || far[f];
  }
  if (flagged) return far;
  for (cad::FaceId f = 0; f < model.face_count(); ++f) {
    far[f] = model.is_planar(f) && lies_on_side(sampling_facets(model, f, true), model.bounds());
  }
  return far;
}

cad::Facets sampling_facets(const cad::Model& model, cad::FaceId face, bool far_field) {
  const double deflection = far_field ? far_facet_deflection * model.bounds().diagonal()
                                      : facet_deflection * model.body_bounds().diagonal();
  return model.facets(face, deflection, facet_angle, cad::Model::Keep::yes);
}

std::vector<SizeSource> face_sources(const cad::Model& model, cad::FaceId face, const cad::Facets& facets,
                                     bool far_field, const SizingOptions& options) {
  std::vector<SizeSource> sources = FaceSampler(model, face, far_field, options).run(facets);
  const std::vector<SizeSource> strips =
      strip_sources(model, facets, options, largest_size(far_field, options));
  sources.insert(sources.end(), strips.begin(), strips.end());
  return sources;
}

std::vector<SizeSource> edge_sources(const cad::Model& model, cad::EdgeId edge, bool far_field,
                                     const SizingOptions& options) {
  const auto& faces = model.edge(edge).faces;
  const bool vanishes = model.is_seam(edge) && model.sheet_count(faces.front()) > 1;
  if (model.edge(edge).degenerate || vanishes) return {};
  return EdgeSampler(model, edge, far_field, options).run();
}

}  // namespace aeroloom::sizing
