#include "surface/charts/open_facets.hpp"

#include "cad/model/facets/corner_parameters.hpp"
#include "geometry/disjoint_sets.hpp"
#include "geometry/place_text.hpp"
#include "surface/surface_error.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

namespace aeroloom::surface {
namespace {

/// A facet node moves to a curve vertex within this fraction of the distance to the next node or vertex.
/// Farther away it is a point of its own. Chosen, not measured.
constexpr double reuse_fraction = 1e-4;
/// Two coedges along a seam have a node in common where their parameters agree to this fraction of the
/// distance to the next. Chosen, not measured.
constexpr double same_parameter_fraction = 1e-7;
/// Points closer than this fraction of the face's extent are one, unless both are mesh vertices. Rounding
/// leaves them less than that apart.
constexpr double no_distance = 1e-10;

using Joining = geometry::DisjointSets<std::int32_t>;

/// Two triangles with the same corners in opposite order enclose nothing: they are left where a narrow part
/// collapsed.
void drop_opposite_pairs(ChartSurface& surface) {
  struct SortedTriangle {
    std::array<std::int32_t, 3> sorted;
    bool odd;  // order of the corners
    std::size_t triangle;
    auto operator<=>(const SortedTriangle&) const = default;
  };
  std::vector<SortedTriangle> rows;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    auto [a, b, c] = surface.triangles[t];
    bool odd = false;
    if (a > b) std::swap(a, b), odd = !odd;
    if (b > c) std::swap(b, c), odd = !odd;
    if (a > b) std::swap(a, b), odd = !odd;
    rows.push_back({{a, b, c}, odd, t});
  }
  std::sort(rows.begin(), rows.end());
  std::vector<char> drop(surface.triangles.size(), 0);
  for (std::size_t i = 1; i < rows.size(); ++i) {
    if (rows[i].sorted != rows[i - 1].sorted || rows[i].odd == rows[i - 1].odd || drop[rows[i - 1].triangle])
      continue;
    drop[rows[i].triangle] = drop[rows[i - 1].triangle] = 1;
  }
  std::size_t kept = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    if (drop[t]) continue;
    surface.triangles[kept] = surface.triangles[t];
    surface.corner_uv[kept++] = surface.corner_uv[t];
  }
  surface.triangles.resize(kept);
  surface.corner_uv.resize(kept);
}

[[noreturn]] void fail(const cad::Model& model, cad::FaceId face, const cad::Coedge& use, geometry::Vec3 at) {
  throw SurfaceError(fmt::format(
      "face {} (patch {}): its triangulation does not follow edge {} near {}; repair this face in the CAD "
      "program",
      model.face(face).name, model.patches()[model.face(face).patch], use.edge, geometry::place_text(at)));
}

}  // namespace

/// Finds half-edges by their ends.
class OpenFacets::SideTable {
public:
  explicit SideTable(const ChartSurface& surface) : _twins(geometry::match_half_edges(surface.triangles)) {
    for (geometry::HalfEdge h = 0; h < static_cast<geometry::HalfEdge>(_twins.size()); ++h)
      _rows.push_back({{start_of(surface, h), end_of(surface, h)}, h});
    std::sort(_rows.begin(), _rows.end());
  }
  geometry::HalfEdge find(std::int32_t from, std::int32_t to) const {
    const SideRow key{{from, to}, -1};
    const auto row = std::lower_bound(_rows.begin(), _rows.end(), key);
    return row != _rows.end() && row->first == key.first ? row->second : -1;
  }
  geometry::HalfEdge twin(geometry::HalfEdge h) const { return _twins[h]; }

private:
  using SideRow = std::pair<std::array<std::int32_t, 2>, geometry::HalfEdge>;
  std::vector<geometry::HalfEdge> _twins;
  std::vector<SideRow> _rows;
};

OpenFacets::OpenFacets(const cad::Model& model, cad::FaceId face, const cad::Facets& facets)
    : _model(model), _uv(facets.uv), _in_sheets(model.is_faceted(face)) {
  _surface.face = face;
  _surface.points = facets.points;
  _surface.triangles = facets.triangles;
  if (_in_sheets) {
    _surface.corner_uv = cad::corner_parameters(model, face);
  } else {
    for (const auto& [a, b, c] : facets.triangles) _surface.corner_uv.push_back({_uv[a], _uv[b], _uv[c]});
  }
  for (const auto& boundary : facets.boundary) {
    Line line{boundary.use, is_constraining(model, boundary.use.edge), {}};
    for (std::size_t i = 0; i < boundary.nodes.size(); ++i)
      line.nodes.push_back({boundary.parameters[i], boundary.nodes[i], -1});
    if (line.constraining && !line.nodes.empty()) {
      line.nodes.front().vertex = model.edge(line.use.edge).first;
      line.nodes.back().vertex = model.edge(line.use.edge).last;
    }
    _lines.push_back(std::move(line));
  }
  if (!_in_sheets) match_line_ends();
}

void OpenFacets::match_line_ends() {
  struct End {
    cad::VertexId vertex;
    std::int32_t point;
  };
  std::vector<End> ends;
  for (const Line& line : _lines) {
    if (line.nodes.empty()) continue;
    ends.push_back({_model.edge(line.use.edge).first, line.nodes.front().point});
    ends.push_back({_model.edge(line.use.edge).last, line.nodes.back().point});
  }
  const auto match_end = [&](const Line& line, cad::VertexId vertex, Node& node) {
    const geometry::Vec2 expected = _model.edge_uv(_surface.face, line.use, node.parameter);
    for (const End& end : ends) {
      if (end.vertex != vertex) continue;
      if (distance(_uv[end.point], expected) < distance(_uv[node.point], expected)) node.point = end.point;
    }
  };
  for (Line& line : _lines) {
    if (line.nodes.empty()) continue;
    match_end(line, _model.edge(line.use.edge).first, line.nodes.front());
    match_end(line, _model.edge(line.use.edge).last, line.nodes.back());
  }
}

void OpenFacets::insert_curve_vertices(const CurveMesh& curves) {
  const SideTable table(_surface);
  std::vector<EdgePoint> divisions;
  for (Line& line : _lines) {
    if (!line.constraining) continue;
    const auto chain = curves.chain(_model, line.use.edge);
    const auto parameters = curves.chain_parameters(_model, line.use.edge);
    std::vector<Wanted> wanted;
    for (std::size_t i = 1; i + 1 < chain.size(); ++i)
      wanted.push_back({parameters[i], chain[i], curves.points[chain[i]]});
    plan(line, wanted, reuse_fraction, table, divisions);
  }
  divide(std::move(divisions));
}

OpenFacets::Line* OpenFacets::other_coedge(const Line& line) {
  for (Line& other : _lines) {
    if (&other != &line && other.use.edge == line.use.edge) return &other;
  }
  return nullptr;
}

void OpenFacets::match_seams() {
  const SideTable table(_surface);
  std::vector<EdgePoint> divisions;
  for (Line& line : _lines) {
    if (line.constraining || _model.edge(line.use.edge).degenerate) continue;
    const Line* other = other_coedge(line);
    if (other == nullptr) continue;
    std::vector<Wanted> wanted;
    for (std::size_t i = 1; i + 1 < other->nodes.size(); ++i)
      wanted.push_back({other->nodes[i].parameter, -1, _surface.points[other->nodes[i].point]});
    plan(line, wanted, same_parameter_fraction, table, divisions);
  }
  divide(std::move(divisions));
}

void OpenFacets::plan(Line& line, const std::vector<Wanted>& wanted, double reuse_tolerance,
                      const SideTable& table, std::vector<EdgePoint>& divisions) {
  const std::vector<Node> old = line.nodes;
  std::vector<char> claimed(old.size(), 0);
  claimed.front() = claimed.back() = 1;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const auto [t, vertex, point] = wanted[i];
    const auto above =
        std::upper_bound(old.begin() + 1, old.end() - 1, t,
                         [](double value, const Node& node) { return value < node.parameter; });
    const std::size_t k = static_cast<std::size_t>(above - old.begin()) - 1;
    const double part = old[k + 1].parameter - old[k].parameter;
    double spacing = part;
    if (i > 0) spacing = std::min(spacing, t - wanted[i - 1].parameter);
    if (i + 1 < wanted.size()) spacing = std::min(spacing, wanted[i + 1].parameter - t);
    const geometry::Vec2 uv = _model.edge_uv(_surface.face, line.use, t);
    const std::size_t near = t - old[k].parameter < old[k + 1].parameter - t ? k : k + 1;
    if (!claimed[near] && std::abs(t - old[near].parameter) <= reuse_tolerance * spacing) {
      claimed[near] = 1;
      if (vertex < 0) continue;
      line.nodes[near] = {t, old[near].point, vertex};
      _surface.points[old[near].point] = point;
      _uv[old[near].point] = uv;
      continue;
    }
    const auto index = static_cast<std::int32_t>(_surface.points.size());
    const double ahead = std::clamp((t - old[k].parameter) / part, 0.0, 1.0);
    geometry::HalfEdge h = table.find(old[k].point, old[k + 1].point);
    const bool along = h >= 0;
    if (!along) h = table.find(old[k + 1].point, old[k].point);
    if (h < 0) fail(_model, _surface.face, line.use, point);
    const double fraction = along ? ahead : 1 - ahead;
    divisions.push_back({h, fraction, index, uv});
    if (table.twin(h) >= 0) divisions.push_back({table.twin(h), 1 - fraction, index, uv});
    line.nodes.push_back({t, index, vertex});
    _surface.points.push_back(point);
    _uv.push_back(uv);
  }
  std::stable_sort(line.nodes.begin(), line.nodes.end(),
                   [](const Node& a, const Node& b) { return a.parameter < b.parameter; });
}

void OpenFacets::divide(std::vector<EdgePoint> divisions) {
  divide_edges(_surface, std::move(divisions));
  if (_in_sheets) return;
  for (std::size_t t = 0; t < _surface.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) _surface.corner_uv[t][i] = _uv[_surface.triangles[t][i]];
  }
}

std::vector<std::int32_t> OpenFacets::join_points() const {
  Joining joining(_surface.points.size());
  std::map<cad::VertexId, std::int32_t> at_vertex;
  const auto join_vertex = [&](cad::VertexId vertex, std::int32_t point) {
    joining.unite(at_vertex.emplace(vertex, point).first->second, point);
  };
  for (std::size_t l = 0; l < _lines.size(); ++l) {
    const Line& line = _lines[l];
    if (line.nodes.empty()) continue;
    const cad::Edge& edge = _model.edge(line.use.edge);
    join_vertex(edge.first, line.nodes.front().point);
    join_vertex(edge.last, line.nodes.back().point);
    for (std::size_t i = 0; edge.degenerate && i < line.nodes.size(); ++i)
      join_vertex(edge.first, line.nodes[i].point);
    if (edge.degenerate || line.constraining) continue;
    for (std::size_t m = 0; m < l; ++m) {
      if (_lines[m].use.edge != line.use.edge || _lines[m].nodes.size() != line.nodes.size()) continue;
      for (std::size_t i = 0; i < line.nodes.size(); ++i)
        joining.unite(_lines[m].nodes[i].point, line.nodes[i].point);
    }
  }
  std::vector<char> is_mesh_vertex(_surface.points.size(), 0);
  for (const Line& line : _lines) {
    for (const Node& node : line.nodes) is_mesh_vertex[joining.root(node.point)] |= node.vertex >= 0;
  }
  geometry::Box box;
  for (const geometry::Vec3 p : _surface.points) box.add(p);
  for (const auto& triangle : _surface.triangles) {
    for (int i = 0; i < 3; ++i) {
      const std::int32_t a = joining.root(triangle[i]), b = joining.root(triangle[(i + 1) % 3]);
      if (a == b || distance(_surface.points[a], _surface.points[b]) > no_distance * box.diagonal()) continue;
      if (is_mesh_vertex[a] && is_mesh_vertex[b]) continue;
      joining.unite(a, b);
      is_mesh_vertex[std::min(a, b)] |= is_mesh_vertex[std::max(a, b)];
    }
  }
  std::vector<std::int32_t> roots(_surface.points.size());
  for (std::size_t i = 0; i < roots.size(); ++i) roots[i] = joining.root(static_cast<std::int32_t>(i));
  return roots;
}

void OpenFacets::collect_vertices(const CurveMesh& curves, FaceVertices& vertices) const {
  std::vector<std::pair<CurveVertex, std::int32_t>> found;
  for (const Line& line : _lines) {
    for (const Node& node : line.nodes) {
      if (node.vertex >= 0) found.push_back({node.vertex, node.point});
    }
  }
  std::sort(found.begin(), found.end());
  vertices = {};
  for (const auto& [vertex, point] : found) {
    const mesh::SharedVertexKey vertex_key = key_of(curves, vertex);
    if (!vertices.vertex_keys.empty() && vertices.vertex_keys.back() == vertex_key) continue;
    vertices.vertex_keys.push_back(vertex_key);
    vertices.points.push_back(point_of(curves, vertex));
    vertices.uv.push_back(_uv[point]);
  }
}

ChartSurface OpenFacets::close(const CurveMesh& curves, FaceVertices& vertices) {
  const std::vector<std::int32_t> roots = join_points();
  collect_vertices(curves, vertices);
  ChartSurface joined;
  joined.face = _surface.face;
  joined.points = _surface.points;
  joined.mesh_vertex.assign(joined.points.size(), -1);
  for (const Line& line : _lines) {
    for (const Node& node : line.nodes) {
      if (node.vertex < 0) continue;
      const std::int32_t index = vertices.find(key_of(curves, node.vertex));
      joined.mesh_vertex[roots[node.point]] = index;
      joined.points[roots[node.point]] = vertices.points[index];
    }
  }
  for (std::size_t t = 0; t < _surface.triangles.size(); ++t) {
    const auto& [a, b, c] = _surface.triangles[t];
    const std::array<std::int32_t, 3> triangle{roots[a], roots[b], roots[c]};
    if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) continue;
    joined.triangles.push_back(triangle);
    joined.corner_uv.push_back(_surface.corner_uv[t]);
  }
  drop_opposite_pairs(joined);
  const std::vector<std::int32_t> all_one(joined.triangles.size(), 0);
  return separate_parts(joined, geometry::match_half_edges(joined.triangles), all_one, 1).front();
}

}  // namespace aeroloom::surface
