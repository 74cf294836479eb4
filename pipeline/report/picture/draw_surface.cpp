#include "pipeline/report/picture/drawing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace aeroloom::picture {
namespace {

using geometry::Vec3;
using mesh::LocalIndex;

/// Triangles that turn by less are a smooth surface to the eye; colours and lights below are a matter of
/// taste.
constexpr double sharp = 35 * std::numbers::pi / 180;
/// Lines have a width, and the surface rises beside them: pixels.
constexpr double raised = 2;

/// Brightness of a wall that is turned to the viewer: light from the viewer and from the upper left.
double brightness(const Viewpoint& view, Vec3 flow_normal) {
  const Vec3 light = normalized(view.towards + 0.9 * view.up - 0.6 * view.right);
  return 0.5 + 0.34 * std::max(0.0, dot(flow_normal, view.towards)) +
         0.22 * std::max(0.0, dot(flow_normal, light));
}

/// The drawing of the triangles of a surface that a camera sees.
class SurfaceDrawing {
public:
  SurfaceDrawing(Canvas& canvas, const Camera& camera, const SurfaceLook& look)
      : _canvas(canvas), _camera(camera), _look(look) {}

  /// `colours`: by triangle, or null for those of the patches.
  void draw(const mesh::Piece& piece, const std::vector<std::uint8_t>& shown,
            const std::vector<EdgeNeighbour>& neighbours, const std::vector<Colour>* colours) {
    for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
      if (!shown[t]) continue;
      const Vec3 normal = -normalized(area_normal(piece, t));
      if (!is_seen(normal)) continue;
      const LocalIndex* v = piece.cell(t);
      std::array<ScreenPoint, 3> corners;
      for (int i = 0; i < 3; ++i) corners[i] = _camera.project(piece.point(v[i]));
      const Colour own = colours == nullptr ? colour_of(piece.triangle_patch[t]) : (*colours)[t];
      const Colour colour =
          lit(own, brightness(_camera.view,
                              shading_normal(normal, neighbours.data() + 3 * static_cast<std::size_t>(t))));
      TriangleStyle style{colour, mix(colour, ink, 0.8), 1.1};
      if (_look.edge_opacity > 0) style.line_opacity.fill(_look.edge_opacity * visible_fraction(corners));
      _canvas.draw_triangle(corners, style);
      for (int i = 0; i < 3; ++i) {
        const EdgeNeighbour& neighbour = neighbours[3 * static_cast<std::size_t>(t) + i];
        draw_border(corners[i], corners[(i + 1) % 3], normal, piece.triangle_patch[t], own, neighbour);
      }
    }
  }

private:
  bool is_seen(Vec3 flow_normal) const { return dot(flow_normal, _camera.view.towards) > 0; }

  /// Without lines the triangles are not to be seen, but the shape.
  Vec3 shading_normal(Vec3 normal, const EdgeNeighbour* neighbours) const {
    if (_look.edge_opacity > 0) return normal;
    Vec3 sum = normal;
    for (int i = 0; i < 3; ++i) {
      if (dot(normal, -neighbours[i].normal) > std::cos(sharp)) sum += -neighbours[i].normal;
    }
    return normalized(sum);
  }

  Colour colour_of(std::int32_t patch) const {
    const bool is_known = patch >= 0 && static_cast<std::size_t>(patch) < _look.patch_colours.size();
    return is_known ? _look.patch_colours[patch] : name_colours.back();
  }

  /// Lines get lighter where they come closer than a few pixels.
  static double visible_fraction(const std::array<ScreenPoint, 3>& c) {
    const double area =
        std::abs((c[1].x - c[0].x) * (c[2].y - c[0].y) - (c[1].y - c[0].y) * (c[2].x - c[0].x));
    double longest = 0;
    for (int i = 0; i < 3; ++i) {
      const ScreenPoint &a = c[i], &b = c[(i + 1) % 3];
      longest = std::max(longest, std::hypot(b.x - a.x, b.y - a.y));
    }
    const double height = longest > 0 ? area / longest : 0;
    constexpr double invisible = 1.5, full = 6;  // pixels of a triangle's height
    return std::clamp((height - invisible) / (full - invisible), 0.0, 1.0);
  }

  void draw_border(const ScreenPoint& a, const ScreenPoint& b, Vec3 normal, std::int32_t patch, Colour own,
                   const EdgeNeighbour& neighbour) {
    const bool is_outline = neighbour.is_open() || !neighbour.shown || !is_seen(-neighbour.normal);
    const bool is_sharp = neighbour.several || dot(normal, -neighbour.normal) < std::cos(sharp);
    if (is_outline) {
      _canvas.draw_line(a, b, _look.outline_width, ink, raised);
    } else if (is_sharp || neighbour.patch != patch) {
      _canvas.draw_line(a, b, 0.85 * _look.outline_width, mix(ink, own, 0.25), raised);
    }
  }

  Canvas& _canvas;
  const Camera& _camera;
  const SurfaceLook& _look;
};

}  // namespace

void draw_surface(Canvas& canvas, const Camera& camera, const mesh::DistributedMesh& surface,
                  const EdgeNeighbours& neighbours, const Scene& scene, const SurfaceLook& look) {
  canvas.set_window(camera.window);
  SurfaceDrawing drawing(canvas, camera, look);
  for (std::size_t p = 0; p < surface.pieces.size(); ++p) {
    const bool by_triangle = look.triangle_colours != nullptr;
    drawing.draw(surface.pieces[p], scene.shown[p], neighbours[p],
                 by_triangle ? &(*look.triangle_colours)[p] : nullptr);
  }
}

}  // namespace aeroloom::picture
