#include "cad/faceted/faceted_geometry.hpp"

#include "cad/faceted/facet_sheets.hpp"
#include "cad/model/library_unit.hpp"
#include "cad/tolerances.hpp"
#include "geometry/angle.hpp"
#include "geometry/sort_unique.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

constexpr int facets_in_leaf = 8;
/// What single precision, which STL has, leaves of a coordinate.
constexpr double single_precision = 6e-8;

std::vector<Box> boxes_in_space(const FacetComplex& complex, const FacetedFace& face) {
  std::vector<Box> boxes(face.count);
  for (std::int32_t i = 0; i < face.count; ++i) {
    for (const Vec3 p : corners_of(complex, face.first + i)) boxes[i].add(p);
  }
  return boxes;
}

std::vector<Box> boxes_in_plane(std::span<const CornerUv> uv) {
  std::vector<Box> boxes(uv.size());
  for (std::size_t i = 0; i < uv.size(); ++i) {
    for (const Vec2 at : uv[i]) boxes[i].add(Vec3{at.x, at.y, 0});
  }
  return boxes;
}

/// The turn of a polyline at its points over the length of its sides, a spike of one point cut.
std::vector<double> curvatures_along(const FacetComplex& complex, const FacetedEdge& edge) {
  const std::size_t count = edge.points.size();
  const bool closed = edge.points.front() == edge.points.back();
  std::vector<double> turns(count, 0);
  for (std::size_t i = 0; i < count; ++i) {
    if (!closed && (i == 0 || i + 1 == count)) continue;
    const std::size_t before = i == 0 ? count - 2 : i - 1, after = i + 1 == count ? 1 : i + 1;
    const Vec3 a = complex.points[edge.points[i]] - complex.points[edge.points[before]];
    const Vec3 b = complex.points[edge.points[after]] - complex.points[edge.points[i]];
    const double length = norm(a) + norm(b);
    if (length > 0) turns[i] = 2 * angle_between(a, b) / length;
  }
  if (!closed && count > 2) turns.front() = turns[1], turns.back() = turns[count - 2];
  std::vector<double> smooth = turns;
  for (std::size_t i = 1; i + 1 < count; ++i) {
    const double low = std::min({turns[i - 1], turns[i], turns[i + 1]});
    const double high = std::max({turns[i - 1], turns[i], turns[i + 1]});
    smooth[i] = turns[i - 1] + turns[i] + turns[i + 1] - low - high;
  }
  return smooth;
}

}  // namespace

FacetedGeometry::FacetedGeometry(FacetComplex complex, FacetSheets sheets, double planar_tolerance)
    : _complex(std::move(complex)),
      _sheets(std::move(sheets)),
      _planar_tolerance(planar_tolerance),
      _links(link_facets(_complex)),
      _uv(flatten(_complex, _sheets)) {
  collect_faces();
  collect_edges();
  trace_loops();
}

void FacetedGeometry::collect_faces() {
  _faces.resize(_complex.faces.size());
  const auto triangles = static_cast<std::int32_t>(_complex.triangles.size());
  std::vector<std::int32_t> number(_complex.points.size(), -1);
  for (std::int32_t begin = 0, end = 0; begin < triangles; begin = end) {
    FacetedFace& face = _faces[_complex.face_of[begin]];
    while (end < triangles && _complex.face_of[end] == _complex.face_of[begin]) ++end;
    face.first = begin, face.count = end - begin;
    face.first_sheet = _sheets.of[begin];
    for (std::int32_t t = begin; t < end; ++t) {
      const auto [low, high] = std::minmax({face.first_sheet, _sheets.of[t]});
      face.first_sheet = low;
      face.sheet_count = std::max(face.sheet_count, high - low + 1);
      face.points.insert(face.points.end(), _complex.triangles[t].begin(), _complex.triangles[t].end());
    }
    geometry::sort_unique(face.points);
    std::vector<Vec3> points;
    points.reserve(face.points.size());
    for (const std::int32_t p : face.points) {
      number[p] = static_cast<std::int32_t>(points.size());
      points.push_back(_complex.points[p]);
    }
    for (std::int32_t t = begin; t < end; ++t) {
      const auto& [a, b, c] = _complex.triangles[t];
      face.triangles.push_back({number[a], number[b], number[c]});
    }
    face.planar = lies_in_plane(face);
    face.shape = shape_of(points, face.triangles);
    if (face.planar) face.shape.curvatures.assign(points.size(), {0, 0, true});
    face.in_space = geometry::BoxTree(boxes_in_space(_complex, face), facets_in_leaf);
    face.in_plane = geometry::BoxTree(
        boxes_in_plane(std::span<const CornerUv>(_uv).subspan(face.first, face.count)), facets_in_leaf);
  }
}

bool FacetedGeometry::lies_in_plane(const FacetedFace& face) const {
  Vec3 sum;
  for (std::int32_t t = face.first; t < face.first + face.count; ++t)
    sum += area_vector2(corners_of(_complex, t));
  const Vec3 normal = normalized(sum), origin = _complex.points[face.points.front()];
  for (std::int32_t t = face.first; t < face.first + face.count; ++t) {
    const auto corners = corners_of(_complex, t);
    if (!(dot(area_vector2(corners), normal) > 0)) return false;
    for (const Vec3 p : corners) {
      if (!(std::abs(dot(p - origin, normal)) <= _planar_tolerance)) return false;
    }
  }
  return true;
}

void FacetedGeometry::collect_edges() {
  for (const FacetComplex::Curve& curve : _complex.curves) {
    FacetedEdge& edge = _edges.emplace_back();
    edge.points = curve.points;
    edge.along.push_back(0);
    for (std::size_t i = 1; i < edge.points.size(); ++i) {
      edge.along.push_back(edge.along.back() +
                           distance(_complex.points[edge.points[i - 1]], _complex.points[edge.points[i]]));
    }
    edge.curvatures = curvatures_along(_complex, edge);
  }
  // Triangles are sorted by face, so uses come by face.
  for (geometry::HalfEdge h = 0; h < static_cast<geometry::HalfEdge>(_links.on_curve.size()); ++h) {
    const CurveSide& side = _links.on_curve[h];
    if (side.curve == no_entity) continue;
    const FaceId face = _complex.face_of[h / 3];
    std::vector<FacetedUse>& uses = _edges[side.curve].uses;
    if (uses.empty() || uses.back().face != face) {
      uses.push_back({face, !side.along,
                      std::vector<geometry::HalfEdge>(_complex.curves[side.curve].points.size() - 1, -1)});
    }
    uses.back().half_edges[side.side] = h;
  }
}

void FacetedGeometry::trace_loops() {
  std::vector<char> seen(_links.on_curve.size(), 0);
  for (EdgeId e = 0; e < static_cast<EdgeId>(_edges.size()); ++e) {
    for (const FacetedUse& use : _edges[e].uses) {
      if (std::ranges::find(use.half_edges, -1) != use.half_edges.end()) {
        throw CadError(fmt::format(
            "face '{}' ends part of the way along the edge from {}. Remedy: repair the triangles "
            "there in the program that made the file",
            _complex.faces[use.face].name, place_in_file(_complex.points[_edges[e].points.front()])));
      }
      geometry::HalfEdge h = use.reversed ? use.half_edges.back() : use.half_edges.front();
      if (seen[h]) continue;
      auto& loop = _faces[use.face].loops.emplace_back();
      while (!seen[h]) {
        const CurveSide& side = _links.on_curve[h];
        const std::size_t last = side.along ? _edges[side.curve].points.size() - 2 : 0;
        const std::size_t first = side.along ? 0 : _edges[side.curve].points.size() - 2;
        seen[h] = 1;
        if (static_cast<std::size_t>(side.side) == first) loop.push_back({side.curve, 0, !side.along});
        if (static_cast<std::size_t>(side.side) != last) {
          // Inside an edge its own next side, whatever other fans of the face touch the point.
          for (const FacetedUse& own : _edges[side.curve].uses) {
            if (own.face == use.face) h = own.half_edges[side.side + (side.along ? 1 : -1)];
          }
          continue;
        }
        h = next_on_border(_links, h);
      }
    }
  }
}

Facets FacetedGeometry::facets(FaceId id) const {
  const FacetedFace& face = _faces[id];
  Facets facets;
  facets.triangles = face.triangles;
  for (const std::int32_t p : face.points) facets.points.push_back(_complex.points[p]);
  facets.uv.resize(face.points.size());
  std::vector<char> known(face.points.size(), 0);
  for (std::int32_t t = 0; t < face.count; ++t) {
    for (int i = 0; i < 3; ++i) {
      const std::int32_t p = face.triangles[t][i];
      if (!known[p]) facets.uv[p] = _uv[face.first + t][i];
      known[p] = 1;
    }
  }
  const auto number = [&](std::int32_t p) {
    return static_cast<std::int32_t>(std::lower_bound(face.points.begin(), face.points.end(), p) -
                                     face.points.begin());
  };
  const auto add_line = [&](const Coedge& use) {
    const FacetedEdge& edge = _edges[use.edge];
    Facets::BoundaryLine line{use, {}, edge.along};
    for (const std::int32_t p : edge.points) line.nodes.push_back(number(p));
    facets.boundary.push_back(std::move(line));
  };
  for (const std::vector<Coedge>& loop : face.loops) std::ranges::for_each(loop, add_line);
  return facets;
}

double FacetedGeometry::face_area(FaceId id) const {
  double area = 0;
  for (std::int32_t t = _faces[id].first; t < _faces[id].first + _faces[id].count; ++t)
    area += 0.5 * norm(area_vector2(corners_of(_complex, t)));
  return area;
}

FacePlace FacetedGeometry::face_place(FaceId id) const {
  FacePlace place{0, {}, {}};
  for (std::int32_t t = _faces[id].first; t < _faces[id].first + _faces[id].count; ++t) {
    const auto corners = corners_of(_complex, t);
    const double area = 0.5 * norm(area_vector2(corners));
    place.area += area;
    place.centre += area / 3 * (corners[0] + corners[1] + corners[2]);
    for (const Vec3 p : corners) place.box.add(p);
  }
  if (place.area > 0) place.centre = place.centre / place.area;
  return place;
}

double planar_tolerance_of(const FacetComplex& complex) {
  double farthest = 0;
  for (const Vec3 p : complex.points)
    farthest = std::max({farthest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  return std::max(tolerances::coincident * box_of_points(complex.points).diagonal(),
                  2 * single_precision * farthest);
}

FacetedGeometry make_faceted_geometry(FacetComplex complex) {
  const double tolerance = planar_tolerance_of(complex);
  return make_faceted_geometry(std::move(complex), tolerance);
}

FacetedGeometry make_faceted_geometry(FacetComplex complex, double planar_tolerance) {
  divide_at_sharp_seams(complex);
  FacetSheets sheets = cut_into_sheets(complex, link_facets(complex));
  return FacetedGeometry(std::move(complex), std::move(sheets), planar_tolerance);
}

}  // namespace aeroloom::cad
