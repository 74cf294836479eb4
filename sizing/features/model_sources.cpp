#include "sizing/features/model_sources.hpp"

#include "sizing/field/curvature_size.hpp"

#include <algorithm>
#include <array>
#include <numbers>

namespace aeroloom::sizing {
namespace {

using geometry::Vec3;

/// Facets that samples start from: a fillet that turns less than this is seen by its neighbours.
constexpr double facet_angle = 20 * std::numbers::pi / 180;
/// Over the diagonal of the body, and over that of everything for the far field, which has no details.
/// Chosen, not measured: samples are refined by sizes afterwards.
constexpr double facet_deflection = 1e-3, far_facet_deflection = 5e-3;
/// Of each smooth part of an edge, so that bisection misses no bend between two samples of equal size.
constexpr int first_intervals = 8;

struct EdgeSample {
  double parameter;
  Vec3 point;
  double size;
};

/// Samples one edge by bisection, adds up its length on the way.
class EdgeSampler {
public:
  EdgeSampler(const cad::Model& model, cad::EdgeId edge, bool far_field, const SizingOptions& options)
      : _model(model), _edge(edge), _options(options), _limits(curvature_limits(far_field, options)) {}

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
    add_length_source();
    return std::move(_sources);
  }

private:
  EdgeSample sample(double t) {
    const EdgeSample result{
        t, _model.edge_point(_edge, t),
        size_for_curvature(_model.edge_curvature(_edge, t), _limits, _options.maximum, _options)};
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

  void add_length_source() {
    const cad::Edge& edge = _model.edge(_edge);
    if (_length >= _options.maximum) return;
    const double size = feature_size(_length, smallest_feature_size(_options), _options);
    _sources.push_back({_model.edge_point(_edge, 0.5 * (edge.first_parameter + edge.last_parameter)), size});
  }

  const cad::Model& _model;
  cad::EdgeId _edge;
  const SizingOptions& _options;
  CurvatureLimits _limits;
  double _length = 0;
  std::vector<SizeSource> _sources;
};

}  // namespace

cad::Facets sampling_facets(const cad::Model& model, cad::FaceId face, bool far_field) {
  const double deflection = far_field ? far_facet_deflection * model.bounds().diagonal()
                                      : facet_deflection * model.body_bounds().diagonal();
  return model.facets(face, deflection, facet_angle, cad::Model::Keep::yes);
}

std::vector<SizeSource> edge_sources(const cad::Model& model, cad::EdgeId edge, bool far_field,
                                     const SizingOptions& options) {
  const auto& faces = model.edge(edge).faces;
  const bool vanishes = model.is_seam(edge) && model.sheet_count(faces.front()) > 1;
  if (model.edge(edge).degenerate || vanishes) return {};
  return EdgeSampler(model, edge, far_field, options).run();
}

}  // namespace aeroloom::sizing
