/// Prediction of the improvement work of a piece, for load balancing.
#pragma once

#include "improve/improve_options.hpp"
#include "improve/improve_report.hpp"
#include "mesh/data/piece.hpp"

#include <optional>

namespace aeroloom::improve {

/// Tests whether a piece needs no work: off the boundary, and no tetrahedron worse than in the lattice, which
/// meets the target. Returns its state, or nothing for other pieces. The scan stops at the first worse
/// tetrahedron.
std::optional<BadState> look_at_lattice(const mesh::Piece& piece, const ImproveOptions& options);

/// Expected cost of a piece; the unit is the time to read in one tetrahedron. All tetrahedra are read in, and
/// each bad one is worked on. Pieces that need no work are only scanned.
double expected_work(const mesh::Piece& piece, const ImproveOptions& options);
/// The same from a report, for a piece of `cells` tetrahedra.
double expected_work(double cells, const ImproveReport& report);

}  // namespace aeroloom::improve
