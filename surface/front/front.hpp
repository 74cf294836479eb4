/// Advancing front method in a plane chart: fills a region with triangles that follow a size function.
///
/// The front places each point at the ideal distance from one of its edges. A constrained Delaunay
/// triangulation with exact predicates connects the points, so the front always closes (Rebay, J. Comput.
/// Phys. 106, 1993, doi:10.1006/jcph.1993.1097; Frey, Borouchaki and George, Comput. Methods Appl. Mech. Eng.
/// 157, 1998, doi:10.1016/S0045-7825(97)00222-3).
#pragma once

#include "geometry/vec.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace aeroloom::front {

/// Boundary loops in the chart. The front fills their inside.
struct FrontInput {
  std::vector<geometry::Vec2> points;              ///< boundary vertices
  std::vector<std::array<std::int32_t, 2>> edges;  ///< directed closed loops, the region on their left
};

/// Wanted edge length at a point of the chart; positive. `hint` belongs to the function: 0 at the first call,
/// then the value that it set for a nearby point.
using ChartSize = std::function<double(geometry::Vec2 point, std::int32_t& hint)>;

struct FrontResult {
  std::vector<geometry::Vec2> points;                  ///< the input points in input order, then new ones
  std::vector<std::array<std::int32_t, 3>> triangles;  ///< counter-clockwise; they have all input edges
};

/// Two boundary edges that cross or touch, as indices into FrontInput::edges.
struct CrossingEdges {
  std::int32_t first, second;
};

/// The boundary is not a set of simple closed loops: its edges cross or touch.
class FrontError : public std::runtime_error {
public:
  FrontError(const std::string& what, std::vector<CrossingEdges> crossings)
      : std::runtime_error(what), _crossings(std::move(crossings)) {}
  const std::vector<CrossingEdges>& crossings() const { return _crossings; }

private:
  std::vector<CrossingEdges> _crossings;
};

/// Fills the region. The result depends on the arguments alone. Throws FrontError for an invalid boundary,
/// std::invalid_argument for a size that is not positive.
FrontResult fill_front(const FrontInput& input, const ChartSize& size);

}  // namespace aeroloom::front
