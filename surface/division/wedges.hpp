/// Wedges around a vertex: the parts of a fan between borders of parts.
#pragma once

#include "surface/division/background_surface.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::partition {

inline bool is_feature(const BackgroundSurface& surface, geometry::HalfEdge h) {
  return surface.twins[h] < 0;
}

inline bool is_border(const BackgroundSurface& surface, const std::vector<PartIndex>& part,
                      geometry::HalfEdge h) {
  return is_feature(surface, h) || part[h / 3] != part[surface.twins[h] / 3];
}

/// Calls visit(wedge) for each wedge of a fan: between two neighbouring cuts, or a cut and a feature curve.
/// Wedges between two feature curves are left out, since no decomposition changes them.
template <class Visit>
void visit_wedges(const BackgroundSurface& surface, const VertexFans& fans,
                  const std::vector<PartIndex>& part, FanIndex fan, Visit visit) {
  const std::int32_t size = fans.size(fan), edges = fans.edge_count(fan);
  std::int32_t start = 0;
  while (start < edges && !is_border(surface, part, fans.edge(fan, start))) ++start;
  if (start == edges) return;
  const std::int32_t steps = fans.closed[fan] ? size : size - start;
  std::int32_t from = start;
  double angle = 0;
  for (std::int32_t k = 0; k < steps; ++k) {
    angle += fans.angles[fans.first[fan] + (start + k) % size];
    const std::int32_t to = fans.closed[fan] ? (start + k + 1) % size : start + k + 1;
    if (!is_border(surface, part, fans.edge(fan, to))) continue;
    const bool forced = is_feature(surface, fans.edge(fan, from)) && is_feature(surface, fans.edge(fan, to));
    if (!forced && !(from == to)) visit(FanWedge{fan, from, to, angle});
    from = to;
    angle = 0;
  }
}

}  // namespace aeroloom::partition
