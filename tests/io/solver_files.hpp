/// What tests of solver files share: what a mesh has in a file.
#pragma once

#include "io/file_mesh.hpp"
#include "tests/io/mesh_volumes.hpp"
#include "tests/io/scratch_folder.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

namespace aeroloom::io::examples {

/// What must survive a file.
struct Contents {
  std::int64_t vertices = 0;
  std::array<std::int64_t, cell_shape_count> cells{};
  std::array<double, cell_shape_count> volumes{};
  std::map<std::string, std::array<std::int64_t, face_shape_count>> faces;  ///< by name of patch
  std::map<std::string, mesh::PatchType> types;
  double enclosed = 0;  ///< by the boundary faces
};

/// A sixth of the divergence integral over a face.
inline double volume_below(const MeshPart& part, const std::vector<mesh::LocalIndex>& corners) {
  const geometry::Vec3 a = part.point(corners[0]);
  double volume = 0;
  for (std::size_t k = 1; k + 1 < corners.size(); ++k)
    volume += dot(a, cross(part.point(corners[k]) - a, part.point(corners[k + 1]) - a)) / 6;
  return volume;
}

inline Contents contents_of(const FileMesh& mesh) {
  const parallel::Communicator& world = mesh.pieces->communicator;
  Contents contents;
  contents.vertices = mesh.vertex_count;
  contents.volumes = volumes_of(mesh);
  for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
    if (mesh.patches[p].type == mesh::PatchType::interior) continue;
    contents.faces[mesh.patches[p].name] = mesh.patch_faces[p];
    contents.types[mesh.patches[p].name] = mesh.patches[p].type;
  }
  for (const MeshPart& part : mesh.parts) {
    for (const Block& block : part.faces) {
      for (const Run& run : block.runs) {
        if (mesh.patches[run.id].type == mesh::PatchType::interior) continue;
        for (mesh::LocalIndex i = run.begin; i < run.end; ++i)
          contents.enclosed += volume_below(part, {block.item(i), block.item(i) + block.corners});
      }
    }
  }
  for (const CellShape shape : cell_shapes) {
    const auto s = static_cast<std::size_t>(shape);
    contents.cells[s] = mesh.cell_count(shape);
  }
  contents.enclosed = world.sum(contents.enclosed);
  return contents;
}

/// The same under names as solvers can have them.
inline Contents with_plain_names(const Contents& contents) {
  Contents plain = contents;
  const auto rename = [](auto& map) {
    std::remove_reference_t<decltype(map)> renamed;
    for (const auto& [name, value] : map) {
      std::string changed = name;
      std::replace_if(
          changed.begin(), changed.end(), [](char c) { return c == ' ' || c == '/'; }, '_');
      renamed[changed] = value;
    }
    map = renamed;
  };
  rename(plain.faces);
  rename(plain.types);
  return plain;
}

inline void expect_same(const Contents& found, const Contents& wanted) {
  EXPECT_EQ(found.vertices, wanted.vertices);
  EXPECT_EQ(found.cells, wanted.cells);
  EXPECT_EQ(found.faces, wanted.faces);
  EXPECT_EQ(found.types, wanted.types);
  for (std::size_t s = 0; s < cell_shape_count; ++s) EXPECT_NEAR(found.volumes[s], wanted.volumes[s], 1e-9);
  EXPECT_NEAR(found.enclosed, wanted.enclosed, 1e-9);
}

}  // namespace aeroloom::io::examples
