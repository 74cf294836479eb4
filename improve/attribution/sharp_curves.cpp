#include "improve/attribution/sharp_curves.hpp"

#include "geometry/sort_unique.hpp"

#include <limits>
#include <tuple>
#include <utility>

namespace aeroloom::attribution {

SharpCurves::SharpCurves(const mesh::DistributedMesh& mesh, const std::vector<SharpSegment>& mine)
    : _segments(mesh.communicator.all_gather_items<SharpSegment>(mine)) {
  const auto key = [](const SharpSegment& s) { return std::tie(s.region, s.low, s.high, s.edge); };
  const auto same = [&](const SharpSegment& s, const SharpSegment& t) { return key(s) == key(t); };
  geometry::sort_unique(
      _segments, [&](const SharpSegment& s, const SharpSegment& t) { return key(s) < key(t); }, same);
  std::map<Wedge, std::vector<sizing::SegmentTree::Segment>> segments;
  for (std::size_t i = 0; i < _segments.size(); ++i) {
    const SharpSegment& s = _segments[i];
    segments[{s.region, s.low, s.high}].push_back({s.a, s.b, static_cast<std::int32_t>(i)});
  }
  for (auto& [wedge, of_wedge] : segments) _trees.emplace(wedge, std::move(of_wedge));
}

std::optional<SharpCurves::Nearest> SharpCurves::nearest(mesh::RegionId region, std::int32_t low,
                                                         std::int32_t high, geometry::Vec3 point) const {
  const auto tree = _trees.find({region, low, high});
  if (tree == _trees.end()) return std::nullopt;
  std::int32_t last = 0;  // of those that were the nearest so far
  const sizing::SegmentTree::Hit hit =
      tree->second.nearest_hit(point, std::numeric_limits<double>::infinity(),
                               [&](std::int32_t segment) { return last = segment, true; });
  return Nearest{hit.away, _segments[last].angle, 0.5 * (_segments[last].a + _segments[last].b)};
}

}  // namespace aeroloom::attribution
