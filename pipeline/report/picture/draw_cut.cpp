#include "mesh/data/piece_faces.hpp"
#include "mesh/quality/quality.hpp"
#include "pipeline/report/picture/drawing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace aeroloom::picture {
namespace {

using geometry::Vec3;
using mesh::LocalIndex;

/// Where the plane cuts an edge whose ends lie `high` above it and `low` below it. The same bits for all
/// tetrahedra at the edge.
Vec3 crossing(Vec3 above, double high, Vec3 below, double low) {
  return above + high / (high - low) * (below - above);
}

/// A cut tetrahedron: three corners or four, one after another.
struct CutPolygon {
  std::array<Vec3, 4> corners;
  int count = 0;
};

CutPolygon cut(const std::array<Vec3, 4>& corners, const std::array<double, 4>& heights) {
  std::array<int, 4> above{}, below{};
  int above_count = 0, below_count = 0;
  for (int i = 0; i < 4; ++i) {
    if (heights[i] > 0) {
      above[above_count++] = i;
    } else {
      below[below_count++] = i;
    }
  }
  CutPolygon polygon;
  const auto add = [&](int a, int b) {
    polygon.corners[polygon.count++] = crossing(corners[a], heights[a], corners[b], heights[b]);
  };
  if (above_count == 2 && below_count == 2) {
    add(above[0], below[0]), add(above[0], below[1]), add(above[1], below[1]), add(above[1], below[0]);
  } else {
    for (int i = 0; i < above_count; ++i) {
      for (int j = 0; j < below_count; ++j) add(above[i], below[j]);
    }
  }
  return polygon;
}

void draw_polygon(Canvas& canvas, const Camera& camera, const CutPolygon& polygon, Colour colour,
                  double edge_opacity, double size) {
  std::array<ScreenPoint, 4> p;
  for (int i = 0; i < polygon.count; ++i) {
    p[i] = camera.project(polygon.corners[i]);
    p[i].depth = 0;
  }
  // By the size of the tetrahedron in pixels, so that slender cuts have lines as their neighbours have.
  constexpr double invisible = 2, full = 7;
  const double opacity = edge_opacity * std::clamp((size - invisible) / (full - invisible), 0.0, 1.0);
  TriangleStyle style{colour, mix(colour, ink, 0.75), 1.0, {opacity, opacity, opacity}};
  if (polygon.count == 3) return canvas.draw_triangle({p[0], p[1], p[2]}, style);
  style.line_opacity = {opacity, opacity, 0};
  canvas.draw_triangle({p[0], p[1], p[2]}, style);
  style.line_opacity = {0, opacity, opacity};
  canvas.draw_triangle({p[0], p[2], p[3]}, style);
}

/// Whether some of these corners are above the plane and others are not.
bool straddles(const std::vector<double>& heights, const LocalIndex* corners, int count) {
  const bool first = heights[corners[0]] > 0;
  return std::any_of(corners + 1, corners + count, [&](LocalIndex v) { return (heights[v] > 0) != first; });
}

/// Where a plane cuts the edges of a pyramid, prism or tetrahedron, one after another around the cell.
std::vector<ScreenPoint> cut_of_cell(const mesh::Piece& piece, mesh::CellOfPiece cell,
                                     const std::vector<double>& heights, const Camera& camera) {
  std::vector<ScreenPoint> corners;
  ScreenPoint centre;
  const LocalIndex* v = vertices_of(piece, cell);
  for (const mesh::CellFace& face : mesh::faces_of(cell.shape)) {
    for (int k = 0; k < 4 && face[k] >= 0; ++k) {
      const LocalIndex a = v[face[k]], b = v[face[k == 3 || face[k + 1] < 0 ? 0 : k + 1]];
      // Each edge twice, once each way.
      if (!(heights[a] > 0) || heights[b] > 0) continue;
      corners.push_back(camera.project(crossing(piece.point(a), heights[a], piece.point(b), heights[b])));
      corners.back().depth = 0;
      centre.x += corners.back().x, centre.y += corners.back().y;
    }
  }
  const auto count = static_cast<double>(std::max<std::size_t>(1, corners.size()));
  centre.x /= count, centre.y /= count;
  const auto angle = [&](const ScreenPoint& p) { return std::atan2(p.y - centre.y, p.x - centre.x); };
  std::sort(corners.begin(), corners.end(),
            [&](const ScreenPoint& p, const ScreenPoint& q) { return angle(p) < angle(q); });
  return corners;
}

/// The cells of boundary layers, in one colour. Lines fade where layers are thin.
void draw_layers(Canvas& canvas, const Camera& camera, const mesh::Piece& piece,
                 const std::vector<double>& heights, double edge_opacity) {
  for (LocalIndex c = 0; c < piece.total_cell_count(); ++c) {
    const mesh::CellOfPiece cell = mesh::cell_of(piece, c);
    if (!straddles(heights, vertices_of(piece, cell), mesh::corners_of(cell.shape))) continue;
    const std::vector<ScreenPoint> p = cut_of_cell(piece, cell, heights, camera);
    double area = 0, around = 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
      const ScreenPoint &a = p[i], &b = p[(i + 1) % p.size()];
      area += 0.5 * (a.x * b.y - b.x * a.y);
      around += std::hypot(b.x - a.x, b.y - a.y);
    }
    constexpr double invisible = 1.5, full = 5;  // pixels, of a layer's height
    const double height = around > 0 ? 4 * std::abs(area) / around : 0;
    const double opacity = edge_opacity * std::clamp((height - invisible) / (full - invisible), 0.0, 1.0);
    TriangleStyle style{layer_green, mix(layer_green, ink, 0.75), 1.0, {}};
    for (std::size_t i = 1; i + 1 < p.size(); ++i) {
      style.line_opacity = {i == 1 ? opacity : 0, opacity, i + 2 == p.size() ? opacity : 0};
      canvas.draw_triangle({p[0], p[i], p[i + 1]}, style);
    }
  }
}

}  // namespace

void draw_cut(Canvas& canvas, const Camera& camera, const mesh::DistributedMesh& volume, Plane plane,
              double edge_opacity) {
  canvas.set_window(camera.window);
  for (const mesh::Piece& piece : volume.pieces) {
    std::vector<double> heights(piece.vertex_count());
    for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      heights[v] = dot(plane.normal, piece.point(v)) - plane.offset;
    }
    const auto is_above = [](double height) { return height > 0; };
    const auto above = std::count_if(heights.begin(), heights.end(), is_above);
    if (above == 0 || above == static_cast<std::ptrdiff_t>(heights.size())) continue;
    if (!piece.layers.empty()) {
      draw_layers(canvas, camera, piece, heights, edge_opacity);
      continue;
    }
    for (LocalIndex c = 0; c < piece.cell_count(); ++c) {
      const LocalIndex* v = piece.cell(c);
      if (!straddles(heights, v, 4)) continue;
      const std::array<double, 4> h = {heights[v[0]], heights[v[1]], heights[v[2]], heights[v[3]]};
      std::array<Vec3, 4> corners;
      for (int i = 0; i < 4; ++i) corners[i] = piece.point(v[i]);
      const CutPolygon polygon = cut(corners, h);
      const double angle = mesh::dihedral_range(corners[0], corners[1], corners[2], corners[3]).smallest;
      const double volume6 = geometry::volume6(corners[0], corners[1], corners[2], corners[3]);
      draw_polygon(canvas, camera, polygon, angle_classes[angle_class(angle)].colour, edge_opacity,
                   camera.scale * std::cbrt(std::abs(volume6)));
    }
  }
}

void draw_section(Canvas& canvas, const Camera& camera, const mesh::DistributedMesh& surface,
                  const Scene& scene, Plane plane, double width) {
  canvas.set_window(camera.window);
  for (std::size_t p = 0; p < surface.pieces.size(); ++p) {
    const mesh::Piece& piece = surface.pieces[p];
    for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
      if (!scene.shown[p][t]) continue;
      std::array<ScreenPoint, 3> crossings;
      int count = 0;
      for (int i = 0; i < 3; ++i) {
        const Vec3 a = piece.point(piece.cell(t)[i]), b = piece.point(piece.cell(t)[(i + 1) % 3]);
        const double at_a = dot(plane.normal, a) - plane.offset, at_b = dot(plane.normal, b) - plane.offset;
        if ((at_a > 0) == (at_b > 0)) continue;
        crossings[count] = camera.project(at_a > 0 ? crossing(a, at_a, b, at_b) : crossing(b, at_b, a, at_a));
        crossings[count++].depth = 0;
      }
      if (count == 2) canvas.draw_line(crossings[0], crossings[1], width, ink, 1);
    }
  }
}

void draw_backdrop(Canvas& canvas, const Camera& camera, const geometry::Box& box, Colour colour) {
  canvas.set_window(camera.window);
  geometry::Box seen;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p{corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                 corner & 4 ? box.high.z : box.low.z};
    const ScreenPoint s = camera.project(p);
    seen.add(Vec3{s.x, s.y, 0});
  }
  constexpr double far_depth = 1e6;  // pixels: farther than anything that is drawn
  const ScreenPoint a{seen.low.x, seen.low.y, far_depth}, b{seen.high.x, seen.low.y, far_depth},
      c{seen.high.x, seen.high.y, far_depth}, d{seen.low.x, seen.high.y, far_depth};
  canvas.draw_triangle({a, b, c}, {colour, colour});
  canvas.draw_triangle({a, c, d}, {colour, colour});
}

}  // namespace aeroloom::picture
