/// Angles at which cuts between pieces meet, measured between edges of the fine mesh.
#pragma once

#include "surface/division/piece_problem.hpp"
#include "surface/surface_report.hpp"

#include <array>
#include <set>
#include <vector>

namespace aeroloom::surface {

/// The fine edges of a face on its CAD curves, by the keys of their ends.
class FeatureEdges {
public:
  FeatureEdges(const ChartSurface& surface, const FaceVertices& vertices);
  bool contains(mesh::SharedVertexKey a, mesh::SharedVertexKey b) const;

private:
  std::set<std::array<mesh::SharedVertexKey, 2>> _edges;
};

/// The angles of the pieces of one face where cuts end: on a feature curve, or where three cuts or more meet.
/// Angles between two feature curves are not listed.
std::vector<CutAngle> measure_cut_angles(const std::vector<PieceProblem>& problems,
                                         const FeatureEdges& features);

}  // namespace aeroloom::surface
