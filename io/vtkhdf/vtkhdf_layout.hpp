/// The places of the arrays in a VTKHDF file. They follow from counts and names alone.
#pragma once

#include "io/file_mesh.hpp"
#include "io/hdf5/file_layout.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace aeroloom::io::vtkhdf {

/// The counts of a partition of a grid, or the sums over all partitions before it.
struct GridCounts {
  std::int64_t points = 0, cells = 0, corners = 0;
};

/// The offset of the first item of each array, in bytes.
struct GridPlaces {
  std::int64_t points = 0, numbers = 0;        ///< double; int64
  std::int64_t connectivity = 0, offsets = 0;  ///< int64; per partition one offset more than cells
  std::int64_t types = 0, parts = 0, ids = 0;  ///< uint8; int32; int32
};

/// Lays out the group /VTKHDF with cell data `part` and `id_name` and point data `global_id`. `partitions`:
/// the counts of each partition.
GridPlaces lay_out_grid(hdf5::FileLayout& file, std::span<const GridCounts> partitions,
                        const std::string& id_name);

struct BoundaryPlaces {
  std::int64_t connectivity = 0, offsets = 0;  ///< int64; one offset more than faces
  std::int64_t types = 0, patches = 0;         ///< uint8; int32
};

/// Lays out the group /Boundary.
BoundaryPlaces lay_out_boundary(hdf5::FileLayout& file, std::int64_t faces, std::int64_t corners,
                                std::span<const mesh::Patch> patches);

/// Stores the names and the types of patches at these paths.
void store_patches(hdf5::FileLayout& file, const std::string& names_path, const std::string& types_path,
                   std::span<const mesh::Patch> patches);

/// The sums over the partitions before each one; a last entry has the sums over all.
std::vector<GridCounts> sums_before(std::span<const GridCounts> partitions);

}  // namespace aeroloom::io::vtkhdf
