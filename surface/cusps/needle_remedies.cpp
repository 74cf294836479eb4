#include "surface/cusps/needle_remedies.hpp"

#include "geometry/sort_unique.hpp"
#include "surface/curves/sharp_corners.hpp"

#include <algorithm>

namespace aeroloom::surface {
namespace {

using mesh::CadDimension;
using mesh::LocalIndex;

/// Sizes at a short side, in its length; less of a fall than this fraction of the size there is not worth a
/// round.
constexpr double sides = 2, worthwhile = 0.8;
/// A leg that is shorter than this, over the longest of short ones, is a short one whose size has been
/// rounded.
constexpr double long_leg = 1.1;

sizing::SizeSource source_at_shortest_side(const mesh::Piece& piece, const LocalIndex* v) {
  geometry::Vec3 a = piece.point(v[2]), b = piece.point(v[0]);
  for (int i = 0; i < 2; ++i) {
    const geometry::Vec3 c = piece.point(v[i]), d = piece.point(v[i + 1]);
    if (distance(c, d) < distance(a, b)) a = c, b = d;
  }
  return {0.5 * (a + b), sides * distance(a, b)};
}

/// The CAD vertices of long sides between vertices on curves.
void add_long_legs(const mesh::Piece& piece, const LocalIndex* v, const sizing::SizeField& field,
                   std::vector<cad::VertexId>& vertices) {
  for (int i = 0; i < 3; ++i) {
    const LocalIndex a = v[i], b = v[(i + 1) % 3];
    const auto [lower, higher] = std::minmax(piece.vertex_dimension[a], piece.vertex_dimension[b]);
    if (lower != CadDimension::vertex || !is_on_curve(higher)) continue;
    const geometry::Vec3 p = piece.point(a), q = piece.point(b);
    if (distance(p, q) < long_leg * longest_short_leg * field(0.5 * (p + q))) continue;
    for (const LocalIndex end : {a, b}) {
      if (piece.vertex_dimension[end] == CadDimension::vertex) vertices.push_back(piece.vertex_entity[end]);
    }
  }
}

}  // namespace

NeedleRemedies find_needle_remedies(const mesh::DistributedMesh& surface, const std::vector<Needle>& needles,
                                    const sizing::SizeField& field) {
  NeedleRemedies mine;
  for (const Needle& needle : needles) {
    if (needle.cause != NeedleCause::mesh) continue;
    const mesh::Piece& piece = surface.pieces[needle.piece];
    const LocalIndex* v = piece.cell(needle.triangle);
    const std::size_t legs = mine.short_legs.size();
    add_long_legs(piece, v, field, mine.short_legs);
    const sizing::SizeSource source = source_at_shortest_side(piece, v);
    if (mine.short_legs.size() == legs && source.size > 0 && source.size < worthwhile * field(source.point))
      mine.sizes.push_back(source);
  }
  NeedleRemedies all;
  all.sizes = surface.communicator.all_gather_items<sizing::SizeSource>(mine.sizes);
  all.short_legs = surface.communicator.all_gather_items<cad::VertexId>(mine.short_legs);
  geometry::sort_unique(all.short_legs);
  return all;
}

}  // namespace aeroloom::surface
