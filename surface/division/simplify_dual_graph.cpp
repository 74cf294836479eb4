#include "surface/division/simplify_dual_graph.hpp"

#include "geometry/disjoint_sets.hpp"

#include <algorithm>
#include <tuple>

namespace aeroloom::partition {
namespace {

/// Triangles united to clusters, with their loads.
class ClusterForest {
public:
  explicit ClusterForest(const std::vector<double>& loads) : _sets(loads.size()), _loads(loads) {}
  TriangleIndex root(TriangleIndex t) { return _sets.root(t); }
  double load(TriangleIndex root) const { return _loads[root]; }
  /// Of two roots.
  void unite(TriangleIndex a, TriangleIndex b) {
    _sets.unite(a, b);
    _loads[std::min(a, b)] += _loads[std::max(a, b)];
  }

private:
  geometry::DisjointSets<TriangleIndex> _sets;
  std::vector<double> _loads;
};

/// All wedges below the threshold, the sharpest first. In a closed fan no wedge goes all the way round.
std::vector<FanWedge> sharp_wedges(const VertexFans& fans, double threshold) {
  std::vector<FanWedge> wedges;
  for (FanIndex fan = 0; fan < fans.count(); ++fan) {
    const std::int32_t size = fans.size(fan);
    for (std::int32_t from = 0; from < size; ++from) {
      double angle = 0;
      const std::int32_t most = fans.closed[fan] ? size - 1 : size - from;
      for (std::int32_t k = 0; k < most; ++k) {
        angle += fans.angles[fans.first[fan] + (from + k) % size];
        if (angle >= threshold) break;
        const std::int32_t to = from + k + 1;
        wedges.push_back({fan, from, fans.closed[fan] ? to % size : to, angle});
      }
    }
  }
  std::sort(wedges.begin(), wedges.end(), [](const FanWedge& a, const FanWedge& b) {
    return std::tie(a.angle, a.fan, a.from, a.to) < std::tie(b.angle, b.fan, b.from, b.to);
  });
  return wedges;
}

/// Numbers the clusters by first triangle.
Clusters number_clusters(const BackgroundSurface& surface, ClusterForest& forest) {
  Clusters clusters;
  clusters.of_triangle.resize(surface.triangles.size());
  for (TriangleIndex t = 0; t < static_cast<TriangleIndex>(surface.triangles.size()); ++t) {
    const TriangleIndex root = forest.root(t);
    if (root == t) {
      clusters.of_triangle[t] = static_cast<ClusterIndex>(clusters.loads.size());
      clusters.loads.push_back(forest.load(t));
    } else {
      clusters.of_triangle[t] = clusters.of_triangle[root];
    }
  }
  for (geometry::HalfEdge h = 0; h < static_cast<geometry::HalfEdge>(surface.twins.size()); ++h) {
    const geometry::HalfEdge twin = surface.twins[h];
    if (twin > h && clusters.of_triangle[h / 3] == clusters.of_triangle[twin / 3]) ++clusters.forbidden_edges;
  }
  return clusters;
}

}  // namespace

Clusters simplify_dual_graph(const BackgroundSurface& surface, const VertexFans& fans,
                             const SimplifyOptions& options) {
  ClusterForest forest(surface.loads);
  std::int32_t unresolved = 0;
  for (const FanWedge& wedge : sharp_wedges(fans, options.smallest_angle)) {
    // The clusters on both sides of each of its edges; a feature curve cannot be contracted.
    struct Arc {
      bool feature = true;
      TriangleIndex left = -1, right = -1;  // roots of the clusters beside it
      double load = 0;
      geometry::HalfEdge half_edge = -1;
    };
    const auto arc_of = [&](std::int32_t edge) {
      Arc arc;
      arc.half_edge = fans.edge(wedge.fan, edge);
      const geometry::HalfEdge twin = surface.twins[arc.half_edge];
      if (twin < 0) return arc;
      arc.feature = false;
      arc.left = forest.root(arc.half_edge / 3);
      arc.right = forest.root(twin / 3);
      arc.load = forest.load(arc.left) + forest.load(arc.right);
      return arc;
    };
    Arc first = arc_of(wedge.from), second = arc_of(wedge.to);
    const auto is_contracted = [](const Arc& arc) { return !arc.feature && arc.left == arc.right; };
    if (is_contracted(first) || is_contracted(second) || (first.feature && second.feature)) continue;
    const bool take_second = first.feature || (!second.feature && std::tie(second.load, second.half_edge) <
                                                                      std::tie(first.load, first.half_edge));
    const Arc& chosen = take_second ? second : first;
    if (options.largest_load > 0 && chosen.load > options.largest_load) {
      ++unresolved;
      continue;
    }
    forest.unite(chosen.left, chosen.right);
  }
  Clusters clusters = number_clusters(surface, forest);
  clusters.unresolved = unresolved;
  return clusters;
}

}  // namespace aeroloom::partition
