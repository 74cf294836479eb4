#include "improve/borders/perturbation.hpp"

#include "geometry/predicates.hpp"
#include "mesh/data/cell_stars.hpp"
#include "mesh/data/mixing.hpp"

#include <algorithm>
#include <limits>
#include <vector>

namespace aeroloom::improve {
namespace {

using geometry::Vec3;
using mesh::LocalIndex;

/// Evenly within -1 and 1.
double offset_of(std::uint64_t seed, LocalIndex v, int axis) {
  const std::uint64_t bits =
      mesh::mix_in(mesh::mix_in(seed, static_cast<std::uint64_t>(v)), static_cast<std::uint64_t>(axis));
  return static_cast<double>(bits >> 11) * 0x1p-52 - 1;
}

}  // namespace

void perturb(mesh::Piece& piece, double fraction, std::uint64_t seed) {
  const mesh::CellStars stars(piece, 4);
  std::vector<char> stays(piece.vertex_count(), 0);
  for (const LocalIndex v : piece.shared_vertices) stays[v] = 1;
  for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
    if (stays[v] || is_on_boundary(piece.vertex_dimension[v])) continue;
    const Vec3 origin = piece.point(v);
    double shortest = std::numeric_limits<double>::max();
    stars.for_each(v, [&](LocalIndex, const mesh::AscendingCell& cell) {
      for (int k = 0; k < 4; ++k) {
        if (cell[k] != v) shortest = std::min(shortest, distance(origin, piece.point(cell[k])));
      }
    });
    if (shortest == std::numeric_limits<double>::max()) continue;
    Vec3 to = origin;
    for (int axis = 0; axis < 3; ++axis) to[axis] += fraction * shortest * offset_of(seed, v, axis);
    piece.set_point(v, to);
    bool positive = true;
    stars.for_each(v, [&](LocalIndex t, const mesh::AscendingCell&) {
      const LocalIndex* c = piece.cell(t);
      positive = positive && geometry::has_positive_volume(piece.point(c[0]), piece.point(c[1]),
                                                           piece.point(c[2]), piece.point(c[3]));
    });
    if (!positive) piece.set_point(v, origin);
  }
}

}  // namespace aeroloom::improve
