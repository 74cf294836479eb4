/// What the user may ask of the surface stage.
#pragma once

#include <cstdint>

namespace aeroloom::surface {

/// How a surface is cut into pieces: one per CAD face, or as many as their size asks for.
enum class SurfaceDecomposition : std::int8_t { faces, pieces };

/// The steps that make the cuts of a face good. All are done; benchmarks leave one out to see what it is
/// worth.
struct DivisionSteps {
  bool contraction = true;    ///< of arcs of the dual graph, before it is partitioned
  bool repair = true;         ///< of parts that fell asunder: stray components join a neighbour
  bool widening = true;       ///< of wedges below the cut angle, which go to the part beside them
  bool straightening = true;  ///< of the borders between parts
};

struct SurfaceOptions {
  SurfaceDecomposition decomposition = SurfaceDecomposition::pieces;
  std::int64_t piece_triangles = 10'000;  ///< wanted triangles of a piece
  double cut_angle = 40;  ///< degrees that cuts make with each other and with feature curves at least; 0: any
  DivisionSteps division = {};
  double facet_angle = 15;  ///< degrees neighbouring facets of a face's chart surface may turn
  double chart_spread =
      60;  ///< degrees normals of one chart may spread from their axis before the chart is split
  int smoothing_sweeps = 6;  ///< of vertex smoothing and edge flips inside a face
  int mending_rounds = 6;    ///< rounds of local refinement where faces come too close, before giving up
  double most_growth =
      4;  ///< triangles that rounds of local refinement may come to, over those predicted for the first one
  int needle_rounds =
      2;  ///< at most as many rounds of local refinement for needles that the CAD does not force
};

}  // namespace aeroloom::surface
