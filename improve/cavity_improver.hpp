/// Improvement across pieces: what was frozen on the border of a piece is inside of a cavity.
#pragma once

#include "improve/improver.hpp"
#include "mesh/cavities.hpp"

#include <optional>

namespace aeroloom::improve {

/// Wishes for the stars of all vertices of tetrahedra that miss the target, grouped by place; `shift` as in
/// mesh::cavity_at. Returns their number on this rank.
std::int64_t wish_for_bad(const mesh::DistributedMesh& mesh, const ImproveOptions& options, int shift,
                          mesh::CavityWishes& wishes);

/// Wishes for the stars of shared vertices whose tetrahedra are worse shaped on average than those of a
/// lattice, as relaxation.hpp sees it; from the second shift on, those that the last round did not reach.
/// Returns their number on this rank.
std::int64_t wish_for_borders(const mesh::DistributedMesh& mesh, int shift, mesh::CavityWishes& wishes);

/// Improves the tetrahedra of a cavity, its boundary fixed; nothing where that changes nothing.
std::optional<mesh::Refilling> improve_cavity(const mesh::Cavity& cavity, const ImproveOptions& options,
                                              ImproveReport& report);

}  // namespace aeroloom::improve
