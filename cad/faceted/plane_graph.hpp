/// Triangulates polygons and planar graphs of straight sides, without new points.
///
/// Ears are clipped (Meisters, Amer. Math. Monthly 82, 1975, doi:10.2307/2319703). An ear may have no other
/// corner on it, so that no triangle is flat. Components of a graph are first connected by bridges. All signs
/// are exact.
#pragma once

#include "geometry/half_edges.hpp"
#include "geometry/vec.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace aeroloom::cad {

/// Projection to the coordinate plane most nearly normal to a direction. The direction points to the viewer.
class CoordinatePlane {
public:
  explicit CoordinatePlane(geometry::Vec3 normal);
  geometry::Vec2 operator()(geometry::Vec3 p) const {
    const double x = p[_first], y = p[_second];
    return {x, y};
  }

private:
  int _first = 0, _second = 1;
};

/// Twice the area vector of a closed polygon (Newell).
geometry::Vec3 polygon_area_vector(std::span<const geometry::Vec3> corners);

/// Triangulates a polygon whose inside is on its left. It may touch itself. `loop` holds numbers of corners,
/// which are indices into `places`. Empty if the polygon crosses itself.
std::optional<std::vector<geometry::TriangleCorners>> cut_ears(std::vector<std::int32_t> loop,
                                                               std::span<const geometry::Vec2> places);

/// Which spaces of a graph are filled: all enclosed ones, or every second one from outside inward.
enum class PlaneFilling { all, alternating };

struct PlaneGraph {
  std::vector<geometry::Vec2> places;
  std::vector<std::array<std::int32_t, 2>> sides;
  std::vector<geometry::Vec2> holes;  ///< points in spaces that stay empty
  PlaneFilling filling = PlaneFilling::all;
};

/// Counter-clockwise triangles. Empty if sides cross, overlap or pass through a place.
std::optional<std::vector<geometry::TriangleCorners>> fill_plane_graph(const PlaneGraph& graph);

}  // namespace aeroloom::cad
