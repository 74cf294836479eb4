#include "pipeline/curved_ends.hpp"

#include "cad/model/evaluation/point_locator.hpp"

#include <algorithm>
#include <utility>

namespace aeroloom::pipeline {
namespace {

using geometry::Vec3;
using layers::EndPlace;

/// Vertices are farther than this fraction of the model from their CAD only where gaps were sewn.
constexpr double on_cad = 1e-6;

class CadEnds : public layers::CurvedEnds {
public:
  explicit CadEnds(cad::Model model)
      : _model(std::move(model)),
        _locator(_model),
        _tolerance(on_cad * _model.bounds().diagonal() + _model.sewn_gap()) {}

  Vec3 normal(std::int32_t face, Vec3 point) const override {
    const std::optional<cad::Vec2> uv = _locator.on_face(face, point, _tolerance);
    if (!uv) return {};
    const Vec3 found = _model.face_frame(face, *uv).normal;
    return found == Vec3{} ? mean_normal_about(face, point) : found;
  }

  std::optional<EndPlace> place(std::span<const std::int32_t> faces, Vec3 point) const override {
    EndPlace place;
    if (faces.size() == 1) {
      const std::optional<cad::Vec2> uv = _locator.on_face(faces[0], point, _tolerance);
      if (!uv) return std::nullopt;
      place.face = faces[0];
      place.parameters = {uv->x, uv->y};
      place.across[0] = normal(faces[0], point);
      return place;
    }
    if (faces.size() != 2) return std::nullopt;
    for (const std::vector<cad::Coedge>& loop : _model.face(faces[0]).loops) {
      for (const cad::Coedge& use : loop) {
        const cad::Edge& edge = _model.edge(use.edge);
        if (edge.degenerate || std::count(edge.faces.begin(), edge.faces.end(), faces[1]) == 0) continue;
        const std::optional<double> at = _locator.on_edge(use.edge, point, _tolerance);
        if (!at) continue;
        place.edge = use.edge;
        place.parameters = {*at, 0};
        place.across = across(faces, point, normalized(_model.edge_tangent(use.edge, *at)));
        return place;
      }
    }
    return std::nullopt;
  }

  Vec3 onto(const EndPlace& place, Vec3 point) const override {
    if (place.face >= 0) {
      const Vec3 found = _model.project(place.face, point, {place.parameters[0], place.parameters[1]}).point;
      return cad::onto_exact_plane(_model, place.face, found);
    }
    Vec3 found =
        _model.edge_point(place.edge, cad::project_on_edge(_model, place.edge, point, place.parameters[0]));
    for (const cad::FaceId face : _model.edge(place.edge).faces)
      found = cad::onto_exact_plane(_model, face, found);
    return found;
  }

private:
  /// At a pole, where the surface has no normal: the mean of those at places about it.
  Vec3 mean_normal_about(std::int32_t face, Vec3 point) const {
    constexpr double away = 100;  // tolerances; chosen, not measured
    Vec3 sum;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double step : {-away * _tolerance, away * _tolerance}) {
        Vec3 beside = point;
        beside[axis] += step;
        if (const auto uv = _locator.on_face(face, beside, 2 * away * _tolerance))
          sum += _model.face_frame(face, *uv).normal;
      }
    }
    return sum == Vec3{} ? sum : normalized(sum);
  }

  /// The normals of both faces, unless these are tangent.
  std::array<Vec3, 2> across(std::span<const std::int32_t> faces, Vec3 point, Vec3 tangent) const {
    constexpr double least_angle = 0.1;  // radians; chosen, not measured
    const Vec3 first = normal(faces[0], point), second = normal(faces[1], point);
    if (norm(cross(first, second)) > least_angle) return {first, second};
    return {first, normalized(cross(tangent, first))};
  }

  cad::Model _model;
  mutable cad::PointLocator _locator;  // keeps samples
  double _tolerance;
};

}  // namespace

std::shared_ptr<const layers::CurvedEnds> curved_ends_of(const cad::Model& model) {
  return std::make_shared<CadEnds>(model);
}

}  // namespace aeroloom::pipeline
