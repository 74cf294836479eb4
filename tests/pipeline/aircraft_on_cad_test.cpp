// The built-in aircraft stage by stage, as a library: faces divided, volume in zones, improved, and its
// boundary compared with the CAD itself.
#include "cad/domain/domain.hpp"
#include "improve/improver.hpp"
#include "mesh/checks/validity.hpp"
#include "surface/surface_mesher.hpp"
#include "tests/references.hpp"
#include "volume/volume_mesher.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include <gtest/gtest.h>

namespace aeroloom {
namespace {

using geometry::Vec3;

struct Aircraft {
  cad::Model model;
  surface::SurfaceMesh surface;
  mesh::DistributedMesh volume;
  volume::VolumeReport report;
  improve::ImproveReport improved;
};

Aircraft mesh_aircraft(const parallel::Communicator& ranks) {
  cad::DomainOptions domain;
  domain.transport.emplace();
  domain.far_field.emplace();
  domain.far_field->extent = 3;
  const cad::Model model = cad::Model::from_bytes(cad::prepare_domain(domain).model.serialise());
  sizing::SizingOptions sizes = sizing::choose_sizes(ranks, model, 360'000);
  sizes.feature_minimum = 0.5 * sizes.minimum;  // small for a test: trailing edges stay unresolved
  sizes.narrow_minimum = 0;
  const sizing::SizeField field = sizing::build_size_field(ranks, model, sizes);
  surface::SurfaceOptions surface_options;
  surface_options.piece_triangles = 200;
  Aircraft aircraft{model, surface::mesh_surface(model, field, surface_options), {}, {}, {}};
  volume::VolumeOptions options;
  options.piece_tets = 10'000;
  const volume::VolumeInput input{aircraft.surface, options};
  aircraft.volume = volume::fill_zones(input, volume::decompose(input), aircraft.report);
  cad::PointLocator locator(model);
  aircraft.improved = improve::improve_mesh(aircraft.volume, {}, {&locator, &aircraft.surface.field});
  return aircraft;
}

/// How far the boundary vertices of a mesh are from the CAD vertex, edge or face they are classified on.
double largest_distance(const cad::Model& model, const mesh::DistributedMesh& mesh) {
  cad::PointLocator locator(model);
  const double tolerance = 1e-4 * model.body_bounds().diagonal();
  double largest = 0;
  for (const mesh::Piece& piece : mesh.pieces) {
    for (mesh::LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      const Vec3 p = piece.point(v);
      const std::int32_t entity = piece.vertex_entity[v];
      if (piece.vertex_dimension[v] == mesh::CadDimension::vertex) {
        largest = std::max(largest, distance(p, model.vertex(entity)));
      } else if (piece.vertex_dimension[v] == mesh::CadDimension::edge) {
        const auto t = locator.on_edge(entity, p, tolerance);
        largest = std::max(largest, t ? distance(p, model.edge_point(entity, *t)) : 1e300);
      } else if (piece.vertex_dimension[v] == mesh::CadDimension::face) {
        const auto uv = locator.on_face(entity, p, tolerance);
        largest = std::max(largest, uv ? distance(p, model.face_point(entity, *uv)) : 1e300);
      }
    }
  }
  return largest;
}

/// Areas of the boundary by CAD face. Collective.
std::vector<double> areas_by_face(const cad::Model& model, const mesh::DistributedMesh& mesh) {
  const parallel::Communicator& ranks = mesh.communicator;
  std::vector<double> areas(model.face_count(), 0);
  for (const mesh::Piece& piece : mesh.pieces) {
    for (mesh::LocalIndex t = 0; t < piece.boundary_count(); ++t) {
      const mesh::LocalIndex* v = piece.boundary_triangle(t);
      const Vec3 a = piece.point(v[0]);
      areas[piece.triangle_face[t]] += 0.5 * norm(cross(piece.point(v[1]) - a, piece.point(v[2]) - a));
    }
  }
  for (double& area : areas) area = ranks.sum(area);
  return areas;
}

/// Meshed once for all tests.
class AircraftOnCad : public testing::Test {
protected:
  static void SetUpTestSuite() { meshed.emplace(mesh_aircraft(parallel::Communicator::world())); }
  static void TearDownTestSuite() { meshed.reset(); }

  inline static std::optional<Aircraft> meshed;
  const parallel::Communicator ranks = parallel::Communicator::world();
  const Aircraft& aircraft = *meshed;
};

TEST_F(AircraftOnCad, TheImprovedBoundaryIsThatOfTheCad) {
  EXPECT_GT(aircraft.surface.report.divided_faces, 3) << "faces are cut into pieces";
  EXPECT_GT(aircraft.volume.piece_count, 2) << "the volume is filled in zones";
  EXPECT_GT(ranks.sum(aircraft.improved.changed_triangles), 0) << "there is something to compare";
  const mesh::NumberedMesh numbered = mesh::number_mesh(aircraft.volume);
  const mesh::ValidityReport validity = mesh::check_volume_mesh(numbered, nullptr);
  EXPECT_TRUE(validity.violations.empty());
  const double length = aircraft.model.body_bounds().diagonal();
  EXPECT_LT(ranks.maximum(largest_distance(aircraft.model, aircraft.volume)), 1e-7 * length);
  // Coarse triangles cut corners: by little altogether, by more on the narrow ends of lifting surfaces.
  const std::vector<double> areas = areas_by_face(aircraft.model, aircraft.volume);
  double body = 0, cad_body = 0;
  for (cad::FaceId f = 0; f < aircraft.model.face_count(); ++f) {
    const double area = aircraft.model.face_area(f);
    EXPECT_NEAR(areas[f], area, 0.25 * area) << aircraft.model.face(f).name;
    if (!aircraft.model.is_far_field(f)) body += areas[f], cad_body += area;
  }
  EXPECT_NEAR(body, cad_body, 0.01 * cad_body);
}

TEST_F(AircraftOnCad, IsTheSameMeshOnAnyNumberOfRanks) {
  const auto hash = [](const Aircraft& of) { return mesh::hash_mesh(mesh::number_mesh(of.volume)); };
  const std::string together = hash(aircraft);
  if (!ranks.is_root()) return;
  const auto self = parallel::Communicator::self();
  EXPECT_EQ(together, references::of_one_rank(ranks, together, [&] { return hash(mesh_aircraft(self)); }));
}

}  // namespace
}  // namespace aeroloom
