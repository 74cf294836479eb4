#include "mesh/findings.hpp"

#include <algorithm>
#include <span>
#include <tuple>

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

const char* noun_of(Entity entity, CellKind kind) {
  switch (entity) {
    case Entity::vertex:
      return "vertex";
    case Entity::cell:
    case Entity::cell_face:
      return kind == CellKind::tetrahedron ? "tetrahedron" : "triangle";
    default:
      return kind == CellKind::tetrahedron ? "boundary triangle" : "triangle";
  }
}

std::int64_t items_per_entity(Entity entity) {
  return entity == Entity::cell_face ? 4 : entity == Entity::triangle_edge ? 3 : 1;
}

geometry::Vec3 mean_point(const Piece& piece, const std::vector<LocalIndex>& vertices) {
  geometry::Vec3 sum;
  for (const LocalIndex v : vertices) sum += piece.point(v);
  return sum / static_cast<double>(vertices.size());
}

/// The vertex itself, or the mean of the corners of a cell, face, triangle or edge.
geometry::Vec3 place_of(const Piece& piece, const Offender& offender) {
  const auto index = static_cast<LocalIndex>(offender.item / items_per_entity(offender.entity));
  const auto part = offender.item % items_per_entity(offender.entity);
  switch (offender.entity) {
    case Entity::vertex:
      return piece.point(index);
    case Entity::cell: {
      const LocalIndex* cell = piece.cell(index);
      return mean_point(piece, {cell, cell + piece.vertices_per_cell()});
    }
    case Entity::cell_face: {
      const LocalIndex* cell = piece.cell(index);
      const auto& face = tetrahedron_faces[part];
      return mean_point(piece, {cell[face[0]], cell[face[1]], cell[face[2]]});
    }
    case Entity::triangle: {
      const LocalIndex* triangle = piece.boundary_triangle(index);
      return mean_point(piece, {triangle, triangle + 3});
    }
    default: {
      const LocalIndex* triangle = piece.boundary_triangle(index);
      return mean_point(piece, {triangle[part], triangle[(part + 1) % 3]});
    }
  }
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

std::vector<std::string> Findings::sentences(const parallel::Communicator& communicator,
                                             const DistributedMesh& mesh) const {
  struct Place {
    std::int64_t violation;
    geometry::Vec3 point;

    static constexpr auto fields() { return std::tuple(&Place::violation, &Place::point); }
  };
  const Table table = over_all_ranks(communicator);
  std::vector<Place> mine;
  for (std::size_t v = 0; v < violation_count; ++v) {
    const auto holder = std::find_if(mesh.pieces.begin(), mesh.pieces.end(),
                                     [&](const Piece& piece) { return piece.id == table[v].first.piece; });
    if (table[v].count == 0 || holder == mesh.pieces.end()) continue;
    mine.push_back({static_cast<std::int64_t>(v), place_of(*holder, table[v].first)});
  }
  std::vector<Place> places = communicator.all_gather_items(std::span<const Place>(mine));
  std::sort(places.begin(), places.end(),
            [](const Place& a, const Place& b) { return a.violation < b.violation; });
  std::vector<std::string> result;
  for (const Place& place : places) {
    const auto& [count, first] = table[place.violation];
    result.push_back(fmt::format("{}: {}, the first being {} {} of piece {} at ({:.9g}, {:.9g}, {:.9g})",
                                 rule_of(place.violation), count, noun_of(first.entity, mesh.kind),
                                 first.item / items_per_entity(first.entity), first.piece, place.point.x,
                                 place.point.y, place.point.z));
  }
  return result;
}

}  // namespace aeroloom::mesh
