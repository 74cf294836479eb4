#include "partition/coarse_surface.hpp"

#include <algorithm>
#include <map>
#include <span>
#include <utility>

namespace aeroloom::partition {
namespace {

using geometry::Vec3;

/// A path leaves its chord by this part of the chord's length at most.
constexpr double largest_sag = 0.2;
/// A triangle that looks more than about 70 degrees away from its cell is a fold.
constexpr double least_cosine = 0.35;

/// A border edge of the cells, both directions together.
struct Link {
  std::int32_t a, b;                ///< rim vertices, a < b
  std::vector<std::int32_t> cells;  ///< around it, ascending, repeated where a cell touches itself
};

class CoarseBuilder {
public:
  CoarseBuilder(std::vector<RimEdge> edges, std::vector<FineVertex> vertices, const std::vector<Cell>& cells)
      : _cells(cells) {
    list_vertices(std::move(vertices));
    list_edges(std::move(edges));
    join_edges();
  }

  CoarseSurface run() {
    trace_paths();
    split_parallel_chords();
    number_corners();
    for (std::size_t c = 0; c < _cells.size(); ++c) fill_cell(static_cast<std::int32_t>(c));
    refuse_double_edges();
    return std::move(_result);
  }

private:
  struct Directed {
    std::int32_t from, to, cell;
  };
  using Path = std::vector<std::int32_t>;

  Vec3 point(std::int32_t rim_vertex) const { return _result.rim[rim_vertex].point; }

  void list_vertices(std::vector<FineVertex> vertices) {
    std::sort(vertices.begin(), vertices.end(),
              [](const FineVertex& a, const FineVertex& b) { return a.number < b.number; });
    vertices.erase(std::unique(vertices.begin(), vertices.end(),
                               [](const FineVertex& a, const FineVertex& b) { return a.number == b.number; }),
                   vertices.end());
    _result.rim = std::move(vertices);
  }

  std::int32_t rim_index(mesh::GlobalIndex number) const {
    const auto at = std::lower_bound(_result.rim.begin(), _result.rim.end(), number,
                                     [](const FineVertex& v, mesh::GlobalIndex n) { return v.number < n; });
    return static_cast<std::int32_t>(at - _result.rim.begin());
  }

  void list_edges(std::vector<RimEdge> edges) {
    _directed.reserve(edges.size());
    for (const RimEdge& e : edges) _directed.push_back({rim_index(e.from), rim_index(e.to), e.cell});
    std::sort(_directed.begin(), _directed.end(), [](const Directed& a, const Directed& b) {
      return a.cell != b.cell ? a.cell < b.cell : a.from != b.from ? a.from < b.from : a.to < b.to;
    });
  }

  void join_edges() {
    std::vector<Directed> sorted = _directed;
    for (Directed& e : sorted) {
      if (e.from > e.to) std::swap(e.from, e.to);
    }
    std::sort(sorted.begin(), sorted.end(), [](const Directed& a, const Directed& b) {
      return a.from != b.from ? a.from < b.from : a.to != b.to ? a.to < b.to : a.cell < b.cell;
    });
    for (std::size_t i = 0, j = 0; i < sorted.size(); i = j) {
      Link link{sorted[i].from, sorted[i].to, {}};
      for (; j < sorted.size() && sorted[j].from == link.a && sorted[j].to == link.b; ++j)
        link.cells.push_back(sorted[j].cell);
      _links.push_back(std::move(link));
    }
    _around.resize(_result.rim.size());
    for (std::size_t l = 0; l < _links.size(); ++l) {
      _around[_links[l].a].push_back(static_cast<std::int32_t>(l));
      _around[_links[l].b].push_back(static_cast<std::int32_t>(l));
    }
  }

  bool is_corner(std::int32_t v) const {
    const auto& links = _around[v];
    return links.size() != 2 || _links[links[0]].cells != _links[links[1]].cells;
  }

  void trace_paths() {
    _used.assign(_links.size(), 0);
    const auto rim = static_cast<std::int32_t>(_result.rim.size());
    for (std::int32_t v = 0; v < rim; ++v) {
      if (!is_corner(v)) continue;
      for (const std::int32_t l : _around[v]) {
        if (!_used[l]) split_by_sag(follow(v, l));
      }
    }
    for (std::int32_t v = 0; v < rim; ++v) {  // what is left are rings without a corner
      for (const std::int32_t l : _around[v]) {
        if (!_used[l]) split_by_sag(follow(v, l));
      }
    }
  }

  Path follow(std::int32_t start, std::int32_t link) {
    Path path{start};
    while (true) {
      _used[link] = 1;
      const std::int32_t v = _links[link].a == path.back() ? _links[link].b : _links[link].a;
      path.push_back(v);
      if (v == start || is_corner(v)) return path;
      const auto& links = _around[v];
      link = links[0] == link ? links[1] : links[0];
    }
  }

  /// Splits where the path is farthest from its chord, until it is near everywhere (Douglas and Peucker,
  /// Cartographica 10, 1973, doi:10.3138/FM57-6770-U75U-7727).
  void split_by_sag(Path path) {
    const std::size_t last = path.size() - 1;
    if (last >= 2) {
      const Vec3 a = point(path.front()), along = point(path.back()) - a;
      const double length = norm(along);
      std::size_t worst = last / 2;
      double farthest = 0;
      for (std::size_t i = 1; i < last; ++i) {
        const Vec3 to = point(path[i]) - a;
        const double s = length > 0 ? std::clamp(dot(to, along) / (length * length), 0.0, 1.0) : 0.0;
        const double away = norm(to - s * along);
        if (away > farthest) farthest = away, worst = i;
      }
      if (farthest > largest_sag * length) {
        split_by_sag(Path(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(worst) + 1));
        split_by_sag(Path(path.begin() + static_cast<std::ptrdiff_t>(worst), path.end()));
        return;
      }
    }
    if (path.front() > path.back()) std::reverse(path.begin(), path.end());
    _paths.push_back(std::move(path));
  }

  /// Two chords between the same corners would be one: all but single edges are split until there are none.
  void split_parallel_chords() {
    const auto ends_less = [](const Path& a, const Path& b) {
      const std::pair x(a.front(), a.back()), y(b.front(), b.back());
      return x != y ? x < y : a < b;
    };
    for (bool again = true; again;) {
      again = false;
      std::sort(_paths.begin(), _paths.end(), ends_less);
      std::vector<Path> kept;
      for (std::size_t i = 0, j = 0; i < _paths.size(); i = j) {
        while (j < _paths.size() && _paths[j].front() == _paths[i].front() &&
               _paths[j].back() == _paths[i].back())
          ++j;
        for (std::size_t k = i; k < j; ++k) {
          if (j - i == 1 || _paths[k].size() == 2) {
            kept.push_back(std::move(_paths[k]));
            continue;
          }
          const auto middle = _paths[k].begin() + static_cast<std::ptrdiff_t>(_paths[k].size() / 2);
          for (Path half : {Path(_paths[k].begin(), middle + 1), Path(middle, _paths[k].end())}) {
            if (half.front() > half.back()) std::reverse(half.begin(), half.end());
            kept.push_back(std::move(half));
          }
          again = true;
        }
      }
      _paths = std::move(kept);
    }
  }

  void number_corners() {
    _corner.assign(_result.rim.size(), -1);
    for (const Path& path : _paths) _corner[path.front()] = _corner[path.back()] = 0;
    for (std::size_t v = 0; v < _corner.size(); ++v) {
      if (_corner[v] < 0) continue;
      _corner[v] = static_cast<std::int32_t>(_result.vertices.size());
      _result.vertices.push_back(_result.rim[v]);
      _result.is_apex.push_back(0);
    }
    for (Path& path : _paths) {
      const std::int32_t from = _corner[path.front()], to = _corner[path.back()];
      _result.chords.push_back({from, to, std::move(path)});
    }
    _paths.clear();
  }

  void fill_cell(std::int32_t cell) {
    const std::vector<std::int32_t> polygon = polygon_of(cell);
    if (polygon.size() < 3) {
      _result.unfit.push_back(cell);
      return;
    }
    const std::size_t before = _result.triangles.size();
    if (_cells[cell].apex >= 0) {
      const auto apex = static_cast<std::int32_t>(_result.vertices.size());
      _result.vertices.push_back({_cells[cell].apex, _cells[cell].apex_point, 2, _cells[cell].face});
      _result.is_apex.push_back(1);
      for (std::size_t i = 0; i < polygon.size(); ++i)
        add_triangle(cell, {polygon[i], polygon[(i + 1) % polygon.size()], apex});
    } else {
      fill_polygon(cell, polygon);
    }
    for (std::size_t t = before; t < _result.triangles.size(); ++t) {
      const auto& v = _result.triangles[t];
      const auto& x = _result.vertices;
      const Vec3 area = 0.5 * cross(x[v[1]].point - x[v[0]].point, x[v[2]].point - x[v[0]].point);
      if (dot(area, _cells[cell].area) >= least_cosine * norm(area) * norm(_cells[cell].area)) continue;
      _result.unfit.push_back(cell);
      return;
    }
  }

  void add_triangle(std::int32_t cell, std::array<std::int32_t, 3> triangle) {
    _result.triangles.push_back(triangle);
    _result.cell_of.push_back(cell);
  }

  /// The corners around a cell; empty when its rim is no single ring.
  std::vector<std::int32_t> polygon_of(std::int32_t cell) const {
    const auto less = [](const Directed& e, std::int32_t c) { return e.cell < c; };
    const auto first = std::lower_bound(_directed.begin(), _directed.end(), cell, less);
    const auto last = std::lower_bound(first, _directed.end(), cell + 1, less);
    if (first == last) return {};
    const std::span<const Directed> rim(&*first, static_cast<std::size_t>(last - first));
    std::vector<std::int32_t> polygon;
    std::int32_t v = rim.front().from;
    for (std::size_t i = 0; i < rim.size(); ++i) {
      const auto at = std::lower_bound(rim.begin(), rim.end(), v,
                                       [](const Directed& e, std::int32_t from) { return e.from < from; });
      if (at == rim.end() || at->from != v) return {};
      if (_corner[v] >= 0) polygon.push_back(_corner[v]);
      v = at->to;
      if (v == rim.front().from && i + 1 < rim.size()) return {};
    }
    return v == rim.front().from ? polygon : std::vector<std::int32_t>{};
  }

  /// The triangulation of a polygon in space with the shortest inner edges (Klincsek, Ann. Discrete Math. 9,
  /// 1980, doi:10.1016/S0167-5060(08)70044-X, with another weight).
  void fill_polygon(std::int32_t cell, const std::vector<std::int32_t>& polygon) {
    const std::size_t n = polygon.size();
    const auto at = [&](std::size_t i) { return _result.vertices[polygon[i]].point; };
    std::vector<double> cost(n * n, 0);
    std::vector<std::size_t> choice(n * n, 0);
    for (std::size_t span = 2; span < n; ++span) {
      for (std::size_t i = 0; i + span < n; ++i) {
        const std::size_t j = i + span;
        double best = 1e300;
        for (std::size_t k = i + 1; k < j; ++k) {
          const Vec3 area = 0.5 * cross(at(k) - at(i), at(j) - at(i));
          const double fold = dot(area, _cells[cell].area) > 0 ? 0 : 1e3 * distance(at(i), at(j));
          const double c = cost[i * n + k] + cost[k * n + j] + fold;
          if (c < best) best = c, choice[i * n + j] = k;
        }
        cost[i * n + j] = best + distance(at(i), at(j));
      }
    }
    std::vector<std::pair<std::size_t, std::size_t>> stack{{0, n - 1}};
    const auto note_diagonal = [&](std::size_t i, std::size_t j) {
      if (j - i > 1)
        _diagonals.push_back({std::min(polygon[i], polygon[j]), std::max(polygon[i], polygon[j]), cell});
    };
    while (!stack.empty()) {
      const auto [i, j] = stack.back();
      stack.pop_back();
      if (j - i < 2) continue;
      const std::size_t k = choice[i * n + j];
      add_triangle(cell, {polygon[i], polygon[k], polygon[j]});
      note_diagonal(i, k);
      note_diagonal(k, j);
      stack.push_back({i, k});
      stack.push_back({k, j});
    }
  }

  /// Cells with a diagonal where there is a chord or another diagonal.
  void refuse_double_edges() {
    std::vector<std::array<std::int32_t, 3>> edges = _diagonals;
    for (const Chord& chord : _result.chords)
      edges.push_back({std::min(chord.from, chord.to), std::max(chord.from, chord.to), -1});
    std::sort(edges.begin(), edges.end());
    for (std::size_t i = 1; i < edges.size(); ++i) {
      if (edges[i][0] != edges[i - 1][0] || edges[i][1] != edges[i - 1][1]) continue;
      for (const std::int32_t cell : {edges[i - 1][2], edges[i][2]}) {
        if (cell >= 0) _result.unfit.push_back(cell);
      }
    }
  }

  const std::vector<Cell>& _cells;
  CoarseSurface _result;
  std::vector<std::array<std::int32_t, 3>> _diagonals;  // ends ascending, cell
  std::vector<Directed> _directed;                      // by cell, then start
  std::vector<Link> _links;
  std::vector<std::vector<std::int32_t>> _around;  // links at each rim vertex
  std::vector<char> _used;
  std::vector<Path> _paths;
  std::vector<std::int32_t> _corner;  // coarse vertex of a rim vertex, or -1
};

}  // namespace

CoarseSurface build_coarse_surface(std::vector<RimEdge> edges, std::vector<FineVertex> vertices,
                                   const std::vector<Cell>& cells) {
  return CoarseBuilder(std::move(edges), std::move(vertices), cells).run();
}

}  // namespace aeroloom::partition
