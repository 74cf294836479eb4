/// The loops of a background mesh: a subset of the vertices on the loops of a piece.
#pragma once

#include "sizing/field/size_field.hpp"
#include "surface/division/piece_problem.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::surface {

/// A stretch of a loop between two vertices that are kept. Vertices are those of the piece problem.
struct CoarseSegment {
  std::int32_t from, to;    ///< kept
  std::int32_t begin, end;  ///< of CoarseLoops::inside: the vertices between, in this direction
};

struct CoarseLoops {
  std::vector<CoarseSegment> segments;  ///< by (from, to); no two join the same vertices
  std::vector<std::int32_t> inside;

  /// The segment that runs between two vertices in either direction; null where there is none.
  const CoarseSegment* find(std::int32_t from, std::int32_t to) const;
};

/// Keeps corners of the loops (turns above `largest_turn`, radians), and between them vertices so that
/// segments follow `coarse` sizes and turn by at most `largest_turn`, as far as the fine edges allow it.
/// Every loop has three segments at least. What two pieces share need not be coarsened alike: fine vertices
/// tie them together.
CoarseLoops coarsen_loops(const PieceProblem& problem, const sizing::SizeField& coarse, double largest_turn);

}  // namespace aeroloom::surface
