#include "surface/division/background_surface.hpp"

#include "geometry/angle.hpp"

#include <numbers>

namespace aeroloom::partition {
namespace {

double corner_angle(const BackgroundSurface& surface, geometry::HalfEdge corner) {
  const geometry::Vec3 at = surface.points[surface.start(corner)];
  const geometry::Vec3 u = surface.points[surface.end(corner)] - at;
  const geometry::Vec3 v = surface.points[surface.start(geometry::previous_half_edge(corner))] - at;
  return angle_between(u, v) * 180 / std::numbers::pi;
}

}  // namespace

VertexFans gather_fans(const BackgroundSurface& surface) {
  VertexFans fans;
  const auto count = static_cast<geometry::HalfEdge>(surface.twins.size());
  std::vector<char> done(count, 0);
  const auto gather = [&](geometry::HalfEdge start) {
    fans.first.push_back(static_cast<std::int32_t>(fans.corners.size()));
    geometry::HalfEdge corner = start;
    do {
      done[corner] = 1;
      fans.corners.push_back(corner);
      corner = surface.twins[geometry::previous_half_edge(corner)];
    } while (corner >= 0 && corner != start);
    fans.closed.push_back(corner >= 0);
  };
  for (geometry::HalfEdge h = 0; h < count; ++h) {
    if (surface.twins[h] < 0) gather(h);
  }
  for (geometry::HalfEdge h = 0; h < count; ++h) {
    if (!done[h]) gather(h);
  }
  fans.first.push_back(static_cast<std::int32_t>(fans.corners.size()));
  fans.angles.reserve(fans.corners.size());
  for (const geometry::HalfEdge corner : fans.corners) fans.angles.push_back(corner_angle(surface, corner));
  return fans;
}

}  // namespace aeroloom::partition
