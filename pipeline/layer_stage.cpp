#include "pipeline/layer_stage.hpp"

#include "layers/cap_layout.hpp"
#include "layers/column_heights.hpp"
#include "layers/end_planes.hpp"
#include "layers/opened_wall.hpp"
#include "mesh/transfer/split_pieces.hpp"
#include "parallel/observation/log.hpp"
#include "pipeline/curved_ends.hpp"
#include "pipeline/edge_turns.hpp"
#include "pipeline/stage_log.hpp"
#include "sizing/field/sources.hpp"
#include "surface/moved_faces.hpp"
#include "surface/plane_remesher.hpp"

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

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

/// The places of the cap where layers end: a function of the wall and its columns, for planes that were
/// meshed again are other pieces in the cap.
struct ColumnEnd {
  Vec3 at;
  double size;  ///< wanted of the tetrahedra there
};

/// Of tetrahedra on a last layer: the edges there are given by the wall, the height by the layer below. Where
/// columns end early and the layer is thin, the mean of both makes a smoother step.
double size_above(double edge, double last_height) {
  constexpr double thin = 0.1;  // of the height that is aimed at; at 0.2 it took 9 to 27 % more tetrahedra
  const double isotropic = last_height / layers::isotropic_height;
  return isotropic < thin * edge ? 0.5 * (edge + isotropic) : edge;
}

std::vector<ColumnEnd> ends_of_columns(const mesh::Piece& wall, const layers::PieceColumns& columns) {
  const layers::CapLayout layout = layers::lay_out_cap(wall, columns);
  mesh::Piece moved;
  moved.kind = mesh::CellKind::triangle;
  for (const auto& corners : layout.triangles)
    moved.cells.insert(moved.cells.end(), corners.begin(), corners.end());
  moved.coordinates.resize(3 * layout.column_of_vertex.size());
  for (LocalIndex v = 0; v < layout.vertex_count; ++v) {
    const std::int32_t column = layout.column_of_vertex[v];
    if (column < 0) continue;
    moved.set_point(v, layers::node(wall, columns, column, columns.counts[columns.vertex_of(column)]));
  }
  for (std::size_t f = 0; f < columns.fan_faces.size(); ++f) {
    if (layout.apex_of_face[f] < 0) continue;
    Vec3 sum;
    for (const std::int32_t column : columns.fan_faces[f].columns)
      sum += moved.point(layout.vertex_of_column[column]);
    moved.set_point(layout.apex_of_face[f], sum / 4);
  }
  const std::vector<double> edges = mean_edges(moved);
  std::vector<ColumnEnd> ends;
  for (LocalIndex v = 0; v < layout.vertex_count; ++v) {
    const std::int32_t column = layout.column_of_vertex[v];
    if (column < 0) continue;
    const LocalIndex of = columns.vertex_of(column);
    if (columns.counts[of] == 0) continue;
    const double last = layers::heights(columns, of).last(columns.counts[of]);
    ends.push_back({moved.point(v), size_above(edges[v], last)});
  }
  return ends;
}

/// What the cap of this rank's pieces asks of the sizes, where the field is well above that.
/// Sources are thinned as if they asked for twice their size, each piece by itself, for pieces do not depend
/// on ranks: in between the field grows by less than what counts as well above.
std::vector<sizing::SizeSource> sizes_of_cap(const mesh::DistributedMesh& wall,
                                             const layers::Columns& columns, const sizing::SizeField& field) {
  constexpr double well_above = 1.3, thinning = 2;
  const parallel::ScopedCpu task(parallel::ScopedCpu::As::task);
  const sizing::RootCube root(field.domain());
  std::vector<sizing::SizeSource> all;
  for (std::size_t p = 0; p < wall.pieces.size(); ++p) {
    std::vector<sizing::SizeSource> sources;
    for (const ColumnEnd& end : ends_of_columns(wall.pieces[p], columns.pieces[p])) {
      if (field(end.at) > well_above * end.size) sources.push_back({end.at, thinning * end.size});
    }
    for (const sizing::SizeSource& source : sizing::thin_sources(root, sources))
      all.push_back({source.point, source.size / thinning});
  }
  return all;
}

/// What a piece has of a patch.
struct EdgesOfPatch {
  double area = 0, edges = 0;  ///< sum of areas; of areas times mean edges
  std::int32_t patch = 0;
  mesh::PieceId piece = 0;
};

std::vector<EdgesOfPatch> edges_of_piece(const mesh::Piece& piece, std::size_t patch_count) {
  std::vector<EdgesOfPatch> sums(patch_count);
  for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
    const LocalIndex* const cell = piece.cell(t);
    const Vec3 a = piece.point(cell[0]), b = piece.point(cell[1]), c = piece.point(cell[2]);
    const double area = 0.5 * norm(cross(b - a, c - a));
    EdgesOfPatch& sum = sums.at(piece.triangle_patch[t]);
    sum.area += area;
    sum.edges += area * (distance(a, b) + distance(b, c) + distance(c, a)) / 3;
  }
  return sums;
}

/// The mean length of edges on each patch, weighted by area; 0 without triangles. Sums run in the order of
/// pieces. Collective; equal for any number of ranks.
std::vector<double> mean_edges_of_patches(const mesh::DistributedMesh& wall) {
  std::vector<EdgesOfPatch> rows;
  for (const mesh::Piece& piece : wall.pieces) {
    const std::vector<EdgesOfPatch> sums = edges_of_piece(piece, wall.patches.size());
    for (std::size_t p = 0; p < sums.size(); ++p) {
      if (sums[p].area > 0)
        rows.push_back({sums[p].area, sums[p].edges, static_cast<std::int32_t>(p), piece.id});
    }
  }
  std::vector<double> areas(wall.patches.size(), 0), edges(wall.patches.size(), 0);
  for (const EdgesOfPatch& row : wall.communicator.gather_sorted(rows, &EdgesOfPatch::piece))
    areas[row.patch] += row.area, edges[row.patch] += row.edges;
  for (std::size_t p = 0; p < edges.size(); ++p) edges[p] = areas[p] > 0 ? edges[p] / areas[p] : 0;
  return edges;
}

/// Changes layers as `layers.fit` asks, and says so. Collective.
void fit_layers(const cases::LayerRequest& request, const mesh::DistributedMesh& wall,
                layers::LayerOptions& options) {
  if (request.fit == cases::LayerFit::none) return;
  const std::vector<double> edges = mean_edges_of_patches(wall);
  for (std::size_t p = 0; p < options.patches.size(); ++p) {
    layers::WallLayers& wanted = options.patches[p];
    if (wanted.first <= 0 || edges.at(p) <= 0) continue;
    const layers::WallLayers asked = wanted;
    wanted = cases::fitted_layers(asked, edges[p], request.fit, request.growth_maximum);
    const std::string change = cases::change_of_fit(asked, wanted, edges[p]);
    if (!change.empty()) parallel::log_info(fmt::format("layers on '{}': {}", wall.patches[p], change));
  }
}

/// The faces that layers end on, ascending.
struct EndFaces {
  std::vector<cad::FaceId> planes, curved, all;
};

EndFaces find_end_faces(const mesh::DistributedMesh& wall, const layers::LayerOptions& options) {
  EndFaces faces;
  const std::vector<Vec3> normals = layers::find_end_planes(wall, options);
  const std::vector<std::uint8_t> curved =
      layers::find_curved_ends(wall, options, normals, mesh::SharedVertices(wall));
  for (std::size_t face = 0; face < normals.size(); ++face) {
    const auto id = static_cast<cad::FaceId>(face);
    if (!(normals[face] == Vec3{})) faces.planes.push_back(id);
    if (curved[face] != 0) faces.curved.push_back(id);
    if (!(normals[face] == Vec3{}) || curved[face] != 0) faces.all.push_back(id);
  }
  return faces;
}

}  // namespace

LayersAndCap build_layers(const cases::Case& input, FinishedSurface& surface) {
  surface.patch_types = surface.types;
  layers::LayerOptions options =
      cases::layer_options(cases::without_missing_patches(input.layers, surface.patches), input.sizing,
                           surface.patches, surface.types);
  fit_layers(input.layers, surface, options);
  options.bends_columns =
      !cases::rows_along_edges(cases::in_model_units(input.sizing).edges, surface.model).empty();
  options.curved_ends = curved_ends_of(surface.model);
  const EndFaces ends = find_end_faces(surface, options);
  options.edges = find_edge_turns(surface.model, ends.planes);
  surface.bounds_volume = ends.all.empty();
  static_cast<mesh::NumberedMesh&>(surface) =
      mesh::split_pieces(surface, layers::wall_piece_triangles, ends.all,
                         [&](const mesh::Piece& piece) { return layers::predict_wall_load(piece, options); });
  const auto remesh = [&](const mesh::DistributedMesh& wall, mesh::DistributedMesh& cap) {
    surface::PlaneConflicts conflicts = surface::remesh_moved_faces(
        surface.model, surface.field, {ends.curved, ends.planes}, input.surface, wall, cap);
    if (conflicts.empty())
      conflicts = surface::remesh_planes(surface.model, surface.field, {ends.planes, input.surface}, cap);
    return std::move(conflicts.vertices);
  };
  layers::Layers made = layers::build_layers(surface, options, remesh);
  report::LayerRecord record{options, std::move(made.report)};
  if (input.layers.reynolds && input.layers.length)
    record.boundary_layer = cases::boundary_layer_thickness(*input.layers.reynolds, *input.layers.length);
  record.fit = input.layers.fit;
  log_layers(record);
  if (surface.communicator.is_root()) {
    warn_of_missing_layers(record, surface.patches);
    warn_of_low_layers(record, surface.patches);
  }
  const mesh::DistributedMesh& wall = made.opened ? made.opened->mesh : surface;
  const std::vector<sizing::SizeSource> sizes = sizes_of_cap(wall, made.columns, surface.field);
  sizing::SizeField field = surface.communicator.sum(static_cast<std::int64_t>(sizes.size())) > 0
                                ? surface.field.refined(sizes)
                                : surface.field;
  return {std::move(made.columns),
          std::move(made.opened),
          {mesh::number_mesh(std::move(made.cap)), std::move(field)},
          std::move(record)};
}

std::vector<std::vector<std::int32_t>> layers_over_triangles(const mesh::DistributedMesh& surface,
                                                             const LayersAndCap& layered) {
  const layers::LayerOptions& asked = layered.record.asked;
  std::vector<std::vector<std::int32_t>> all;
  for (std::size_t p = 0; p < surface.pieces.size(); ++p) {
    const mesh::Piece& piece = surface.pieces[p];
    const bool inner = surface.sides_of(piece.common_face()).is_inner();
    const std::int64_t back = inner && layered.opened ? layered.opened->back_of[p] : -1;
    std::vector<std::int32_t>& mine = all.emplace_back();
    for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const LocalIndex* const v = piece.cell(t);
      const auto patch = static_cast<std::size_t>(piece.triangle_patch[t]);  // of none: beyond all
      const bool wanted = patch < asked.patches.size() && asked.patches[patch].first > 0 &&
                          (!inner || layers::inner_sides_of(asked, patch) != layers::InnerSides::none);
      const auto least = [&](std::size_t place) {
        const std::vector<std::int32_t>& counts = layered.columns.pieces[place].counts;
        return std::min({counts[v[0]], counts[v[1]], counts[v[2]]});
      };
      mine.push_back(!wanted    ? -1
                     : back < 0 ? least(p)
                                : std::max(least(p), least(static_cast<std::size_t>(back))));
    }
  }
  return all;
}

void append_layers(const cases::Case& input, const mesh::NumberedMesh& surface, const LayersAndCap& layered,
                   mesh::DistributedMesh& volume) {
  constexpr std::int64_t most_cells = 170'000;  // as pieces of the volume at most, by default
  const parallel::ScopedCpu task(parallel::ScopedCpu::As::task);
  const layers::OpenedWall* const opened = layered.opened.get();
  layers::append_layers(opened != nullptr ? opened->mesh : surface, layered.columns, layered.cap,
                        {input.volume.piece_tets.value_or(most_cells), input.layers.elements, opened},
                        volume);
}

}  // namespace aeroloom::pipeline
