/// The angles at which pieces meet, measured between the edges of the fine mesh.
#pragma once

#include "surface/division/piece_problem.hpp"
#include "surface/surface_report.hpp"

#include <array>
#include <set>
#include <vector>

namespace aeroloom::surface {

/// The fine edges of a face on its CAD curves, by the names of their ends.
class FeatureEdges {
public:
  FeatureEdges(const ChartSurface& surface, const FaceVertices& vertices);
  bool contains(mesh::SharedVertexKey a, mesh::SharedVertexKey b) const;

private:
  std::set<std::array<mesh::SharedVertexKey, 2>> _edges;
};

/// Angles of the pieces of one face at the ends of cuts: where a cut meets a feature curve, and where three
/// cuts or more meet. Angles between two feature curves are not listed.
std::vector<CutAngle> measure_cut_angles(const std::vector<PieceProblem>& problems,
                                         const FeatureEdges& features);

}  // namespace aeroloom::surface
