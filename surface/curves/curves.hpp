/// CAD curves discretised under the size field. Each is discretised once, for all its faces.
#pragma once

#include "cad/model/model.hpp"
#include "mesh/data/shared_vertex_keys.hpp"
#include "sizing/field/size_field.hpp"
#include "surface/curves/sharp_corners.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::surface {

/// Index of a vertex on the curves: CAD vertices first, then inner vertices edge by edge.
using CurveVertex = std::int32_t;

/// All curve vertices of a model. Seams and degenerate edges carry none, since they do not constrain the
/// mesh. (A seam is an edge that one face uses twice and no other face uses.)
struct CurveMesh {
  std::vector<geometry::Vec3> points;        ///< by curve vertex
  std::vector<std::int32_t> first_interior;  ///< (edges + 1): the interior vertices of edge e are [e], [e+1]
  std::vector<double> parameters;  ///< by curve vertex minus the model's vertex count: on its edge, ascending
  std::vector<SharpCorner> sharp_corners;  ///< of all faces

  /// The vertices of an edge along its parameter, ends included; empty where it carries none.
  std::vector<CurveVertex> chain(const cad::Model& model, cad::EdgeId edge) const;
  /// The parameter of each vertex of chain().
  std::vector<double> chain_parameters(const cad::Model& model, cad::EdgeId edge) const;
  /// The CAD edge that an inner vertex lies on; no_entity for CAD vertices.
  cad::EdgeId edge_of(const cad::Model& model, CurveVertex v) const;
  /// The key of a vertex, and the vertex of a key. Keys ascend with vertices. A key stays valid as long as
  /// the vertices of its own edge do not change.
  mesh::SharedVertexKey vertex_key(const cad::Model& model, CurveVertex v) const;
  CurveVertex vertex_of(mesh::SharedVertexKey vertex_key) const;
};

/// Whether an edge constrains the surface mesh: it is neither degenerate nor a seam.
bool is_constraining(const cad::Model& model, cad::EdgeId edge);

/// Places vertices so that each segment has length 1 in the metric of the field. The integral of ds/h is
/// divided into equal parts, at least as many as count_segments() asks for. At sharp corners of faces the
/// first segment is longer (sharp_corners.hpp), but limited at the CAD vertices in `short_legs` (ascending,
/// the same on every rank). Beside closed cusps vertices lie opposite each other (cusp_alignment.hpp). Each
/// edge is discretised by one rank and the result is broadcast to all ranks of the field. Collective.
CurveMesh discretise_curves(const cad::Model& model, const sizing::SizeField& field,
                            std::span<const cad::VertexId> short_legs = {});

}  // namespace aeroloom::surface
