#include "sizing/choice/sampled_model.hpp"

#include "parallel/communication/collective_error.hpp"
#include "parallel/communication/schedule.hpp"
#include "parallel/observation/progress.hpp"
#include "parallel/observation/timers.hpp"

#include <algorithm>
#include <utility>

namespace aeroloom::sizing {
namespace {

using cad::FaceId;
using parallel::ScopedCpu;

/// Loads by which faces are distributed for sampling: the same for each face, and its part of the body's
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

}  // namespace

SampledModel::SampledModel(const parallel::Communicator& communicator, const cad::Model& model,
                           const std::vector<FaceRole>& roles)
    : _communicator(communicator),
      _model(model),
      _root(model.bounds()),
      _far_field(find_far_field(communicator, model, roles)),
      _areas(measure_faces()) {
  parallel::collectively(communicator, ScopedCpu::As::task, [&] {
    const std::vector<double> loads = predict_sampling_loads(_far_field.faces, _areas);
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
}

SampledModel::SampledModel(SampledModel&& before, const cad::Model& joined)
    : _communicator(before._communicator),
      _model(joined),
      _root(before._root),
      _part_on_boundary(std::move(before._part_on_boundary)),
      _facets(std::move(before._facets)),
      _body_box(before._body_box) {
  _far_field.decision = before._far_field.decision;
  parallel::collectively(_communicator, ScopedCpu::As::task, [&] {
    std::vector<FaceId> number(before._model.face_count());
    for (FaceId f = 0; f < joined.face_count(); ++f) {
      const std::vector<FaceId> members = joined.members(f);
      _far_field.faces.push_back(before._far_field.faces[members.front()]);
      _owners.push_back(before._owners[members.front()]);
      _areas.push_back(0);
      for (const FaceId member : members) _areas[f] += before._areas[member], number[member] = f;
    }
    for (ModelFacet& facet : _facets->items) facet.face = number[facet.face];
    take_faces(std::move(before._faces), number);
    list_corners();
  });
}

std::vector<double> SampledModel::measure_faces() const {
  std::vector<double> mine, areas(_model.face_count());
  parallel::collectively(_communicator, ScopedCpu::As::task, [&] {
    for (FaceId f = _communicator.rank(); f < _model.face_count(); f += _communicator.size()) {
      mine.push_back(_model.face_area(f));
    }
  });
  const std::vector<double> all = _communicator.all_gather_items<double>(mine);
  std::size_t next = 0;
  for (int rank = 0; rank < _communicator.size(); ++rank) {
    for (FaceId f = rank; f < _model.face_count(); f += _communicator.size()) areas[f] = all[next++];
  }
  return areas;
}

void SampledModel::add_face(FaceId id) {
  _faces.push_back({id, sampling_facets(_model, id, _far_field.faces[id])});
}

void SampledModel::take_faces(std::vector<SampledFace> before, const std::vector<FaceId>& number) {
  for (SampledFace& face : before) {
    const FaceId now = number[face.id];
    if (_model.sheet_count(now) > 1) continue;
    face.id = now;
    _faces.push_back(std::move(face));
  }
  for (FaceId f = 0; f < _model.face_count(); ++f) {
    if (_model.sheet_count(f) > 1 && _owners[f] == _communicator.rank()) add_face(f);
  }
  std::sort(_faces.begin(), _faces.end(),
            [](const SampledFace& a, const SampledFace& b) { return a.id < b.id; });
}

void SampledModel::list_corners() {
  for (SampledFace& face : _faces) {
    face.closed_corners.clear();  // edges are the same in every model, what lies beyond them need not be
    for (const cad::FaceCorner& corner : cad::corners_of(_model, face.id)) {
      if (!may_be_sharp(_model, corner)) continue;
      _corners.push_back(corner);
      if (is_closed_corner(_model, corner))
        face.closed_corners.push_back(std::minmax(corner.arriving.edge, corner.leaving.edge));
    }
  }
}

void SampledModel::gather_triangles() {
  std::vector<ModelFacet> mine;
  parallel::collectively(_communicator, ScopedCpu::As::task, [&] {
    for (const SampledFace& face : _faces) {
      if (_model.face(face.id).back != cad::no_entity && !_far_field.faces[face.id]) continue;
      const auto& points = face.facets.points;
      const std::vector<double> deviations = facet_deviations(_model, face.id, face.facets);
      const std::vector<double> curvatures = facet_curvatures(_model, face.id, face.facets);
      for (std::size_t i = 0; i < deviations.size(); ++i) {
        const auto& [a, b, c] = face.facets.triangles[i];
        const auto& uv = face.facets.uv;
        mine.push_back({face.id,
                        {points[a], points[b], points[c]},
                        {uv[a], uv[b], uv[c]},
                        deviations[i],
                        curvatures[i]});
      }
    }
  });
  std::vector<ModelFacet> all = _communicator.all_gather_items<ModelFacet>(mine);
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.face < b.face; });
  ScopedCpu cpu(ScopedCpu::As::repeated);
  std::vector<Triangle> boundary;
  for (const ModelFacet& t : all) {
    if (!_far_field.faces[t.face]) {
      for (const geometry::Vec3 p : t.corners) _body_box.add(p);
    }
    if (_model.face(t.face).back == cad::no_entity) boundary.push_back(t.corners);
  }
  // Without faces between regions all facets are the boundary: one tree serves both.
  if (boundary.size() < all.size()) _part_on_boundary.emplace(std::move(boundary));
  _facets.emplace(std::move(all));
  if (_body_box.empty()) _body_box = _model.bounds();
}

std::vector<SizeSource> SampledModel::sample_own_edges(const SizingOptions& options) const {
  std::vector<SizeSource> sources;
  for (cad::EdgeId e = _communicator.rank(); e < _model.edge_count(); e += _communicator.size()) {
    const std::vector<FaceId>& faces = _model.edge(e).faces;
    const bool only_far_field =
        std::all_of(faces.begin(), faces.end(), [&](FaceId f) { return _far_field.faces[f]; });
    const auto more = edge_sources(_model, e, only_far_field, options);
    sources.insert(sources.end(), more.begin(), more.end());
  }
  return sources;
}

}  // namespace aeroloom::sizing
