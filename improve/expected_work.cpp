#include "improve/expected_work.hpp"

#include "improve/limits/examination.hpp"
#include "mesh/quality/tet_quality.hpp"

namespace aeroloom::improve {
namespace {

/// Degrees: least angles of the lattice off the surface, where its tetrahedra come from a table, are not
/// below (34.9 at the perturbations that are allowed).
constexpr double lattice_angle = 33;

/// Of the time of reading one tetrahedron in, 0.5 microseconds: work on a bad one, measured (25
/// microseconds); looking at one of the lattice, chosen, not measured.
constexpr double work_per_bad = 50;
constexpr double work_per_lattice_cell = 0.1;

double work_of(double cells, double bad) {
  return cells + work_per_bad * bad;
}

}  // namespace

std::optional<BadState> look_at_lattice(const mesh::Piece& piece, const ImproveOptions& options) {
  if (piece.boundary_count() > 0 || options.target_angle > lattice_angle) return std::nullopt;
  const mesh::TetQuality measure(lattice_angle);
  Examination examination(measure);
  for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) {
    const auto p = points_of(piece, t);
    examination.add(measure(p[0], p[1], p[2], p[3]), p);
    if (examination.state.bad > 0) return std::nullopt;
  }
  return examination.state;
}

double expected_work(const mesh::Piece& piece, const ImproveOptions& options) {
  if (look_at_lattice(piece, options)) return work_per_lattice_cell * static_cast<double>(piece.cell_count());
  const mesh::TetQuality measure(options.target_angle);
  std::int64_t bad = 0;
  for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) {
    bad += quality_of(piece, t, measure) < measure.target();
  }
  return work_of(piece.cell_count(), static_cast<double>(bad));
}

double expected_work(double cells, const ImproveReport& report) {
  return report.is_lattice ? work_per_lattice_cell * cells
                           : work_of(cells, static_cast<double>(report.bad_before));
}

}  // namespace aeroloom::improve
