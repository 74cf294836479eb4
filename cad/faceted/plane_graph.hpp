/// Polygons, and plane graphs of straight sides, cut into triangles without new points.
///
/// Ears are cut off as in Meisters (Amer. Math. Monthly 82, 1975, doi:10.2307/2319703), where an ear has no
/// other corner on it, so that corners on straight sides leave no triangle without area. Parts of a graph
/// that hang together nowhere are first joined by bridges. All signs are exact.
#pragma once

#include "geometry/half_edges.hpp"
#include "geometry/vec.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace aeroloom::cad {

/// The coordinate plane that a normal is steepest to: looked at with the normal towards the viewer.
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

/// A polygon whose inside is on its left, cut into triangles; it may touch itself. Nothing where it crosses
/// itself. Corners are told by their numbers in `loop`, places by `places[number]`.
std::optional<std::vector<geometry::TriangleCorners>> cut_ears(std::vector<std::int32_t> loop,
                                                               std::span<const geometry::Vec2> places);

/// What of a plane graph is filled: every space that is enclosed, or every second one from outside inwards.
enum class PlaneFilling { all, alternating };

struct PlaneGraph {
  std::vector<geometry::Vec2> places;
  std::vector<std::array<std::int32_t, 2>> sides;
  std::vector<geometry::Vec2> holes;  ///< points in spaces that stay empty
  PlaneFilling filling = PlaneFilling::all;
};

/// Triangles, counter-clockwise. Nothing where sides cross, overlap, or run through a place of another one.
std::optional<std::vector<geometry::TriangleCorners>> fill_plane_graph(const PlaneGraph& graph);

}  // namespace aeroloom::cad
