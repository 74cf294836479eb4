/// Half models whose plane of symmetry is meshed again, and what holds for it.
#pragma once

#include "mesh/checks/intersection.hpp"
#include "mesh/checks/validity.hpp"
#include "mesh/quality/quality.hpp"
#include "surface/plane_remesher.hpp"
#include "surface/surface_mesher.hpp"
#include "tests/cad/cad_shapes.hpp"

#include <algorithm>
#include <bit>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::surface::testing {

using cad::Model;
using geometry::Vec3;
using mesh::SharedVertexKey;
using parallel::Communicator;

/// The fluid on one side of y = 0.
inline cad::DomainOptions half_domain(double extent) {
  cad::DomainOptions options;
  options.far_field = cad::FarFieldOptions{
      .shape = cad::FarFieldShape::hemisphere, .extent = extent, .symmetry = cad::Symmetry::y};
  return options;
}

struct Meshed {
  SurfaceMesh surface;
  std::vector<cad::FaceId> planes;
};

inline Meshed mesh_model(const Communicator& communicator, const Model& model,
                         const sizing::SizingOptions& sizes, const SurfaceOptions& options) {
  const sizing::SizeField field = sizing::build_size_field(communicator, model, sizes);
  return {mesh_surface(model, field, options), cad::shapes::faces_of_patch(model, "symmetry")};
}

inline PlaneConflicts remesh(const Model& model, const SurfaceOptions& options, Meshed& meshed) {
  return remesh_planes(model, meshed.surface.field, {meshed.planes, options}, meshed.surface);
}

/// Moves the vertices that `moved` has a place for.
inline void move_vertices(const std::function<std::optional<Vec3>(SharedVertexKey, Vec3)>& moved,
                          mesh::DistributedMesh& surface) {
  for (mesh::Piece& piece : surface.pieces) {
    for (std::size_t s = 0; s < piece.shared_vertices.size(); ++s) {
      const mesh::LocalIndex v = piece.shared_vertices[s];
      if (const auto to = moved(piece.shared_keys[s], piece.point(v))) piece.set_point(v, *to);
    }
  }
}

inline std::string hash_of(const mesh::DistributedMesh& surface) {
  return mesh::hash_mesh(mesh::number_mesh(surface));
}

inline bool is_of(const std::vector<cad::FaceId>& faces, const mesh::Piece& piece) {
  return std::find(faces.begin(), faces.end(), piece.common_face()) != faces.end();
}

/// Of the pieces of planes.
struct PlaneMeasures {
  double least_angle = 180, area = 0;
  std::int64_t pieces = 0, off = 0;  ///< off: vertices that do not have the coordinate of the plane exactly
};

inline PlaneMeasures measure_planes(const Communicator& communicator, const Meshed& meshed) {
  PlaneMeasures measures;
  for (const mesh::Piece& piece : meshed.surface.pieces) {
    if (!is_of(meshed.planes, piece)) continue;
    ++measures.pieces;
    for (mesh::LocalIndex v = 0; v < piece.vertex_count(); ++v)
      measures.off += std::bit_cast<std::uint64_t>(piece.point(v).y) != 0;
    for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const mesh::LocalIndex* v = piece.cell(t);
      const Vec3 a = piece.point(v[0]), b = piece.point(v[1]), c = piece.point(v[2]);
      measures.least_angle = std::min(measures.least_angle, mesh::smallest_angle(a, b, c));
      measures.area += 0.5 * norm(cross(b - a, c - a));
    }
  }
  measures.least_angle = communicator.minimum(measures.least_angle);
  measures.area = communicator.sum(measures.area);
  measures.pieces = communicator.sum(measures.pieces);
  measures.off = communicator.sum(measures.off);
  return measures;
}

/// Intersections that triangles of planes have a part in.
inline std::int64_t count_plane_hits(const Communicator& communicator, const Meshed& meshed) {
  std::vector<mesh::PieceId> planes;
  for (const mesh::Piece& piece : meshed.surface.pieces) {
    if (is_of(meshed.planes, piece)) planes.push_back(piece.id);
  }
  planes = communicator.all_gather_items<mesh::PieceId>(planes);
  const auto hits = mesh::find_intersections(meshed.surface);
  return std::count_if(hits.begin(), hits.end(), [&](const mesh::TriangleHit& hit) {
    return std::find(planes.begin(), planes.end(), hit.first_piece) != planes.end() ||
           std::find(planes.begin(), planes.end(), hit.second_piece) != planes.end();
  });
}

inline void expect_closed(const Meshed& meshed) {
  const auto report = mesh::check_surface_mesh(mesh::number_mesh(meshed.surface));
  EXPECT_TRUE(report.valid()) << report.violations.front();
}

}  // namespace aeroloom::surface::testing
