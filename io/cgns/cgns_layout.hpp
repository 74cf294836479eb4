/// The content of a CGNS file, and the place of each array in it. All follows from counts and names.
#pragma once

#include "io/file_mesh.hpp"
#include "io/hdf5/file_layout.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace aeroloom::io::cgns {

/// Counts and names of the whole mesh, as in the members of FileMesh with these names.
struct Totals {
  mesh::GlobalIndex vertex_count = 0;
  std::vector<mesh::Patch> patches;
  std::vector<std::string> regions;
  std::vector<std::array<mesh::GlobalIndex, cell_shape_count>> region_cells;
  std::vector<std::array<mesh::GlobalIndex, face_shape_count>> patch_faces;
};

/// The elements of one shape in one region or patch. Numbers of elements run through all sections, from 1.
struct Section {
  std::string name;
  std::string full_name;  ///< the name of the region, where `name` is a shortened one
  std::int32_t type = 0;  ///< the number of the shape in CGNS
  int corners = 0;
  mesh::GlobalIndex first = 0, count = 0;
  std::int64_t offset = 0;  ///< of the connectivity in the file, in bytes
};

/// A patch: a family, a boundary condition, and one or two adjacent sections.
struct Boundary {
  std::string name;
  std::string full_name;  ///< the name of the patch, where `name` is a shortened one
  std::string condition;  ///< a BCType_t
  mesh::GlobalIndex first = 0, last = 0;
};

struct Plan {
  hdf5::ItemType index_type = hdf5::ItemType::int32;
  mesh::GlobalIndex vertices = 0, cells = 0;
  std::vector<Section> sections;
  std::vector<Boundary> boundaries;
  /// By region (or patch) and shape: the index of the section, or -1.
  std::vector<std::array<std::int32_t, cell_shape_count>> section_of_region;
  std::vector<std::array<std::int32_t, face_shape_count>> section_of_patch;
  std::array<std::int64_t, 3> coordinates{};  ///< offsets of x, y and z in the file, in bytes
};

/// Sections and names, without offsets. Indices have 32 bits, or 64 bits where a number or the length of an
/// array needs them.
Plan plan_file(const Totals& totals);

/// Computes the offsets of the plan, and returns the bytes of the file's structure.
std::vector<hdf5::Extent> lay_out(Plan& plan);

}  // namespace aeroloom::io::cgns
