#include "geometry/predicates.hpp"
#include "mesh/matching.hpp"
#include "mesh/validity.hpp"
#include "mesh/validity_checks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace aeroloom::mesh {

using geometry::Vec3;

namespace {

constexpr double volume_tolerance = 1e-10;
constexpr int triangle_role = 1;

/// Volume of a piece's cells; those that are not exactly positive are reported.
double measure_cells(const Piece& piece, Findings& findings) {
  CompensatedSum sum;
  for (LocalIndex c = 0; c < piece.cell_count(); ++c) {
    const LocalIndex* v = piece.cell(c);
    const Vec3 p[4] = {piece.point(v[0]), piece.point(v[1]), piece.point(v[2]), piece.point(v[3])};
    const double volume = geometry::volume6(p[0], p[1], p[2], p[3]);
    if (!std::isfinite(volume) || !geometry::has_positive_volume(p[0], p[1], p[2], p[3])) {
      findings.add(Violation::volume_not_positive, {{piece.id, c}, piece.id, Entity::cell, c});
    }
    sum.add(volume);
  }
  return sum.value() / 6;
}

/// Whether two cells of one region meet on opposite sides, and nothing else: so it is nearly everywhere.
bool is_inside_region(std::span<const Member> members) {
  return members.size() == 2 && members[0].role() == cell_role && members[1].role() == cell_role &&
         members[0].label == members[1].label && members[0].odd() != members[1].odd();
}

/// What meets at a face.
struct FaceParts {
  const Member *cell = nullptr, *other_cell = nullptr, *triangle = nullptr;
  std::size_t cells = 0, triangles = 0;
};

FaceParts sort_out(std::span<const Member> members) {
  FaceParts parts;
  for (const Member& member : members) {
    if (member.role() == triangle_role) {
      parts.triangle = &member, ++parts.triangles;
    } else {
      (parts.cells++ == 0 ? parts.cell : parts.other_cell) = &member;
    }
  }
  return parts;
}

/// On the boundary of the domain: a boundary triangle of an outer face that agrees with the cell on outside.
/// Cells are labelled with their region.
std::optional<Violation> judge_one_cell(const FaceParts& parts, FaceSides sides) {
  if (parts.triangles == 0) return Violation::face_without_partner;
  if (parts.triangles > 1) return Violation::repeated_triangle;
  if (sides.is_inner()) return Violation::inner_triangle_of_one_cell;
  if (parts.triangle->odd() != parts.cell->odd()) return Violation::triangle_turned_inward;
  return parts.cell->label != sides.front ? std::optional(Violation::triangle_of_other_regions)
                                          : std::nullopt;
}

/// Between two cells: on opposite sides, with one triangle of an inner face exactly where a region ends.
std::optional<Violation> judge_two_cells(const FaceParts& parts, FaceSides sides) {
  if (parts.cell->odd() == parts.other_cell->odd()) return Violation::cells_on_one_side;
  if (parts.triangles == 0) {
    return parts.cell->label != parts.other_cell->label ? std::optional(Violation::regions_without_triangle)
                                                        : std::nullopt;
  }
  if (!sides.is_inner()) return Violation::triangle_inside_mesh;
  if (parts.triangles > 1) return Violation::repeated_triangle;
  const bool first_in_front = parts.cell->odd() == parts.triangle->odd();
  const Member& front = first_in_front ? *parts.cell : *parts.other_cell;
  const Member& back = first_in_front ? *parts.other_cell : *parts.cell;
  return front.label != sides.front || back.label != sides.back
             ? std::optional(Violation::triangle_of_other_regions)
             : std::nullopt;
}

void check_faces(const parallel::Communicator& communicator, const DistributedMesh& mesh,
                 const Numbering& numbering, Findings& findings) {
  const auto faces = [](const Piece& piece, const auto& sink) {
    for (LocalIndex t = 0; t < piece.boundary_count(); ++t) {
      const LocalIndex* v = piece.boundary_triangle(t);
      sink(std::array<LocalIndex, 3>{v[0], v[1], v[2]}, triangle_role, static_cast<std::uint32_t>(t));
    }
  };
  const auto label = [](const Piece& piece, int role, std::int64_t item) {
    return role == cell_role ? piece.region : piece.triangle_face[item];
  };
  const auto judge = [&mesh](std::span<const Member> members) -> std::optional<Violation> {
    if (is_inside_region(members)) return std::nullopt;
    const FaceParts parts = sort_out(members);
    if (parts.cells > 2) return Violation::face_of_many_cells;
    if (parts.cells == 0) return Violation::triangle_without_cell;
    const FaceSides sides = parts.triangle ? mesh.sides_of(parts.triangle->label) : FaceSides{};
    return parts.cells == 1 ? judge_one_cell(parts, sides) : judge_two_cells(parts, sides);
  };
  match_all<3>(communicator, mesh, numbering,
               Matching{{Entity::cell_face, Entity::triangle}, faces, label, judge, CellFaces::matched},
               findings);
}

/// Sums the cells and the divergence integral over the boundary, and compares, region by region.
void check_volumes(const parallel::Communicator& communicator, const DistributedMesh& mesh,
                   ValidityReport& report, Findings& findings) {
  std::vector<RegionTerm> of_cells;
  for (const Piece& piece : mesh.pieces) {
    of_cells.push_back({piece.region, piece.id, measure_cells(piece, findings)});
  }
  report.region_volumes = sum_by_region(communicator, mesh, of_cells);
  const std::vector<double> enclosed = enclosed_volumes(communicator, mesh);
  for (RegionId region = 0; region < mesh.region_count(); ++region) {
    const double filled = report.region_volumes[region], surrounded = enclosed[region];
    report.volume += filled;
    report.surface_volume += surrounded;
    const double larger = std::max(std::abs(filled), std::abs(surrounded));
    if (std::abs(filled - surrounded) <= volume_tolerance * larger) continue;
    report.violations.push_back(
        fmt::format("{}the tetrahedra fill {:.17g}, but the boundary encloses {:.17g}",
                    region_prefix(mesh, region), filled, surrounded));
  }
}

}  // namespace

ValidityReport check_volume_mesh(const parallel::Communicator& communicator, const DistributedMesh& mesh,
                                 const Numbering& numbering, const DistributedMesh* surface) {
  require_checkable(communicator, mesh, CellKind::tetrahedron, numbering);
  ValidityReport report;
  Findings in_mesh, in_surface;
  check_finite_coordinates(mesh, numbering, in_mesh);
  check_shared_coordinates(communicator, mesh, numbering, in_mesh);
  check_orphans(mesh, numbering, in_mesh);
  check_labels(mesh, in_mesh);
  check_volumes(communicator, mesh, report, in_mesh);
  check_faces(communicator, mesh, numbering, in_mesh);
  // The boundary of a boundary is nothing: where all faces are sound, the triangles around a region close.
  if (in_mesh.any(communicator)) check_boundary_edges(communicator, mesh, numbering, in_mesh);
  if (surface != nullptr) check_same_triangles(communicator, mesh, *surface, in_mesh, in_surface);
  std::vector<std::string> sentences = in_mesh.sentences(communicator, mesh);
  if (surface != nullptr) {
    for (auto& sentence : in_surface.sentences(communicator, *surface)) sentences.push_back(sentence);
  }
  if (numbering.cell_count == 0) sentences.push_back("the mesh has no tetrahedra");
  report.violations.insert(report.violations.begin(), sentences.begin(), sentences.end());
  return report;
}

}  // namespace aeroloom::mesh
