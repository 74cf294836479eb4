/// Half far fields, and what holds for every half model.
#pragma once

#include "cad/domain/domain.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

namespace aeroloom::cad::half_models {

struct FarField {
  const char* name;
  FarFieldShape shape;
  Axis axis = Axis::x;  ///< of the cylinder
};

/// Half far fields at a plane normal to y: the cylinders' axes lie in it or stand on it.
inline const FarField far_fields[] = {
    {"Hemisphere", FarFieldShape::hemisphere},
    {"HalfSphere", FarFieldShape::sphere},
    {"HalfBox", FarFieldShape::box},
    {"HalfCylinderAlongX", FarFieldShape::cylinder, Axis::x},
    {"HalfCylinderAlongZ", FarFieldShape::cylinder, Axis::z},
    {"HalfCylinderAcross", FarFieldShape::cylinder, Axis::y},
};

/// Of half a far field that reaches a radius from its centre on the plane.
inline double volume(const FarField& far_field, double radius) {
  const double cube = radius * radius * radius;
  switch (far_field.shape) {
    case FarFieldShape::box:
      return 4 * cube;
    case FarFieldShape::cylinder:
      return std::numbers::pi * cube;
    case FarFieldShape::sphere:
    case FarFieldShape::hemisphere:
      break;
  }
  return 2 * std::numbers::pi / 3 * cube;
}

/// A coordinate that everything on a plane must have, bit for bit: a negative zero is no zero.
class ExactCoordinate {
public:
  ExactCoordinate(int axis, double position) : _axis(axis), _position(position) {}

  void check(Vec3 p, const char* what) const {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(p[_axis]), std::bit_cast<std::uint64_t>(_position))
        << what << " at " << p[_axis] << ", the plane at " << _position;
  }

  /// Facets, evaluations and projections of a face, its edges and vertices.
  void check_face(const Model& model, FaceId f) const {
    const Facets facets = model.facets(f, 0.01 * model.bounds().diagonal(), 0.2);
    Vec3 beside{0.01, 0.02, 0.03};
    for (std::size_t i = 0; i < facets.points.size(); ++i) {
      check(facets.points[i], "facet");
      check(model.face_point(f, facets.uv[i]), "face point");
      check(model.face_frame(f, facets.uv[i]).point, "frame");
      check(model.project(f, facets.points[i] + beside, facets.uv[i]).point, "projection");
    }
    for (const auto& loop : model.face(f).loops) {
      for (const Coedge& use : loop) check_edge(model, use.edge);
    }
  }

private:
  void check_edge(const Model& model, EdgeId id) const {
    const Edge& edge = model.edge(id);
    check(model.vertex(edge.first), "vertex");
    check(model.vertex(edge.last), "vertex");
    for (const double share : {0.0, 0.137, 0.5, 0.861, 1.0}) {
      const double t = edge.first_parameter + share * (edge.last_parameter - edge.first_parameter);
      check(model.edge_point(id, t), "edge point");
    }
  }

  int _axis;
  double _position;
};

/// Everything of the model lies on one side of the plane, but for rounding in facets of faces that are not on
/// it.
inline void expect_one_side(const Model& model, int axis, double position, bool positive) {
  const double rounding = 1e-14 * model.bounds().diagonal();
  double least = model.bounds().diagonal();
  for (FaceId f = 0; f < model.face_count(); ++f) {
    for (const Vec3 p : model.facets(f, 0.01 * model.bounds().diagonal(), 0.2).points)
      least = std::min(least, positive ? p[axis] - position : position - p[axis]);
  }
  EXPECT_NEAR(least, 0, rounding);
}

}  // namespace aeroloom::cad::half_models
