/// CAD curves where two faces enclose a small angle and form a wedge.
#pragma once

#include "geometry/vec.hpp"
#include "mesh/data/distributed_mesh.hpp"
#include "sizing/features/segment_tree.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

namespace aeroloom::attribution {

/// A mesh edge on such a curve, for two of the faces that meet there.
struct SharpSegment {
  std::int64_t edge;       ///< its number, equal on all ranks
  mesh::RegionId region;   ///< region of the wedge
  std::int32_t low, high;  ///< CAD faces, low < high
  double angle;            ///< degrees, enclosed by the boundary
  geometry::Vec3 a, b;     ///< its ends, equal on all ranks
};

/// All such segments of a mesh, for nearest-segment queries.
class SharpCurves {
public:
  SharpCurves() = default;
  /// Collects the segments of all ranks; ranks may have some in common. Collective.
  SharpCurves(const mesh::DistributedMesh& mesh, const std::vector<SharpSegment>& mine);

  struct Nearest {
    double distance, angle;
    geometry::Vec3 at;  ///< middle of the segment
  };
  /// The segment between two faces in a region that is nearest to a point, if there is one.
  std::optional<Nearest> nearest(mesh::RegionId region, std::int32_t low, std::int32_t high,
                                 geometry::Vec3 point) const;

private:
  using Wedge = std::tuple<mesh::RegionId, std::int32_t, std::int32_t>;  // region and faces
  std::vector<SharpSegment> _segments;                                   // by wedge and edge, each once
  std::map<Wedge, sizing::SegmentTree> _trees;                           // of their segments, by number
};

}  // namespace aeroloom::attribution
