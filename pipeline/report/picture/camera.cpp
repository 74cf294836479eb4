#include "pipeline/report/picture/camera.hpp"

#include <algorithm>
#include <cmath>

namespace aeroloom::picture {

using geometry::Vec3;

Viewpoint look_from(Vec3 from, Vec3 up) {
  const Vec3 towards = normalized(from);
  Vec3 right = cross(up, towards);
  constexpr double along_up = 1e-6, along_y = 0.9;  // a sine, below which there is no right; a cosine
  if (norm(right) < along_up * norm(up)) {
    right = cross(std::abs(towards.y) < along_y ? Vec3{0, 1, 0} : Vec3{1, 0, 0}, towards);
  }
  right = normalized(right);
  return {right, cross(towards, right), towards};
}

Camera frame(const Viewpoint& view, const geometry::Box& seen, Window window, double margin) {
  const Vec3 middle = seen.center(), size = seen.size();
  const double across = std::max(size.x / std::max(window.width - 2 * margin, 1.0),
                                 size.y / std::max(window.height - 2 * margin, 1.0));
  return {view, middle.x * view.right + middle.y * view.up + middle.z * view.towards,
          across > 0 ? 1 / across : 1, window};
}

Camera close_up(const Viewpoint& view, Vec3 target, double width, Window window) {
  return {view, target, window.width / width, window};
}

}  // namespace aeroloom::picture
