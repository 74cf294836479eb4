/// A model whose shapes are in a unit of the CAD library (library_unit.hpp), seen in the file's unit.
/// Internal to cad/.
#pragma once

#include "cad/model/model.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace aeroloom::cad {

/// The model in the file's unit; the same model for a unit of 1. Lengths come out multiplied by the unit, a
/// power of two, and so without rounding. Parameters stay as they are.
Model in_file_unit(Model model, double unit);

/// What a scaled model asks, and converts. Functions are those of Model.
struct ScaledModel {
  Model model;  ///< in the library's unit
  double unit;  ///< length of that unit in the file's

  Vec3 edge_point(EdgeId id, double parameter) const { return unit * model.edge_point(id, parameter); }
  Vec3 edge_tangent(EdgeId id, double parameter) const { return unit * model.edge_tangent(id, parameter); }
  double edge_curvature(EdgeId id, double parameter) const {
    return model.edge_curvature(id, parameter) / unit;
  }
  Vec3 face_point(FaceId id, Vec2 uv) const { return unit * model.face_point(id, uv); }
  SurfaceFrame face_frame(FaceId id, Vec2 uv) const;
  PrincipalCurvatures face_curvatures(FaceId id, Vec2 uv) const;
  CurvedPoint face_curved_point(FaceId id, Vec2 uv) const;
  Projection project(FaceId id, Vec3 point, Vec2 guess) const;
  double face_area(FaceId id) const;
  Vec3 face_area_vector(FaceId id) const;
  double region_volume(RegionId id) const;
  FacePlace face_place(FaceId id) const;
  Facets facets(FaceId id, double deflection, double angle, Model::Keep keep) const;
};

/// The model within a scaled one, with the patches that the scaled one has now.
Model within(const Model& scaled);

Box scaled(const Box& box, double factor);
FacePlace scaled(const FacePlace& place, double factor);

/// Bytes of a scaled model begin with a number of their own.
bool are_of_scaled_model(std::span<const std::byte> bytes);
Model scaled_from_bytes(std::span<const std::byte> bytes);

}  // namespace aeroloom::cad
