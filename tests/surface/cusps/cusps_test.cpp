/// The cusp of a face between two curves tangent to each other is closed, and nothing sharp stays there.
#include "surface/cusps/cusps.hpp"

#include "mesh/checks/validity.hpp"
#include "mesh/quality/quality.hpp"
#include "sizing/field/closed_corners.hpp"
#include "surface/curves/cusp_alignment.hpp"
#include "surface/surface_mesher.hpp"
#include "tests/cad/cad_shapes.hpp"
#include "tests/references.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <GC_MakeArcOfCircle.hxx>
#include <gp_Pln.hxx>
#include <gtest/gtest.h>

namespace aeroloom::surface {
namespace {

using cad::Model;
using geometry::Vec3;
using parallel::Communicator;

constexpr double radius = 4;
/// Where the arc leaves the cube.
const double arc_end = radius - std::sqrt(radius * radius - 1);

TopoDS_Face polygon(const std::vector<gp_Pnt>& corners) {
  BRepBuilderAPI_MakePolygon wire;
  for (const gp_Pnt& corner : corners) wire.Add(corner);
  wire.Close();
  return BRepBuilderAPI_MakeFace(wire.Wire()).Face();
}

/// A part of the cube's top: beside the arc from (0, 0, 1) to (1, arc_end, 1), which leaves the edge y = 0
/// along it, and the corners.
TopoDS_Face beside_arc(const std::vector<gp_Pnt>& corners) {
  const double half = 0.5 * std::asin(1 / radius);
  const gp_Pnt first(0, 0, 1), last(1, arc_end, 1);
  const gp_Pnt middle(radius * std::sin(half), radius * (1 - std::cos(half)), 1);
  BRepBuilderAPI_MakeWire wire(
      BRepBuilderAPI_MakeEdge(GC_MakeArcOfCircle(first, middle, last).Value()).Edge());
  gp_Pnt from = last;
  for (const gp_Pnt& corner : corners) {
    wire.Add(BRepBuilderAPI_MakeEdge(from, corner).Edge());
    from = corner;
  }
  wire.Add(BRepBuilderAPI_MakeEdge(from, first).Edge());
  return BRepBuilderAPI_MakeFace(gp_Pln(gp_Pnt(0, 0, 1), gp_Dir(0, 0, 1)), wire.Wire()).Face();
}

/// The unit cube, its top cut in two by the arc.
Model cube_with_cusp() {
  const std::vector<TopoDS_Face> faces{
      beside_arc({{1, 0, 1}}),
      beside_arc({{1, 1, 1}, {0, 1, 1}}),
      polygon({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}),
      polygon({{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}}),
      polygon({{0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1}}),
      polygon({{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}}),
      polygon({{1, 0, 0}, {1, 1, 0}, {1, 1, 1}, {1, arc_end, 1}, {1, 0, 1}})};
  return cad::shapes::prepare_fluid(cad::shapes::compound_of(faces)).model;
}

const sizing::SizingOptions sizes{0.02, 0.1, 12, 1.3, 0};

SurfaceMesh mesh_cube(const Communicator& communicator, const Model& model) {
  return mesh_surface(model, sizing::build_size_field(communicator, model, sizes), {});
}

double least_angle(const mesh::DistributedMesh& surface) {
  double least = 180;
  for (const mesh::Piece& piece : surface.pieces) {
    for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const mesh::LocalIndex* v = piece.cell(t);
      least = std::min(least, mesh::smallest_angle(piece.point(v[0]), piece.point(v[1]), piece.point(v[2])));
    }
  }
  return least;
}

TEST(CuspsLocal, AreClosedAsFarAsTheirCurvesAreOne) {
  const Communicator communicator = Communicator::world();
  const Model model = cube_with_cusp();
  const SurfaceMesh surface = mesh_cube(communicator, model);
  ASSERT_EQ(surface.report.closed_cusps.size(), 1u);
  const ClosedCusp& cusp = surface.report.closed_cusps.front();
  EXPECT_LT(distance(cusp.point, {0, 0, 1}), 1e-9);
  // The arc is x^2 / (2 radius) from the edge.
  const double widest = sizing::closing_gap(sizes);
  EXPECT_LT(cusp.length, std::sqrt(2 * radius * widest) * 1.01);
  EXPECT_GT(cusp.length, 0.4 * std::sqrt(2 * radius * widest));
  EXPECT_GT(cusp.moved, 0);
  EXPECT_LE(cusp.moved, 0.5 * sizes.minimum);
  EXPECT_GT(least_angle(surface), 5);
}

TEST(CuspsLocal, LeaveAValidSurfaceOfTheSameArea) {
  const Communicator communicator = Communicator::world();
  const Model model = cube_with_cusp();
  const SurfaceMesh surface = mesh_cube(communicator, model);
  EXPECT_TRUE(mesh::check_surface_mesh(surface).valid());
  double area = 0;
  for (const mesh::Piece& piece : surface.pieces) {
    mesh::require_consistent_arrays(piece);
    for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const mesh::LocalIndex* v = piece.cell(t);
      const Vec3 a = piece.point(v[0]);
      area += 0.5 * norm(cross(piece.point(v[1]) - a, piece.point(v[2]) - a));
    }
  }
  EXPECT_NEAR(communicator.sum(area), 6, 1e-4);
}

TEST(Cusps, AreClosedAlikeOnAnyNumberOfRanks) {
  const Model model = cube_with_cusp();
  references::expect_as_on_one_rank([&](const Communicator& communicator) {
    const mesh::DistributedMesh surface = mesh_cube(communicator, model);
    return mesh::hash_mesh(mesh::number_mesh(surface));
  });
}

TEST(CuspsLocal, KeepExactPlanes) {
  const Model model = cube_with_cusp();
  const SurfaceMesh surface = mesh_cube(Communicator::world(), model);
  ASSERT_FALSE(surface.report.closed_cusps.empty());
  for (const mesh::Piece& piece : surface.pieces) {
    const Vec3 first = piece.point(0);
    int planes = 0;
    for (int axis = 0; axis < 3; ++axis) {
      bool same = true;
      for (mesh::LocalIndex v = 0; v < piece.vertex_count(); ++v) same &= piece.point(v)[axis] == first[axis];
      planes += same ? 1 : 0;
    }
    EXPECT_EQ(planes, 1) << model.face(piece.common_face()).name;
  }
}

TEST(CuspsLocal, AskForNoSizesWhereTheyAreClosed) {
  const Model model = cube_with_cusp();
  const sizing::SizeField field = sizing::build_size_field(Communicator::world(), model, sizes);
  EXPECT_GT(field({0, 0, 1}), 2 * sizing::closing_gap(sizes));
  const double end = std::sqrt(2 * radius * sizing::closing_gap(sizes));
  EXPECT_LT(field({1.2 * end, 0, 1}), 4 * sizing::closing_gap(sizes));
}

TEST(CuspsLocal, HaveSizesThatFollowTheirWidthBehind) {
  const Model model = cube_with_cusp();
  const sizing::SizeField field = sizing::build_size_field(Communicator::world(), model, sizes);
  for (double x = 0.12; x < 0.4; x *= 1.02) {
    const double width = x * x / (2 * radius);
    EXPECT_LT(field({x, 0, 1}), 2 * width) << x;
  }
}

TEST(CuspsLocal, HaveVerticesOppositeEachOther) {
  const Model model = cube_with_cusp();
  const sizing::SizeField field = sizing::build_size_field(Communicator::world(), model, sizes);
  const CurveMesh curves = discretise_curves(model, field);
  ASSERT_FALSE(curves.sharp_corners.empty());
  const SharpCorner& corner = curves.sharp_corners.front();
  std::vector<std::vector<double>> away;
  for (const cad::EdgeEnd& end : corner.ends) {
    auto chain = curves.chain(model, end.edge);
    if (!end.first) std::reverse(chain.begin(), chain.end());
    away.emplace_back();
    for (const CurveVertex v : chain) away.back().push_back(distance(curves.points[v], {0, 0, 1}));
    EXPECT_TRUE(std::is_sorted(away.back().begin(), away.back().end()));
  }
  const double end = std::sqrt(2 * radius * sizing::closing_gap(sizes));
  for (std::size_t i = 1; away[0][i] < end; ++i) EXPECT_NEAR(away[0][i], away[1][i], 1e-9);
}

/// Vertices at these distances from the ends of two edges alone.
CurveMesh vertices_at(const Model& model, const std::array<cad::EdgeEnd, 2>& ends,
                      const std::array<std::vector<double>, 2>& distances) {
  CurveMesh curves;
  for (cad::VertexId v = 0; v < model.vertex_count(); ++v) curves.points.push_back(model.vertex(v));
  for (cad::EdgeId e = 0; e < model.edge_count(); ++e) {
    curves.first_interior.push_back(static_cast<std::int32_t>(curves.points.size()));
    for (int i = 0; i < 2; ++i) {
      std::vector<double> parameters;
      for (const double distance : distances[i]) {
        if (ends[i].edge == e) parameters.push_back(*cad::parameter_at(model, ends[i], distance));
      }
      std::sort(parameters.begin(), parameters.end());
      for (const double parameter : parameters) {
        curves.parameters.push_back(parameter);
        curves.points.push_back(model.edge_point(e, parameter));
      }
    }
  }
  curves.first_interior.push_back(static_cast<std::int32_t>(curves.points.size()));
  return curves;
}

TEST(CuspsLocal, KeepTheOrderOfVerticesOfTheOtherHalf) {
  const Model model = cube_with_cusp();
  const sizing::SizeField field = sizing::build_size_field(Communicator::world(), model, sizes);
  const SharpCorner corner = discretise_curves(model, field).sharp_corners.front();
  // Two of four are in the first half: beside the one at 0.35 the second would pass the other two.
  const std::vector<double> sparse{0.1, 0.35, 0.45}, dense{0.1, 0.15, 0.2, 0.3};
  for (const bool first_leads : {true, false}) {
    CurveMesh curves =
        vertices_at(model, corner.ends, {first_leads ? sparse : dense, first_leads ? dense : sparse});
    curves.sharp_corners = {corner};
    align_cusps(model, 1, curves);
    for (const cad::EdgeEnd& end : corner.ends) {
      const std::vector<double> along = curves.chain_parameters(model, end.edge);
      EXPECT_TRUE(std::is_sorted(along.begin(), along.end(), std::less_equal<>())) << first_leads;
    }
  }
}

TEST(CuspsLocal, StayWhereTheCurvesAreApart) {
  const Communicator communicator = Communicator::world();
  const Model model = cube_with_cusp();
  const auto field = sizing::build_size_field(communicator, model, sizes);
  const CurveMesh curves = discretise_curves(model, field);
  mesh::DistributedMesh surface = mesh_cube(communicator, model);
  EXPECT_TRUE(close_cusps(model, curves, 1e-9, surface).empty());
}

}  // namespace
}  // namespace aeroloom::surface
