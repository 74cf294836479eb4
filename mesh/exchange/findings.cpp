#include "mesh/exchange/findings.hpp"

#include "mesh/data/piece_faces.hpp"

#include <algorithm>
#include <span>
#include <string_view>
#include <tuple>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::mesh {

namespace {

constexpr auto violation_count = static_cast<std::size_t>(Violation::count);

const char* rule_of(std::size_t violation) {
  static constexpr const char* rules[violation_count] = {
      "vertices with a coordinate that is no finite number",
      "shared vertices whose coordinates differ between pieces",
      "orphan vertices, which no cell of their piece uses",
      "tetrahedra without positive volume",
      "pyramids, prisms and hexahedra with a corner that is turned inside out",
      "degenerate triangles",
      "faces of more than two tetrahedra",
      "faces of one tetrahedron without a boundary triangle",
      "faces with both tetrahedra on one side",
      "boundary triangles that are no face of a tetrahedron",
      "boundary triangles between two tetrahedra",
      "repeated triangles",
      "boundary triangles turned inward",
      "triangles of inner faces with a tetrahedron on one side only",
      "faces between two regions without a triangle",
      "boundary triangles beside tetrahedra of other regions than their CAD face lies between",
      "open edges, with a triangle on one side only",
      "edges whose triangles do not pair up in opposite directions",
      "boundary triangles without a patch",
      "boundary triangles without a CAD face",
      "boundary triangles that the surface mesh does not have",
      "triangles of the surface mesh that the boundary does not have"};
  return rules[violation];
}

/// The rule in words; those of meshes of tetrahedra hold for all cells and faces where there are others.
std::string rule_in_words(std::size_t violation, bool is_mixed) {
  std::string words = rule_of(violation);
  if (!is_mixed) return words;
  constexpr std::pair<std::string_view, std::string_view> wider[] = {
      {"tetrahedra", "cells"}, {"tetrahedron", "cell"}, {"triangle", "face"}};
  for (const auto& [narrow, wide] : wider) {
    for (std::size_t at = 0; (at = words.find(narrow, at)) != std::string::npos;)
      words.replace(at, narrow.size(), wide);
  }
  return words;
}

geometry::Vec3 mean_point(const Piece& piece, std::span<const LocalIndex> vertices) {
  geometry::Vec3 sum;
  for (const LocalIndex v : vertices) sum += piece.point(v);
  return sum / static_cast<double>(vertices.size());
}

/// What a sentence says of an offender: a vertex, cell or boundary face, its number among those of its shape,
/// and the place of the vertex itself, or the mean of the corners of the cell, face or edge.
struct OffenderPlace {
  enum class Noun : std::int32_t {
    vertex,
    triangle,
    tetrahedron,
    pyramid,
    prism,
    hexahedron,
    boundary_triangle,
    quad
  };
  std::int32_t violation;
  Noun noun;
  std::int64_t number;
  geometry::Vec3 point;
};

const char* word_of(OffenderPlace::Noun noun) {
  static constexpr const char* words[] = {
      "vertex", "triangle",   "tetrahedron",       "pyramid",
      "prism",  "hexahedron", "boundary triangle", "boundary quadrilateral"};
  return words[static_cast<std::size_t>(noun)];
}

OffenderPlace place_of_cell(const Piece& piece, LocalIndex number) {
  if (piece.kind == CellKind::triangle)
    return {0, OffenderPlace::Noun::triangle, number, mean_point(piece, corners_of_boundary(piece, number))};
  const CellOfPiece cell = cell_of(piece, number);
  const auto noun = static_cast<OffenderPlace::Noun>(static_cast<int>(OffenderPlace::Noun::tetrahedron) +
                                                     static_cast<int>(cell.shape));
  const auto corners = static_cast<std::size_t>(corners_of(cell.shape));
  return {0, noun, cell.index, mean_point(piece, {vertices_of(piece, cell), corners})};
}

OffenderPlace place_of_face(const Piece& piece, LocalIndex face) {
  const geometry::Vec3 middle = mean_point(piece, corners_of_boundary(piece, face));
  if (face >= piece.boundary_count())
    return {0, OffenderPlace::Noun::quad, face - piece.boundary_count(), middle};
  return {0,
          piece.kind == CellKind::triangle ? OffenderPlace::Noun::triangle
                                           : OffenderPlace::Noun::boundary_triangle,
          face, middle};
}

OffenderPlace place_of(const Piece& piece, const Offender& offender) {
  const auto index = static_cast<LocalIndex>(offender.item);
  if (offender.entity == Entity::vertex) return {0, OffenderPlace::Noun::vertex, index, piece.point(index)};
  if (offender.entity == Entity::cell) return place_of_cell(piece, index);
  if (offender.entity == Entity::boundary_face) return place_of_face(piece, index);
  std::array<LocalIndex, 4> corners;
  std::size_t count = 0;
  OffenderPlace place;
  if (offender.entity == Entity::cell_face) {
    const SideOfCell side = cell_at_side(piece, static_cast<std::size_t>(offender.item));
    place = place_of_cell(piece, side.cell);
    for (const LocalIndex v : PieceFaces(piece).side(side.cell, side.side)) {
      if (v >= 0) corners[count++] = v;
    }
  } else {
    const EdgeOfFace edge = face_at_edge(piece, offender.item);
    place = place_of_face(piece, edge.face);
    const std::span<const LocalIndex> face = corners_of_boundary(piece, edge.face);
    const auto k = static_cast<std::size_t>(edge.edge);
    corners[count++] = face[k];
    corners[count++] = face[(k + 1) % face.size()];
  }
  place.point = mean_point(piece, std::span(corners).first(count));
  return place;
}

bool before(const Offender& a, const Offender& b) {
  return std::tie(a.key, a.piece, a.entity, a.item) < std::tie(b.key, b.piece, b.entity, b.item);
}

}  // namespace

void Findings::add(Violation violation, const Offender& offender) {
  Finding& finding = _table[static_cast<std::size_t>(violation)];
  if (finding.count++ == 0 || before(offender, finding.first)) finding.first = offender;
}

bool Findings::any(const parallel::Communicator& communicator) const {
  std::int64_t found = 0;
  for (const Finding& finding : _table) found += finding.count;
  return communicator.sum(found) > 0;
}

Findings::Table Findings::over_all_ranks(const parallel::Communicator& communicator) const {
  Table total;
  for (const Table& table : communicator.all_gather_items(std::span<const Table>(&_table, 1))) {
    for (std::size_t v = 0; v < violation_count; ++v) {
      if (table[v].count == 0) continue;
      if (total[v].count == 0 || before(table[v].first, total[v].first)) total[v].first = table[v].first;
      total[v].count += table[v].count;
    }
  }
  return total;
}

std::vector<std::string> Findings::sentences(const DistributedMesh& mesh) const {
  const parallel::Communicator& communicator = mesh.communicator;
  const Table table = over_all_ranks(communicator);
  std::vector<OffenderPlace> mine;
  for (std::size_t v = 0; v < violation_count; ++v) {
    const auto holder = std::find_if(mesh.pieces.begin(), mesh.pieces.end(),
                                     [&](const Piece& piece) { return piece.id == table[v].first.piece; });
    if (table[v].count == 0 || holder == mesh.pieces.end()) continue;
    mine.push_back(place_of(*holder, table[v].first));
    mine.back().violation = static_cast<std::int32_t>(v);
  }
  const bool here = std::any_of(mesh.pieces.begin(), mesh.pieces.end(),
                                [](const Piece& piece) { return !piece.has_tetrahedra_alone(); });
  const bool is_mixed = communicator.maximum(std::int64_t{here}) > 0;
  std::vector<OffenderPlace> places = communicator.gather_sorted(mine, &OffenderPlace::violation);
  std::vector<std::string> result;
  for (const OffenderPlace& place : places) {
    const auto& [count, first] = table[static_cast<std::size_t>(place.violation)];
    result.push_back(fmt::format("{}: {}, the first being {} {} of piece {} at ({:.9g}, {:.9g}, {:.9g})",
                                 rule_in_words(static_cast<std::size_t>(place.violation), is_mixed), count,
                                 word_of(place.noun), place.number, first.piece, place.point.x, place.point.y,
                                 place.point.z));
  }
  return result;
}

}  // namespace aeroloom::mesh
