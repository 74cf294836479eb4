/// The loops of a background mesh: a subset of the vertices on the loops of a piece.
#pragma once

#include "sizing/field/size_field.hpp"
#include "surface/division/piece_problem.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::surface {

/// The part of a loop between two vertices that are kept. Vertices are numbered as in the piece problem.
struct CoarseSegment {
  std::int32_t from, to;    ///< kept
  std::int32_t begin, end;  ///< range in CoarseLoops::inside: the vertices between, in this direction
};

struct CoarseLoops {
  std::vector<CoarseSegment> segments;  ///< by (from, to); no two join the same vertices
  std::vector<std::int32_t> inside;

  /// The segment between two vertices, in either direction; null where there is none.
  const CoarseSegment* find(std::int32_t from, std::int32_t to) const;
};

/// Chooses the loop vertices to keep. Corners, which turn by more than `largest_turn` (radians), are kept.
/// Between them segments follow the `coarse` sizes and turn by at most `largest_turn`, as far as fine edges
/// allow. Every loop keeps at least three segments. Neighbouring pieces may coarsen a common curve
/// differently: they still share the fine vertices.
CoarseLoops coarsen_loops(const PieceProblem& problem, const sizing::SizeField& coarse, double largest_turn);

}  // namespace aeroloom::surface
