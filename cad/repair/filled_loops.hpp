/// Faces over openings that are no plane. Internal to cad/.
#pragma once

#include "cad/repair/plane_loops.hpp"

#include <optional>
#include <vector>

#include <TopoDS_Edge.hxx>

namespace aeroloom::cad {

/// Lengths and areas that tell which openings may be closed unasked.
struct WallSizes {
  double diagonal = 0;
  double area = 0;  ///< of all walls
};

/// A face over a closed loop of edges, which are in order: the smooth surface through them that bends least.
/// It shares the edges, whose tolerances grow to their distance from it. Empty if they miss it by more than
/// `tolerance`, or if it folds over itself as seen along the normal of the loop.
std::optional<Cap> fill_loop(const std::vector<TopoDS_Edge>& loop, double tolerance);

/// The same for a loop that is small or narrow, unless it is `named`. What is too wide costs no work.
std::optional<Cap> fill_narrow_loop(const std::vector<TopoDS_Edge>& loop, const WallSizes& walls, bool named);

/// Whether a cap closes an opening that is small, as a missing face is, or narrow, as a blunt edge or a tip.
bool is_small_or_narrow(const Cap& cap, const WallSizes& walls);

/// Whether a cap is so narrow for its length that it stands for a gap, which is to be sewn.
bool is_gap(const Cap& cap, const WallSizes& walls);

}  // namespace aeroloom::cad
