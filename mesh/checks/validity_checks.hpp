/// The checks that volume and surface meshes have in common. All report to Findings.
#pragma once

#include "mesh/data/distributed_mesh.hpp"
#include "mesh/exchange/findings.hpp"

#include <string>
#include <vector>

namespace aeroloom::mesh {

/// Throws CollectiveError when the arrays of a piece do not fit together, cells are of another kind, or the
/// numbering belongs to another mesh, or regions are named that the mesh does not have: then nothing else can
/// be checked. Collective.
void require_checkable(const NumberedMesh& mesh, CellKind kind);

/// Every coordinate is a finite number. Not collective.
void check_finite_coordinates(const NumberedMesh& mesh, Findings& findings);
/// Every vertex is used by a cell of its piece, of whatever shape. Not collective.
void check_orphans(const NumberedMesh& mesh, Findings& findings);
/// Every boundary face has one of the mesh's patches and CAD faces. Not collective.
void check_labels(const DistributedMesh& mesh, Findings& findings);
/// All pieces agree on the coordinate bits of the vertices they share. Collective.
void check_shared_coordinates(const NumberedMesh& mesh, Findings& findings);
/// The boundary of each region closes: its triangles and quadrilaterals pass each edge equally often in both
/// directions. Collective.
void check_boundary_edges(const NumberedMesh& mesh, Findings& findings);

/// The boundary triangles of `mesh` are exactly the triangles of `surface`, by the bits of their coordinates
/// and their orientation. Collective.
void check_same_triangles(const DistributedMesh& mesh, const DistributedMesh& surface, Findings& in_mesh,
                          Findings& in_surface);

/// A sum that carries its rounding error along (Neumaier, ZAMM 54, 1974, doi:10.1002/zamm.19740540106).
class CompensatedSum {
public:
  void add(double term);
  double value() const { return _sum + _error; }

private:
  double _sum = 0, _error = 0;
};

/// A piece's part of a sum over a region.
struct RegionTerm {
  RegionId region;
  PieceId piece;
  double value;
};
/// The sums by region, taken in piece order: the same bits whatever the ranks. A piece has one term for a
/// region at most. Collective.
std::vector<double> sum_by_region(const DistributedMesh& mesh, const std::vector<RegionTerm>& terms);
/// The volume that the boundary faces around each region enclose, by the divergence integral; quadrilaterals
/// count as bilinear surfaces, as in cell_volume (mesh/quality/cell_measures.hpp). Collective.
std::vector<double> enclosed_volumes(const DistributedMesh& mesh);
/// "region 'name': " where the mesh has several, for sentences about one; empty otherwise.
std::string region_prefix(const DistributedMesh& mesh, RegionId region);

}  // namespace aeroloom::mesh
