/// Periodic parameters of CAD faces: one point has several.
#pragma once

#include "cad/model/model.hpp"

#include <cmath>

namespace aeroloom::surface {

/// The parameter of the same place that is nearest to `reference`.
inline double unwrap(double parameter, double reference, double period) {
  return period > 0 ? parameter - period * std::round((parameter - reference) / period) : parameter;
}

/// The parameters of the same point nearest to `reference`. If the point lies in the parameter plane of
/// another part of a joined face (another sheet), `reference` itself.
inline geometry::Vec2 unwrap(const cad::Model& model, cad::FaceId face, geometry::Vec2 uv,
                             geometry::Vec2 reference) {
  if (model.sheet(face, uv) != model.sheet(face, reference)) return reference;
  const geometry::Vec2 periods = model.parameter_periods(face, reference);
  return {unwrap(uv.x, reference.x, periods.x), unwrap(uv.y, reference.y, periods.y)};
}

}  // namespace aeroloom::surface
