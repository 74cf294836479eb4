#include "layers/ridge_edges.hpp"

#include <algorithm>
#include <utility>

namespace aeroloom::layers {
namespace {

/// Lists the edges of ridges and their lengths.
class RidgeEdgeLister {
public:
  RidgeEdgeLister(const LocalWall& wall, const VertexStars& stars)
      : _wall(wall), _stars(stars), _names(wall.vertex_names()) {}

  RidgeEdges list(const std::vector<double>& mean_edges) {
    list_edges();
    smooth_lengths(mean_edges);
    return std::move(_found);
  }

private:
  /// The place of the edge from a vertex to another among those of the ridge there; -1: none.
  std::int32_t slot_of(std::int32_t from, std::int32_t to) const {
    const Ridge* ridge = _stars.ridge_at(from);
    if (ridge == nullptr) return -1;
    for (std::size_t e = 0; e < ridge->edges.size(); ++e) {
      if (ridge->edges[e].end == _names[to]) return static_cast<std::int32_t>(e);
    }
    return -1;
  }

  void list_edges() {
    for (std::int32_t t = 0; t < _wall.triangle_count(); ++t) {
      if (_wall.roles[t] != WallRole::layered) continue;
      const TrianglePlace here = _wall.place_of(t);
      for (int i = 0; i < 3; ++i) {
        const std::int32_t a = _wall.triangles[t][i], b = _wall.triangles[t][(i + 1) % 3];
        const std::array slots{slot_of(a, b), slot_of(b, a)};
        if (slots[0] < 0 && slots[1] < 0) continue;
        const Ridge::Edge& edge =
            slots[0] >= 0 ? _stars.ridge_at(a)->edges[slots[0]] : _stars.ridge_at(b)->edges[slots[1]];
        _found.edges.push_back({t, {a, b}, slots, !(std::min(edge.left, edge.right) < here)});
      }
    }
  }

  /// Lengths of a ridge's edges, as smooth along it as mean edges are over the wall: these are longer where
  /// the wall is fine along its edges alone.
  void smooth_lengths(const std::vector<double>& mean_edges) {
    constexpr int sweeps = 8;  // as many as mean edges have; chosen, not measured
    struct Around {
      double sum;
      std::int64_t count;
      double mean() const { return sum / static_cast<double>(count); }
    };
    std::vector<Around> around(_wall.points.size());
    const auto average = [&](const auto& value) {
      std::fill(around.begin(), around.end(), Around{});
      for (const RidgeEdge& edge : _found.edges) {
        if (!edge.is_owned) continue;
        for (int end = 0; end < 2; ++end) {
          Around& here = around[edge.ends[end]];
          here.sum += value(edge, end);
          ++here.count;
        }
      }
      _wall.combine(around, [](Around a, Around b) { return Around{a.sum + b.sum, a.count + b.count}; });
    };
    _found.lengths = mean_edges;
    average([&](const RidgeEdge& edge, int) {
      return distance(_wall.points[edge.ends[0]], _wall.points[edge.ends[1]]);
    });
    for (std::size_t v = 0; v < around.size(); ++v) {
      if (around[v].count > 0) _found.lengths[v] = around[v].mean();
    }
    for (int sweep = 0; sweep < sweeps; ++sweep) {
      average([&](const RidgeEdge& edge, int end) { return _found.lengths[edge.ends[1 - end]]; });
      for (std::size_t v = 0; v < around.size(); ++v) {
        if (around[v].count > 0) _found.lengths[v] = 0.5 * (_found.lengths[v] + around[v].mean());
      }
    }
  }

  const LocalWall& _wall;
  const VertexStars& _stars;
  std::vector<mesh::VertexName> _names;
  RidgeEdges _found;
};

}  // namespace

RidgeEdges list_ridge_edges(const LocalWall& wall, const VertexStars& stars,
                            const std::vector<double>& mean_edges) {
  return RidgeEdgeLister(wall, stars).list(mean_edges);
}

}  // namespace aeroloom::layers
