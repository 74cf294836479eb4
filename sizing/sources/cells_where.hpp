/// Cells of the octree in which something asks for sizes, found from the root down.
#pragma once

#include "sizing/field/sources.hpp"

#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

namespace aeroloom::sizing {

inline constexpr double no_size = std::numeric_limits<double>::infinity();

/// What is asked for in a cube.
struct CubeDemand {
  double least = no_size;       ///< the smallest size anywhere in it, about; infinite: the cube is left out
  double size = no_size;        ///< that a source in its middle asks for
  double resolution = no_size;  ///< edges of cubes are at most this long before they are left as they are
};
using AskInCube = std::function<CubeDemand(geometry::Vec3 middle, double half_edge)>;

/// A rank, and how many share the work.
struct RankOf {
  int rank, ranks;
};

/// Divides the root until no cell is larger than what is asked for in it. One rank's part of sources in the
/// middles of those cells whose size is below `limit`; those of all ranks together do not depend on how
/// many there are. Ends early with one more than `most` sources.
std::vector<SizeSource> sources_where(const RootCube& root, const AskInCube& ask, RankOf part,
                                      double limit = no_size,
                                      std::int64_t most = std::numeric_limits<std::int64_t>::max());

}  // namespace aeroloom::sizing
