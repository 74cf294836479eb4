/// The stage of boundary layers alone: mpirun -n N layers_benchmark CASE FIRST PATCH [KEY=VALUE ...] prints
/// one RESULT line. FIRST: height of the first layer over the diagonal of all walls. PATCH: the one that has
/// layers until they are isotropic; `all`: all but those with the usual name of a far field, a plane of
/// symmetry or an opening. The case's groups and its keys of layers do not count.
///
/// CPU figures are those of the stage clock: without waiting.
#include "benchmarks/case_surface.hpp"
#include "benchmarks/layer_figures.hpp"
#include "layers/columns.hpp"
#include "mesh/transfer/split_pieces.hpp"
#include "parallel/communication/environment.hpp"
#include "parallel/observation/log.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <span>
#include <string>
#include <vector>

namespace {

using namespace aeroloom;
using parallel::Communicator;

bool is_wall(const std::string& patch) {
  return mesh::patch_type_by_name(patch).value_or(mesh::PatchType::wall) == mesh::PatchType::wall;
}

/// Diagonal of the box around the triangles of patches that are layered.
double diagonal_of(const mesh::DistributedMesh& wall, const std::vector<bool>& layered) {
  const Communicator& communicator = wall.communicator;
  geometry::Box box;
  for (const mesh::Piece& piece : wall.pieces) {
    for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) {
      if (!layered[piece.triangle_patch[t]]) continue;
      for (int i = 0; i < 3; ++i) box.add(piece.point(piece.cell(t)[i]));
    }
  }
  std::vector<double> ends{box.low.x, box.low.y, box.low.z, -box.high.x, -box.high.y, -box.high.z};
  communicator.minimum_each(ends);
  return geometry::distance({ends[0], ends[1], ends[2]}, {-ends[3], -ends[4], -ends[5]});
}

layers::LayerOptions options_for(const mesh::DistributedMesh& wall, double first, const std::string& patch) {
  std::vector<bool> layered;
  for (const std::string& name : wall.patches)
    layered.push_back(patch == "all" ? is_wall(name) : patch == name);
  layers::LayerOptions options;
  options.patches.resize(wall.patches.size());
  const double height = first * diagonal_of(wall, layered);
  for (std::size_t p = 0; p < layered.size(); ++p) options.patches[p].first = layered[p] ? height : 0;
  return options;
}

layers::PatchLayers sum_of(const layers::LayerReport& report) {
  layers::PatchLayers sum;
  for (const layers::PatchLayers& patch : report.patches) {
    sum.area += patch.area, sum.full_area += patch.full_area, sum.partial_area += patch.partial_area;
    sum.empty_area += patch.empty_area;
    sum.sums.layers += patch.sums.layers, sum.isotropic_area += patch.isotropic_area;
    for (std::size_t i = 0; i < layers::layer_limit_count; ++i) sum.limited_area[i] += patch.limited_area[i];
    sum.triangles += patch.triangles, sum.prisms += patch.prisms;
    sum.pyramids += patch.pyramids, sum.tetrahedra += patch.tetrahedra;
    sum.hexahedra += patch.hexahedra;
    sum.most_layers = std::max(sum.most_layers, patch.most_layers);
  }
  return sum;
}

void print_figures(const Communicator& communicator, const benchmarks::LayerFigures& mine) {
  const auto gather = [&](const std::vector<double>& values) {
    return communicator.all_gather_items(std::span<const double>(values));
  };
  std::vector<double> jacobians = gather(mine.jacobians), heights = gather(mine.first_heights);
  const auto within =
      std::count_if(heights.begin(), heights.end(), [](double h) { return h > 0.9 && h < 1.1; });
  const double between = communicator.sum(mine.between), volume = communicator.sum(mine.volume);
  const std::int64_t bad = communicator.sum(std::int64_t{mine.bad_cells});
  if (!communicator.is_root()) return;
  const auto percentile = [](std::vector<double>& values, double share) {
    return benchmarks::LayerFigures::percentile(values, share);
  };
  std::printf(
      "       bad_cells=%lld volume_error=%.1e jacobian_min=%.3f jacobian_1%%=%.3f jacobian_median=%.3f "
      "first_within_10%%=%.2f first_min=%.3f first_max=%.3f\n",
      static_cast<long long>(bad), std::abs(volume - between) / between, percentile(jacobians, 0),
      percentile(jacobians, 0.01), percentile(jacobians, 0.5),
      100.0 * static_cast<double>(within) / std::max<double>(1, static_cast<double>(heights.size())),
      percentile(heights, 0), percentile(heights, 1));
}

void run(const Communicator& communicator, const cases::Case& input, double first, const std::string& patch) {
  const surface::SurfaceMesh made = benchmarks::mesh_surface(communicator, input);
  const layers::LayerOptions options = options_for(made, first, patch);
  const mesh::NumberedMesh wall =
      mesh::split_pieces(made, layers::wall_piece_triangles, {},
                         [&](const mesh::Piece& piece) { return layers::predict_wall_load(piece, options); });
  parallel::StageClock clock;
  clock.begin("layers");
  const layers::Layers layers = layers::build_layers(wall, options);
  clock.end();
  const parallel::StageSummary stage = clock.summarise(communicator).back();
  const double cpu_used = stage.cpu_seconds_mean * communicator.size();
  const std::string hash = mesh::hash_mesh(mesh::number_mesh(layers.cap));
  print_figures(communicator, {wall, layers, options});
  if (!communicator.is_root()) return;
  const layers::PatchLayers sum = sum_of(layers.report);
  const auto cells = static_cast<double>(sum.prisms + sum.hexahedra + sum.pyramids + sum.tetrahedra);
  const auto percent = [&](double area) { return 100 * area / std::max(sum.area, 1e-300); };
  std::printf(
      "RESULT ranks=%d triangles=%lld prisms=%lld hexahedra=%lld pyramids=%lld tetrahedra=%lld cpu=%.3f "
      "cpu_max=%.3f "
      "wall=%.3f "
      "cells_per_cpu_second=%.0f full=%.2f isotropic=%.2f partial=%.2f empty=%.2f "
      "layers_mean=%.1f "
      "layers_max=%lld validity_rounds=%d crossing_rounds=%d crossings=%lld zeroed=%lld hash=%s\n",
      communicator.size(), static_cast<long long>(sum.triangles), static_cast<long long>(sum.prisms),
      static_cast<long long>(sum.hexahedra), static_cast<long long>(sum.pyramids),
      static_cast<long long>(sum.tetrahedra), cpu_used, stage.cpu_seconds_max, stage.wall_seconds,
      cells / cpu_used, percent(sum.full_area), percent(sum.isotropic_area), percent(sum.partial_area),
      percent(sum.empty_area), sum.sums.layers / sum.area, static_cast<long long>(sum.most_layers),
      layers.report.validity_rounds, layers.report.crossing_rounds,
      static_cast<long long>(layers.report.crossings), static_cast<long long>(layers.report.zeroed_by_force),
      hash.c_str());
  std::printf("       limited, %% of the area:");
  for (const layers::LayerLimit limit : layers::all_layer_limits)
    std::printf(" %s=%.2f", std::string(layers::name_of(limit)).c_str(),
                percent(sum.limited_area[static_cast<std::size_t>(limit)]));
  std::puts("");
  for (std::size_t p = 0; p < layers.report.patches.size(); ++p) {
    const layers::PatchLayers& patch = layers.report.patches[p];
    if (patch.area == 0) continue;
    std::printf("       %s: triangles=%lld area=%.4g full=%.2f isotropic=%.2f empty=%.2f\n",
                wall.patches[p].c_str(), static_cast<long long>(patch.triangles), patch.area,
                100 * patch.full_area / patch.area, 100 * patch.isotropic_area / patch.area,
                100 * patch.empty_area / patch.area);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const parallel::Environment environment(argc, argv);
  const Communicator world = Communicator::world();
  if (argc < 4) {
    std::fprintf(stderr, "usage: layers_benchmark CASE FIRST PATCH [KEY=VALUE ...]\n");
    return 2;
  }
  try {
    parallel::configure_log(world, parallel::LogLevel::quiet);
    run(world, cases::read_case(argv[1], {argv + 4, argv + argc}), std::stod(argv[2]), argv[3]);
  } catch (const std::exception& error) {
    if (world.is_root()) std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
