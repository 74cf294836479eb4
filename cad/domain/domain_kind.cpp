#include "cad/domain/domain_kind.hpp"

#include "cad/domain/patch_names.hpp"
#include "cad/model/patches.hpp"
#include "cad/model/shape_map.hpp"
#include "cad/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

// The bounds that tell a fluid from bodies were chosen, not measured; the fill and the number of inner faces
// are in the log, and `geometry.domain` overrules the decision.

/// Half spaces that stand for the convex hull: normals some 15 degrees apart.
constexpr int direction_count = 200;
/// A far field with a body in it fills nearly all of its hull, since bodies are small in it.
constexpr double fluid_fill = 0.85;
/// A face is a piece of the hull where no more of it lies before the face (of the diagonal): facets and
/// directions 15 degrees apart leave some before any round hull.
constexpr double hull_tolerance = 0.02;
/// A face with more of the hull before it lies inside: a wall of an obstacle.
constexpr double inner_distance = 0.1;
/// Facets for all that (of the diagonal; radians).
constexpr double hull_facet_deflection = 0.005, hull_facet_angle = 0.6;

/// Directions spread evenly over the sphere (Fibonacci's spiral), the axes first: boxes are common.
std::vector<Vec3> spread_directions() {
  std::vector<Vec3> directions{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (int i = 0; i < direction_count; ++i) {
    const double z = 1 - (2 * i + 1.0) / direction_count;
    const double angle = i * std::numbers::pi * (3 - std::sqrt(5.0));
    const double r = std::sqrt(1 - z * z);
    directions.push_back({r * std::cos(angle), r * std::sin(angle), z});
  }
  return directions;
}

/// The half spaces dot(direction, x) <= height that hold all points.
struct Polytope {
  std::vector<Vec3> directions = spread_directions();
  std::vector<double> heights = std::vector<double>(directions.size(), -std::numeric_limits<double>::max());
  std::vector<Vec3> extremes =
      std::vector<Vec3>(directions.size());  ///< the point farthest in each direction

  void add(Vec3 p) {
    for (std::size_t i = 0; i < directions.size(); ++i) {
      const double height = dot(directions[i], p);
      if (height > heights[i]) heights[i] = height, extremes[i] = p;
    }
  }
  /// Distance from an inner point to the nearest half space's border.
  double depth(Vec3 p) const {
    double least = std::numeric_limits<double>::max();
    for (std::size_t i = 0; i < directions.size(); ++i)
      least = std::min(least, heights[i] - dot(directions[i], p));
    return least;
  }
  double volume(const Box& box) const;
};

double radical_inverse(int base, int index) {
  double result = 0, weight = 1;
  for (; index > 0; index /= base) {
    weight /= base;
    result += weight * (index % base);
  }
  return result;
}

/// The fraction of the box, by Halton's points.
double Polytope::volume(const Box& box) const {
  constexpr int samples = 20000;  // chosen, not measured
  const Vec3 size = box.size();
  int inside = 0;
  for (int i = 1; i <= samples; ++i) {
    const Vec3 p = box.low + Vec3{size.x * radical_inverse(2, i), size.y * radical_inverse(3, i),
                                  size.z * radical_inverse(5, i)};
    inside += depth(p) >= 0;
  }
  return size.x * size.y * size.z * inside / samples;
}

std::vector<Facets> coarse_facets(const Model& model) {
  std::vector<Facets> facets;
  facets.reserve(model.face_count());
  for (FaceId f = 0; f < model.face_count(); ++f) {
    facets.push_back(model.facets(f, hull_facet_deflection * model.bounds().diagonal(), hull_facet_angle));
  }
  return facets;
}

/// How far the hull lies outside the facets of a face, each along its own normal: 0 for a piece of the
/// hull.
double distance_to_hull(const Facets& facets, const Polytope& hull) {
  double largest = 0;
  for (const auto& t : facets.triangles) {
    const Vec3 a = facets.points[t[0]];
    const Vec3 normal = normalized(cross(facets.points[t[1]] - a, facets.points[t[2]] - a));
    for (const Vec3 p : hull.extremes) largest = std::max(largest, dot(normal, p - a));
  }
  return largest;
}

/// The name of the first face that one of the patterns names; empty if there is none.
std::string first_on_hull(const Model& model, const std::vector<char>& on_hull,
                          const std::vector<std::string>& patterns) {
  const std::vector<NamePattern> names(patterns.begin(), patterns.end());
  for (FaceId f = 0; f < model.face_count(); ++f) {
    const std::string &face = model.face(f).name, &patch = model.patches()[model.face(f).patch];
    const bool named = std::ranges::any_of(
        names, [&](const NamePattern& name) { return name.matches(face) || name.matches(patch); });
    if (named && on_hull[f]) return face;
  }
  return {};
}

/// As side_of_box(); the box of a face takes long where it is no plane, and its edges tell mostly that it is
/// not flat.
std::string side_of_face(const TopoDS_Shape& face, const Box& all) {
  const TopTools_IndexedMapOfShape edges = map_of(face, TopAbs_EDGE);
  const Box border = tight_box(std::vector<TopoDS_Shape>(edges.cbegin(), edges.cend()));
  if (!border.empty() && side_of_box(border, all).empty()) return {};
  return side_of_box(tight_box(face), all);
}

}  // namespace

std::string side_of_box(const Box& face, const Box& all) {
  static const char* const names[3][2] = {{"xmin", "xmax"}, {"ymin", "ymax"}, {"zmin", "zmax"}};
  const double tolerance = tolerances::same_place * all.diagonal();
  for (int axis = 0; axis < 3; ++axis) {
    if (face.high[axis] - face.low[axis] > tolerance) continue;
    if (std::abs(face.low[axis] - all.low[axis]) <= tolerance) return names[axis][0];
    if (std::abs(face.high[axis] - all.high[axis]) <= tolerance) return names[axis][1];
  }
  return {};
}

HullComparison compare_with_hull(const Model& solids, double volume, const OpeningNames& openings) {
  const std::vector<Facets> facets = coarse_facets(solids);
  Polytope hull;
  for (const Facets& face : facets) {
    for (const Vec3 p : face.points) hull.add(p);
  }
  const double diagonal = solids.bounds().diagonal();
  HullComparison result;
  result.fill = volume / hull.volume(solids.bounds());
  for (const Facets& face : facets) {
    const double outside = distance_to_hull(face, hull) / diagonal;
    result.on_hull.push_back(outside <= hull_tolerance);
    result.inner_faces += outside > inner_distance;
  }
  result.inlet = first_on_hull(solids, result.on_hull, openings.inlets);
  result.outlet = first_on_hull(solids, result.on_hull, openings.outlets);
  return result;
}

KindDecision decide_kind(const HullComparison& hull, int loose_inside) {
  const bool fluid = hull.fill > fluid_fill && hull.inner_faces > 0;
  const std::string figures = fmt::format(
      "it fills {:.0f} % of its convex hull, and {} of its faces have much of the hull in front of them",
      100 * hull.fill, hull.inner_faces);
  if (fluid) return {DomainKind::fluid, "taken as the fluid: " + figures + ", as around an obstacle"};
  if (hull.fill > fluid_fill && loose_inside > 0) {
    return {DomainKind::fluid,
            fmt::format("taken as the fluid: it fills {:.0f} % of its convex hull, and {} loose face(s) lie "
                        "inside of it, as baffles do",
                        100 * hull.fill, loose_inside)};
  }
  if (!hull.inlet.empty() && !hull.outlet.empty()) {
    return {DomainKind::fluid,
            fmt::format("taken as the fluid: its faces '{}' and '{}' are an inlet and an outlet on the hull, "
                        "as those of a duct (`geometry.domain: body` where they belong to a body)",
                        hull.inlet, hull.outlet)};
  }
  return {DomainKind::body,
          "taken as a body: " + figures +
              fmt::format(" (a fluid fills more than {:.0f} % and has such faces)", 100 * fluid_fill)};
}

std::vector<FaceTag> tag_faces(const NamedShape& domain, DomainKind kind, const HullComparison* hull) {
  const TopTools_IndexedMapOfShape faces = map_of(domain.shape, TopAbs_FACE);
  const Box all = kind == DomainKind::fluid ? tight_box(domain.shape) : Box{};
  const std::vector<std::vector<int>> solids = solids_around_faces(domain.shape);
  bool is_numbered = false;
  for (int i = 1; i <= faces.Extent(); ++i) {
    const FaceLabel* const found = domain.labels.Seek(faces(i));
    is_numbered = is_numbered || (found != nullptr && found->number >= 0);
  }
  InterfaceNames interfaces(region_names(domain));
  const TopTools_IndexedMapOfShape baffles = faces_inside_solids(domain.shape);
  std::vector<FaceTag> tags;
  for (int i = 1; i <= faces.Extent(); ++i) {
    const FaceLabel* found = domain.labels.Seek(faces(i));
    const FaceLabel label = found ? *found : FaceLabel{};
    FaceTag tag{shown_name(label), label.far_field ? std::string("farfield") : label.name,
                label.far_field,   label.solid,
                label.layer,       label.colour,
                label.number};
    // A built-in shape has no file: its faces count as they come.
    if (!is_numbered && !label.far_field) tag.number = i - 1;
    // Numbers are those of the file: what was made here has none.
    if (tag.name.empty() && is_numbered) tag.name = fmt::format("new_face_{}", i - 1);
    if (label.symmetry) tag.patch = "symmetry";
    if (label.far_field || label.symmetry) tag.origin = PatchOrigin::program;
    const bool fluid = kind == DomainKind::fluid;
    const std::vector<int>& around = solids[i - 1];
    const bool is_interface = tag.patch.empty() && around.size() == 2;
    if (is_interface) tag.patch = interfaces(around[0], around[1]);
    if (tag.patch.empty() && baffles.Contains(faces(i))) tag.patch = "baffle";
    if (tag.patch.empty() && !fluid) tag.patch = label.solid;
    if (tag.patch.empty()) tag.patch = label.layer;
    if (tag.patch.empty()) tag.patch = label.colour;
    if (tag.patch.empty() || is_interface) tag.origin = PatchOrigin::unnamed;
    if (tag.patch.empty() && fluid) tag.patch = side_of_face(faces(i), all);
    if (tag.patch.empty() && fluid && hull && hull->on_hull[i - 1]) tag.patch = "outer";
    if (tag.patch.empty()) tag.patch = "body";
    tags.push_back(std::move(tag));
  }
  return tags;
}

}  // namespace aeroloom::cad
