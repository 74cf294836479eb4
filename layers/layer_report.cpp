#include "layers/layer_report.hpp"

#include "layers/layer_shapes.hpp"

#include <algorithm>
#include <cmath>

namespace aeroloom::layers {
namespace {

/// What a piece has of a patch.
struct PieceRow {
  PatchLayers layers;
  std::int32_t patch = 0;
  mesh::PieceId piece = 0;
};

/// A third of a triangle's area, under one of its columns.
void add_column(const ColumnLimits& limits, std::int32_t v, double area, PatchLayers& patch) {
  const std::int32_t count = limits.count(v);
  const bool smooth = count > 0 && limits.last_height(v) >= smooth_end * limits.mean_edge(v);
  const bool full = count >= limits.wanted_count(v) || smooth;
  (full ? patch.full_area : count > 0 ? patch.partial_area : patch.empty_area) += area;
  if (smooth) patch.isotropic_area += area;
  if (!full) patch.limited_area[static_cast<std::size_t>(limits.cause(v))] += area;
  patch.sums.layers += area * count;
  patch.sums.wanted += area * limits.wanted_count(v);
  patch.sums.heights += area * limits.total(v);
  patch.sums.edges += area * limits.mean_edge(v);
  if (limits.mean_edge(v) > 0) patch.sums.last += area * limits.last_height(v) / limits.mean_edge(v);
  patch.most_layers = std::max<std::int64_t>(patch.most_layers, count);
}

/// Of counts in ascending order.
void add_cells(const std::array<std::int32_t, 3>& counts, LayerElements elements, PatchLayers& patch) {
  if (elements == LayerElements::tets) {
    patch.tetrahedra += counts[0] + counts[1] + counts[2];
    return;
  }
  patch.prisms += counts[0];
  patch.pyramids += counts[1] - counts[0];
  patch.tetrahedra += counts[2] - counts[1];
}

void add_cell(mesh::CellShape shape, PatchLayers& patch) {
  ++(shape == mesh::CellShape::tetrahedron ? patch.tetrahedra
     : shape == mesh::CellShape::pyramid   ? patch.pyramids
     : shape == mesh::CellShape::prism     ? patch.prisms
                                           : patch.hexahedra);
}

/// The cells over the faces of fans, and the apexes of sectors.
void add_fan(const Fans& fans, const ColumnLimits& limits, const FanFace& face, PatchLayers& patch) {
  const std::array<std::int32_t, 2> ends{fans.vertex_of(face.columns[0]), fans.vertex_of(face.columns[2])};
  const LayersOverFan over{face.is_sector(), {limits.count(ends[0]), limits.count(ends[1])}};
  for (std::int32_t k = 1; k <= std::max(over.counts[0], over.counts[1]); ++k)
    visit_layer(over, k, [&](mesh::CellShape shape, const auto&) { add_cell(shape, patch); });
  if (over.is_sector && over.counts[0] > 0 && over.counts[1] > 0) ++patch.pyramids;
}

/// What is reported of.
struct Reported {
  const LocalWall& wall;
  const Fans& fans;
  const Directions& directions;
  const ColumnLimits& limits;
  const LayerOptions& options;
};

void add_triangle(const Reported& of, std::int32_t t, PatchLayers& patch) {
  const auto& [wall, fans, directions, limits, options] = of;
  const auto& [a, b, c] = wall.triangles[t];
  const geometry::Vec3 twice = cross(wall.points[b] - wall.points[a], wall.points[c] - wall.points[a]);
  const double area = 0.5 * norm(twice), asked = options.patches[wall.patches[t]].first;
  std::array<std::int32_t, 3> counts{limits.count(a), limits.count(b), limits.count(c)};
  std::sort(counts.begin(), counts.end());
  ++patch.triangles;
  patch.area += area;
  add_cells(counts, options.elements, patch);
  for (int i = 0; i < 3; ++i) {
    const std::int32_t v = wall.triangles[t][i];
    add_column(limits, v, area / 3, patch);
    if (limits.count(v) == 0) continue;
    const double lean = std::abs(dot(directions.smoothed[fans.columns[t][i]], normalized(twice)));
    if (lean * limits.heights(v).first < PatchLayers::low * asked) patch.low_first_area += area / 3;
  }
}

}  // namespace

void add_figures(const PatchLayers& row, PatchLayers& sum) {
  for (double PatchLayers::*member :
       {&PatchLayers::area, &PatchLayers::full_area, &PatchLayers::partial_area, &PatchLayers::empty_area,
        &PatchLayers::isotropic_area, &PatchLayers::low_first_area})
    sum.*member += row.*member;
  for (std::size_t i = 0; i < layer_limit_count; ++i) sum.limited_area[i] += row.limited_area[i];
  for (std::int64_t PatchLayers::*member :
       {&PatchLayers::triangles, &PatchLayers::prisms, &PatchLayers::pyramids, &PatchLayers::tetrahedra,
        &PatchLayers::hexahedra})
    sum.*member += row.*member;
  using Sums = PatchLayers::Sums;
  for (double Sums::*member : {&Sums::layers, &Sums::wanted, &Sums::heights, &Sums::edges, &Sums::last})
    sum.sums.*member += row.sums.*member;
  sum.most_layers = std::max(sum.most_layers, row.most_layers);
}

std::vector<PatchLayers> report_patches(const LocalWall& wall, const Fans& fans, const Directions& directions,
                                        const ColumnLimits& limits, const LayerOptions& options) {
  std::vector<PieceRow> rows;
  auto face = fans.faces.begin();
  for (std::size_t p = 0; p < wall.mesh.pieces.size(); ++p) {
    std::vector<PatchLayers> patches(wall.mesh.patches.size());
    for (std::int32_t t = wall.first_triangle[p]; t < wall.first_triangle[p + 1]; ++t) {
      if (wall.roles[t] == WallRole::layered)
        add_triangle({wall, fans, directions, limits, options}, t, patches[wall.patches[t]]);
      for (; face != fans.faces.end() && face->triangle == t; ++face)
        add_fan(fans, limits, *face, patches[wall.patches[t]]);
    }
    for (std::size_t i = 0; i < patches.size(); ++i) {
      if (patches[i].triangles > 0)
        rows.push_back({patches[i], static_cast<std::int32_t>(i), wall.mesh.pieces[p].id});
    }
  }
  rows = wall.mesh.communicator.gather_sorted(rows, &PieceRow::piece);
  std::vector<PatchLayers> patches(wall.mesh.patches.size());
  for (const PieceRow& row : rows) add_figures(row.layers, patches[row.patch]);
  return patches;
}

}  // namespace aeroloom::layers
