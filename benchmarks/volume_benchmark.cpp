/// The volume stage alone: mpirun -n N volume_benchmark CASE [KEY=VALUE ...] prints one RESULT line.
///
/// CPU figures are those of the stage clock: around the tasks and in the sandboxed children, without waiting.
#include "benchmarks/case_surface.hpp"
#include "mesh/checks/validity.hpp"
#include "mesh/quality/quality.hpp"
#include "parallel/communication/environment.hpp"
#include "parallel/observation/log.hpp"
#include "volume/volume_mesher.hpp"

#include <cstdio>
#include <exception>

namespace {

using namespace aeroloom;
using parallel::Communicator;

void run(const Communicator& communicator, const cases::Case& input) {
  const surface::SurfaceMesh from = benchmarks::mesh_surface(communicator, input);
  const volume::VolumeInput task{from, input.volume};
  parallel::StageClock clock;
  clock.begin("decompose");
  volume::Decomposition decomposition = volume::decompose(task);
  clock.end();
  const volume::DecompositionReport parts = decomposition.report();
  volume::VolumeReport report;
  clock.begin("volume");
  mesh::DistributedMesh made = volume::fill_zones(task, std::move(decomposition), report);
  clock.end();
  const std::vector<parallel::StageSummary> stages = clock.summarise(communicator);
  const mesh::NumberedMesh filled = mesh::number_mesh(std::move(made));
  const bool valid = mesh::check_volume_mesh(filled, &from).valid();
  const auto quality = mesh::summarise_quality(filled);
  const std::string hash = mesh::hash_mesh(filled);
  if (!communicator.is_root()) return;
  const parallel::StageSummary &points = stages[0], &filling = stages[1];
  const double cpu = (points.cpu_seconds_mean + filling.cpu_seconds_mean) * communicator.size();
  const auto tetrahedra = static_cast<double>(filled.numbering.cell_count);
  std::printf(
      "RESULT ranks=%d zones=%d blocks=%lld lattice_points=%lld overlap=%.3f imbalance=%.3f tets=%.0f "
      "valid=%d "
      "decompose_wall=%.3f volume_wall=%.3f decompose_cpu=%.3f volume_cpu=%.3f volume_cpu_max=%.3f "
      "serial_seconds=%.3f tets_per_cpu_second=%.0f peak_bytes_per_tet=%.0f rounds=%d retries=%zu "
      "disagreements=%zu steiner=%lld mean_ratio=%.4f min_dihedral=%.3f hash=%s\n",
      communicator.size(), parts.zones, static_cast<long long>(parts.blocks),
      static_cast<long long>(parts.lattice_points), report.overlap, parts.imbalance, tetrahedra, valid,
      points.wall_seconds, filling.wall_seconds, points.cpu_seconds_mean * communicator.size(),
      filling.cpu_seconds_mean * communicator.size(), filling.cpu_seconds_max,
      points.serial_seconds + filling.serial_seconds, tetrahedra / cpu,
      static_cast<double>(filling.peak_resident_bytes_sum) / tetrahedra, report.rounds, report.retries.size(),
      report.disagreements.size(), static_cast<long long>(report.steiner_points), quality.mean_ratio.mean,
      quality.min_dihedral.minimum, hash.c_str());
}

}  // namespace

int main(int argc, char** argv) {
  const parallel::Environment environment(argc, argv);
  const Communicator world = Communicator::world();
  if (argc < 2) {
    std::fprintf(stderr, "usage: volume_benchmark CASE [KEY=VALUE ...]\n");
    return 2;
  }
  try {
    parallel::configure_log(world, parallel::LogLevel::quiet);
    run(world, cases::read_case(argv[1], {argv + 2, argv + argc}));
  } catch (const std::exception& error) {
    if (world.is_root()) std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
