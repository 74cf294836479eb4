#include "geometry/predicates.hpp"
#include "mesh/checks/validity.hpp"
#include "mesh/checks/validity_checks.hpp"
#include "mesh/exchange/matching.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <fmt/format.h>

namespace aeroloom::mesh {

using geometry::Vec3;

namespace {

/// Exact: three points lie on one line when all three projections do.
bool is_degenerate(Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 ab = b - a, ac = c - a, normal = geometry::cross(ab, ac);
  const auto sum = [](Vec3 e) { return std::abs(e.x) + std::abs(e.y) + std::abs(e.z); };
  if (!std::isfinite(geometry::norm(normal))) return true;
  if (sum(normal) > 1e-14 * sum(ab) * sum(ac)) return false;  // rounding cannot matter
  return geometry::orient2d({a.x, a.y}, {b.x, b.y}, {c.x, c.y}) == 0 &&
         geometry::orient2d({a.y, a.z}, {b.y, b.z}, {c.y, c.z}) == 0 &&
         geometry::orient2d({a.z, a.x}, {b.z, b.x}, {c.z, c.x}) == 0;
}

void check_degenerate(const DistributedMesh& mesh, Findings& findings) {
  for (const Piece& piece : mesh.pieces) {
    for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const LocalIndex* v = piece.cell(t);
      if (!is_degenerate(piece.point(v[0]), piece.point(v[1]), piece.point(v[2]))) continue;
      findings.add(Violation::degenerate_triangle, {{piece.id, t}, piece.id, Entity::boundary_face, t});
    }
  }
}

void check_repeated(const NumberedMesh& mesh, Findings& findings) {
  const auto triangles = [](const Piece& piece, const auto& sink) {
    for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const LocalIndex* v = piece.cell(t);
      sink(std::array<LocalIndex, 3>{v[0], v[1], v[2]}, 0, static_cast<std::uint32_t>(t));
    }
  };
  const auto no_label = [](const Piece&, int, std::int64_t) { return 0; };
  const auto judge = [](std::span<const Member> members) {
    return members.size() > 1 ? std::optional(Violation::repeated_triangle) : std::nullopt;
  };
  match_all<3>(mesh, Matching{{Entity::boundary_face, Entity::boundary_face}, triangles, no_label, judge},
               findings);
}

}  // namespace

ValidityReport check_surface_mesh(const NumberedMesh& mesh) {
  require_checkable(mesh, CellKind::triangle);
  ValidityReport report;
  Findings findings;
  check_finite_coordinates(mesh, findings);
  check_shared_coordinates(mesh, findings);
  check_orphans(mesh, findings);
  check_labels(mesh, findings);
  check_degenerate(mesh, findings);
  check_repeated(mesh, findings);
  check_boundary_edges(mesh, findings);
  report.violations = findings.sentences(mesh);

  report.region_volumes = enclosed_volumes(mesh);
  for (RegionId region = 0; region < mesh.region_count(); ++region) {
    const double volume = report.region_volumes[region];
    report.volume += volume;
    if (volume > 0) continue;
    report.violations.push_back(fmt::format("{}the surface encloses {:.17g}, no positive volume",
                                            region_prefix(mesh, region), volume));
  }
  report.surface_volume = report.volume;
  return report;
}

}  // namespace aeroloom::mesh
