/// Options of the surface stage.
#pragma once

#include <cstdint>
#include <vector>

namespace aeroloom::surface {

/// How a surface is cut into pieces: one per CAD face, or as many as the load asks for.
enum class SurfaceDecomposition : std::int8_t { faces, pieces };

/// Steps that improve the cuts of a face. Benchmarks leave one out to measure its effect.
struct DivisionSteps {
  bool contraction = true;    ///< of arcs of the dual graph, before it is partitioned
  bool repair = true;         ///< of disconnected parts: stray components join a neighbour
  bool widening = true;       ///< of wedges below the cut angle: they join the part beside them
  bool straightening = true;  ///< of the borders between parts
};

/// Rows of right-angled triangles along a CAD edge, on the faces beside it.
struct EdgeRows {
  double height = 0;    ///< of the first row, along the surface, in the model's unit; 0: no rows
  double growth = 1.2;  ///< height of a row over that of the one before

  bool operator==(const EdgeRows&) const = default;
};

struct SurfaceOptions {
  SurfaceDecomposition decomposition = SurfaceDecomposition::pieces;
  std::int64_t piece_triangles = 10'000;  ///< wanted triangles of a piece
  double cut_angle = 40;  ///< degrees: least angle between cuts, and between cuts and feature curves; 0: any
  DivisionSteps division = {};
  double facet_angle = 15;   ///< degrees between neighbouring facets that a face is triangulated by first
  double chart_spread = 60;  ///< degrees from the mean normal up to which a chart may exceed its other limits
  int smoothing_sweeps = 6;  ///< of vertex smoothing and edge flips inside a face
  int mending_rounds = 16;   ///< most rounds of local refinement where faces come too close
  double most_growth = 4;    ///< triangles after local refinement over those of the first round, at most
  std::vector<EdgeRows> rows = {};  ///< by CAD edge; empty: none
  int needle_rounds = 2;            ///< most rounds of refinement for needles that the CAD does not force
  double needle_growth = 1.2;  ///< triangles after those rounds over those before, at most; 1,000 more are
                               ///< allowed in any case
};

}  // namespace aeroloom::surface
