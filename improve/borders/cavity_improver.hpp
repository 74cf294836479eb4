/// Improvement across pieces: what was frozen on the border of a piece is inside of a cavity.
#pragma once

#include "improve/borders/bad_cells.hpp"
#include "improve/borders/rounds.hpp"
#include "improve/improve_options.hpp"
#include "improve/improve_report.hpp"
#include "improve/mesh_source.hpp"
#include "mesh/quality/tet_quality.hpp"

#include <optional>
#include <vector>

namespace aeroloom::improve {

/// Claims the stars of all vertices of tetrahedra that miss the local target (local_target.hpp; the
/// target itself, with full effort), grouped by place; `shift` as in cavities::cavity_at. Returns
/// their number on this rank.
std::int64_t claim_for_bad(const mesh::DistributedMesh& mesh, const BadCells& bad,
                           const mesh::TetQuality& measure, int shift, Effort effort,
                           cavities::CavityClaims& claims);

/// Improves the tetrahedra of cavities. What other tetrahedra have in common with a cavity stays, and so do
/// triangles between two regions; other triangles of the surface mesh may change as in a piece.
class CavityImprover {
public:
  /// All must outlive it.
  CavityImprover(const mesh::DistributedMesh& mesh, const ImproveOptions& options, const MeshSource& source)
      : _mesh(mesh), _options(options), _measure(options.target_angle), _source(source) {}

  /// Nothing where improvement changes nothing. Adds to the report.
  std::optional<cavities::CavityContent> improve(const cavities::Cavity& cavity, ImproveReport& report);
  /// The best of several: what improves the cavity as it is, then what improves it with its vertices inside
  /// scattered (scatter.hpp; `seed` gives other throws), until none misses the target. The best has the best
  /// worst tetrahedron, then the fewest that miss the target. Nothing where none is better than what is
  /// there.
  std::optional<cavities::CavityContent> improve_by_trials(const cavities::Cavity& cavity, int trials,
                                                           std::uint64_t seed, ImproveReport& report);

private:
  void order_vertices(const cavities::Cavity& cavity);
  void build_piece(const cavities::Cavity& cavity);
  bool is_worse_than(const cavities::Cavity& cavity) const;
  cavities::CavityContent build_content(const cavities::Cavity& cavity) const;

  const mesh::DistributedMesh& _mesh;
  const ImproveOptions& _options;
  mesh::TetQuality _measure;
  const MeshSource& _source;
  std::vector<mesh::LocalIndex> _order;   ///< of the cavity's vertices: those that stay first
  std::vector<mesh::LocalIndex> _number;  ///< per vertex of the cavity: its place in that order
  mesh::LocalIndex _staying = 0;
  mesh::Piece _piece;
  std::vector<mesh::LocalIndex> _numbered;  ///< after improvement, per vertex of the piece: its place before
};

}  // namespace aeroloom::improve
