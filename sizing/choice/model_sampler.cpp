#include "sizing/choice/model_sampler.hpp"

#include "parallel/communication/schedule.hpp"
#include "parallel/observation/progress.hpp"
#include "parallel/observation/timers.hpp"
#include "sizing/field/curvature_size.hpp"
#include "sizing/field/field_builder.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

namespace aeroloom::sizing {
namespace {

using cad::FaceId;
using parallel::ScopedCpu;

/// Areas of all faces, each measured by one rank.
std::vector<double> measure_faces(const parallel::Communicator& communicator, const cad::Model& model) {
  std::vector<double> mine, areas(model.face_count());
  parallel::collectively(communicator, ScopedCpu::As::task, [&] {
    for (FaceId f = communicator.rank(); f < model.face_count(); f += communicator.size()) {
      mine.push_back(model.face_area(f));
    }
  });
  const std::vector<double> all = communicator.all_gather_items<double>(mine);
  std::size_t next = 0;
  for (int rank = 0; rank < communicator.size(); ++rank) {
    for (FaceId f = rank; f < model.face_count(); f += communicator.size()) areas[f] = all[next++];
  }
  return areas;
}

/// Loads by which faces are distributed for sampling: a share for each face, and its share of the body's
/// area.
std::vector<double> predict_sampling_loads(const std::vector<bool>& far_field,
                                           const std::vector<double>& areas) {
  double body_area = 0;
  for (std::size_t f = 0; f < areas.size(); ++f) body_area += far_field[f] ? 0 : areas[f];
  std::vector<double> loads(areas.size(), 1);
  for (std::size_t f = 0; f < areas.size(); ++f) {
    if (!far_field[f] && body_area > 0)
      loads[f] += 100 * static_cast<double>(areas.size()) * areas[f] / body_area;
  }
  return loads;
}

bool only_far_field(const cad::Edge& edge, const std::vector<bool>& far_field) {
  return std::all_of(edge.faces.begin(), edge.faces.end(), [&](FaceId f) { return far_field[f]; });
}

/// Widths are measured at places this far apart, at least, over the widest.
constexpr double finest_strip = 0.01;
/// Parts of strips by which their elements are counted are this many times as long as wide, at most.
constexpr double aspect_of_parts = 8;
constexpr double largest_aspect = 1e30;  // finite, for widths of nothing

/// Sources in gaps and thin bodies.
std::vector<SizeSource> gap_sources(const Gaps& gaps, const SizingOptions& options) {
  std::vector<SizeSource> sources;
  const double across_gaps = elements_across_gaps(options);
  for (const Gap& gap : gaps.seen) {
    const double elements = gap.is_meshed ? across_gaps : options.proximity;
    const double size = std::max(gap.width / elements, options.minimum);
    if (elements > 0 && size < options.maximum) sources.push_back({gap.point, size});
  }
  for (const Gap& gap : gaps.open) {
    if (across_gaps <= 0) break;
    const double size = std::max(gap.width / across_gaps, smallest_gap_size(options));
    if (size < options.minimum) sources.push_back({gap.point, size});
  }
  return sources;
}

}  // namespace

ModelSampler::ModelSampler(const parallel::Communicator& communicator, const cad::Model& model, double layers,
                           Fields fields, SizeDemands demands)
    : _communicator(communicator),
      _model(model),
      _layers(layers),
      _fields(fields),
      _demands(std::move(demands)),
      _root(model.bounds()),
      _asked_on_faces(sizes_on_faces(model, _demands)),
      _areas(measure_faces(communicator, model)) {
  parallel::collectively(communicator, ScopedCpu::As::task, [&] {
    _far_field = find_far_field(model);
    const std::vector<double> loads = predict_sampling_loads(_far_field, _areas);
    _owners = parallel::assign_largest_first(loads, communicator.size());
    parallel::Progress progress("sizing", model.face_count(), "faces");
    for (FaceId f = 0; f < model.face_count(); ++f) {
      const bool mine = _owners[f] == communicator.rank();
      const double begin = parallel::cpu_seconds();
      if (mine) add_face(f);
      if (mine)
        parallel::note_task({parallel::TaskKind::sampled_face, f, loads[f], parallel::cpu_seconds() - begin});
      progress.advance(1, mine ? 1 : 0);
    }
    list_corners();
  });
  gather_triangles();
  lay_surfaces();
  measure_gaps(Notes::tell);
}

ModelSampler::ModelSampler(ModelSampler&& before, const cad::Model& joined)
    : _communicator(before._communicator),
      _model(joined),
      _layers(before._layers),
      _fields(before._fields),
      _demands(std::move(before._demands)),
      _root(before._root),
      _asked_on_faces(sizes_on_faces(joined, _demands)),
      _part_on_boundary(std::move(before._part_on_boundary)),
      _walls(std::move(before._walls)),
      _surfaces(std::move(before._surfaces)),
      _body_box(before._body_box) {
  parallel::collectively(_communicator, ScopedCpu::As::task, [&] {
    std::vector<FaceId> number(before._model.face_count());
    for (FaceId f = 0; f < joined.face_count(); ++f) {
      const std::vector<FaceId> members = joined.members(f);
      _far_field.push_back(before._far_field[members.front()]);
      _owners.push_back(before._owners[members.front()]);
      _areas.push_back(0);
      for (const FaceId member : members) _areas[f] += before._areas[member], number[member] = f;
    }
    for (Wall& wall : _walls->facets) wall.face = number[wall.face];
    take_faces(std::move(before._faces), number);
    list_corners();
  });
  measure_gaps(Notes::were_told);
}

void ModelSampler::add_face(FaceId id) {
  _faces.push_back(
      {id, sampling_facets(_model, id, _far_field[id]), FaceSamples(_model.is_planar(id)), std::nullopt});
}

void ModelSampler::take_faces(std::vector<OwnFace> before, const std::vector<FaceId>& number) {
  for (OwnFace& face : before) {
    const FaceId now = number[face.id];
    if (_model.sheet_count(now) > 1) continue;
    face.id = now;
    // Between walls that meet in an edge there is no gap: neighbours that were joined share more edges.
    const auto is_joined = [&](FaceId other) { return _model.sheet_count(other) > 1; };
    const bool neighbours_joined =
        std::any_of(face.facets.boundary.begin(), face.facets.boundary.end(), [&](const auto& line) {
          const std::vector<FaceId>& users = _model.edge(line.use.edge).faces;
          return std::any_of(users.begin(), users.end(), is_joined);
        });
    if (neighbours_joined) face.gaps.reset();
    _faces.push_back(std::move(face));
  }
  for (FaceId f = 0; f < _model.face_count(); ++f) {
    if (_model.sheet_count(f) > 1 && _owners[f] == _communicator.rank()) add_face(f);
  }
  std::sort(_faces.begin(), _faces.end(), [](const OwnFace& a, const OwnFace& b) { return a.id < b.id; });
}

void ModelSampler::list_corners() {
  for (OwnFace& face : _faces) {
    face.closed_corners.clear();  // edges are the same in every model, what lies beyond them need not be
    for (const cad::FaceCorner& corner : cad::corners_of(_model, face.id)) {
      if (!may_be_sharp(_model, corner)) continue;
      _corners.push_back(corner);
      if (is_closed_corner(_model, corner))
        face.closed_corners.push_back(std::minmax(corner.arriving.edge, corner.leaving.edge));
    }
  }
}

void ModelSampler::gather_triangles() {
  std::vector<Wall> mine;
  parallel::collectively(_communicator, ScopedCpu::As::task, [&] {
    for (const OwnFace& face : _faces) {
      if (_model.face(face.id).back != cad::no_entity && !_far_field[face.id]) continue;
      const auto& points = face.facets.points;
      const std::vector<double> deviations = facet_deviations(_model, face.id, face.facets);
      for (std::size_t i = 0; i < deviations.size(); ++i) {
        const auto& [a, b, c] = face.facets.triangles[i];
        const auto& uv = face.facets.uv;
        mine.push_back({face.id, {points[a], points[b], points[c]}, {uv[a], uv[b], uv[c]}, deviations[i]});
      }
    }
  });
  std::vector<Wall> all = _communicator.all_gather_items<Wall>(mine);
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.face < b.face; });
  ScopedCpu cpu(ScopedCpu::As::repeated);
  std::vector<Triangle> boundary;
  for (const Wall& t : all) {
    if (!_far_field[t.face]) {
      for (const geometry::Vec3 p : t.corners) _body_box.add(p);
    }
    if (_model.face(t.face).back == cad::no_entity) boundary.push_back(t.corners);
  }
  // Without faces between regions the walls are the boundary: one tree serves both.
  if (boundary.size() < all.size()) _part_on_boundary.emplace(std::move(boundary));
  _walls.emplace(std::move(all));
  if (_body_box.empty()) _body_box = _model.bounds();
}

std::vector<SizeSource> ModelSampler::sample_own(const SizingOptions& given, double coarser) {
  std::vector<SizeSource> mine;
  const auto keep = [&](const std::vector<SizeSource>& more) {
    mine.insert(mine.end(), more.begin(), more.end());
  };
  for (OwnFace& face : _faces) {
    const bool far_field = _far_field[face.id];
    const SizingOptions options = options_on(face.id, given);
    FaceSamples once(_model.is_planar(face.id));
    FaceSamples& samples = _fields == Fields::several ? face.samples : once;
    std::vector<SizeSource> sources =
        samples.sources(_model, face.id, face.facets, far_field, options, coarser);
    const std::vector<SizeSource> strips =
        strip_sources(_model, face.facets, face.closed_corners, options, largest_size(far_field, options));
    sources.insert(sources.end(), strips.begin(), strips.end());
    keep(thin_sources(_root, sources));
    if (face.gaps) keep(gap_sources(*face.gaps, options));
  }
  for (cad::EdgeId e = _communicator.rank(); e < _model.edge_count(); e += _communicator.size()) {
    keep(edge_sources(_model, e, only_far_field(_model.edge(e), _far_field), given));
  }
  return mine;
}

std::vector<double> ModelSampler::sizes_at(std::span<const geometry::Vec3> points,
                                           std::span<const SizeSource> own,
                                           const SizingOptions& options) const {
  std::vector<double> sizes(points.size(), options.maximum);
  {
    ScopedCpu cpu(ScopedCpu::As::task);
    const double slope = std::log(options.growth);
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (const SizeSource& s : own)
        sizes[i] = std::min(sizes[i], s.size + slope * distance(s.point, points[i]));
    }
  }
  _communicator.minimum_each(sizes);
  return sizes;
}

std::vector<SizeSource> ModelSampler::sample_corners(std::span<const SizeSource> own,
                                                     const SizingOptions& options) const {
  std::vector<geometry::Vec3> points;
  for (const cad::FaceCorner& corner : _corners) points.push_back(_model.vertex(corner.vertex));
  const auto before =
      static_cast<std::size_t>(_communicator.exclusive_scan(static_cast<std::int64_t>(points.size())));
  points = _communicator.all_gather_items<geometry::Vec3>(points);
  const std::vector<double> sizes = sizes_at(points, own, options);
  std::vector<SizeSource> mine;
  parallel::collectively(_communicator, ScopedCpu::As::task, [&] {
    for (std::size_t i = 0; i < _corners.size(); ++i) {
      const auto more = corner_sources(_model, _corners[i], sizes[before + i], options);
      mine.insert(mine.end(), more.begin(), more.end());
    }
  });
  return mine;
}

std::vector<SizeSource> ModelSampler::sample(const SizingOptions& options, double coarser) {
  check_options(options);
  require_possible(options);
  std::vector<SizeSource> mine;
  parallel::collectively(_communicator, ScopedCpu::As::task, [&] { mine = sample_own(options, coarser); });
  const std::vector<SizeSource> behind_corners = sample_corners(mine, options);
  mine.insert(mine.end(), behind_corners.begin(), behind_corners.end());
  for (SizeSource& source : mine) source.size *= coarser;
  const std::vector<SizeSource> demanded = sample_demands(options, coarser);
  mine.insert(mine.end(), demanded.begin(), demanded.end());
  return mine;
}

std::vector<Strip> ModelSampler::strips_narrower_than(double width, double minimum) const {
  SizingOptions options;
  options.minimum = minimum;
  options.maximum = width;
  options.strip_minimum = finest_strip * width;
  std::vector<Strip> mine;
  parallel::collectively(_communicator, ScopedCpu::As::task, [&] {
    for (const OwnFace& face : _faces) {
      Strip narrowest{face.id, width, {}};
      for (const StripPart& part : strip_parts(_model, face.facets, face.closed_corners, options, width)) {
        if (part.first_width < narrowest.width) narrowest = {face.id, part.first_width, part.first};
        if (part.last_width < narrowest.width) narrowest = {face.id, part.last_width, part.last};
      }
      if (narrowest.width < width) mine.push_back(narrowest);
    }
  });
  std::vector<Strip> all =
      _communicator.gather_sorted(mine, [](const Strip& each) { return std::pair(each.width, each.face); });
  return all;
}

std::vector<double> ModelSampler::elements_along_strips(std::span<const double> aspects,
                                                        const SizingOptions& options) const {
  struct FaceElements {
    FaceId face;
    std::int32_t aspect;
    double elements;

    static constexpr auto fields() {
      return std::tuple(&FaceElements::face, &FaceElements::aspect, &FaceElements::elements);
    }
  };
  SizingOptions rough = options;
  rough.feature_aspect = aspect_of_parts;
  std::vector<FaceElements> mine;
  parallel::collectively(_communicator, ScopedCpu::As::task, [&] {
    SizingOptions sizes = options;
    for (const OwnFace& face : _faces) {
      const auto parts = strip_parts(_model, face.facets, face.closed_corners, rough, options.minimum);
      for (std::size_t i = 0; i < aspects.size() && !parts.empty(); ++i) {
        sizes.feature_aspect = std::min(aspects[i], largest_aspect);
        double sum = 0;
        for (const StripPart& part : parts) {
          const double width = 0.5 * (part.first_width + part.last_width);
          if (width >= options.minimum) continue;
          const double size = strip_size(width, sizes), on_top = 1 - size / options.minimum;
          sum += distance(part.first, part.last) / size * on_top * on_top;
        }
        mine.push_back({face.id, static_cast<std::int32_t>(i), sum});
      }
    }
  });
  // Summed in the order of faces, whatever the number of ranks.
  std::vector<FaceElements> all = _communicator.gather_sorted(
      mine, [](const FaceElements& each) { return std::pair(each.face, each.aspect); });
  std::vector<double> elements(aspects.size());
  for (const FaceElements& face : all) elements[face.aspect] += face.elements;
  return elements;
}

std::vector<double> ModelSampler::sizes_without_features(std::span<const geometry::Vec3> places,
                                                         const SizingOptions& options) {
  SizingOptions without = options;
  without.feature_minimum = without.strip_minimum = options.maximum;
  std::vector<double> sizes = sizes_at(places, sample(without, 1), options);
  for (double& size : sizes) size = std::max(size, options.minimum);
  return sizes;
}

}  // namespace aeroloom::sizing
