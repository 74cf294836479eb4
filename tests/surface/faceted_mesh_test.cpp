/// CAD and the facets of it: meshes on both enclose the same, but for what the facets leave the CAD by.
#include "cad/faceted/faceted_domain.hpp"
#include "cad/faceted/make_facet_complex.hpp"
#include "geometry/angle.hpp"
#include "mesh/checks/validity.hpp"
#include "surface/surface_mesher.hpp"
#include "tests/cad/faceted_shapes.hpp"
#include "tests/cad/primitives.hpp"

#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::surface {
namespace {

using cad::PrimitiveKind;

/// The facets of all faces, as an exporter writes them.
cad::FacetSoup facets_of(const cad::Model& model, double deflection) {
  cad::FacetSoup soup = cad::faceted::empty_soup();
  for (cad::FaceId face = 0; face < model.face_count(); ++face) {
    const cad::Facets facets = model.facets(face, deflection, 60 * geometry::degree);
    const auto base = static_cast<std::int32_t>(soup.points.size());
    soup.points.insert(soup.points.end(), facets.points.begin(), facets.points.end());
    for (const auto& [a, b, c] : facets.triangles)
      cad::faceted::add_triangle(soup, base + a, base + b, base + c);
  }
  return soup;
}

cad::Model model_of(const cad::FacetSoup& soup) {
  cad::Changes changes;
  cad::DomainOptions options;
  options.kind = cad::DomainKind::fluid;
  return make_faceted_domain(options, make_facet_complex(soup, 40 * geometry::degree, changes), {}).model;
}

double meshed_volume(const cad::Model& model,
                     const sizing::SizingOptions& sizes = {
                         .minimum = 0.01, .maximum = 0.04, .curvature_angle = 10, .growth = 1.3}) {
  const auto world = parallel::Communicator::world();
  const SurfaceMesh surface = mesh_surface(model, sizing::build_size_field(world, model, sizes), {});
  const auto report = mesh::check_surface_mesh(surface);
  EXPECT_TRUE(report.valid());
  return report.volume;
}

TEST(FacetedMeshLocal, EnclosesWhatTheMeshOfItsCadDoes) {
  constexpr double deflection = 0.005;
  for (const PrimitiveKind kind : {PrimitiveKind::sphere, PrimitiveKind::cylinder, PrimitiveKind::torus}) {
    const cad::Model exact = cad::make_primitive_domain(kind, {.radius = 0.25});
    const cad::Model faceted = model_of(facets_of(exact, deflection));
    double area = 0;
    for (cad::FaceId face = 0; face < exact.face_count(); ++face) area += exact.face_area(face);
    const double of_cad = meshed_volume(exact), of_facets = meshed_volume(faceted);
    // Facets of round bodies lie inside, and their mesh leaves them by less than they leave the CAD.
    EXPECT_LT(std::abs(of_cad - of_facets), deflection * area);
    EXPECT_LT(std::abs(faceted.region_volume(0) - of_facets), 0.2 * deflection * area);
    EXPECT_GT(exact.region_volume(0) - faceted.region_volume(0), 0.1 * deflection * area);
  }
}

/// A ramp in the top of a plate: from its foot it rises, or falls, by less than the feature angle. Its other
/// sides are walls. So ramp and top are one face, which goes more than once around the ends of the foot.
struct Ramp {
  double foot, end, length;  // its width at both ends, and its length in plan
  double height;             // of its end over the top
};

/// A plate of 0.5 with ramps in a row.
cad::FacetSoup plate_with_ramps(const std::vector<Ramp>& ramps) {
  constexpr double margin = 0.1, far_side = 1.6, front_of_foot = 0.3, depth = 0.5;
  cad::FacetSoup soup = cad::faceted::empty_soup();
  const auto add_point = [&](double x, double y, double z) {
    soup.points.push_back({x, y, z});
    return static_cast<std::int32_t>(soup.points.size()) - 1;
  };
  const auto add_polygon = [&](const std::vector<std::int32_t>& corners) {
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
      cad::faceted::add_triangle(soup, corners[0], corners[i], corners[i + 1]);
  };
  using Section = std::array<std::int32_t, 4>;  // near and far, above and below
  const auto add_section = [&](double x) {
    return Section{add_point(x, 0, 0), add_point(x, far_side, 0), add_point(x, 0, -depth),
                   add_point(x, far_side, -depth)};
  };
  double x = 0;
  const Section first = add_section(0);
  Section left = first;
  for (const Ramp& ramp : ramps) {
    const double middle = x + margin + 0.5 * ramp.foot, back = front_of_foot + ramp.length;
    x += ramp.foot + 2 * margin;
    const Section right = add_section(x);
    const std::int32_t a = add_point(middle - 0.5 * ramp.foot, front_of_foot, 0);
    const std::int32_t b = add_point(middle + 0.5 * ramp.foot, front_of_foot, 0);
    const std::int32_t c = add_point(middle + 0.5 * ramp.end, back, 0);
    const std::int32_t d = add_point(middle - 0.5 * ramp.end, back, 0);
    const std::int32_t above_c = add_point(middle + 0.5 * ramp.end, back, ramp.height);
    const std::int32_t above_d = add_point(middle - 0.5 * ramp.end, back, ramp.height);
    add_polygon({left[0], right[0], b, a});
    add_polygon({b, right[0], right[1], c});
    add_polygon({c, right[1], left[1], d});
    add_polygon({a, d, left[1], left[0]});
    add_polygon({a, b, above_c, above_d});
    add_polygon({b, c, above_c});
    add_polygon({a, above_d, d});
    add_polygon({c, d, above_d, above_c});
    add_polygon({left[2], left[3], right[3], right[2]});
    add_polygon({left[0], left[2], right[2], right[0]});
    add_polygon({right[1], right[3], left[3], left[1]});
    left = right;
  }
  add_polygon({first[1], first[3], first[2], first[0]});
  add_polygon({left[0], left[2], left[3], left[1]});
  return soup;
}

void expect_mesh_of_plate(const std::vector<Ramp>& ramps, double size) {
  const cad::FacetSoup soup = plate_with_ramps(ramps);
  const double volume =
      meshed_volume(model_of(soup), {.minimum = size, .maximum = size, .curvature_angle = 30, .growth = 1.3});
  // Triangles may cross the feet of the ramps, and cut off no more than a fifth of their size there.
  double feet = 0;
  for (const Ramp& ramp : ramps) feet += ramp.foot;
  EXPECT_NEAR(volume, cad::faceted::volume_of(soup), 0.2 * size * size * feet);
}

TEST(FacetedMesh, DividesAFaceWithTeethWhereItsChartFolds) {
  expect_mesh_of_plate({{0.3, 0.1, 0.4, 0.25}, {0.3, 0.1, 0.4, 0.25}, {0.3, 0.1, 0.4, 0.25}}, 0.08);
}

TEST(FacetedMesh, DividesAFaceWithAThinFinWhereItsChartFolds) {
  expect_mesh_of_plate({{0.1, 0.03, 1, 0.6}}, 0.06);
}

TEST(FacetedMesh, DividesAFaceWithSmallPitsWhereItsChartFolds) {
  expect_mesh_of_plate({{0.3, 0.1, 0.4, -0.25}, {0.1, 0.02, 0.1, -0.06}, {0.3, 0.02, 0.7, 0.4}}, 0.08);
}

}  // namespace
}  // namespace aeroloom::surface
