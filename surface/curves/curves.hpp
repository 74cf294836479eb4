/// CAD curves discretised once, under the size field.
#pragma once

#include "cad/model/model.hpp"
#include "mesh/data/shared_vertex_keys.hpp"
#include "sizing/field/size_field.hpp"
#include "surface/curves/sharp_corners.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::surface {

/// Index of a vertex on the curves: the model's CAD vertices first, then the interior vertices edge by edge.
using CurveVertex = std::int32_t;

/// All curve vertices of a model. Seams (edges that one face uses twice and no other face uses) and
/// degenerate edges carry no vertices: they do not constrain the mesh.
struct CurveMesh {
  std::vector<geometry::Vec3> points;        ///< by curve vertex
  std::vector<std::int32_t> first_interior;  ///< (edges + 1): the interior vertices of edge e are [e], [e+1]
  std::vector<double> parameters;  ///< by curve vertex minus the model's vertex count: on its edge, ascending
  std::vector<SharpCorner> sharp_corners;  ///< of all faces

  /// The vertices of an edge in the direction of its parameter, ends included; empty when it carries none.
  std::vector<CurveVertex> chain(const cad::Model& model, cad::EdgeId edge) const;
  /// Parameter of each vertex of chain().
  std::vector<double> chain_parameters(const cad::Model& model, cad::EdgeId edge) const;
  /// The edge that interior curve vertex v lies on; no_entity for CAD vertices.
  cad::EdgeId edge_of(const cad::Model& model, CurveVertex v) const;
  /// The name of a vertex, and back: ascending like the vertices, and the same as long as its own edge keeps
  /// its vertices.
  mesh::SharedVertexKey vertex_key(const cad::Model& model, CurveVertex v) const;
  CurveVertex vertex_of(mesh::SharedVertexKey vertex_key) const;
};

/// Whether an edge constrains the surface mesh (is neither degenerate nor a seam).
bool is_constraining(const cad::Model& model, cad::EdgeId edge);

/// Spreads vertices so that each segment has length 1 in the metric of the field (equal parts of the integral
/// of ds/h, at least enough segments that no two curves share both ends of a segment: three on a closed edge,
/// two where another edge joins the same vertices). At sharp corners of faces the first segment is longer
/// (sharp_corners.hpp), but not much at the CAD vertices in `short_legs` (ascending, the same on every rank).
/// Beside closed ones vertices lie opposite each other (cusp_alignment.hpp). Each edge is discretised by one
/// rank, the result is shared. Collective.
CurveMesh discretise_curves(const cad::Model& model, const sizing::SizeField& field,
                            std::span<const cad::VertexId> short_legs = {});

}  // namespace aeroloom::surface
