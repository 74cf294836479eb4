/// The work that a piece is expected to need.
#pragma once

#include "improve/improve_options.hpp"
#include "improve/improve_report.hpp"
#include "mesh/data/piece.hpp"

#include <optional>

namespace aeroloom::improve {

/// The state of a piece that is left as it is: off the boundary, with nothing in it worse than in a lattice,
/// which meets the target. Its shape on average is the lattice's too, and reading it in would cost most of
/// what is spent on it. Nothing for others, which are looked at until the first such tetrahedron.
std::optional<BadState> look_at_lattice(const mesh::Piece& piece, const ImproveOptions& options);

/// The expected cost of a piece, in the time of reading one tetrahedron in: reading all in, and work on each
/// bad one. Pieces that are left as they are are looked at alone.
double expected_work(const mesh::Piece& piece, const ImproveOptions& options);
/// That of a piece of so many tetrahedra with this report.
double expected_work(double cells, const ImproveReport& report);

}  // namespace aeroloom::improve
