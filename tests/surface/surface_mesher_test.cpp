/// The whole surface stage on analytic shapes, on any number of ranks.
#include "surface/surface_mesher.hpp"

#include "cad/domain/domain.hpp"
#include "mesh/checks/validity.hpp"
#include "mesh/quality/quality.hpp"
#include "surface/curves/curves.hpp"
#include "surface/piece_mesher.hpp"
#include "tests/cad/primitives.hpp"
#include "tests/references.hpp"

#include <cmath>
#include <numbers>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

namespace aeroloom::surface {
namespace {

using cad::PrimitiveKind;
using parallel::Communicator;

/// A model with its surface meshed at `angle` degrees per element.
struct Meshed {
  cad::Model model;
  sizing::SizeField field;
  SurfaceMesh surface;
};

Meshed mesh_model(const Communicator& communicator, const cad::Model& model, double angle, double maximum) {
  const sizing::SizingOptions sizes{
      .minimum = 1e-3, .maximum = maximum, .curvature_angle = angle, .growth = 1.3};
  sizing::SizeField field = sizing::build_size_field(communicator, model, sizes);
  SurfaceMesh surface = mesh_surface(model, field, {});
  return {model, std::move(field), std::move(surface)};
}

/// Areas of the triangles by CAD face.
std::vector<double> face_areas(const Communicator& communicator, const Meshed& meshed) {
  struct Row {
    std::int32_t face;
    double area;

    static constexpr auto fields() { return std::tuple(&Row::face, &Row::area); }
  };
  std::vector<Row> mine;
  for (const mesh::Piece& piece : meshed.surface.pieces) {
    double area = 0;
    for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const mesh::LocalIndex* v = piece.cell(t);
      area += 0.5 * norm(cross(piece.point(v[1]) - piece.point(v[0]), piece.point(v[2]) - piece.point(v[0])));
    }
    mine.push_back({piece.common_face(), area});
  }
  std::vector<double> areas(meshed.model.face_count());
  for (const Row& row : communicator.all_gather_items<Row>(mine)) areas[row.face] += row.area;
  return areas;
}

TEST(SurfaceMesherLocal, SphereFollowsTheLawOfChords) {
  const Communicator world = Communicator::world();
  const cad::Model model = cad::make_primitive_domain(PrimitiveKind::sphere, {.radius = 0.5});
  const double exact = std::numbers::pi / 6;
  for (const double degrees : {12.0, 8.0, 5.0}) {
    const Meshed meshed = mesh_model(world, model, degrees, 1);
    const auto report = mesh::check_surface_mesh(meshed.surface);
    ASSERT_TRUE(report.valid()) << report.violations.front();
    const double theta = degrees * std::numbers::pi / 180, expected = 3 * theta * theta / 8;
    EXPECT_NEAR((exact - report.volume) / exact, expected, 0.2 * expected) << degrees << " degrees";
  }
}

/// How far the middles of triangles are inside the unit sphere or cylinder around z, at most.
TEST(SurfaceMesherLocal, ChordalDeviationIsBounded) {
  const Communicator world = Communicator::world();
  for (const PrimitiveKind kind : {PrimitiveKind::sphere, PrimitiveKind::cylinder}) {
    const cad::Model model = cad::make_primitive_domain(kind, {.radius = 1, .height = 1});
    for (const double wanted : {1e-2, 1e-3}) {
      sizing::SizingOptions sizes{.minimum = 1, .maximum = 1, .curvature_angle = 60, .growth = 1.3};
      sizes.chordal_deviation = wanted;
      const SurfaceMesh surface = mesh_surface(model, sizing::build_size_field(world, model, sizes), {});
      double largest = 0;
      for (const mesh::Piece& piece : surface.pieces) {
        if (model.is_planar(piece.common_face())) continue;
        for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) {
          const mesh::LocalIndex* v = piece.cell(t);
          geometry::Vec3 middle = (1.0 / 3) * (piece.point(v[0]) + piece.point(v[1]) + piece.point(v[2]));
          if (kind == PrimitiveKind::cylinder) middle.z = 0;
          largest = std::max(largest, 1 - norm(middle));
        }
      }
      largest = world.maximum(largest);
      EXPECT_LE(largest, wanted);
      EXPECT_GT(largest, 0.3 * wanted);
    }
  }
}

class SurfaceShapesLocal : public testing::TestWithParam<PrimitiveKind> {};

TEST_P(SurfaceShapesLocal, AreValidAndTrueToTheCad) {
  const Communicator world = Communicator::world();
  const Meshed meshed = mesh_model(world, cad::make_primitive_domain(GetParam()), 5, 0.1);
  const auto report = mesh::check_surface_mesh(meshed.surface);
  ASSERT_TRUE(report.valid()) << report.violations.front();
  const std::vector<double> areas = face_areas(world, meshed);
  for (cad::FaceId f = 0; f < meshed.model.face_count(); ++f) {
    const double exact = meshed.model.face_area(f);
    bool straight = meshed.model.is_planar(f);
    for (const auto& loop : meshed.model.face(f).loops) {
      for (const cad::Coedge& use : loop)
        straight = straight && meshed.model.edge_curvature(use.edge, 0.5) == 0;
    }
    EXPECT_NEAR(areas[f], exact, (straight ? 1e-12 : 5e-3) * exact) << meshed.model.face(f).name;
  }
  const auto quality = mesh::summarise_quality(meshed.surface);
  EXPECT_GT(quality.min_dihedral.minimum, 20);
  EXPECT_GT(quality.mean_ratio.mean, 0.95);
}

INSTANTIATE_TEST_SUITE_P(Primitives, SurfaceShapesLocal,
                         testing::Values(PrimitiveKind::box, PrimitiveKind::sphere, PrimitiveKind::cylinder,
                                         PrimitiveKind::torus, PrimitiveKind::box_with_sphere));

/// The same pieces come out alone, in another order, and in the run of all: no piece knows of any other.
TEST(SurfaceMesher, PieceAloneHasTheSameBits) {
  const Meshed meshed =
      mesh_model(Communicator::world(), cad::make_primitive_domain(PrimitiveKind::cylinder), 10, 0.1);
  const CurveMesh curves = discretise_curves(meshed.model, meshed.field);
  for (const mesh::Piece& piece : meshed.surface.pieces) {
    const PieceProblem problem =
        problem_of_face(meshed.model, piece.common_face(), curves, meshed.field, {}).rest;
    mesh::Piece alone = mesh_piece(meshed.model, problem, meshed.field, {});
    alone.id = piece.id;
    EXPECT_EQ(parallel::to_wire(piece), parallel::to_wire(alone)) << "face " << piece.common_face();
  }
}

TEST(SurfaceMesher, HashDoesNotDependOnRanks) {
  const cad::Model model = cad::make_primitive_domain(PrimitiveKind::box_with_sphere);
  references::expect_as_on_one_rank([&](const Communicator& communicator) {
    const Meshed meshed = mesh_model(communicator, model, 8, 0.1);
    return mesh::hash_mesh(meshed.surface);
  });
}

}  // namespace
}  // namespace aeroloom::surface
