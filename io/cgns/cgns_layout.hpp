/// What a CGNS file holds and where. Functions of counts and names alone.
#pragma once

#include "io/file_mesh.hpp"
#include "io/hdf5/file_layout.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace aeroloom::io::cgns {

/// What the whole mesh holds; FileMesh's members of these names.
struct Totals {
  mesh::GlobalIndex vertex_count = 0;
  std::vector<mesh::Patch> patches;
  std::vector<std::string> regions;
  std::vector<std::array<mesh::GlobalIndex, cell_shape_count>> region_cells;
  std::vector<std::array<mesh::GlobalIndex, face_shape_count>> patch_faces;
};

/// Elements of one shape of one region or patch. Elements of all sections have consecutive numbers, from 1.
struct Section {
  std::string name;
  std::string full_name;  ///< of its region, where `name` could not hold it
  std::int32_t type = 0;  ///< CGNS's number of the shape
  int corners = 0;
  mesh::GlobalIndex first = 0, count = 0;
  std::int64_t offset = 0;  ///< of its connectivity in the file, in bytes
};

/// A patch: a family, a boundary condition and one section or two, next to each other.
struct Boundary {
  std::string name;
  std::string full_name;  ///< where `name` could not hold it
  std::string condition;  ///< a BCType_t
  mesh::GlobalIndex first = 0, last = 0;
};

struct Plan {
  hdf5::ItemType index_type = hdf5::ItemType::int32;
  mesh::GlobalIndex vertices = 0, cells = 0;
  std::vector<Section> sections;
  std::vector<Boundary> boundaries;
  /// By region (patch) and shape: its place among the sections, -1 where it has none.
  std::vector<std::array<std::int32_t, cell_shape_count>> section_of_region;
  std::vector<std::array<std::int32_t, face_shape_count>> section_of_patch;
  std::array<std::int64_t, 3> coordinates{};  ///< offsets of x, y, z in the file, in bytes
};

/// Sections and names; no offsets yet. Indices have 32 bits unless a number or the length of an array needs
/// more.
Plan plan_file(const Totals& totals);

/// Lays the file out and fills in the plan's offsets; the bytes of its structure.
std::vector<hdf5::Extent> lay_out(Plan& plan);

}  // namespace aeroloom::io::cgns
