/// The sizing stage alone: mpirun -n N sizing_benchmark CASE ... prints one RESULT line per case, with what
/// geometry and sizing cost by the stage clock and a hash of the field, the same on any number of ranks.
#include "parallel/communication/communicator.hpp"
#include "parallel/communication/environment.hpp"
#include "parallel/observation/log.hpp"
#include "parallel/observation/timers.hpp"
#include "pipeline/domain/load_domain.hpp"
#include "pipeline/domain/size_domain.hpp"

#include <bit>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>

using namespace aeroloom;
using parallel::Communicator;

namespace {

/// FNV-1a over leaves and sizes.
std::uint64_t hash_field(const sizing::SizeField& field) {
  std::uint64_t hash = 14695981039346656037ULL;
  const auto add = [&](double value) {
    hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * 1099511628211ULL;
  };
  for (std::int64_t i = 0; i < field.leaf_count(); ++i) {
    const sizing::SizeField::Leaf leaf = field.leaf(i);
    for (int axis = 0; axis < 3; ++axis) add(leaf.low[axis]);
    for (const double value : {leaf.edge, leaf.size}) add(value);
  }
  return hash;
}

void run(const Communicator& communicator, const char* file) {
  const cases::Case input = cases::read_case(file, {});
  parallel::StageClock clock;
  clock.begin("geometry");
  const cad::Model model = domain::load_domain(communicator, input.domain).model;
  clock.end();
  clock.begin("sizing");
  const domain::SizedDomain sized =
      domain::size_domain(communicator, model, input.sizing, domain::Simplification::of(input));
  clock.end();
  const std::vector<parallel::StageSummary> stages = clock.summarise(communicator);
  if (!communicator.is_root()) return;
  const parallel::StageSummary& sizing = stages[1];
  std::printf(
      "RESULT case=%s ranks=%d geometry_cpu=%.3f sizing_wall=%.3f sizing_cpu_max=%.3f sizing_cpu_mean=%.3f "
      "sizing_serial=%.3f sizing_other=%.3f leaves=%lld tetrahedra=%.6g hash=%016llx\n",
      file, communicator.size(), stages[0].cpu_seconds_max, sizing.wall_seconds, sizing.cpu_seconds_max,
      sizing.cpu_seconds_mean, sizing.serial_seconds, sizing.other_seconds,
      static_cast<long long>(sized.field.leaf_count()), sized.findings.counts.tetrahedra,
      static_cast<unsigned long long>(hash_field(sized.field)));
}

}  // namespace

int main(int argc, char** argv) {
  const parallel::Environment environment(argc, argv);
  const Communicator world = Communicator::world();
  if (argc < 2) {
    std::fprintf(stderr, "usage: sizing_benchmark CASE ...\n");
    return 2;
  }
  try {
    const bool verbose = std::getenv("AEROLOOM_VERBOSE") != nullptr;
    parallel::configure_log(world, verbose ? parallel::LogLevel::verbose : parallel::LogLevel::quiet);
    for (int i = 1; i < argc; ++i) run(world, argv[i]);
  } catch (const std::exception& error) {
    if (world.is_root()) std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
