#include "pipeline/forecast.hpp"

#include "layers/columns.hpp"
#include "mesh/transfer/piece_size.hpp"
#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/memory_limit.hpp"
#include "parallel/observation/process_memory.hpp"
#include "parallel/observation/task_kind.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::pipeline {
namespace {

// The cost of a run on one core, from runs at a million tetrahedra (docs/status.md).
constexpr double seconds_per_triangle = 65e-6, seconds_per_tetrahedron = 5e-6;
constexpr double base_bytes = 115e6, bytes_per_tetrahedron = 95;

// The shares of stages in that, of one core for a triangle or a tetrahedron, and what of it no further rank
// spares, from the same runs.
constexpr double surface_per_triangle = 23e-6;
struct StageShare {
  const char* name;
  std::optional<parallel::TaskKind> pieces;  // the kind of its tasks; empty: it has none
  double seconds_per_tetrahedron, repeated;
  double spread = 0;  // of what its tasks take
};
constexpr std::array<StageShare, 5> stage_shares{
    {{"decompose", std::nullopt, 1.0e-6, 0.05},
     {"volume", parallel::TaskKind::zone, 2.1e-6, 0, 0.2},
     {"improve", parallel::TaskKind::improved_piece, 1.9e-6, 0, 0.6},
     {"inspect", std::nullopt, 0.7e-6, 0},
     {"output", std::nullopt, 0.4e-6, 0}}};

/// Of what layers add to the seconds of a run, the share of their own stage: 6.1 s for the 7 million prisms
/// of the DLR-F6, which are taken to add 21 (benchmarks/results/layers.md). Checks and files have the rest.
constexpr double share_of_layer_stage = 0.3;

/// What a run is predicted to make and to hold, layers included, all ranks together but for what each starts
/// with.
struct Elements {
  double tetrahedra, layer_cells, bytes;
};

/// The advice on what would fit on a node of `ranks_here` of all `ranks`. Of layers as many are taken to go
/// as of tetrahedra.
std::string advise(const Elements& elements, double limit, int ranks_here, int ranks) {
  const double for_elements = limit - base_bytes * ranks_here;
  if (for_elements <= 0) {
    return fmt::format("{} rank(s) on a node take {:.3g} GiB before the first element: fewer ranks on each",
                       ranks_here, base_bytes * ranks_here / parallel::gibibyte);
  }
  const double share = for_elements * ranks / (elements.bytes * ranks_here);
  const double fitting = share * elements.tetrahedra;
  return fmt::format(
      "{:.2g} tetrahedra would fit: sizes {:.2f} times as large (sizing.minimum, sizing.maximum "
      "or sizing.target_tetrahedra), or {} times as many nodes",
      fitting, std::cbrt(1 / share), std::ceil(1 / share));
}

// Zones hold about two fifths of the tetrahedra, the rest comes from a table (volume.core_tetrahedra of the
// report), and nearly all work on them. Spreads are of the size of those in tasks.csv of five runs: standard
// deviations over the mean of 0.07 to 0.25 (zones), and over the predicted load of 0.19 to 0.34 (improved
// pieces) and 0.18 to 0.46 (pieces of the surface), of which a spread is the square root of three.
constexpr double fraction_of_zones = 0.4;

/// Tasks, as many as come of pieces of that size. They are scheduled as if they were equal and take from
/// 1 - spread to 1 + spread times as long, in an order without pattern (multiples of the golden ratio).
study::TaskGroup uneven_tasks(parallel::TaskKind kind, double seconds, double elements, double of_piece,
                              double spread) {
  const double count = std::max(1.0, std::ceil(elements / of_piece));
  study::TaskGroup group{kind, 1, {}};
  double sum = 0;
  for (double i = 0; i < count; ++i) {
    const double place = i * std::numbers::phi;
    const double factor = 1 + spread * (2 * (place - std::floor(place)) - 1);
    group.tasks.push_back({.number = static_cast<std::int64_t>(i),
                           .predicted = elements / count,
                           .seconds = factor,
                           .bytes = elements / count});
    sum += factor;
  }
  for (study::TaskCost& task : group.tasks) task.seconds *= seconds / sum;
  return group;
}

}  // namespace

study::WorthwhileRanks predicted_ranks(study::RunCosts measured, const sizing::PredictedCounts& counts,
                                       const std::optional<LayerForecast>& layers, const cases::Case& input) {
  const double held = measured.stages.empty() ? 0 : measured.stages.back().own_bytes;
  measured.ranks = 1;
  study::StageCosts surface{.name = "surface", .own_bytes = held};
  constexpr double spread_of_surface = 0.5;
  surface.groups = {uneven_tasks(parallel::TaskKind::surface_piece, surface_per_triangle * counts.triangles,
                                 counts.triangles, static_cast<double>(input.surface.piece_triangles),
                                 spread_of_surface)};
  measured.stages.push_back(std::move(surface));
  const double layer_seconds = layers ? layers->seconds() : 0, layer_bytes = layers ? layers->bytes() : 0;
  if (layer_seconds > 0) {
    study::StageCosts stage{.name = "layers", .own_bytes = held + layer_bytes};
    stage.groups = {uneven_tasks(parallel::TaskKind::wall_piece, share_of_layer_stage * layer_seconds,
                                 counts.triangles, double{layers::wall_piece_triangles}, spread_of_surface)};
    measured.stages.push_back(std::move(stage));
  }
  const auto of_piece = static_cast<double>(
      input.volume.piece_tets.value_or(partition::suitable_piece_tets(counts.tetrahedra)));
  for (const StageShare& share : stage_shares) {
    const double seconds = share.seconds_per_tetrahedron * counts.tetrahedra;
    study::StageCosts stage{.name = share.name, .repeated = share.repeated * seconds};
    stage.own_bytes = held + bytes_per_tetrahedron * counts.tetrahedra + layer_bytes;
    const double rest = seconds - stage.repeated;
    if (!share.pieces)
      stage.divisible = rest;
    else
      stage.groups = {
          uneven_tasks(*share.pieces, rest, fraction_of_zones * counts.tetrahedra, of_piece, share.spread)};
    measured.stages.push_back(std::move(stage));
  }
  measured.stages.back().divisible += (1 - share_of_layer_stage) * layer_seconds;
  return study::worthwhile_ranks(measured, {});
}

double predicted_seconds(const sizing::PredictedCounts& counts) {
  return seconds_per_triangle * counts.triangles + seconds_per_tetrahedron * counts.tetrahedra;
}

double predicted_bytes(const sizing::PredictedCounts& counts, int ranks) {
  return base_bytes * ranks + bytes_per_tetrahedron * counts.tetrahedra;
}

void require_memory(const parallel::Communicator& communicator, const domain::SizedDomain& sized,
                    const std::vector<mesh::PatchType>& types, const cases::Case& input) {
  const auto limit = static_cast<double>(communicator.minimum(input.memory_limit));
  if (limit <= 0) return;
  const int ranks = communicator.size();
  const auto ranks_here = static_cast<int>(
      communicator.maximum(std::int64_t{parallel::find_node_shape(communicator).ranks_here}));
  Elements elements{sized.findings.counts.tetrahedra, 0,
                    bytes_per_tetrahedron * sized.findings.counts.tetrahedra};
  if (input.layers.given) {
    double cells = 0, bytes = 0;
    parallel::on_root(communicator, [&] {
      const LayerForecast layers = forecast_layers(sized.model, types, input, sized.field);
      cells = layers.cells();
      bytes = layers.bytes();
    });
    elements.layer_cells = communicator.maximum(cells);
    elements.bytes += communicator.maximum(bytes);
  }
  const double needed = (base_bytes + elements.bytes / ranks) * ranks_here;
  if (needed <= limit) return;
  const std::string layers =
      elements.layer_cells > 0 ? fmt::format(" and {:.2g} cells of layers", elements.layer_cells) : "";
  throw parallel::CollectiveError(
      parallel::FailureKind::resources,
      fmt::format("about {:.2g} tetrahedra{} are predicted, which take {:.3g} GiB on a node with {} of {} "
                  "rank(s); {:.3g} GiB are allowed (--max-memory). {}",
                  elements.tetrahedra, layers, needed / parallel::gibibyte, ranks_here, ranks,
                  limit / parallel::gibibyte, advise(elements, limit, ranks_here, ranks)));
}

}  // namespace aeroloom::pipeline
