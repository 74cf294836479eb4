/// Decides from the triangles around them which cusps can be closed. Internal to this folder.
#pragma once

#include "mesh/data/distributed_mesh.hpp"
#include "surface/curves/curves.hpp"

#include <array>
#include <vector>

namespace aeroloom::surface {

/// A cusp, with the pairs of vertices on its two curves that may be merged, from the CAD vertex on.
struct Cusp {
  cad::FaceId face;
  cad::VertexId vertex;
  std::vector<std::array<CurveVertex, 2>> pairs;
};

/// The curve vertex at each vertex of a piece; -1 for others.
std::vector<CurveVertex> curve_vertices(const CurveMesh& curves, const mesh::Piece& piece);

/// The level of each vertex of a piece in a cusp: 0 for the CAD vertex, i for pair i (from 1); -1 elsewhere.
std::vector<std::int32_t> levels_in_cusp(const Cusp& cusp, const std::vector<CurveVertex>& on_curve);

/// The highest level of the vertices of a triangle; -1 where one of them is not in the cusp.
std::int32_t level_of_triangle(const mesh::LocalIndex* triangle, const std::vector<std::int32_t>& ranks);

/// The cusps that can be closed, each with the pairs that can be merged. The triangles between the curves
/// must have no other vertices, and one triangle must end them. Other faces must not join the two curves, or
/// have triangles on both that would coincide. Collective.
std::vector<Cusp> closable_cusps(const CurveMesh& curves, const mesh::DistributedMesh& surface,
                                 std::vector<Cusp> cusps);

}  // namespace aeroloom::surface
