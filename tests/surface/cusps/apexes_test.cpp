/// Faces that run to a point: cones in one face, in halves, in thirds.
#include "surface/cusps/apexes.hpp"

#include "surface/piece_mesher.hpp"
#include "surface/surface_mesher.hpp"
#include "tests/cad/cad_shapes.hpp"
#include "tests/surface/face_fixture.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <gp_Ax2.hxx>
#include <gtest/gtest.h>

namespace aeroloom::surface {
namespace {

using cad::Model;
using geometry::Vec3;

constexpr double height = 2;

/// But for rounding of the CAD library.
bool is_apex(Vec3 p) {
  return distance(p, {0, 0, height}) < 1e-12;
}

double base_radius(double degrees) {
  return height * std::tan(degrees * std::numbers::pi / 180);
}

/// A cone so many degrees about its axis, its side in as many faces.
TopoDS_Shape cone(double degrees, int faces) {
  const double part = 2 * std::numbers::pi / faces;
  TopoDS_Shape whole;
  for (int i = 0; i < faces; ++i) {
    const gp_Ax2 axes({0, 0, 0}, {0, 0, 1}, {std::cos(0.3 + i * part), std::sin(0.3 + i * part), 0});
    const TopoDS_Shape one = BRepPrimAPI_MakeCone(axes, base_radius(degrees), 0, height, part).Shape();
    whole = i == 0 ? one : BRepAlgoAPI_Fuse(whole, one).Shape();
  }
  return whole;
}

struct Shape {
  double degrees = 0;
  int faces = 1;
};

class Apexes : public ::testing::TestWithParam<Shape> {
protected:
  Apexes() : _model(cad::shapes::prepare_fluid(cone(GetParam().degrees, GetParam().faces)).model) {}

  /// The mesh; throws where triangles cross or lie on each other.
  SurfaceMesh mesh(const parallel::Communicator& communicator) const {
    const double size = 0.1;
    const sizing::SizeField field =
        sizing::build_size_field(communicator, _model, {0.5 * size, size, 15, 1.3, 0});
    return mesh_surface(_model, field, {});
  }

  void expect_mesh_to_the_point() const;

  Model _model;
};
class ApexesLocal : public Apexes {};

void Apexes::expect_mesh_to_the_point() const {
  const auto communicator = parallel::Communicator::world();
  const SurfaceMesh surface = mesh(communicator);
  double volume = 0;
  std::int64_t at_apex = 0;
  for (const mesh::Piece& piece : surface.pieces) {
    for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const mesh::LocalIndex* v = piece.cell(t);
      const Vec3 a = piece.point(v[0]), b = piece.point(v[1]), c = piece.point(v[2]);
      volume += dot(a, cross(b, c)) / 6;
      at_apex += is_apex(a) || is_apex(b) || is_apex(c);
    }
    for (mesh::LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      if (is_apex(piece.point(v))) {
        EXPECT_EQ(piece.vertex_dimension[v], mesh::CadDimension::vertex);
      }
    }
  }
  EXPECT_GE(communicator.sum(at_apex), 3);
  const double radius = base_radius(GetParam().degrees);
  const double wanted = std::numbers::pi * radius * radius * height / 3;
  EXPECT_NEAR(std::abs(communicator.sum(volume)), wanted, 0.1 * wanted);
}

TEST_P(Apexes, AreMeshedUpToTheirPoint) {
  expect_mesh_to_the_point();
}
TEST_P(ApexesLocal, AreMeshedUpToTheirPoint) {
  expect_mesh_to_the_point();
}

std::string name_of(const ::testing::TestParamInfo<Shape>& each) {
  return "of_" + std::to_string(static_cast<int>(each.param.degrees)) + "_degrees_in_" +
         std::to_string(each.param.faces);
}

INSTANTIATE_TEST_SUITE_P(Cones, Apexes, ::testing::Values(Shape{10, 2}, Shape{10, 3}), name_of);
INSTANTIATE_TEST_SUITE_P(Cones, ApexesLocal,
                         ::testing::Values(Shape{4, 1}, Shape{10, 1}, Shape{20, 1}, Shape{45, 1}, Shape{4, 2},
                                           Shape{20, 2}, Shape{30, 2}),
                         name_of);

std::vector<Apex> apexes_of(const TopoDS_Shape& shape) {
  const Model model = cad::shapes::prepare_fluid(shape).model;
  const sizing::SizeField field =
      sizing::build_size_field(parallel::Communicator::self(), model, {0.05, 0.1, 15, 1.3, 0});
  const CurveMesh curves = discretise_curves(model, field);
  std::vector<Apex> apexes;
  for (cad::FaceId face = 0; face < model.face_count(); ++face) {
    FaceVertices vertices;
    const ChartSurface surface =
        build_chart_surface(model, face, curves, chart_facets(model, face, {}), field, vertices);
    const auto found = find_apexes(model, surface);
    apexes.insert(apexes.end(), found.begin(), found.end());
  }
  return apexes;
}

TEST(FindApexesLocal, KnowsACone) {
  const auto apexes = apexes_of(cone(20, 1));
  ASSERT_EQ(apexes.size(), 1u);
  EXPECT_TRUE(is_apex(apexes[0].point));
  EXPECT_NEAR(apexes[0].angle, 2 * std::numbers::pi * std::sin(20 * std::numbers::pi / 180), 0.05);
}

// A plane of squares: the second apex's disk would take the first apex with it.
TEST(CapApexesLocal, LeavesAnotherApexInPlace) {
  constexpr int side = 20;
  FaceMesh mesh;
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      mesh.points.push_back({0.1 * column, 0.1 * row, 0});
      mesh.uv.push_back({0.1 * column, 0.1 * row});
    }
  }
  for (int i = 0; i < side * (side - 1); ++i) {
    if (i % side == side - 1) continue;
    mesh.triangles.push_back({i, i + 1, i + side});
    mesh.triangles.push_back({i + 1, i + side + 1, i + side});
  }
  const Model model = cad::shapes::prepare_fluid(cone(20, 1)).model;
  const sizing::SizeField field =
      sizing::build_size_field(parallel::Communicator::self(), model, {0.1, 0.1, 15, 1.3, 0});
  const Vec3 first{0.93, 0.94, 0}, second{0.95, 1, 0};
  cap_apexes(field, {{0, first, {0.93, 0.94}, 4}, {1, second, {0.95, 1}, 4}}, mesh);
  ASSERT_EQ(mesh.apexes.size(), 1u);
  EXPECT_EQ(mesh.apexes[0].vertex, 0);
  EXPECT_EQ(mesh.points[static_cast<std::size_t>(mesh.apexes[0].at)], first);
  double area = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3 a = mesh.points[t[0]];
    const double twice = cross(mesh.points[t[1]] - a, mesh.points[t[2]] - a).z;
    EXPECT_GT(twice, 0);
    area += 0.5 * twice;
  }
  EXPECT_NEAR(area, std::pow(0.1 * (side - 1), 2), 1e-12);
}

TEST(FindApexesLocal, TakesNoPoleOfASmoothFace) {
  EXPECT_TRUE(apexes_of(BRepPrimAPI_MakeSphere(1).Shape()).empty());
}

}  // namespace
}  // namespace aeroloom::surface
