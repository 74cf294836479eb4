#include "geometry/predicates.hpp"
#include "surface/charts/delaunay_flips.hpp"
#include "surface/charts/open_facets.hpp"
#include "surface/front/boundary_triangulation.hpp"

#include <algorithm>
#include <cmath>

namespace aeroloom::surface {
namespace {

using cad::SurfaceFrame;
using geometry::Vec3;

/// Edges between points whose normals differ by more (20 degrees) are divided, and so is the longest edge of
/// a triangle that leans away from the normals of its corners (30 degrees), in so many rounds. Chosen, not
/// measured.
constexpr double turning_cosine = 0.94, leaning_cosine = 0.87;
constexpr int fitting_rounds = 4;
/// Unless the edge is shorter than this fraction of the elements: where sizes do not resolve the curvature,
/// facets as short in every direction would be many times as many.
constexpr double finest_over_size = 0.125;

SurfaceMetric metric_of(const SurfaceFrame& frame) {
  return {dot(frame.du, frame.du), dot(frame.du, frame.dv), dot(frame.dv, frame.dv)};
}

}  // namespace

int OpenFacets::parameter_orientation() const {
  double area = 0;
  for (const Line& line : _lines) {
    const double sign = line.use.reversed ? -1 : 1;
    for (std::size_t i = 1; i < line.nodes.size(); ++i)
      area += sign * cross(_uv[line.nodes[i - 1].point] - _uv[0], _uv[line.nodes[i].point] - _uv[0]);
  }
  return area >= 0 ? 1 : -1;
}

void OpenFacets::fit_to_surface(const sizing::SizeField& field) {
  if (_in_sheets) return;
  std::vector<SurfaceFrame> frames;
  const auto frame_new_points = [&] {
    for (std::size_t i = frames.size(); i < _uv.size(); ++i)
      frames.push_back(_model.face_frame(_surface.face, _uv[i]));
  };
  frame_new_points();
  flip(frames);
  if (is_folded()) {
    std::vector<std::int32_t> crossings;
    triangulate_again(frames, crossings);
    flip(frames);
  }
  for (int round = 0; round < fitting_rounds && divide_turning_edges(frames, field); ++round) {
    frame_new_points();
    flip(frames);
  }
}

void OpenFacets::flip(const std::vector<SurfaceFrame>& frames) {
  std::vector<SurfaceMetric> metrics;
  metrics.reserve(frames.size());
  for (const SurfaceFrame& frame : frames) metrics.push_back(metric_of(frame));
  flip_in_parameters(_surface, metrics, join_points(), parameter_orientation());
}

bool OpenFacets::is_folded() const {
  const int orientation = parameter_orientation();
  return std::any_of(_surface.corner_uv.begin(), _surface.corner_uv.end(),
                     [&](const auto& uv) { return geometry::orient2d(uv[0], uv[1], uv[2]) == -orientation; });
}

bool OpenFacets::triangulate_again(const std::vector<SurfaceFrame>& frames,
                                   std::vector<std::int32_t>& crossings) {
  // Distances in this plane are about those on the surface, so that the triangulation starts well.
  SurfaceMetric mean;
  for (const SurfaceFrame& frame : frames) {
    const SurfaceMetric metric = metric_of(frame);
    mean.uu += metric.uu, mean.vv += metric.vv;
  }
  if (!(mean.uu > 0 && mean.vv > 0)) return false;
  const double height = std::sqrt(mean.vv / mean.uu) * parameter_orientation();
  front::FrontInput region;
  std::vector<std::int32_t> number(_uv.size(), -1), point_of;
  const auto add = [&](std::int32_t point) {
    if (number[point] < 0) {
      number[point] = static_cast<std::int32_t>(point_of.size());
      point_of.push_back(point);
      region.points.push_back({_uv[point].x, height * _uv[point].y});
    }
    return number[point];
  };
  for (const Line& line : _lines) {
    for (std::size_t i = 1; i < line.nodes.size(); ++i) {
      std::array<std::int32_t, 2> edge{add(line.nodes[i - 1].point), add(line.nodes[i].point)};
      if (line.use.reversed) std::swap(edge[0], edge[1]);
      region.edges.push_back(edge);
    }
  }
  for (const auto& triangle : _surface.triangles) {
    for (const std::int32_t point : triangle) add(point);
  }
  try {
    const front::Delaunay plane = front::triangulate_region(region);
    _surface.triangles.clear();
    _surface.corner_uv.clear();
    for (const geometry::LinkedTriangle& triangle : plane.mesh.triangles) {
      if (front::state_of(triangle) == front::TriangleState::outside) continue;
      const auto& [a, b, c] = triangle.vertices;
      _surface.triangles.push_back({point_of[a], point_of[b], point_of[c]});
      _surface.corner_uv.push_back({_uv[point_of[a]], _uv[point_of[b]], _uv[point_of[c]]});
    }
  } catch (const front::FrontError& e) {
    // The loops touch in the parameter plane: the facets stay as they are, and the charts judge them.
    for (const front::CrossingEdges& crossing : e.crossings()) {
      for (const std::int32_t edge : {crossing.first, crossing.second}) {
        for (const std::int32_t point : region.edges[edge]) crossings.push_back(point_of[point]);
      }
    }
    return false;
  }
  return true;
}

std::vector<char> OpenFacets::find_turning_edges(const std::vector<geometry::HalfEdge>& twins,
                                                 const std::vector<SurfaceFrame>& frames) const {
  std::vector<char> marked(twins.size(), 0);
  const auto mark = [&](geometry::HalfEdge h) {
    if (twins[h] >= 0) marked[std::min(h, twins[h])] = 1;
  };
  for (geometry::HalfEdge h = 0; h < static_cast<geometry::HalfEdge>(twins.size()); ++h) {
    const Vec3 first = frames[start_of(_surface, h)].normal, second = frames[end_of(_surface, h)].normal;
    // Normals are zero at singular points.
    if (norm(first) > 0 && norm(second) > 0 && dot(first, second) < turning_cosine) mark(h);
  }
  for (std::size_t t = 0; t < _surface.triangles.size(); ++t) {
    const auto& [a, b, c] = _surface.triangles[t];
    const Vec3 expected = frames[a].normal + frames[b].normal + frames[c].normal;
    const Vec3 found = area_vector(_surface, static_cast<std::int32_t>(t));
    if (dot(expected, found) >= leaning_cosine * norm(expected) * norm(found)) continue;
    geometry::HalfEdge longest = static_cast<geometry::HalfEdge>(3 * t);
    const auto length = [&](geometry::HalfEdge h) {
      return distance(_surface.points[start_of(_surface, h)], _surface.points[end_of(_surface, h)]);
    };
    for (const geometry::HalfEdge h : {longest + 1, longest + 2}) {
      if (length(h) > length(longest)) longest = h;
    }
    mark(longest);
  }
  return marked;
}

bool OpenFacets::divide_turning_edges(const std::vector<SurfaceFrame>& frames,
                                      const sizing::SizeField& field) {
  const std::vector<geometry::HalfEdge> twins = geometry::match_half_edges(_surface.triangles);
  const std::vector<char> marked = find_turning_edges(twins, frames);
  std::vector<EdgePoint> divisions;
  for (geometry::HalfEdge h = 0; h < static_cast<geometry::HalfEdge>(twins.size()); ++h) {
    if (!marked[h]) continue;
    const Vec3 from = _surface.points[start_of(_surface, h)], to = _surface.points[end_of(_surface, h)];
    if (distance(from, to) < finest_over_size * field(0.5 * (from + to))) continue;
    const auto index = static_cast<std::int32_t>(_surface.points.size());
    const geometry::Vec2 uv = 0.5 * (start_uv(_surface, h) + end_uv(_surface, h));
    divisions.push_back({h, 0.5, index, uv});
    divisions.push_back({twins[h], 0.5, index, uv});
    _surface.points.push_back(_model.face_point(_surface.face, uv));
    _uv.push_back(uv);
  }
  const bool any = !divisions.empty();
  divide(std::move(divisions));
  return any;
}

}  // namespace aeroloom::surface
