/// Finds the octree cells in which something asks for a size, from the root down.
#pragma once

#include "sizing/field/sources.hpp"

#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

namespace aeroloom::sizing {

inline constexpr double no_size = std::numeric_limits<double>::infinity();

/// The size that is asked for in a cube.
struct CubeRequest {
  double least = no_size;       ///< about the smallest size anywhere in the cube; infinite: none
  double size = no_size;        ///< of a source in the middle of the cube
  double resolution = no_size;  ///< the largest edge of a cube that is not divided
};
using RequestInCube = std::function<CubeRequest(geometry::Vec3 middle, double half_edge)>;

/// A rank, and the number of ranks that share the work.
struct RankOf {
  int rank, ranks;
};

/// Divides the root until no cell is larger than the size asked for in it. Returns the sources of one rank,
/// in the middles of cells whose size is below `limit`. The sources of all ranks together do not depend on
/// the number of ranks. Ends early with one more than `most` sources.
std::vector<SizeSource> sources_where(const RootCube& root, const RequestInCube& ask, RankOf part,
                                      double limit = no_size,
                                      std::int64_t most = std::numeric_limits<std::int64_t>::max());

}  // namespace aeroloom::sizing
