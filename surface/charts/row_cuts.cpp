#include "surface/charts/open_facets.hpp"

#include <utility>

namespace aeroloom::surface {

using geometry::Vec3;

mesh::SharedVertexKey OpenFacets::key_of(const CurveMesh& curves, CurveVertex vertex) const {
  return is_top(vertex) ? _top_keys[vertex - _first_top] : curves.vertex_key(_model, vertex);
}

Vec3 OpenFacets::point_of(const CurveMesh& curves, CurveVertex vertex) const {
  return is_top(vertex) ? _tops[vertex - _first_top] : curves.points[vertex];
}

void OpenFacets::lower_to_tops(Line& line, const RowStrip& strip, const CurveMesh& curves,
                               std::map<std::int32_t, RowFailure>& columns) {
  std::vector<Node> kept;
  // The vertices of the edge are nodes in their order, as insert_curve_vertices() leaves them.
  const auto has_rows = [&](std::size_t column) {
    return column < strip.tops.size() && strip.tops[column] >= 0;
  };
  std::size_t passed = 0;
  for (const Node& node : line.nodes) {
    if (node.vertex < 0) {
      // Between two columns of which one has rows the boundary is straight.
      if (!has_rows(passed - 1) && !has_rows(passed)) kept.push_back(node);
      continue;
    }
    const std::size_t column = passed++;
    if (!has_rows(column)) {
      kept.push_back(node);
      continue;
    }
    const RowVertex& top = strip.top(column);
    const auto point = static_cast<std::int32_t>(_surface.points.size());
    _surface.points.push_back(top.point);
    _uv.push_back(top.uv);
    kept.push_back({node.parameter, point, _first_top + strip.tops[column]});
    columns[point] = {node.vertex, 0.5 * longest_segment(curves, strip, column)};
  }
  line.nodes = std::move(kept);
}

void OpenFacets::cut_off(FaceRows& rows, const CurveMesh& curves) {
  if (rows.empty()) return;
  _first_top = static_cast<CurveVertex>(curves.points.size());
  for (const RowStrip& strip : rows.strips) {
    for (std::size_t i = 0; i < strip.tops.size(); ++i) {
      if (strip.tops[i] < 0) continue;
      _tops.push_back(strip.top(i).point);
      _top_keys.push_back(rows.top_key(strip.tops[i]));
    }
  }
  std::map<std::int32_t, RowFailure> columns;  // by point of a top: what failed if it is in the way
  for (Line& line : _lines) {
    if (const RowStrip* strip = rows.strip_of(line.use)) lower_to_tops(line, *strip, curves, columns);
  }
  std::vector<cad::SurfaceFrame> frames;
  frames.reserve(_uv.size());
  for (const geometry::Vec2 uv : _uv) frames.push_back(_model.face_frame(_surface.face, uv));
  std::vector<std::int32_t> crossings;
  if (triangulate_again(frames, crossings)) return;
  for (const std::int32_t point : crossings) {
    if (const auto found = columns.find(point); found != columns.end())
      rows.failures.push_back(found->second);
  }
  // Whatever else is wrong with the loops: without rows they are those of the CAD.
  if (!rows.failures.empty()) return;
  for (const auto& [point, failure] : columns) rows.failures.push_back(failure);
}

}  // namespace aeroloom::surface
