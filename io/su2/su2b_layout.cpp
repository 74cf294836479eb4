#include "io/su2/su2b_layout.hpp"

#include <algorithm>
#include <limits>

namespace aeroloom::io {

Su2bLayout su2b_layout(const Su2bCounts& counts) {
  Su2bLayout layout;
  const Su2bStart cells = su2b_start(counts.cells, counts.cells.size());
  std::int64_t largest = std::max(counts.points, cells.integer);
  for (const auto& marker : counts.markers)
    largest = std::max(largest, su2b_start(marker, marker.size()).integer);
  layout.integer_bytes = largest <= std::numeric_limits<std::uint32_t>::max() ? 4 : 8;
  std::int64_t at = 4 * 4;  // size of integers, zones, number of the zone, dimensions
  const auto place = [&](const Su2bStart& end) {
    Su2bLayout::Section section;
    section.count = at;
    section.places = section.count + layout.integer_bytes;
    section.connectivity = section.places + layout.integer_bytes * (end.element + 1);
    at = section.connectivity + layout.integer_bytes * end.integer;
    return section;
  };
  layout.cells = place(cells);
  layout.point_count = at;
  layout.points = layout.point_count + layout.integer_bytes;
  layout.marker_count = layout.points + layout.point_bytes() * counts.points;
  at = layout.marker_count + 4;
  for (const auto& marker : counts.markers) {
    layout.names.push_back(at);
    at += su2b_name_bytes;
    layout.markers.push_back(place(su2b_start(marker, marker.size())));
  }
  layout.end = at;
  return layout;
}

}  // namespace aeroloom::io
