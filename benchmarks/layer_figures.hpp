// What the cells of boundary layers are like, measured from columns alone, for benchmarks.
#pragma once

#include "layers/cap_layout.hpp"
#include "layers/columns.hpp"
#include "layers/layer_shapes.hpp"
#include "mesh/quality/cell_measures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace aeroloom::benchmarks {

/// Of the pieces of this rank.
struct LayerFigures {
  std::vector<double> jacobians;      ///< scaled, of prisms
  std::vector<double> first_heights;  ///< normal to the wall triangle, over the one asked for, by corner
  long bad_cells = 0;                 ///< with a corner that is not positive
  double volume = 0;                  ///< of all cells
  double between = 0;                 ///< enclosed by wall and front

  LayerFigures(const mesh::DistributedMesh& wall, const layers::Layers& made,
               const layers::LayerOptions& options) {
    for (std::size_t p = 0; p < wall.pieces.size(); ++p) {
      const mesh::Piece& piece = wall.pieces[p];
      const layers::PieceColumns& columns = made.columns.pieces[p];
      const mesh::Piece& cap = made.cap.pieces[p];
      for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) {
        const auto& [a, b, c] = columns.corner_columns[t];
        add_triangle(piece, columns, {a, c, b}, options.patches[piece.triangle_patch[t]].first);
        between += enclosed(piece, piece.cell(t));
      }
      for (mesh::LocalIndex t = 0; t < cap.cell_count(); ++t) between -= enclosed(cap, cap.cell(t));
      add_fans(piece, cap, columns);
    }
  }
  /// The value that a share of all are not above.
  static double percentile(std::vector<double>& values, double share) {
    if (values.empty()) return 0;
    const auto at =
        values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
  }

private:
  static double enclosed(const mesh::Piece& piece, const mesh::LocalIndex* v) {
    return dot(piece.point(v[0]), cross(piece.point(v[1]), piece.point(v[2]))) / 6;
  }
  void add_cell(mesh::CellShape shape, const geometry::Vec3* corners) {
    bad_cells += !mesh::has_positive_corners(shape, corners);
    volume += mesh::cell_volume(shape, corners);
    if (shape == mesh::CellShape::prism)
      jacobians.push_back(
          mesh::measure_cell(shape, corners)[static_cast<std::size_t>(mesh::Measure::scaled_jacobian)]);
  }
  void add_fans(const mesh::Piece& piece, const mesh::Piece& cap, const layers::PieceColumns& columns) {
    const layers::CapLayout layout = layers::lay_out_cap(piece, columns);
    for (std::size_t f = 0; f < columns.fan_faces.size(); ++f) {
      const layers::FanFace& face = columns.fan_faces[f];
      const int other = face.is_sector() ? 2 : 0;
      const layers::LayersOverFan over{face.is_sector(),
                                       {columns.counts[columns.vertex_of(face.columns[0])],
                                        columns.counts[columns.vertex_of(face.columns[other])]}};
      const auto at = [&](int i, std::int32_t k) { return layers::node(piece, columns, face.columns[i], k); };
      for (std::int32_t k = 1; k <= std::max(over.counts[0], over.counts[1]); ++k) {
        layers::visit_layer(over, k, [&](mesh::CellShape shape, const auto& nodes) {
          std::array<geometry::Vec3, 8> corners;
          for (std::size_t i = 0; i < nodes.size(); ++i) corners[i] = at(nodes[i].corner, nodes[i].level);
          add_cell(shape, corners.data());
        });
      }
      if (layout.apex_of_face[f] < 0) continue;
      std::array<geometry::Vec3, 5> pyramid;
      for (int i = 0; i < 4; ++i) pyramid[i] = at(i, over.counts[i / 2]);
      pyramid[4] = cap.point(layout.apex_of_face[f]);
      add_cell(mesh::CellShape::pyramid, pyramid.data());
    }
  }
  /// Columns counter-clockwise seen from the fluid.
  void add_triangle(const mesh::Piece& piece, const layers::PieceColumns& columns,
                    const std::array<std::int32_t, 3>& corners, double first) {
    std::array<std::int32_t, 3> counts;
    for (int i = 0; i < 3; ++i) counts[i] = columns.counts[columns.vertex_of(corners[i])];
    const auto at = [&](int i, std::int32_t k) {
      return layers::node(piece, columns, corners[i], std::min(k, counts[i]));
    };
    const std::int32_t most = *std::max_element(counts.begin(), counts.end());
    for (std::int32_t k = 1; k <= most; ++k) {
      const std::array<geometry::Vec3, 6> p{at(0, k - 1), at(1, k - 1), at(2, k - 1),
                                            at(0, k),     at(1, k),     at(2, k)};
      int live = 0, dead = 0, last = 0;
      for (int i = 0; i < 3; ++i) {
        if (counts[i] >= k)
          ++live, last = i;
        else
          dead = i;
      }
      const int i = (dead + 1) % 3, j = (dead + 2) % 3;
      if (live == 3) add_cell(mesh::CellShape::prism, p.data());
      if (live == 2)
        add_cell(mesh::CellShape::pyramid, std::array{p[i], p[i + 3], p[j + 3], p[j], p[dead]}.data());
      if (live == 1) add_cell(mesh::CellShape::tetrahedron, std::array{p[0], p[1], p[2], p[last + 3]}.data());
      if (k > 1 || live < 3) continue;
      const geometry::Vec3 normal = normalized(cross(p[1] - p[0], p[2] - p[0]));
      for (int corner = 0; corner < 3; ++corner)
        first_heights.push_back(dot(p[corner + 3] - p[corner], normal) / first);
    }
  }
};

}  // namespace aeroloom::benchmarks
