/// The lattice on a rank: octree, sizes and surface, from which its points are made.
#pragma once

#include "mesh/data/shared_vertex_keys.hpp"
#include "sizing/field/size_field.hpp"
#include "volume/lattice/lattice_frame.hpp"
#include "volume/lattice/lattice_tree.hpp"
#include "volume/lattice/local_surface.hpp"
#include "volume/lattice/surface_triangles.hpp"
#include "volume/volume_options.hpp"

#include <memory>
#include <vector>

namespace aeroloom::volume {

struct VolumeInput;

/// The blocks of a rank, their ghosts, and the surface near them. The data of a block are the same on every
/// rank where it is local. Immutable once it is complete. Refers to the field.
struct Lattice {
  const sizing::SizeField& field;
  VolumeOptions options;
  LatticeFrame frame;
  LatticeTree tree;
  SurfaceTable table;
  std::vector<SurfaceTriangle> triangles;  ///< those that meet blocks of this rank, by number
  mesh::GlobalIndex surface_vertices = 0;
  SearchRadii radii;                    ///< of this rank's blocks; empty on one rank
  std::vector<mesh::RegionId> regions;  ///< per own block, see find_block_regions

  Leaf leaf_at(geometry::Vec3 place) const { return tree.leaf_at(frame.cell_at(frame.to_grid(place))); }
  /// The shared-vertex key of the lattice point with a number. Surface vertices have lower keys.
  mesh::SharedVertexKey vertex_key(std::int64_t number) const {
    return mesh::running_key(surface_vertices + number);
  }
};

/// Makes frame, tree, ghosts and table. `box` contains the surface. Search radii and regions are still empty.
/// Collective.
Lattice grow_lattice(const VolumeInput& input, const geometry::Box& box);

/// The triangles within the search radii of this rank's blocks. Collective.
std::unique_ptr<const LocalSurface> gather_local_surface(const Lattice& lattice);

}  // namespace aeroloom::volume
