/// The front kernel: fills a region of a plane chart with triangles that follow a size function.
///
/// Points are placed by an advancing front, each at the ideal distance from a front edge; they are connected
/// by a constrained Delaunay triangulation with exact predicates, so the front cannot fail to close (Rebay,
/// J. Comput. Phys. 106, 1993, doi:10.1006/jcph.1993.1097; Frey, Borouchaki and George, Comput. Methods Appl.
/// Mech. Eng. 157, 1998, doi:10.1016/S0045-7825(97)00222-3).
#pragma once

#include "geometry/vec.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace aeroloom::front {

/// Loops of boundary vertices in the chart, whose inside the front fills.
struct FrontInput {
  std::vector<geometry::Vec2> points;  ///< boundary vertices
  std::vector<std::array<std::int32_t, 2>>
      edges;  ///< directed, the region on their left; they form closed loops
};

/// Wanted edge length in the chart at a point of the chart; positive. `hint` is the function's own: 0 at
/// first, then what it left there.
using ChartSize = std::function<double(geometry::Vec2 point, std::int32_t& hint)>;

struct FrontResult {
  std::vector<geometry::Vec2> points;  ///< the input points in input order, then new ones
  std::vector<std::array<std::int32_t, 3>>
      triangles;  ///< counter-clockwise; every input edge is an edge of one
};

/// Two boundary edges that meet where they should not, by index into FrontInput::edges.
struct CrossingEdges {
  std::int32_t first, second;
};

/// The boundary is not a set of simple closed loops: edges cross or touch.
class FrontError : public std::runtime_error {
public:
  FrontError(const std::string& what, std::vector<CrossingEdges> crossings)
      : std::runtime_error(what), _crossings(std::move(crossings)) {}
  const std::vector<CrossingEdges>& crossings() const { return _crossings; }

private:
  std::vector<CrossingEdges> _crossings;
};

/// Fills the region. Deterministic: a function of its arguments alone. Throws FrontError for an invalid
/// boundary, std::invalid_argument for a size that is not positive.
FrontResult fill_front(const FrontInput& input, const ChartSize& size);

}  // namespace aeroloom::front
