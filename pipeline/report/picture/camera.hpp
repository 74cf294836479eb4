/// Projects space onto the canvas (parallel projection). Lengths can be measured in the picture.
#pragma once

#include "geometry/vec.hpp"
#include "pipeline/report/picture/canvas.hpp"

namespace aeroloom::picture {

/// The position of the viewer: three orthonormal vectors.
struct Viewpoint {
  geometry::Vec3 right, up, towards;  ///< `towards`: from the object to the viewer
};

/// A view from the direction `from`, with `up` pointing upwards as far as possible; any upward direction if
/// `up` is parallel to `from`.
Viewpoint look_from(geometry::Vec3 from, geometry::Vec3 up);

/// Coordinates along right, up and towards.
inline geometry::Vec3 in_view(const Viewpoint& view, geometry::Vec3 p) {
  return {dot(view.right, p), dot(view.up, p), dot(view.towards, p)};
}

struct Camera {
  Viewpoint view;
  geometry::Vec3 target;  ///< in the centre of the window, at depth 0
  double scale = 1;       ///< pixels per unit length
  Window window;

  ScreenPoint project(geometry::Vec3 p) const {
    const geometry::Vec3 seen = in_view(view, p - target);
    return {window.left + 0.5 * window.width + scale * seen.x,
            window.top + 0.5 * window.height - scale * seen.y, -scale * seen.z};
  }
};

/// Shows all of `seen`, a box in view coordinates, with a margin in pixels.
Camera frame(const Viewpoint& view, const geometry::Box& seen, Window window, double margin);
/// Shows the point in the centre of the window, which is `width` wide in space.
Camera close_up(const Viewpoint& view, geometry::Vec3 target, double width, Window window);

}  // namespace aeroloom::picture
