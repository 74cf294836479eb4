#include "pipeline/layer_stage.hpp"

#include "aeroloom/layers/layer_cells.hpp"
#include "aeroloom/sizing/sources.hpp"
#include "pipeline/stage_log.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace aeroloom::pipeline {

using geometry::Vec3;
using mesh::LocalIndex;

namespace {

/// The mean length of the edges at each vertex of a piece.
std::vector<double> mean_edges(const mesh::Piece& piece) {
  std::vector<double> sum(piece.vertex_count(), 0);
  std::vector<int> count(piece.vertex_count(), 0);
  for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const LocalIndex a = piece.cell(t)[i], b = piece.cell(t)[(i + 1) % 3];
      const double length = distance(piece.point(a), piece.point(b));
      for (const LocalIndex v : {a, b}) sum[v] += length, ++count[v];
    }
  }
  for (std::size_t v = 0; v < sum.size(); ++v) sum[v] /= std::max(1, count[v]);
  return sum;
}

/// What the front asks of the sizes: its own edges, where the field is well above them. Sources are thinned
/// as if they asked for twice their size: in between the field grows by less than what counts as well above.
std::vector<sizing::SizeSource> sizes_of_front(const parallel::Communicator& communicator,
                                               const layers::Layers& layers, const sizing::SizeField& field,
                                               parallel::StageClock& clock) {
  constexpr double well_above = 1.3, thinning = 2;
  const parallel::ScopedCpu task(clock, parallel::ScopedCpu::As::task);
  std::vector<sizing::SizeSource> sources;
  for (std::size_t p = 0; p < layers.front.pieces.size(); ++p) {
    const mesh::Piece& piece = layers.front.pieces[p];
    const std::vector<double> edges = mean_edges(piece);
    for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      if (layers.columns.pieces[p].counts[v] == 0) continue;
      const Vec3 at = piece.point(v);
      if (field(at) > well_above * edges[v]) sources.push_back({at, thinning * edges[v]});
    }
  }
  const sizing::RootCube root(field.domain());
  sources = sizing::thin_sources(root, sources);
  sources =
      sizing::thin_sources(root, communicator.all_gather_items(std::span<const sizing::SizeSource>(sources)));
  for (sizing::SizeSource& source : sources) source.size /= thinning;
  return sources;
}

}  // namespace

LayeredSurface build_layers(const parallel::Communicator& communicator, const cases::Case& input,
                            FinishedSurface& surface, report::RunRecord& record) {
  surface.mesh.patch_types = record.patch_types;
  const layers::LayerOptions options =
      cases::layer_options(input.layers, input.sizing, surface.mesh.patches, record.patch_types);
  layers::Layers made = layers::build_layers(communicator, surface, options, record.clock);
  record.layers.emplace(report::LayerRecord{options, made.report});
  log_layers(record);
  const std::vector<sizing::SizeSource> sizes =
      sizes_of_front(communicator, made, surface.field, record.clock);
  sizing::SizeField field =
      sizes.empty() ? surface.field : surface.field.refined(communicator, sizes, record.clock);
  layers::name_front(communicator, surface, made.front);
  mesh::NumberedMesh front{std::exchange(made.front, {}), surface.numbering};
  return {std::move(made), {std::move(front), std::move(field)}};
}

void append_layers(const parallel::Communicator& communicator, const cases::Case& input,
                   const FinishedSurface& surface, LayeredSurface layered, mesh::DistributedMesh& volume,
                   report::RunRecord& record) {
  const parallel::ScopedCpu task(record.clock, parallel::ScopedCpu::As::task);
  constexpr std::int64_t most_cells = 170'000;  // as pieces of the volume at most, by default
  layered.layers.front = std::move(layered.front.mesh);
  layers::append_layers(communicator, surface, layered.layers, input.volume.piece_tets.value_or(most_cells),
                        volume);
}

}  // namespace aeroloom::pipeline
