/// Finds the cells at sharp edges of walls on which several columns of layers stand (layers/fans.hpp).
#pragma once

#include "io/file_mesh.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

namespace aeroloom::io {

/// By part on this rank and cell in the order of the file: 1 for cells of sectors, and for all that share a
/// vertex with them, else 0.
using SharpEdgeCells = std::vector<std::vector<std::uint8_t>>;

/// Nothing where no part of the whole mesh has such cells. A sector begins with a prism along the edge, of
/// which two corners lie on a wall and four are of the hexahedron above. Collective.
std::optional<SharpEdgeCells> find_sharp_edge_cells(const FileMesh& mesh);

/// Writes the field constant/sharpEdges of a part: 0 in these cells, 1 elsewhere. Throws filesystem_error.
void write_sharp_edges(const std::filesystem::path& path, std::span<const std::uint8_t> cells);

}  // namespace aeroloom::io
