/// Which cusps of faces can be closed, by what the triangles around them are. Seen by this folder only.
#pragma once

#include "mesh/data/distributed_mesh.hpp"
#include "surface/curves/curves.hpp"

#include <array>
#include <vector>

namespace aeroloom::surface {

/// The vertices of two curves that could become one, from the CAD vertex on.
struct Cusp {
  cad::FaceId face;
  cad::VertexId vertex;
  std::vector<std::array<CurveVertex, 2>> pairs;
};

/// Which vertex of which curve each vertex of a piece is; -1 for others.
std::vector<CurveVertex> curve_vertices(const CurveMesh& curves, const mesh::Piece& piece);

/// Ranks of the vertices of a piece in a cusp: 0 the CAD vertex, i the pair i; -1 elsewhere.
std::vector<std::int32_t> levels_in_cusp(const Cusp& cusp, const std::vector<CurveVertex>& on_curve);

/// The highest of a triangle's ranks in a cusp, -1 where not all of its vertices are in it.
std::int32_t level_of_triangle(const mesh::LocalIndex* triangle, const std::vector<std::int32_t>& ranks);

/// Cusps cut to the pairs that can become one, without those that have none: the triangles between the curves
/// have no other vertices, one triangle ends them, and other faces neither join the two curves nor have
/// triangles on both that would become one. Collective.
std::vector<Cusp> closable_cusps(const CurveMesh& curves, const mesh::DistributedMesh& surface,
                                 std::vector<Cusp> cusps);

}  // namespace aeroloom::surface
