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
constexpr int cell_role = 0, triangle_role = 1;

/// Volume of a piece's cells; those that are not exactly positive are reported.
double measure_cells(const Piece& piece, Findings& findings) {
  CompensatedSum sum;
  for (LocalIndex c = 0; c < piece.cell_count(); ++c) {
    const LocalIndex* v = piece.cell(c);
    const Vec3 p[4] = {piece.point(v[0]), piece.point(v[1]), piece.point(v[2]), piece.point(v[3])};
    const double volume = geometry::volume6(p[0], p[1], p[2], p[3]);
    if (!std::isfinite(volume) || geometry::orient3d(p[0], p[1], p[2], p[3]) <= 0) {
      findings.add(Violation::volume_not_positive, {{piece.id, c}, piece.id, Entity::cell, c});
    }
    sum.add(volume);
  }
  return sum.value() / 6;
}

/// What meets at a face: one cell and one boundary triangle that agree on outside, or two cells on opposite
/// sides.
std::optional<Violation> judge_face(std::span<const Member> members) {
  const Member *cell = nullptr, *other_cell = nullptr, *triangle = nullptr;
  std::size_t cells = 0, triangles = 0;
  for (const Member& member : members) {
    if (member.role() == triangle_role) {
      triangle = &member, ++triangles;
    } else {
      (cells++ == 0 ? cell : other_cell) = &member;
    }
  }
  if (cells > 2) return Violation::face_of_many_cells;
  if (cells == 0) return Violation::triangle_without_cell;
  if (cells == 2) {
    if (triangles > 0) return Violation::triangle_inside_mesh;
    return cell->odd() == other_cell->odd() ? std::optional(Violation::cells_on_one_side) : std::nullopt;
  }
  if (triangles == 0) return Violation::face_without_partner;
  if (triangles > 1) return Violation::repeated_triangle;
  return triangle->odd() != cell->odd() ? std::optional(Violation::triangle_turned_inward) : std::nullopt;
}

void check_faces(const parallel::Communicator& communicator, const DistributedMesh& mesh,
                 const Numbering& numbering, Findings& findings) {
  const auto faces = [](const Piece& piece, const auto& sink) {
    for (LocalIndex c = 0; c < piece.cell_count(); ++c) {
      const LocalIndex* v = piece.cell(c);
      for (int f = 0; f < 4; ++f) {
        const auto& face = tetrahedron_faces[f];
        sink(std::array<LocalIndex, 3>{v[face[0]], v[face[1]], v[face[2]]}, cell_role,
             4 * static_cast<std::uint32_t>(c) + f);
      }
    }
    for (LocalIndex t = 0; t < piece.boundary_count(); ++t) {
      const LocalIndex* v = piece.boundary_triangle(t);
      sink(std::array<LocalIndex, 3>{v[0], v[1], v[2]}, triangle_role, static_cast<std::uint32_t>(t));
    }
  };
  match_all<3>(communicator, mesh, numbering, {Entity::cell_face, Entity::triangle}, faces, judge_face,
               findings);
}

/// Sums the cells and the divergence integral over the boundary, and compares.
void check_volumes(const parallel::Communicator& communicator, const DistributedMesh& mesh,
                   ValidityReport& report, Findings& findings) {
  const Vec3 origin = center_of_mesh(communicator, mesh);
  std::vector<double> of_cells, enclosed;
  for (const Piece& piece : mesh.pieces) {
    of_cells.push_back(measure_cells(piece, findings));
    enclosed.push_back(enclosed_volume(piece, origin));
  }
  report.volume = sum_over_pieces(communicator, mesh, of_cells);
  report.surface_volume = sum_over_pieces(communicator, mesh, enclosed);
}

bool volumes_agree(const ValidityReport& report) {
  const double larger = std::max(std::abs(report.volume), std::abs(report.surface_volume));
  return std::abs(report.volume - report.surface_volume) <= volume_tolerance * larger;
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
  check_boundary_edges(communicator, mesh, numbering, in_mesh);
  if (surface != nullptr) check_same_triangles(communicator, mesh, *surface, in_mesh, in_surface);
  report.violations = in_mesh.sentences(communicator, mesh);
  if (surface != nullptr) {
    for (auto& sentence : in_surface.sentences(communicator, *surface)) report.violations.push_back(sentence);
  }
  if (numbering.cell_count == 0) report.violations.push_back("the mesh has no tetrahedra");
  if (!volumes_agree(report)) {
    report.violations.push_back(fmt::format("the tetrahedra fill {:.17g}, but the boundary encloses {:.17g}",
                                            report.volume, report.surface_volume));
  }
  return report;
}

}  // namespace aeroloom::mesh
