#include "cad/faceted/facet_links.hpp"

#include "cad/model/library_unit.hpp"
#include "geometry/sort_by_number.hpp"

#include <algorithm>
#include <tuple>

#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

using geometry::HalfEdge;

/// A side of a triangle, or of a curve, by its ends.
struct SideRow {
  std::int32_t low, high;
  std::int32_t curve, side;  // no_entity: a triangle's
  HalfEdge half_edge;
  bool ascending;  // it runs from low to high

  auto key() const { return std::tuple(low, high); }
  auto order() const { return std::tuple(low, high, curve == no_entity, half_edge); }
};

SideRow row_of(std::int32_t from, std::int32_t to) {
  return {std::min(from, to), std::max(from, to), no_entity, 0, -1, from < to};
}

std::vector<SideRow> list_sides(const FacetComplex& complex) {
  std::vector<SideRow> rows;
  rows.reserve(3 * complex.triangles.size());
  for (std::size_t c = 0; c < complex.curves.size(); ++c) {
    const auto& points = complex.curves[c].points;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      SideRow row = row_of(points[i], points[i + 1]);
      row.curve = static_cast<std::int32_t>(c), row.side = static_cast<std::int32_t>(i);
      rows.push_back(row);
    }
  }
  for (HalfEdge h = 0; h < static_cast<HalfEdge>(3 * complex.triangles.size()); ++h) {
    SideRow row = row_of(start_of(complex, h), end_of(complex, h));
    row.half_edge = h;
    rows.push_back(row);
  }
  geometry::sort_by_number(
      rows, [](const SideRow& row) { return row.low; },
      [](const SideRow& a, const SideRow& b) { return a.order() < b.order(); });
  return rows;
}

[[noreturn]] void refuse_side(const FacetComplex& complex, const SideRow& row, std::size_t users) {
  const Vec3 at = 0.5 * (complex.points[row.low] + complex.points[row.high]);
  throw CadError(
      fmt::format("a side of {} triangles near {} does not lie between two triangles of one face. Remedy: "
                  "repair the triangles there in the program that made the file",
                  users, place_in_file(at)));
}

}  // namespace

FacetLinks link_facets(const FacetComplex& complex) {
  const std::vector<SideRow> rows = list_sides(complex);
  FacetLinks links;
  links.on_curve.resize(3 * complex.triangles.size());
  links.inside.assign(3 * complex.triangles.size(), -1);
  for (std::size_t begin = 0, end = 0; begin < rows.size(); begin = end) {
    while (end < rows.size() && rows[end].key() == rows[begin].key()) ++end;
    const SideRow& first = rows[begin];
    if (first.curve != no_entity) {
      for (std::size_t i = begin + 1; i < end; ++i) {
        if (rows[i].half_edge < 0) refuse_side(complex, first, end - begin);
        links.on_curve[rows[i].half_edge] = {first.curve, first.side, rows[i].ascending == first.ascending};
      }
      continue;
    }
    const SideRow& last = rows[end - 1];
    if (end - begin != 2 || first.ascending == last.ascending ||
        complex.face_of[first.half_edge / 3] != complex.face_of[last.half_edge / 3])
      refuse_side(complex, first, end - begin);
    links.inside[first.half_edge] = last.half_edge;
    links.inside[last.half_edge] = first.half_edge;
  }
  return links;
}

geometry::HalfEdge next_on_border(const FacetLinks& links, geometry::HalfEdge h) {
  HalfEdge next = geometry::next_half_edge(h);
  while (links.inside[next] >= 0) next = geometry::next_half_edge(links.inside[next]);
  return next;
}

}  // namespace aeroloom::cad
