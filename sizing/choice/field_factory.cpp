#include "sizing/choice/field_factory.hpp"

#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/timers.hpp"
#include "sizing/choice/predict_counts.hpp"
#include "sizing/field/curvature_size.hpp"
#include "sizing/field/field_builder.hpp"
#include "sizing/field/source_tree.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace aeroloom::sizing {
namespace {

using parallel::ScopedCpu;

/// Sources in gaps and thin bodies.
std::vector<SizeSource> gap_sources(const Gaps& gaps, const SizingOptions& options) {
  std::vector<SizeSource> sources;
  const double across_gaps = elements_across_gaps(options);
  for (const Gap& gap : gaps.seen) {
    const double elements = gap.is_meshed ? across_gaps : options.proximity;
    if (elements == 0) continue;
    const double asked = elements > 0 ? gap.width / elements : size_that_keeps_apart(gap.width, gap.bend);
    const double size = std::max(asked, options.minimum);
    if (size < options.maximum) sources.push_back({gap.point, size});
  }
  for (const Gap& gap : gaps.open) {
    if (across_gaps <= 0) break;
    const double size = std::max(gap.width / across_gaps, smallest_gap_size(options));
    if (size < options.minimum) sources.push_back({gap.point, size});
  }
  return sources;
}

/// Sizes that differ by rounding alone.
bool is_same(double a, double b) {
  constexpr double rounding = 1e-9;  // relative
  return std::abs(a - b) <= rounding * std::max(std::abs(a), std::abs(b));
}

/// Requested cells over leaves, from which on a field has clearly more leaves: cells may lie in
/// several regions, and are counted with some to spare.
constexpr double most_cells_per_leaf = 4;

bool are_same_sizes(const SizingOptions& a, const SizingOptions& b) {
  return is_same(a.minimum, b.minimum) && is_same(a.maximum, b.maximum) &&
         is_same(a.surface_maximum, b.surface_maximum) && is_same(a.growth, b.growth) &&
         is_same(a.curvature_angle, b.curvature_angle) && is_same(a.proximity, b.proximity) &&
         is_same(elements_across_gaps(a), elements_across_gaps(b)) &&
         is_same(a.chordal_deviation, b.chordal_deviation) && is_same(a.feature_aspect, b.feature_aspect) &&
         is_same(smallest_feature_size(a), smallest_feature_size(b)) &&
         is_same(smallest_narrow_size(a), smallest_narrow_size(b)) &&
         is_same(smallest_gap_size(a), smallest_gap_size(b));
}

}  // namespace

FieldFactory::FieldFactory(SampledModel sampled, GapDemand gaps, Fields fields, SizeRequests requests)
    : _sampled(std::move(sampled)),
      _requests(_sampled, std::move(requests)),
      _gaps(_sampled, gaps),
      _fields(fields) {}

FieldFactory::FieldFactory(FieldFactory&& before, const cad::Model& joined)
    : _sampled(std::move(before._sampled), joined),
      _requests(std::move(before._requests), _sampled),
      _gaps(std::move(before._gaps), _sampled),
      _fields(before._fields) {
  for (const SampledFace& face : _sampled.own_faces()) {
    if (model().sheet_count(face.id) > 1) continue;
    auto samples = before._samples.extract(model().members(face.id).front());
    if (samples.empty()) continue;
    samples.key() = face.id;
    _samples.insert(std::move(samples));
  }
}

void FieldFactory::request_lines(std::vector<SizeLine> lines) {
  _requests.set_lines(std::move(lines));
  _estimates.clear();
}

std::vector<SizeSource> FieldFactory::sample_own(const SizingOptions& given, double coarsening) {
  std::vector<SizeSource> mine;
  const auto keep = [&](const std::vector<SizeSource>& more) {
    mine.insert(mine.end(), more.begin(), more.end());
  };
  for (const SampledFace& face : _sampled.own_faces()) {
    const bool far_field = _sampled.bounds_far_field(face.id);
    const SizingOptions options = _requests.options_on(_sampled, face.id, given);
    FaceSamples once(model().is_planar(face.id));
    std::vector<SizeSource> sources =
        samples_of(face.id, once).sources(model(), face.id, face.facets, far_field, options, coarsening);
    const std::vector<SizeSource> narrow =
        narrow_sources(model(), face.facets, face.closed_corners, options, largest_size(far_field, options));
    sources.insert(sources.end(), narrow.begin(), narrow.end());
    keep(thin_sources(_sampled.root(), sources));
    if (const Gaps* gaps = _gaps.of_face(face.id)) keep(gap_sources(*gaps, options));
  }
  keep(_sampled.sample_own_edges(given));
  return mine;
}

std::vector<double> FieldFactory::sizes_at(std::span<const geometry::Vec3> points,
                                           std::span<const SizeSource> own,
                                           const SizingOptions& options) const {
  std::vector<double> sizes(points.size(), options.maximum);
  {
    ScopedCpu cpu(ScopedCpu::As::task);
    const SourceTree sources(points.empty() ? std::span<const SizeSource>() : own, std::log(options.growth));
    for (std::size_t i = 0; i < points.size(); ++i) sizes[i] = sources.least(points[i], options.maximum);
  }
  _sampled.communicator().minimum_each(sizes);
  return sizes;
}

std::vector<SizeSource> FieldFactory::sample_corners(std::span<const SizeSource> own,
                                                     const SizingOptions& options) const {
  const std::vector<cad::FaceCorner>& corners = _sampled.own_corners();
  std::vector<geometry::Vec3> points;
  points.reserve(corners.size());
  for (const cad::FaceCorner& corner : corners) points.push_back(model().vertex(corner.vertex));
  const auto before = static_cast<std::size_t>(
      _sampled.communicator().exclusive_scan(static_cast<std::int64_t>(points.size())));
  points = _sampled.communicator().all_gather_items<geometry::Vec3>(points);
  const std::vector<double> sizes = sizes_at(points, own, options);
  std::vector<SizeSource> mine;
  parallel::collectively(_sampled.communicator(), ScopedCpu::As::task, [&] {
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const auto more = corner_sources(model(), corners[i], sizes[before + i], options);
      mine.insert(mine.end(), more.begin(), more.end());
    }
  });
  return mine;
}

std::vector<SizeSource> FieldFactory::sample(const SizingOptions& options, double coarsening,
                                             Requests which) {
  check_options(options);
  require_possible(options);
  std::vector<SizeSource> mine;
  parallel::collectively(_sampled.communicator(), ScopedCpu::As::task,
                         [&] { mine = sample_own(options, coarsening); });
  const std::vector<SizeSource> behind_corners = sample_corners(mine, options);
  mine.insert(mine.end(), behind_corners.begin(), behind_corners.end());
  for (SizeSource& source : mine) source.size *= coarsening;
  const std::vector<SizeSource> requested = _requests.sample(_sampled, options, coarsening, which);
  mine.insert(mine.end(), requested.begin(), requested.end());
  return mine;
}

std::vector<double> FieldFactory::sizes_without_features(std::span<const geometry::Vec3> places,
                                                         const SizingOptions& options) {
  SizingOptions without = options;
  without.feature_minimum = without.narrow_minimum = options.maximum;
  std::vector<double> sizes = sizes_at(places, sample(without, 1, Requests::all), options);
  for (double& size : sizes) size = std::max(size, options.minimum);
  return sizes;
}

SizeField FieldFactory::build_field(const SizingOptions& options) {
  return FieldBuilder(_sampled.communicator(), model().bounds(), options)
      .build(sample(options, 1, Requests::all));
}

std::optional<SizeField> FieldFactory::build_coarser(const SizingOptions& options, double coarsening,
                                                     Requests which, std::int64_t most_leaves) {
  if (_requests.ask_for_more_cells(_sampled, options, coarsening, which,
                                   most_cells_per_leaf * static_cast<double>(most_leaves)))
    return std::nullopt;
  SizingOptions coarse = options;
  for (double* size : {&coarse.minimum, &coarse.feature_minimum, &coarse.narrow_minimum, &coarse.gap_minimum,
                       &coarse.surface_maximum, &coarse.maximum})
    *size *= coarsening;
  if (coarsening > 1) coarse.growth = std::min(std::pow(options.growth, coarsening), largest_growth);
  return FieldBuilder(_sampled.communicator(), model().bounds(), coarse)
      .build_within(sample(options, coarsening, which), most_leaves);
}

std::optional<Trial> FieldFactory::try_sizes(const SizingOptions& options, std::int64_t most_leaves) {
  std::optional<SizeField> field = build_coarser(options, 1, Requests::aimed, most_leaves);
  if (!field) return std::nullopt;
  const double tetrahedra = count_tetrahedra(_sampled, *field);
  return Trial{std::move(*field), tetrahedra};
}

std::optional<double> FieldFactory::estimate_tetrahedra(const SizingOptions& options, double coarsening,
                                                        std::int64_t most_leaves) {
  const auto known = std::find_if(_estimates.begin(), _estimates.end(), [&](const Estimate& each) {
    return each.coarsening == coarsening && are_same_sizes(each.options, options);
  });
  if (known != _estimates.end())
    return known->leaves > most_leaves ? std::nullopt : std::optional(known->tetrahedra);
  const std::optional<SizeField> field = build_coarser(options, coarsening, Requests::aimed, most_leaves);
  if (!field) return std::nullopt;
  const double tetrahedra = std::pow(coarsening, 3) * count_tetrahedra(_sampled, *field);
  _estimates.push_back({options, coarsening, field->leaf_count(), tetrahedra});
  return tetrahedra;
}

SizeField build_size_field(const parallel::Communicator& communicator, const cad::Model& model,
                           const SizingOptions& options) {
  check_options(options);
  return FieldFactory(SampledModel(communicator, model), gap_demand(options), Fields::one)
      .build_field(options);
}

}  // namespace aeroloom::sizing
