#include "layers/fitted_columns.hpp"
#include "layers/layer_cap.hpp"
#include "layers/layer_report.hpp"
#include "layers/opened_wall.hpp"
#include "layers/side_layers.hpp"
#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/timers.hpp"

#include <cstdint>

namespace aeroloom::layers {
namespace {

/// Of a wall without inner faces, or of an opened one.
Layers build_on(const mesh::NumberedMesh& wall, const LayerOptions& options, const OpenedWall* opened,
                const PlaneRemesher& remesh_planes) {
  const LocalWall walls(wall, options);
  const VertexStars stars = gather_stars(walls);
  const std::vector<VertexLayers> wanted = gather_wanted_layers(walls, options);
  const std::vector<double> edges = smooth_mean_edges(walls, wanted);
  const std::vector<FittedLayers> fitted = fit_wanted_layers(wanted, edges);
  const bool may_have_fans = options.fans != FanPlaces::none && options.elements != LayerElements::tets;
  FittedColumns found =
      fit_columns({walls, stars, wanted, fitted, edges, may_have_fans, options.bends_columns});
  const Fans& fans = found.fans;
  const Directions& directions = found.directions;
  ColumnLimits& limits = found.limits;
  Layers layers;
  layers.report.validity_rounds = found.rounds;
  layers.cap = CapClearing(walls, fans, directions, {remesh_planes, opened}).run(limits, layers.report);
  layers.columns = make_columns(walls, fans, directions, limits);
  layers.report.patches = report_patches(walls, fans, directions, limits, options);
  return layers;
}

}  // namespace

Layers build_layers(const mesh::NumberedMesh& wall, const LayerOptions& options,
                    const PlaneRemesher& remesh_planes) {
  const parallel::ScopedCpu cpu(parallel::ScopedCpu::As::task);
  parallel::add_pieces(static_cast<std::int64_t>(wall.pieces.size()));
  if (!has_inner_layers(wall, options)) return build_on(wall, options, nullptr, remesh_planes);
  const auto opened = std::make_shared<const OpenedWall>(open_inner_faces(wall));
  Layers layers = build_on(opened->mesh, options_of_sides(*opened, options), opened.get(), remesh_planes);
  layers.report.patches = join_sides(*opened, layers.report.patches);
  layers.opened = opened;
  return layers;
}

}  // namespace aeroloom::layers
