/// The camera: from space to the canvas, in parallel projection. Lengths are those of the mesh, and what is
/// drawn to one scale can be measured.
#pragma once

#include "geometry/vec.hpp"
#include "pipeline/report/picture/canvas.hpp"

namespace aeroloom::picture {

/// Where the viewer is, as three unit vectors that are perpendicular to each other.
struct Viewpoint {
  geometry::Vec3 right, up, towards;  ///< `towards` points from what is seen to the viewer
};

/// From the direction `from`, with `up` upwards as far as that goes; any other upwards where `up` lies along
/// `from`.
Viewpoint look_from(geometry::Vec3 from, geometry::Vec3 up);

/// Coordinates along right, up and towards.
inline geometry::Vec3 in_view(const Viewpoint& view, geometry::Vec3 p) {
  return {dot(view.right, p), dot(view.up, p), dot(view.towards, p)};
}

struct Camera {
  Viewpoint view;
  geometry::Vec3 target;  ///< seen in the middle of the window, at depth 0
  double scale = 1;       ///< pixels per length
  Window window;

  ScreenPoint project(geometry::Vec3 p) const {
    const geometry::Vec3 seen = in_view(view, p - target);
    return {window.left + 0.5 * window.width + scale * seen.x,
            window.top + 0.5 * window.height - scale * seen.y, -scale * seen.z};
  }
};

/// Shows all of `seen`, a box in coordinates of the view, with a margin of that many pixels.
Camera frame(const Viewpoint& view, const geometry::Box& seen, Window window, double margin);
/// Shows a place with `width` around it from the left border to the right one.
Camera close_up(const Viewpoint& view, geometry::Vec3 target, double width, Window window);

}  // namespace aeroloom::picture
