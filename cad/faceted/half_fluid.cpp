#include "cad/faceted/half_fluid.hpp"

#include "cad/domain/far_field_shape.hpp"
#include "cad/faceted/close_facets.hpp"
#include "cad/faceted/facet_contacts.hpp"
#include "cad/faceted/facet_links.hpp"
#include "cad/faceted/facet_readers.hpp"
#include "cad/faceted/facet_sides.hpp"
#include "cad/faceted/facet_walls.hpp"
#include "cad/faceted/features.hpp"
#include "cad/faceted/fill_openings.hpp"
#include "cad/faceted/plane_filling.hpp"
#include "cad/faceted/shape_facets.hpp"
#include "cad/model/library_unit.hpp"
#include "cad/tolerances.hpp"
#include "geometry/angle.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

// Chosen, not measured: a sphere of a few thousand triangles.
constexpr double far_deflection_over_extent = 2e-4;
constexpr double most_far_angle = 4 * geometry::degree;
/// Corners of the far field nearer to the plane are on it (of the diagonal).
constexpr double far_on_plane = 1e-9;

double volume_inside(const FacetSoup& soup, Vec3 middle) {
  double volume = 0;
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    const auto [a, b, c] = corners_of(soup, t);
    volume += dot(a - middle, cross(b - middle, c - middle)) / 6;
  }
  return volume;
}

/// Triangles of the far field, those on the plane left out.
FacetSoup open_far_field(const FarFieldOptions& options, const FacetPlane& plane, const Box& body,
                         double& volume) {
  SymmetryPlane symmetry;
  symmetry.axis = plane.axis, symmetry.position = plane.position, symmetry.positive = plane.positive;
  FaceLabels labels;
  const TopoDS_Solid solid = place_far_field(options, {plane.whole, body}, symmetry, labels);
  const double extent = tight_box(solid).diagonal();
  FacetSoup soup = facets_of(solid, labels, {far_deflection_over_extent * extent, most_far_angle}).soup;
  for (Vec3& p : soup.points)
    if (std::abs(plane.height(p)) <= far_on_plane * extent) p[plane.axis] = plane.position;
  volume = std::abs(volume_inside(soup, body.center()));
  FacetSoup open = soup;
  open.triangles.clear(), open.group_of.clear();
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    const auto corners = corners_of(soup, t);
    if (std::ranges::all_of(corners, [&](Vec3 p) { return plane.holds(p); })) continue;
    open.triangles.push_back(soup.triangles[t]);
    open.group_of.push_back(soup.group_of[t]);
  }
  return open;
}

class HalfFluidMaker {
public:
  HalfFluidMaker(const FacetPlane& plane) : _plane(plane) {}

  void add(const FacetSoup& soup) {
    const auto points = static_cast<std::int32_t>(_soup.points.size()),
               groups = static_cast<std::int32_t>(_soup.groups.size());
    _soup.points.insert(_soup.points.end(), soup.points.begin(), soup.points.end());
    _soup.groups.insert(_soup.groups.end(), soup.groups.begin(), soup.groups.end());
    for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
      const auto& [a, b, c] = soup.triangles[t];
      _soup.triangles.push_back({a + points, b + points, c + points});
      _soup.group_of.push_back(soup.group_of[t] + groups);
    }
  }

  /// Between the border of the far field and the outlines of the bodies.
  void add_plane() {
    const auto triangles = triangles_on_plane(_soup, list_open_sides(_soup), _plane);
    if (!triangles) {
      throw CadError(
          fmt::format("outlines of the bodies cross or touch on the plane of symmetry {}. Remedy: repair the "
                      "triangles there in the program that made them",
                      name_of(_plane)));
    }
    _first_on_plane = _soup.triangles.size();
    _soup.groups.push_back({"symmetry", {}});
    for (const geometry::TriangleCorners& corners : *triangles) {
      _soup.triangles.push_back(corners);
      _soup.group_of.push_back(static_cast<std::int32_t>(_soup.groups.size()) - 1);
    }
  }

  /// Drops what the plane closes apart from the far field. Returns its volume.
  double drop_cavities(Changes& changes) {
    const FacetComponents components = find_components(_soup);
    std::vector<char> closed_by_plane(components.count, 0);
    for (std::size_t t = _first_on_plane; t < _soup.triangles.size(); ++t)
      closed_by_plane[components.of[t]] = 1;
    closed_by_plane[components.of[0]] = 0;  // the far field comes first
    double volume = 0;
    for (std::int32_t c = 0; c < components.count; ++c) {
      if (closed_by_plane[c] == 0) continue;
      FacetSoup cavity = _soup;
      cavity.triangles.clear();
      for (std::size_t t = 0; t < _soup.triangles.size(); ++t)
        if (components.of[t] == c) cavity.triangles.push_back(_soup.triangles[t]);
      const Vec3 place = _soup.points[cavity.triangles.front()[0]];
      volume += std::abs(volume_inside(cavity, place));
      changes.push_back(
          {"a cavity inside a body, cut open by the plane of symmetry, does not reach the fluid: left out",
           place});
    }
    std::size_t count = 0;
    for (std::size_t t = 0; t < _soup.triangles.size(); ++t) {
      if (closed_by_plane[components.of[t]] != 0) continue;
      _soup.triangles[count] = _soup.triangles[t];
      _soup.group_of[count++] = _soup.group_of[t];
    }
    _soup.triangles.resize(count), _soup.group_of.resize(count);
    std::vector<std::int32_t> same(_soup.points.size());
    for (std::size_t p = 0; p < same.size(); ++p) same[p] = static_cast<std::int32_t>(p);
    replace_points(_soup, same);
    return volume;
  }

  const FacetSoup& soup() const { return _soup; }

private:
  const FacetPlane& _plane;
  FacetSoup _soup;
  std::size_t _first_on_plane = 0;
};

/// The walls without their triangles on the plane, with a group for each face.
FacetSoup soup_of_walls(const FacetComplex& walls, const FacetPlane& plane, bool all) {
  FacetSoup soup;
  soup.points = walls.points;
  soup.groups.assign(walls.faces.begin(), walls.faces.end());
  for (std::size_t t = 0; t < walls.triangles.size(); ++t) {
    const auto corners = corners_of(walls, static_cast<std::int32_t>(t));
    if (!all && std::ranges::all_of(corners, [&](Vec3 p) { return plane.holds(p); })) continue;
    soup.triangles.push_back(walls.triangles[t]);
    soup.group_of.push_back(walls.face_of[t]);
  }
  return soup;
}

}  // namespace

HalfFluid surround_half_facets(const FacetComplex& walls, const FarFieldOptions& options,
                               const FacetPlane& plane, double feature_angle, Changes& changes) {
  const Box body = box_of_points(walls.points);
  HalfFluid fluid;
  fluid.bodies = -volume_inside(soup_of_walls(walls, plane, true), body.center());
  HalfFluidMaker maker(plane);
  const FacetSoup far_field = open_far_field(options, plane, body, fluid.outer);
  const std::size_t far_groups = far_field.groups.size();
  maker.add(far_field);
  maker.add(soup_of_walls(walls, plane, false));
  maker.add_plane();
  fluid.bodies += maker.drop_cavities(changes);
  const FacetSoup& soup = maker.soup();
  fluid.complex =
      split_facets(soup, std::vector<FacetRegions>(soup.triangles.size(), FacetRegions{0, no_entity, false}),
                   feature_angle);
  fluid.complex.regions = {"fluid"};
  fluid.far_field.assign(fluid.complex.faces.size(), 0);
  const auto is_far = [&](std::int32_t group) {
    return static_cast<std::size_t>(group) < far_groups ||
           static_cast<std::size_t>(group) + 1 == soup.groups.size();
  };
  for (std::size_t t = 0; t < soup.triangles.size(); ++t)
    if (is_far(soup.group_of[t])) fluid.far_field[fluid.complex.face_of[t]] = 1;
  return fluid;
}

void tag_half_fluid(const HalfFluid& fluid, std::vector<FaceTag>& tags) {
  for (std::size_t f = 0; f < fluid.far_field.size(); ++f) {
    if (fluid.far_field[f] == 0) continue;
    FaceTag& tag = tags[f];
    tag.patch = tag.name == "symmetry" ? "symmetry" : "farfield";
    tag.far_field = true;
    tag.number = -1;
    tag.origin = PatchOrigin::program;
  }
}

}  // namespace aeroloom::cad
