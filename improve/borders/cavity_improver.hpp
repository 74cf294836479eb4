/// Improvement inside cavities across pieces. What was frozen on the border of a piece is interior there.
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

/// Claims the stars of all vertices of tetrahedra that miss their local target (local_target.hpp). With full
/// effort it is the target itself. Claims are grouped into cavities by place; `shift` as in
/// cavities::cavity_at. Returns the number of such tetrahedra on this rank.
std::int64_t claim_for_bad(const mesh::DistributedMesh& mesh, const BadCells& bad,
                           const mesh::TetQuality& measure, int shift, Effort effort,
                           cavities::CavityClaims& claims);

/// Improves the tetrahedra of a cavity. Vertices and faces common with other tetrahedra stay, as do triangles
/// between two regions. Other surface triangles may change as in a piece.
class CavityImprover {
public:
  /// All arguments must outlive the object.
  CavityImprover(const mesh::DistributedMesh& mesh, const ImproveOptions& options, const MeshSource& source)
      : _mesh(mesh), _options(options), _measure(options.target_angle), _source(source) {}

  /// Improves a cavity once. Returns nothing if nothing improved. Adds to the report.
  std::optional<cavities::CavityContent> improve(const cavities::Cavity& cavity, ImproveReport& report);
  /// Makes several trials: first with the cavity as it is, then with interior vertices perturbed
  /// (perturbation.hpp) by random numbers that depend on `seed`. Stops when no tetrahedron misses the target.
  /// The best trial has the best worst quality, then the fewest bad tetrahedra. Returns nothing if no trial
  /// beats the cavity.
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
  std::vector<mesh::LocalIndex> _order;   ///< vertices of the cavity, fixed ones first
  std::vector<mesh::LocalIndex> _number;  ///< per vertex of the cavity: its place in that order
  mesh::LocalIndex _staying = 0;
  mesh::Piece _piece;
  std::vector<mesh::LocalIndex> _numbered;  ///< after improvement, per vertex of the piece: its number before
};

}  // namespace aeroloom::improve
