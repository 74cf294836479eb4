/// The improver alone, piece by piece on one rank: improve_benchmark CASE [KEY=VALUE ...] prints one RESULT
/// line. The boundary may change, but does not slide on the CAD.
#include "benchmarks/case_surface.hpp"
#include "improve/improver.hpp"
#include "mesh/quality/quality.hpp"
#include "parallel/communication/environment.hpp"
#include "parallel/observation/log.hpp"
#include "volume/volume_mesher.hpp"

#include <array>
#include <cstdio>
#include <exception>

namespace {

using namespace aeroloom;
using mesh::LocalIndex;
using parallel::Communicator;

/// The angles of a mesh, degrees.
struct Angles {
  double smallest = 180, largest = 0;
  std::array<std::int64_t, 4> below{};  ///< tetrahedra whose smallest angle is below 5, 10, 15, 20
  std::int64_t tetrahedra = 0;
};

Angles measure_angles(const mesh::DistributedMesh& filled) {
  Angles angles;
  for (const mesh::Piece& piece : filled.pieces) {
    angles.tetrahedra += piece.cell_count();
    for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const LocalIndex* c = piece.cell(t);
      const auto range =
          mesh::dihedral_range(piece.point(c[0]), piece.point(c[1]), piece.point(c[2]), piece.point(c[3]));
      angles.smallest = std::min(angles.smallest, range.smallest);
      angles.largest = std::max(angles.largest, range.largest);
      for (int i = 0; i < 4; ++i) angles.below[i] += range.smallest < 5 * (i + 1);
    }
  }
  return angles;
}

mesh::DistributedMesh fill(const surface::SurfaceMesh& from, const volume::VolumeOptions& options) {
  const volume::VolumeInput task{from, options};
  volume::VolumeReport report;
  return volume::fill_zones(task, volume::decompose(task), report);
}

void run(const Communicator& communicator, const cases::Case& input) {
  const surface::SurfaceMesh from = benchmarks::mesh_surface(communicator, input);
  mesh::DistributedMesh filled = fill(from, input.volume);
  const Angles before = measure_angles(filled);
  improve::ImproveReport total;
  const double start = parallel::cpu_seconds();
  for (mesh::Piece& piece : filled.pieces) {
    const improve::ImproveReport report =
        improve::improve_piece(piece, input.improve, {nullptr, &from.field});
    total.bad_before += report.bad_before;
    total.bad_after += report.bad_after;
    total.smoothed += report.smoothed;
    total.replaced += report.replaced;
  }
  const double seconds = parallel::cpu_seconds() - start;
  const Angles after = measure_angles(filled);
  std::printf(
      "RESULT pieces=%zu target_deg=%g tets_before=%lld tets_after=%lld cpu_seconds=%.3f "
      "seconds_per_million=%.3f bad_before=%lld bad_after=%lld smoothed=%lld replaced=%lld",
      filled.pieces.size(), input.improve.target_angle, static_cast<long long>(before.tetrahedra),
      static_cast<long long>(after.tetrahedra), seconds,
      1e6 * seconds / static_cast<double>(before.tetrahedra), static_cast<long long>(total.bad_before),
      static_cast<long long>(total.bad_after), static_cast<long long>(total.smoothed),
      static_cast<long long>(total.replaced));
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
  const parallel::Environment environment(argc, argv);
  const Communicator world = Communicator::world();
  if (argc < 2 || world.size() > 1) {
    if (world.is_root()) std::fprintf(stderr, "usage: improve_benchmark CASE [KEY=VALUE ...], on one rank\n");
    return 2;
  }
  try {
    parallel::configure_log(world, parallel::LogLevel::quiet);
    run(world, cases::read_case(argv[1], {argv + 2, argv + argc}));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
