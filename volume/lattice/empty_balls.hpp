/// Balls without triangles: all points of such a ball lie in one region.
#pragma once

#include "geometry/vec.hpp"
#include "mesh/data/piece.hpp"

#include <array>
#include <cstddef>
#include <optional>

namespace aeroloom::volume {

/// Remembers the last 16 balls. Use it for points that follow each other closely in space.
class EmptyBalls {
public:
  /// `radius` is at most the distance from the centre to the nearest triangle.
  void remember(geometry::Vec3 center, double radius, mesh::RegionId region) {
    _balls[_next++ % _balls.size()] = {center, radius, region};
  }
  /// The region of a point in one of the balls; nothing outside of them.
  std::optional<mesh::RegionId> region_at(geometry::Vec3 p) const {
    for (const Ball& ball : _balls) {
      if (dot(p - ball.center, p - ball.center) < ball.radius * ball.radius) return ball.region;
    }
    return std::nullopt;
  }

private:
  struct Ball {
    geometry::Vec3 center;
    double radius = 0;
    mesh::RegionId region = mesh::no_region;
  };

  std::array<Ball, 16> _balls{};
  std::size_t _next = 0;
};

}  // namespace aeroloom::volume
