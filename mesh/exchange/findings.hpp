/// What a validity check found: how often each rule is broken, and where first.
#pragma once

#include "mesh/data/distributed_mesh.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace aeroloom::mesh {

/// The rules a mesh may break, in the order of the report.
enum class Violation : std::int32_t {
  coordinate_not_finite,
  shared_coordinates_differ,
  orphan_vertex,
  volume_not_positive,
  corner_not_positive,
  degenerate_triangle,
  face_of_many_cells,
  face_without_partner,
  cells_on_one_side,
  triangle_without_cell,
  triangle_inside_mesh,
  repeated_triangle,
  triangle_turned_inward,
  inner_triangle_of_one_cell,
  regions_without_triangle,
  triangle_of_other_regions,
  edge_of_one_triangle,
  edge_unbalanced,
  triangle_without_patch,
  triangle_without_face,
  triangle_not_in_surface,
  triangle_missing_from_mesh,
  count
};

/// What part of a piece an offender is; `item` counts vertices, cells, sides of cells, boundary faces, or
/// edges of these (mesh/data/piece_faces.hpp); the triangles of a triangle piece are its boundary faces.
enum class Entity : std::int32_t { vertex, cell, cell_face, boundary_face, boundary_edge };

struct Offender {
  std::array<GlobalIndex, 3> key{};  ///< lowest comes first: global numbers of what it is about
  PieceId piece = 0;
  Entity entity = Entity::vertex;
  std::int64_t item = 0;
};

/// Counts violations on this rank and keeps the first offender of each.
class Findings {
public:
  void add(Violation violation, const Offender& offender);

  /// Whether any rank has found something. Collective.
  bool any(const parallel::Communicator& communicator) const;

  /// One sentence per broken rule, the same on every rank: its count over all ranks, and piece and
  /// coordinates of the first offender. `mesh` is the one the offenders belong to. Collective.
  std::vector<std::string> sentences(const DistributedMesh& mesh) const;

private:
  struct Finding {
    std::int64_t count = 0;
    Offender first;
  };
  using Table = std::array<Finding, static_cast<std::size_t>(Violation::count)>;
  Table over_all_ranks(const parallel::Communicator& communicator) const;

  Table _table;
};

}  // namespace aeroloom::mesh
