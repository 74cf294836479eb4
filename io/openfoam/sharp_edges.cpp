#include "io/openfoam/sharp_edges.hpp"

#include "io/openfoam/foam_case.hpp"
#include "io/openfoam/foam_file.hpp"
#include "mesh/data/piece_faces.hpp"
#include "mesh/exchange/shared_vertices.hpp"

#include <algorithm>

namespace aeroloom::io {

namespace {

using mesh::LocalIndex;
using mesh::Piece;

/// By piece on this rank and vertex.
using VertexFlags = std::vector<std::vector<std::uint8_t>>;

VertexFlags no_flags(const mesh::DistributedMesh& mesh) {
  VertexFlags flags;
  for (const Piece& piece : mesh.pieces) flags.emplace_back(piece.vertex_count(), 0);
  return flags;
}

void share(const mesh::SharedVertices& shared, VertexFlags& flags) {
  shared.combine(flags, [](std::uint8_t a, std::uint8_t b) { return std::max(a, b); });
}

/// Calls visit(the six corners) for the first prisms of sectors of a piece.
template <class Visit>
void for_each_first_prism(const Piece& piece, const std::vector<std::uint8_t>& of_hexahedra,
                          const std::vector<std::uint8_t>& on_walls, const Visit& visit) {
  constexpr std::size_t corners = corners_of(CellShape::prism);
  for (std::size_t c = 0; c < piece.prisms.size(); c += corners) {
    const LocalIndex* prism = piece.prisms.data() + c;
    const auto count = [&](const std::vector<std::uint8_t>& flags) {
      return std::count_if(prism, prism + corners, [&](LocalIndex v) { return flags[v] != 0; });
    };
    if (count(of_hexahedra) == 4 && count(on_walls) == 2) visit(prism);
  }
}

/// The vertices of sectors; none where hexahedra are others. Collective.
VertexFlags find_sector_vertices(const mesh::DistributedMesh& mesh) {
  VertexFlags of_sectors = no_flags(mesh), on_walls = no_flags(mesh);
  const mesh::SharedVertices shared(mesh);
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    const Piece& piece = mesh.pieces[p];
    for (const LocalIndex v : piece.hexahedra) of_sectors[p][v] = 1;
    for (LocalIndex f = 0; f < mesh::boundary_face_count(piece); ++f) {
      if (mesh.type_of_patch(mesh::patch_of(piece, f)) != mesh::PatchType::wall) continue;
      for (const LocalIndex v : mesh::corners_of_boundary(piece, f)) on_walls[p][v] = 1;
    }
  }
  share(shared, of_sectors);
  share(shared, on_walls);
  VertexFlags on_edges = no_flags(mesh);
  std::int64_t found = 0;
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    for_each_first_prism(mesh.pieces[p], of_sectors[p], on_walls[p], [&](const LocalIndex* prism) {
      for (std::size_t i = 0; i < corners_of(CellShape::prism); ++i) on_edges[p][prism[i]] = 1;
      ++found;
    });
  }
  if (mesh.communicator.sum(found) == 0) return {};
  share(shared, on_edges);
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    for (std::size_t v = 0; v < on_edges[p].size(); ++v) of_sectors[p][v] |= on_edges[p][v];
  }
  return of_sectors;
}

}  // namespace

std::optional<SharpEdgeCells> find_sharp_edge_cells(const FileMesh& mesh) {
  const parallel::Communicator& communicator = mesh.communicator();
  const std::vector<Piece>& pieces = mesh.pieces->pieces;
  const auto any = [&](bool here) { return communicator.maximum(std::int64_t{here}) > 0; };
  if (!any(std::any_of(pieces.begin(), pieces.end(), [](const Piece& p) { return !p.hexahedra.empty(); })))
    return std::nullopt;
  const VertexFlags of_sectors = find_sector_vertices(*mesh.pieces);
  if (!any(!of_sectors.empty())) return std::nullopt;
  SharpEdgeCells cells(mesh.parts.size());
  for (std::size_t p = 0; p < cells.size(); ++p) {
    const std::vector<std::uint8_t>& flags = of_sectors[p];
    for (const CellShape shape : cell_shapes) {
      const Block& block = mesh.parts[p].cells[static_cast<std::size_t>(shape)];
      for (LocalIndex c = 0; c < block.count(); ++c) {
        const LocalIndex* corners = block.item(c);
        cells[p].push_back(
            std::any_of(corners, corners + block.corners, [&](LocalIndex v) { return flags[v] != 0; }) ? 1
                                                                                                       : 0);
      }
    }
  }
  return cells;
}

void write_sharp_edges(const std::filesystem::path& path, std::span<const std::uint8_t> cells) {
  const FoamFormat text{false, 32};
  LocalFile file(path.string());
  file.text(foam_header(text, "volScalarField", "constant", FoamCase::sharp_edges_name));
  file.text("dimensions      [0 0 0 0 0 0 0];\ninternalField   ");
  if (std::count(cells.begin(), cells.end(), 1) == 0) {
    file.text("uniform 1");
  } else {
    file.text("nonuniform List<scalar> ");
    FoamList list(file, text, static_cast<std::int64_t>(cells.size()));
    for (const std::uint8_t cell : cells) list.flag(cell == 0);
    list.end();
  }
  // Groups come before patterns, and later patterns before others.
  file.text(
      ";\nboundaryField\n{\n    \".*\" { type zeroGradient; }\n    symmetry { type symmetry; }\n"
      "    \"procBoundary.*\" { type processor; }\n}\n");
  file.finish();
}

}  // namespace aeroloom::io
