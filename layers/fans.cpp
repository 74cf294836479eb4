#include "layers/fans.hpp"

#include "layers/sectors.hpp"

#include <algorithm>
#include <cmath>

namespace aeroloom::layers {
namespace {

class FanFinder {
public:
  FanFinder(const LocalWall& wall, const VertexStars& stars, const RidgeEdges& ridges, const Sectors& sectors)
      : _wall(wall), _stars(stars), _ridges(ridges), _sectors(sectors), _names(wall.vertex_names()) {}

  Fans find() {
    place_columns();
    for (const RidgeEdge& edge : _ridges.edges) {
      if (edge.is_owned) add_faces(edge);
    }
    for (const auto& [v, fan] : _sectors.fans) add_triangles(v, fan);
    std::stable_sort(_fans.faces.begin(), _fans.faces.end(),
                     [](const FanFace& a, const FanFace& b) { return a.triangle < b.triangle; });
    for (std::int32_t v = 0; v < _wall.vertex_count(); ++v) add_rim(v);
    _fans.is_end = _sectors.is_end;
    list_around();
    return std::move(_fans);
  }

private:
  void place_columns() {
    _fans = without_fans(_wall);
    _fans.first.assign(1, 0);
    _fans.directions.clear();
    for (std::int32_t v = 0; v < _wall.vertex_count(); ++v) {
      if (const VertexFan* fan = _sectors.fan_at(v)) {
        _fans.directions.insert(_fans.directions.end(), fan->directions.begin(), fan->directions.end());
        const double cone = fan->visibility;
        _fans.visibility[v] = cone;
        _fans.leans[v] = 0.5 * (cone + 1);
      } else {
        _fans.directions.emplace_back();
      }
      _fans.first.push_back(static_cast<std::int32_t>(_fans.directions.size()));
      _fans.vertices.resize(_fans.directions.size(), v);
    }
    for (std::int32_t t = 0; t < _wall.triangle_count(); ++t) {
      for (int i = 0; i < 3; ++i) {
        const std::int32_t v = _wall.triangles[t][i];
        const VertexFan* fan = _sectors.fan_at(v);
        const RidgeSide side = _stars.sides[3 * static_cast<std::size_t>(t) + static_cast<std::size_t>(i)];
        const bool is_first = fan == nullptr || side == side_of_plane;
        _fans.columns[t][i] = _fans.first[v] + (is_first ? 0 : fan->of_side[side]);
      }
    }
  }

  /// The columns at an end of an edge, from the left to the right seen from the first end.
  std::vector<std::int32_t> columns_across(const RidgeEdge& edge, int end) const {
    const std::int32_t v = edge.ends[end], slot = edge.slots[end];
    const VertexFan* fan = _sectors.fan_at(v);
    if (slot < 0 || fan == nullptr) return {_fans.columns[edge.triangle][_wall.corner_of(edge.triangle, v)]};
    std::vector<std::int32_t> columns = fan->across[slot];
    if (end == 1) std::reverse(columns.begin(), columns.end());  // seen from there the sides are exchanged
    for (std::int32_t& c : columns) c += _fans.first[v];
    return columns;
  }

  void add_faces(const RidgeEdge& edge) {
    const std::vector<std::int32_t> from = columns_across(edge, 0), to = columns_across(edge, 1);
    const auto column = [](const std::vector<std::int32_t>& columns, std::size_t i) {
      return columns[std::min(i, columns.size() - 1)];  // one where the fan ends
    };
    for (std::size_t i = 0; i + 1 < std::max(from.size(), to.size()); ++i)
      add_sector(edge, {column(from, i), column(from, i + 1), column(to, i + 1), column(to, i)});
  }

  void add_sector(const RidgeEdge& edge, const std::array<std::int32_t, 4>& columns) {
    FanFace face{columns, edge.triangle};
    for (int end = 0; end < 2; ++end) {
      const Ridge* ridge = _stars.ridge_at(edge.ends[end]);
      if (ridge == nullptr || !ridge->on_plane) continue;
      face.end_faces[end] = ridge->plane_face, face.end_patches[end] = ridge->plane_patch;
    }
    _fans.faces.push_back(face);
  }

  /// The lowest triangle around a vertex has the triangles between its columns.
  void add_triangles(std::int32_t v, const VertexFan& fan) {
    const Ridge& ridge = *_stars.ridge_at(v);
    for (const std::int32_t t : _wall.triangles_around(v)) {
      if (_wall.place_of(t) != ridge.lowest) continue;
      const std::int32_t first = _fans.first[v];
      for (const auto& [a, b, c] : fan.triangles)
        _fans.faces.push_back({{first + a, first + b, first + c, -1}, t});
    }
  }

  /// Where a fan ends on a plane whose triangles beside it are here.
  void add_rim(std::int32_t v) {
    const Ridge* ridge = _stars.ridge_at(v);
    if (ridge == nullptr || !ridge->on_plane || _sectors.fan_at(v) == nullptr) return;
    for (const std::int32_t t : _wall.triangles_around(v)) {
      if (_wall.place_of(t) != ridge->last_of_plane) continue;
      const std::int32_t first = _fans.first[v], last = _fans.first[v + 1] - 1;
      for (const std::int32_t w : _wall.triangles[t]) {
        if (_names[w] == ridge->rim) _fans.rims.push_back({{last, first, _fans.first[w]}, t});
      }
      for (std::int32_t c = first + 1; c < last; ++c) _fans.rims.push_back({{first, c + 1, c}, t});
    }
  }

  void list_around() {
    const auto ends_of = [&](const FanFace& face) {
      return std::array{_fans.vertex_of(face.columns[0]), _fans.vertex_of(face.columns[2])};
    };
    _fans.first_around.assign(_wall.points.size() + 2, 0);
    for (const FanFace& face : _fans.faces) {
      const auto ends = ends_of(face);
      for (const std::int32_t v : ends) ++_fans.first_around[v + 2];
    }
    for (std::size_t v = 2; v < _fans.first_around.size(); ++v)
      _fans.first_around[v] += _fans.first_around[v - 1];
    _fans.around.resize(2 * _fans.faces.size());
    for (std::size_t f = 0; f < _fans.faces.size(); ++f) {
      for (const std::int32_t v : ends_of(_fans.faces[f]))
        _fans.around[_fans.first_around[v + 1]++] = static_cast<std::int32_t>(f);
    }
  }

  const LocalWall& _wall;
  const VertexStars& _stars;
  const RidgeEdges& _ridges;
  const Sectors& _sectors;
  std::vector<mesh::VertexName> _names;
  Fans _fans;
};

}  // namespace

Fans without_fans(const LocalWall& wall) {
  Fans fans;
  const std::size_t n = wall.points.size();
  for (std::size_t v = 0; v <= n; ++v) fans.first.push_back(static_cast<std::int32_t>(v));
  fans.directions.assign(n, {}), fans.visibility.assign(n, 0), fans.leans.assign(n, 0);
  fans.columns = wall.triangles;
  fans.is_end.assign(n, 0);
  fans.first_around.assign(n + 1, 0);
  return fans;
}

Fans find_fans(const LocalWall& wall, const VertexStars& stars, const FanNeeds& needs) {
  return FanFinder(wall, stars, needs.ridges, count_sectors(wall, stars, needs)).find();
}

}  // namespace aeroloom::layers
