#include "geometry/predicates.hpp"
#include "mesh/checks/validity.hpp"
#include "mesh/checks/validity_checks.hpp"
#include "mesh/data/piece_faces.hpp"
#include "mesh/exchange/matching.hpp"
#include "mesh/quality/cell_measures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
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

/// The volume of one cell, times six; reported where it is not exactly positive.
double judge_tetrahedron(const Piece& piece, LocalIndex c, Findings& findings) {
  const LocalIndex* v = piece.cell(c);
  const Vec3 p[4] = {piece.point(v[0]), piece.point(v[1]), piece.point(v[2]), piece.point(v[3])};
  const double volume = geometry::volume6(p[0], p[1], p[2], p[3]);
  if (!std::isfinite(volume) || !geometry::has_positive_volume(p[0], p[1], p[2], p[3]))
    findings.add(Violation::volume_not_positive, {{piece.id, c}, piece.id, Entity::cell, c});
  return volume;
}

/// Pyramids and prisms: by their bilinear volume, and exactly at each corner.
double judge_other_cell(const Piece& piece, LocalIndex c, Findings& findings) {
  const CellOfPiece cell = cell_of(piece, c);
  std::array<Vec3, most_corners> points;
  points_of(piece, cell, points.data());
  const double volume = cell_volume(cell.shape, points.data());
  const Offender offender{{piece.id, c}, piece.id, Entity::cell, c};
  if (!std::isfinite(volume) || volume <= 0) {
    findings.add(Violation::volume_not_positive, offender);
  } else if (!has_positive_corners(cell.shape, points.data())) {
    findings.add(Violation::corner_not_positive, offender);
  }
  return 6 * volume;
}

/// The volumes of a piece's cells by region.
void measure_cells(const Piece& piece, std::vector<RegionTerm>& terms, Findings& findings) {
  std::map<RegionId, CompensatedSum> sums;
  LocalIndex first = 0;
  for (const CellShape shape : cell_shapes) {
    for_each_region_run(piece, shape, [&](RegionId region, LocalIndex begin, LocalIndex end) {
      CompensatedSum& sum = sums[region];
      for (LocalIndex c = first + begin; c < first + end; ++c)
        sum.add(shape == CellShape::tetrahedron ? judge_tetrahedron(piece, c, findings)
                                                : judge_other_cell(piece, c, findings));
    });
    first += static_cast<LocalIndex>(connectivity_of(piece, shape).size() /
                                     static_cast<std::size_t>(corners_of(shape)));
  }
  for (const auto& [region, sum] : sums) terms.push_back({region, piece.id, sum.value() / 6});
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

/// Calls sink(corners, role, item) for the faces of pyramids, prisms and hexahedra with N corners, and
/// for boundary faces.
template <std::size_t N, class Sink>
void enumerate_faces(const Piece& piece, const Sink& sink) {
  const auto face_of = [](const LocalIndex* v, const auto& face) {
    std::array<LocalIndex, N> corners;
    for (std::size_t k = 0; k < N; ++k) corners[k] = v[face[k]];
    return corners;
  };
  const LocalIndex first = N == 3 ? 0 : piece.boundary_count();
  const LocalIndex last = N == 3 ? piece.boundary_count() : boundary_face_count(piece);
  for (LocalIndex f = first; f < last; ++f)
    sink(face_of(corners_of_boundary(piece, f).data(), std::array{0, 1, 2, 3}), triangle_role,
         static_cast<std::uint32_t>(f));
  auto item = static_cast<std::uint32_t>(first_side(piece, piece.cell_count()));
  for (const CellShape shape : {CellShape::pyramid, CellShape::prism, CellShape::hexahedron}) {
    const std::span<const LocalIndex> corners = connectivity_of(piece, shape);
    for (std::size_t i = 0; i < corners.size(); i += static_cast<std::size_t>(corners_of(shape))) {
      for (const CellFace& face : faces_of(shape)) {
        if ((face[3] < 0) == (N == 3)) sink(face_of(corners.data() + i, face), cell_role, item);
        ++item;
      }
    }
  }
}

/// Triangles with N = 3, those of tetrahedra among them; quadrilaterals with N = 4.
template <std::size_t N>
void check_faces(const NumberedMesh& mesh, Findings& findings) {
  const auto faces = [](const Piece& piece, const auto& sink) { enumerate_faces<N>(piece, sink); };
  const auto label = [](const Piece& piece, int role, std::int64_t item) {
    if (role != cell_role) return cad_face_of(piece, static_cast<LocalIndex>(item));
    if (piece.runs.empty()) return piece.region;
    return region_of(piece, cell_at_side(piece, static_cast<std::size_t>(item)).cell);
  };
  const auto judge = [&mesh](std::span<const Member> members) -> std::optional<Violation> {
    if (is_inside_region(members)) return std::nullopt;
    const FaceParts parts = sort_out(members);
    if (parts.cells > 2) return Violation::face_of_many_cells;
    if (parts.cells == 0) return Violation::triangle_without_cell;
    const FaceSides sides = parts.triangle ? mesh.sides_of(parts.triangle->label) : FaceSides{};
    return parts.cells == 1 ? judge_one_cell(parts, sides) : judge_two_cells(parts, sides);
  };
  match_all<N>(mesh,
               Matching{{Entity::cell_face, Entity::boundary_face},
                        faces,
                        label,
                        judge,
                        N == 3 ? CellFaces::matched : CellFaces::left_out},
               findings);
}

/// Whether any piece has cells or faces of other shapes than tetrahedra and triangles. Collective.
bool has_other_shapes(const DistributedMesh& mesh) {
  const parallel::Communicator& communicator = mesh.communicator;
  const bool here = std::any_of(mesh.pieces.begin(), mesh.pieces.end(),
                                [](const Piece& piece) { return !piece.has_tetrahedra_alone(); });
  return communicator.maximum(std::int64_t{here}) > 0;
}

/// Sums the cells and the divergence integral over the boundary, and compares, region by region.
void check_volumes(const DistributedMesh& mesh, const char* cells, ValidityReport& report,
                   Findings& findings) {
  std::vector<RegionTerm> of_cells;
  for (const Piece& piece : mesh.pieces) measure_cells(piece, of_cells, findings);
  report.region_volumes = sum_by_region(mesh, of_cells);
  const std::vector<double> enclosed = enclosed_volumes(mesh);
  for (RegionId region = 0; region < mesh.region_count(); ++region) {
    const double filled = report.region_volumes[region], surrounded = enclosed[region];
    report.volume += filled;
    report.surface_volume += surrounded;
    const double larger = std::max(std::abs(filled), std::abs(surrounded));
    if (std::abs(filled - surrounded) <= volume_tolerance * larger) continue;
    report.violations.push_back(fmt::format("{}the {} fill {:.17g}, but the boundary encloses {:.17g}",
                                            region_prefix(mesh, region), cells, filled, surrounded));
  }
}

}  // namespace

ValidityReport check_volume_mesh(const NumberedMesh& mesh, const DistributedMesh* surface) {
  const parallel::Communicator& communicator = mesh.communicator;
  require_checkable(mesh, CellKind::tetrahedron);
  ValidityReport report;
  Findings in_mesh, in_surface;
  check_finite_coordinates(mesh, in_mesh);
  check_shared_coordinates(mesh, in_mesh);
  check_orphans(mesh, in_mesh);
  check_labels(mesh, in_mesh);
  const bool mixed = has_other_shapes(mesh);
  check_volumes(mesh, mixed ? "cells" : "tetrahedra", report, in_mesh);
  check_faces<3>(mesh, in_mesh);
  if (mixed) check_faces<4>(mesh, in_mesh);
  // The boundary of a boundary is nothing: where all faces are sound, the triangles around a region close.
  if (in_mesh.any(communicator)) check_boundary_edges(mesh, in_mesh);
  if (surface != nullptr) check_same_triangles(mesh, *surface, in_mesh, in_surface);
  std::vector<std::string> sentences = in_mesh.sentences(mesh);
  if (surface != nullptr) {
    for (auto& sentence : in_surface.sentences(*surface)) sentences.push_back(sentence);
  }
  if (mesh.numbering.cell_count == 0) sentences.push_back("the mesh has no tetrahedra");
  report.violations.insert(report.violations.begin(), sentences.begin(), sentences.end());
  return report;
}

}  // namespace aeroloom::mesh
