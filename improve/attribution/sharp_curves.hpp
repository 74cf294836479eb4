/// Curves of the CAD at which two faces enclose a small angle: where wedges begin.
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

/// An edge of the mesh on such a curve, for two of the faces that meet there.
struct SharpSegment {
  std::int64_t edge;       ///< its number, the same on every rank
  mesh::RegionId region;   ///< that the wedge lies in
  std::int32_t low, high;  ///< the faces, low < high
  double angle;            ///< degrees that the boundary encloses
  geometry::Vec3 a, b;     ///< its ends, alike on every rank

  static constexpr auto fields() {
    return std::tuple(&SharpSegment::edge, &SharpSegment::region, &SharpSegment::low, &SharpSegment::high,
                      &SharpSegment::angle, &SharpSegment::a, &SharpSegment::b);
  }
};

/// All of them, to be asked for the nearest one between two faces.
class SharpCurves {
public:
  SharpCurves() = default;
  /// From each rank's own, some of which others may have too. Collective.
  SharpCurves(const mesh::DistributedMesh& mesh, const std::vector<SharpSegment>& mine);

  struct Nearest {
    double distance, angle;
    geometry::Vec3 at;  ///< the middle of the segment
  };
  /// The segment between two faces in a region that is nearest to a point, if there is any.
  std::optional<Nearest> nearest(mesh::RegionId region, std::int32_t low, std::int32_t high,
                                 geometry::Vec3 point) const;

private:
  using Wedge = std::tuple<mesh::RegionId, std::int32_t, std::int32_t>;  // region and faces
  std::vector<SharpSegment> _segments;                                   // by wedge and edge, each once
  std::map<Wedge, sizing::SegmentTree> _trees;                           // of their segments, by number
};

}  // namespace aeroloom::attribution
