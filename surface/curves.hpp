/// CAD curves discretised once, under the size field.
#pragma once

#include "geometry/model.hpp"
#include "mesh/piece.hpp"
#include "parallel/communicator.hpp"
#include "parallel/timers.hpp"
#include "sizing/size_field.hpp"
#include "surface/sharp_corners.hpp"

#include <cstdint>
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
  std::vector<CurveVertex> chain(const geometry::Model& model, geometry::EdgeId edge) const;
  /// Parameter of each vertex of chain().
  std::vector<double> chain_parameters(const geometry::Model& model, geometry::EdgeId edge) const;
  /// The edge that interior curve vertex v lies on; no_entity for CAD vertices.
  geometry::EdgeId edge_of(const geometry::Model& model, CurveVertex v) const;
  /// The name of a vertex, and back: ascending like the vertices, and the same as long as its own edge keeps
  /// its vertices.
  mesh::SharedToken token(const geometry::Model& model, CurveVertex v) const;
  CurveVertex vertex_of(mesh::SharedToken token) const;
};

/// The CAD edge in the name of an interior vertex of a curve, no_entity for CAD vertices and vertices on
/// cuts.
geometry::EdgeId edge_of_token(mesh::SharedToken token);
/// The name of vertex `index` on the cuts that one division (`group`, below 2^16) of a face made; index below
/// 2^24, face below 2^23.
mesh::SharedToken cut_token(geometry::FaceId face, std::int32_t group, std::int32_t index);
bool is_cut_token(mesh::SharedToken token);

/// Whether an edge constrains the surface mesh (is neither degenerate nor a seam).
bool is_constraining(const geometry::Model& model, geometry::EdgeId edge);

/// Spreads vertices so that each segment has length 1 in the metric of the field (equal parts of the integral
/// of ds/h, at least enough segments that no two curves share both ends of a segment: three on a closed edge,
/// two where another edge joins the same vertices). At sharp corners of faces the first segment is longer
/// (sharp_corners.hpp). Each edge is discretised by one rank, the result is
/// shared. Collective.
CurveMesh discretise_curves(const parallel::Communicator& communicator, const geometry::Model& model,
                            const sizing::SizeField& field, parallel::StageClock& clock);

}  // namespace aeroloom::surface
