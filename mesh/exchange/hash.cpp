#include "mesh/data/distributed_mesh.hpp"
#include "mesh/data/mixing.hpp"
#include "mesh/exchange/delivery.hpp"

#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace aeroloom::mesh {

namespace {

/// A 128-bit sum. Addition commutes, so items may be hashed on any rank and in any order: each carries its
/// kind and global number, and so its place.
struct Sum128 {
  std::uint64_t low = 0, high = 0;
  void add(Sum128 other) {
    low += other.low;
    high += other.high + (low < other.low ? 1 : 0);
  }
};

enum class ItemKind : std::uint64_t {
  vertex = 1,
  cell,
  triangle,
  patch_name,
  face_name,
  region_name,
  face_sides,
  region_of_piece,
  whole,
  pyramid,
  prism,
  quad,
  region_run,
  hexahedron
};

/// Hashes one item word by word. The first lane is a bijection of each word given those before it, so a
/// changed word changes it; the second makes accidental agreement of both as unlikely as 128 bits allow.
class ItemHash {
public:
  ItemHash(ItemKind kind, GlobalIndex number) {
    add(static_cast<std::uint64_t>(kind));
    add(static_cast<std::uint64_t>(number));
  }
  void add(std::uint64_t word) {
    _low = mix_bits(_low ^ word);
    _high = mix_bits((_high ^ std::rotl(word, 32)) + 0x9e3779b97f4a7c15ULL * _low);
  }
  void add_signed(std::int64_t value) { add(static_cast<std::uint64_t>(value)); }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
  Sum128 digest() const { return {mix_bits(_low + _high), _high}; }

private:
  std::uint64_t _low = 0x243f6a8885a308d3ULL, _high = 0x13198a2e03707344ULL;  // digits of pi
};

void add_vertices(const Piece& piece, const std::vector<GlobalIndex>& numbers,
                  const std::vector<std::uint8_t>& owned, Sum128& sum) {
  for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
    if (!owned[v]) continue;
    ItemHash item(ItemKind::vertex, numbers[v]);
    for (int axis = 0; axis < 3; ++axis) item.add(piece.coordinates[3 * static_cast<std::size_t>(v) + axis]);
    if (!piece.vertex_dimension.empty()) {
      item.add_signed(static_cast<std::int64_t>(piece.vertex_dimension[v]));
      item.add_signed(piece.vertex_entity[v]);
    }
    sum.add(item.digest());
  }
}

void add_cells(const Piece& piece, const std::vector<GlobalIndex>& numbers, GlobalIndex first, Sum128& sum) {
  const int corners = piece.vertices_per_cell();
  for (LocalIndex c = 0; c < piece.cell_count(); ++c) {
    ItemHash item(ItemKind::cell, first + c);
    for (int k = 0; k < corners; ++k) item.add_signed(numbers[piece.cell(c)[k]]);
    sum.add(item.digest());
  }
}

/// Pyramids, prisms and hexahedra.
void add_other_cells(const Piece& piece, const std::vector<GlobalIndex>& numbers, GlobalIndex first,
                     Sum128& sum) {
  first += piece.cell_count();
  for (const auto& [shape, kind] :
       {std::pair(CellShape::pyramid, ItemKind::pyramid), std::pair(CellShape::prism, ItemKind::prism),
        std::pair(CellShape::hexahedron, ItemKind::hexahedron)}) {
    const std::span<const LocalIndex> corners = connectivity_of(piece, shape);
    const auto n = static_cast<std::size_t>(corners_of(shape));
    for (std::size_t c = 0; c < corners.size(); c += n) {
      ItemHash item(kind, first++);
      for (std::size_t k = 0; k < n; ++k) item.add_signed(numbers[corners[c + k]]);
      sum.add(item.digest());
    }
  }
}

void add_quads(const Piece& piece, const std::vector<GlobalIndex>& numbers, GlobalIndex first, Sum128& sum) {
  for (std::size_t q = 0; q < piece.quad_face.size(); ++q) {
    ItemHash item(ItemKind::quad, first + static_cast<GlobalIndex>(q));
    for (std::size_t k = 0; k < 4; ++k) item.add_signed(numbers[piece.quads[4 * q + k]]);
    item.add_signed(piece.quad_face[q]);
    item.add_signed(piece.quad_patch[q]);
    sum.add(item.digest());
  }
}

void add_triangles(const Piece& piece, const std::vector<GlobalIndex>& numbers, GlobalIndex first,
                   Sum128& sum) {
  for (LocalIndex t = 0; t < piece.boundary_count(); ++t) {
    ItemHash item(ItemKind::triangle, first + t);
    for (int k = 0; k < 3; ++k) item.add_signed(numbers[piece.boundary_triangle(t)[k]]);
    item.add_signed(piece.triangle_face[t]);
    item.add_signed(piece.triangle_patch[t]);
    sum.add(item.digest());
  }
}

void add_names(const std::vector<std::string>& names, ItemKind kind, Sum128& sum) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    ItemHash item(kind, static_cast<GlobalIndex>(i));
    item.add(std::uint64_t{names[i].size()});
    for (const char letter : names[i]) item.add_signed(letter);
    sum.add(item.digest());
  }
}

void add_sides(const std::vector<FaceSides>& sides, Sum128& sum) {
  for (std::size_t i = 0; i < sides.size(); ++i) {
    ItemHash item(ItemKind::face_sides, static_cast<GlobalIndex>(i));
    item.add_signed(sides[i].front);
    item.add_signed(sides[i].back);
    sum.add(item.digest());
  }
}

void add_regions(const DistributedMesh& mesh, Sum128& sum) {
  for (const Piece& piece : mesh.pieces) {
    ItemHash item(ItemKind::region_of_piece, piece.id);
    item.add_signed(piece.region);
    sum.add(item.digest());
    if (piece.runs.empty()) continue;
    ItemHash runs(ItemKind::region_run, piece.id);
    for (const RegionRun& run : piece.runs) {
      runs.add_signed(run.region);
      runs.add_signed(run.end);
    }
    sum.add(runs.digest());
  }
}

/// Global number of each local piece's first boundary face of a shape; the total comes last.
std::vector<GlobalIndex> first_faces(const DistributedMesh& mesh, FaceShape shape) {
  std::vector<GlobalIndex> counts;
  for (const Piece& piece : mesh.pieces)
    counts.push_back(static_cast<GlobalIndex>(cad_faces_of(piece, shape).size()));
  return first_by_piece(mesh, counts);
}

}  // namespace

std::string hash_mesh(const NumberedMesh& mesh) {
  const parallel::Communicator& communicator = mesh.communicator;
  const std::vector<GlobalIndex> first_triangle = first_faces(mesh, FaceShape::triangle),
                                 first_quad = first_faces(mesh, FaceShape::quadrilateral);
  Sum128 mine;
  if (mesh.kind == CellKind::tetrahedron) add_regions(mesh, mine);
  for (std::size_t i = 0; i < mesh.pieces.size(); ++i) {
    const Piece& piece = mesh.pieces[i];
    add_vertices(piece, mesh.numbering.vertices[i], mesh.numbering.owned[i], mine);
    if (mesh.kind == CellKind::tetrahedron)
      add_cells(piece, mesh.numbering.vertices[i], mesh.numbering.first_cell[i], mine);
    add_other_cells(piece, mesh.numbering.vertices[i], mesh.numbering.first_cell[i], mine);
    add_triangles(piece, mesh.numbering.vertices[i], first_triangle[i], mine);
    add_quads(piece, mesh.numbering.vertices[i], first_quad[i], mine);
  }
  Sum128 sum;
  for (const Sum128& part : communicator.all_gather_items(std::span<const Sum128>(&mine, 1))) sum.add(part);
  add_names(mesh.patches, ItemKind::patch_name, sum);
  add_names(mesh.faces, ItemKind::face_name, sum);
  add_names(mesh.regions, ItemKind::region_name, sum);
  add_sides(mesh.sides, sum);

  ItemHash whole(ItemKind::whole, static_cast<GlobalIndex>(mesh.kind));
  for (const GlobalIndex count :
       {mesh.numbering.vertex_count, mesh.numbering.cell_count, first_triangle.back()}) {
    whole.add_signed(count);
  }
  whole.add(std::uint64_t{mesh.patches.size()});
  whole.add(std::uint64_t{mesh.faces.size()});
  whole.add(std::uint64_t{mesh.regions.size()});
  whole.add(std::uint64_t{mesh.sides.size()});
  if (first_quad.back() > 0) whole.add_signed(first_quad.back());
  whole.add(sum.low);
  whole.add(sum.high);
  const Sum128 digest = whole.digest();
  return fmt::format("{:016x}{:016x}", digest.high, digest.low);
}

}  // namespace aeroloom::mesh
