/// The improver alone: a box with a spherical hole under uniform and graded sizes.
/// usage: improve_benchmark [BALL_PARTS] [TARGET_ANGLE]; the ball's surface has 20 BALL_PARTS^2 triangles.
#include "improve/improver.hpp"
#include "mesh/quality.hpp"
#include "parallel/environment.hpp"
#include "parallel/timers.hpp"
#include "tests/volume/fields.hpp"
#include "tests/volume/surfaces.hpp"
#include "volume/volume_mesher.hpp"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace {

using aeroloom::mesh::LocalIndex;
using aeroloom::mesh::Piece;

/// The angles of a piece, degrees.
struct Angles {
  double smallest = 180, largest = 0;
  std::array<std::int64_t, 4> below{};  ///< tetrahedra whose smallest angle is below 5, 10, 15, 20
};

Angles measure_angles(const Piece& piece) {
  Angles angles;
  for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
    const LocalIndex* c = piece.cell(t);
    const auto range = aeroloom::mesh::dihedral_range(piece.point(c[0]), piece.point(c[1]), piece.point(c[2]),
                                                      piece.point(c[3]));
    angles.smallest = std::min(angles.smallest, range.smallest);
    angles.largest = std::max(angles.largest, range.largest);
    for (int i = 0; i < 4; ++i) angles.below[i] += range.smallest < 5 * (i + 1);
  }
  return angles;
}

Piece fill(const aeroloom::volume::ClosedSurface& surface, const aeroloom::sizing::SizeField& field) {
  aeroloom::volume::FilledVolume filled = aeroloom::volume::fill_volume(surface, field, {});
  Piece piece;
  piece.coordinates = std::move(filled.coordinates);
  piece.cells = std::move(filled.tetrahedra);
  piece.vertex_dimension.assign(piece.vertex_count(), 3);
  std::fill_n(piece.vertex_dimension.begin(), surface.points.size(), 2);
  piece.vertex_entity.assign(piece.vertex_count(), 0);
  for (const auto& triangle : surface.triangles) {
    piece.boundary.insert(piece.boundary.end(), triangle.begin(), triangle.end());
  }
  return piece;
}

void run(const std::string& name, Piece piece, const aeroloom::improve::ImproveOptions& options) {
  const Angles before = measure_angles(piece);
  const LocalIndex tets = piece.cell_count();
  const double start = aeroloom::parallel::cpu_seconds();
  const auto report = aeroloom::improve::improve_piece(piece, options);
  const double seconds = aeroloom::parallel::cpu_seconds() - start;
  const Angles after = measure_angles(piece);
  std::printf(
      "RESULT benchmark=improve case=%s target_deg=%g tets_before=%d tets_after=%d cpu_seconds=%.3f "
      "seconds_per_million=%.3f bad_before=%lld bad_after=%lld smoothed=%lld swaps=%lld",
      name.c_str(), options.target_angle, tets, piece.cell_count(), seconds, 1e6 * seconds / tets,
      static_cast<long long>(report.bad_before), static_cast<long long>(report.bad_after),
      static_cast<long long>(report.smoothed), static_cast<long long>(report.swaps));
  for (const auto& [when, angles] : {std::pair("before", before), std::pair("after", after)}) {
    std::printf(" min_angle_%s=%.3f max_angle_%s=%.3f", when, angles.smallest, when, angles.largest);
    for (int i = 0; i < 4; ++i) {
      std::printf(" below_%d_%s=%lld", 5 * (i + 1), when, static_cast<long long>(angles.below[i]));
    }
  }
  std::printf("\n");
}

}  // namespace

int main(int argc, char** argv) {
  namespace volume = aeroloom::volume;
  volume::register_volume_tasks();
  const aeroloom::parallel::Environment environment(argc, argv);
  const int ball_parts = argc > 1 ? std::atoi(argv[1]) : 14;
  aeroloom::improve::ImproveOptions options;
  if (argc > 2) options.target_angle = std::atof(argv[2]);
  const double size = 1.1 / ball_parts;
  run("uniform",
      fill(volume::surfaces::cube_with_ball(static_cast<int>(4 / size), ball_parts),
           volume::fields::uniform(size)),
      options);
  run("graded",
      fill(volume::surfaces::cube_with_ball(static_cast<int>(0.5 / size), ball_parts),
           volume::fields::around_unit_sphere(size, 8 * size)),
      options);
  return 0;
}
