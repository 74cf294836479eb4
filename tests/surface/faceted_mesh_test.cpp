/// CAD and the facets of it: meshes on both enclose the same, but for what the facets leave the CAD by.
#include "cad/faceted/faceted_domain.hpp"
#include "cad/faceted/make_facet_complex.hpp"
#include "geometry/angle.hpp"
#include "mesh/checks/validity.hpp"
#include "surface/surface_mesher.hpp"
#include "tests/cad/faceted_shapes.hpp"
#include "tests/cad/primitives.hpp"

#include <cmath>

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

double meshed_volume(const cad::Model& model) {
  const auto world = parallel::Communicator::world();
  const sizing::SizingOptions sizes{.minimum = 0.01, .maximum = 0.04, .curvature_angle = 10, .growth = 1.3};
  const SurfaceMesh surface = mesh_surface(model, sizing::build_size_field(world, model, sizes), {});
  const auto report = mesh::check_surface_mesh(surface);
  EXPECT_TRUE(report.valid());
  return report.volume;
}

TEST(FacetedMesh, EnclosesWhatTheMeshOfItsCadDoes) {
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

}  // namespace
}  // namespace aeroloom::surface
