#include "improve/attribution/strip_edges.hpp"

#include "geometry/sort_unique.hpp"
#include "improve/attribution/strip_triangles.hpp"

#include <algorithm>
#include <limits>
#include <tuple>

namespace aeroloom::attribution {

using mesh::GlobalIndex;
using mesh::LocalIndex;
using mesh::Piece;

std::vector<StripEdge> find_strip_edges(const mesh::DistributedMesh& mesh, const mesh::Numbering& numbering,
                                        const std::vector<EdgeName>& edges) {
  const auto triangles = find_strip_triangles(mesh, numbering);
  std::vector<StripEdge> mine;
  for (std::size_t i = 0; i < mesh.pieces.size(); ++i) {
    const Piece& piece = mesh.pieces[i];
    for (const StripTriangle& strip : triangles[i]) {
      const LocalIndex c = strip.corners[2];
      for (const LocalIndex a : {strip.corners[0], strip.corners[1]}) {
        const GlobalIndex ga = numbering.vertices[i][a], gc = numbering.vertices[i][c];
        // The triangles are in pieces of one side of a face; its edges are meant as any region sees them.
        const EdgeName first{std::min(ga, gc), std::max(ga, gc), std::numeric_limits<std::int64_t>::min()};
        for (auto found = std::lower_bound(edges.begin(), edges.end(), first);
             found != edges.end() && found->low == first.low && found->high == first.high; ++found) {
          mine.push_back({found - edges.begin(), piece.triangle_face[strip.triangle], strip.width,
                          0.5 * (piece.point(a) + piece.point(c))});
        }
      }
    }
  }
  std::vector<StripEdge> strips = mesh.communicator.all_gather_items<StripEdge>(mine);
  const auto same = [](const StripEdge& a, const StripEdge& b) { return a.edge == b.edge; };
  geometry::sort_unique(
      strips,
      [](const StripEdge& a, const StripEdge& b) {
        return std::tie(a.edge, a.width, a.face) < std::tie(b.edge, b.width, b.face);
      },
      same);
  return strips;
}

const StripEdge* find_strip_edge(const std::vector<StripEdge>& strips, std::int64_t edge) {
  const auto found =
      std::lower_bound(strips.begin(), strips.end(), edge,
                       [](const StripEdge& strip, std::int64_t wanted) { return strip.edge < wanted; });
  return found != strips.end() && found->edge == edge ? &*found : nullptr;
}

}  // namespace aeroloom::attribution
