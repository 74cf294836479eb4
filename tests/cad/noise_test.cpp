// What is below the tolerance of noise is closed before it becomes a model; what is above stays.
#include "cad/repair/noise.hpp"

#include "cad/repair/noise_faces.hpp"
#include "tests/cad/blunt_shapes.hpp"
#include "tests/cad/model_checks.hpp"
#include "tests/cad/strip_shapes.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <GC_MakeArcOfCircle.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <gp_Pln.hxx>
#include <gtest/gtest.h>

namespace aeroloom::cad {
namespace {

using shapes::polygon;
constexpr double noise = 3e-7;  // wide; bodies are about one large

/// Faces that are only as far apart as their numbers, made to share edges.
TopoDS_Shape sewn(const std::vector<TopoDS_Face>& faces) {
  BRepBuilderAPI_Sewing sewing(1e-8);
  for (const TopoDS_Face& face : faces) sewing.Add(face);
  sewing.Perform();
  EXPECT_EQ(sewing.NbFreeEdges(), 0);
  return sewing.SewedShape();
}

/// The unit cube without its top, whose outline is cut at the given places along x at y = 0 and y = 1.
std::vector<TopoDS_Face> open_cube() {
  return {polygon({{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}}),
          polygon({{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}}),
          polygon({{1, 0, 0}, {1, 1, 0}, {1, 1, 1}, {1, 0, 1}}),
          polygon({{1, 1, 0}, {0, 1, 0}, {0, 1, 1}, {1, 1, 1}}),
          polygon({{0, 1, 0}, {0, 0, 0}, {0, 0, 1}, {0, 1, 1}})};
}

TopoDS_Shape cube_with_top(const std::vector<TopoDS_Face>& top) {
  std::vector<TopoDS_Face> faces = open_cube();
  faces.insert(faces.end(), top.begin(), top.end());
  return sewn(faces);
}

double shortest_edge(const Model& model) {
  double shortest = std::numeric_limits<double>::infinity();
  for (EdgeId e = 0; e < model.edge_count(); ++e) {
    const Edge& edge = model.edge(e);
    if (edge.degenerate) continue;
    double length = 0;
    constexpr int steps = 16;
    const auto at = [&](int k) {
      return model.edge_point(
          e, edge.first_parameter + (edge.last_parameter - edge.first_parameter) * k / steps);
    };
    for (int k = 0; k < steps; ++k) length += distance(at(k), at(k + 1));
    shortest = std::min(shortest, length);
  }
  return shortest;
}

/// The shape as a fluid without noise.
Model closed_model(const TopoDS_Shape& shape, int faces, int said, double volume) {
  const Domain domain = shapes::prepare_fluid(shape);
  const Model& model = domain.model;
  EXPECT_EQ(model.face_count(), faces);
  EXPECT_EQ(shapes::changes_about(domain.report.changes, "below the noise").size(),
            static_cast<std::size_t>(said));
  for (const Change& change : shapes::changes_about(domain.report.changes, "stays"))
    ADD_FAILURE() << change.what;
  EXPECT_GT(shortest_edge(model), 1e-3);
  checks::expect_watertight(model);
  checks::expect_closed_loops(model, 1e-5);
  for (FaceId f = 0; f < model.face_count(); ++f) {
    EXPECT_GT(model.face_area(f), 1e-3);
    checks::expect_sound_facets(model, f, 1e-2, 0.3, 1e-5);
  }
  EXPECT_NEAR(checks::facets_volume(model, 1e-4, 0.05), volume, 1e-3 * volume);
  return model;
}

TEST(Noise, ToleranceHeedsSizeAndPrecision) {
  EXPECT_DOUBLE_EQ(noise_tolerance(10, 0, 0), 2e-5);
  EXPECT_DOUBLE_EQ(noise_tolerance(10, 1e-7, 0), 2e-5);
  EXPECT_DOUBLE_EQ(noise_tolerance(10, 2e-5, 0), 4e-5);
  EXPECT_DOUBLE_EQ(noise_tolerance(10, 1, 0), 1e-4) << "a hundred thousandth of the diagonal at most";
  EXPECT_DOUBLE_EQ(noise_tolerance(10, 0, 1e-4), 1e-5) << "a tenth of the smallest size at most";
}

TEST(Noise, WidthIsThatOfTheStrip) {
  const TopoDS_Face strip = polygon({{0, 0, 0}, {1, 0, 0}, {1, 1e-6, 0}, {0, 1e-6, 0}});
  const auto found = examine_noise(strip, 2e-6);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->widest, 1e-6, 5e-8);
  EXPECT_FALSE(examine_noise(strip, 0.9e-6));
  EXPECT_FALSE(examine_noise(polygon({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), 2e-6));
}

TEST(Noise, BluntEndBecomesAnEdge) {
  closed_model(shapes::prism({{0, -0.2}, {1, -0.5 * noise}, {1, 0.5 * noise}, {0, 0.2}}, 1), 5, 1, 0.2);
}

TEST(Noise, StripsBesideEachOther) {
  closed_model(shapes::prism({{0, -0.2}, {1, -noise}, {1 + noise, 0}, {1, noise}, {0, 0.2}}, 1), 5, 2, 0.2);
}

TEST(Noise, StripInASmoothSide) {
  closed_model(cube_with_top({polygon({{0, 0, 1}, {0.4, 0, 1}, {0.4, 1, 1}, {0, 1, 1}}),
                              polygon({{0.4, 0, 1}, {0.4 + noise, 0, 1}, {0.4 + noise, 1, 1}, {0.4, 1, 1}}),
                              polygon({{0.4 + noise, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0.4 + noise, 1, 1}})}),
               7, 1, 1);
}

TEST(Noise, StripAroundACorner) {
  const double a = 0.4, b = 0.4 + noise;
  closed_model(cube_with_top({polygon({{0, 0, 1}, {a, 0, 1}, {a, b, 1}, {1, b, 1}, {1, 1, 1}, {0, 1, 1}}),
                              polygon({{a, 0, 1}, {b, 0, 1}, {b, a, 1}, {1, a, 1}, {1, b, 1}, {a, b, 1}}),
                              polygon({{b, 0, 1}, {1, 0, 1}, {1, a, 1}, {b, a, 1}})}),
               7, 1, 1);
}

TEST(Noise, FaceShapedLikeATee) {
  const double a = 0.4, b = 0.4 + noise;
  closed_model(
      cube_with_top(
          {polygon({{0, 0, 1}, {1, 0, 1}, {1, a, 1}, {0, a, 1}}),
           polygon({{0, a, 1}, {1, a, 1}, {1, b, 1}, {b, b, 1}, {b, 1, 1}, {a, 1, 1}, {a, b, 1}, {0, b, 1}}),
           polygon({{0, b, 1}, {a, b, 1}, {a, 1, 1}, {0, 1, 1}}),
           polygon({{b, b, 1}, {1, b, 1}, {1, 1, 1}, {b, 1, 1}})}),
      8, 1, 1);
}

TEST(Noise, TriangleAlongAnEdge) {
  closed_model(cube_with_top({polygon({{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1 - noise, 1}}),
                              polygon({{0, 1 - noise, 1}, {1, 1, 1}, {0, 1, 1}})}),
               6, 1, 1);
}

TEST(Noise, SlotFromTheRimInOneFace) {
  const double a = 0.4, b = 0.4 + noise;
  closed_model(
      cube_with_top(
          {polygon(
               {{0, 0, 1}, {a, 0, 1}, {a, 0.5, 1}, {b, 0.5, 1}, {b, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}),
           polygon({{a, 0, 1}, {b, 0, 1}, {b, 0.5, 1}, {a, 0.5, 1}})}),
      6, 1, 1);
}

TEST(Noise, LensInsideAFace) {
  const gp_Pnt a(0.3, 0.5, 1), b(0.7, 0.5, 1);
  const auto arc = [&](double bulge) {
    return BRepBuilderAPI_MakeEdge(GC_MakeArcOfCircle(a, gp_Pnt(0.5, 0.5 + bulge, 1), b).Value()).Edge();
  };
  const TopoDS_Edge low = arc(0.1), high = arc(0.1 + noise);
  const BRepBuilderAPI_MakeWire wire = [&] {
    BRepBuilderAPI_MakeWire made(low, TopoDS::Edge(high.Reversed()));
    return made;
  }();
  BRepBuilderAPI_MakeWire lens = wire;
  const TopoDS_Face strip = BRepBuilderAPI_MakeFace(gp_Pln(a, gp::DZ()), lens.Wire()).Face();
  BRepBuilderAPI_MakeFace top(polygon({{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}));
  top.Add(TopoDS::Wire(lens.Wire().Reversed()));
  closed_model(cube_with_top({top.Face(), strip}), 6, 1, 1);
}

TEST(Noise, SameFaceOnBothSidesOfAStrip) {
  // A cylinder whose side is one face but for a strip: it becomes a seam.
  const gp_Circ circle(gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), 1);
  BRepBuilderAPI_MakeWire wire(BRepBuilderAPI_MakeEdge(circle, 0, 2 * noise).Edge(),
                               BRepBuilderAPI_MakeEdge(circle, 2 * noise, 2 * std::numbers::pi).Edge());
  closed_model(BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(wire.Wire()).Face(), gp_Vec(0, 0, 2)).Shape(), 3,
               1, 2 * std::numbers::pi);
}

TEST(Noise, LooseStripsAsWideAsWhatIsSewn) {
  // Sewing with a tolerance of the strip's width would lay its neighbour's two ends on one another.
  const gp_Circ circle(gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), 1);
  const double diagonal = std::sqrt(12);
  for (const double share : {3e-8, 0.98e-7, 3e-7}) {
    const double cut = share * diagonal;
    BRepBuilderAPI_MakeWire wire(BRepBuilderAPI_MakeEdge(circle, 0, cut).Edge(),
                                 BRepBuilderAPI_MakeEdge(circle, cut, 2 * std::numbers::pi).Edge());
    const TopoDS_Shape cylinder =
        BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(wire.Wire()).Face(), gp_Vec(0, 0, 2)).Shape();
    closed_model(shapes::compound_of(shapes::loose_faces(cylinder)), 3, 1, 2 * std::numbers::pi);
  }
}

TEST(Noise, StripBetweenSplines) {
  const gp_Circ circle(gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), 1);
  BRepBuilderAPI_MakeWire wire(
      BRepBuilderAPI_MakeEdge(circle, 0, 2 * noise).Edge(),
      BRepBuilderAPI_MakeEdge(circle, 2 * noise, std::numbers::pi).Edge(),
      BRepBuilderAPI_MakeEdge(circle, std::numbers::pi, 2 * std::numbers::pi).Edge());
  BRepPrimAPI_MakePrism prism(BRepBuilderAPI_MakeFace(wire.Wire()).Face(), gp_Vec(0, 0, 2));
  closed_model(BRepBuilderAPI_NurbsConvert(prism.Shape()).Shape(), 4, 1, 2 * std::numbers::pi);
}

TEST(Noise, RingWithClosedSides) {
  const Handle(Geom_Surface) side = new Geom_CylindricalSurface(gp_Ax3(gp::Origin(), gp::DZ()), 1);
  std::vector<TopoDS_Face> faces;
  const double turn = 2 * std::numbers::pi;
  for (const auto& [low, high] : {std::pair(0.0, 1.0), std::pair(1.0, 1 + noise), std::pair(1 + noise, 2.0)})
    faces.push_back(BRepBuilderAPI_MakeFace(side, 0, turn, low, high, 1e-9).Face());
  for (const double z : {0.0, 2.0}) {
    const gp_Ax2 axes(gp_Pnt(0, 0, z), gp::DZ());
    BRepBuilderAPI_MakeWire wire(BRepBuilderAPI_MakeEdge(gp_Circ(axes, 1)).Edge());
    faces.push_back(BRepBuilderAPI_MakeFace(gp_Pln(gp_Ax3(axes)), wire.Wire()).Face());
  }
  closed_model(sewn(faces), 4, 1, 2 * std::numbers::pi);
}

TEST(Noise, RidgeBecomesATip) {
  // A hip roof whose ridge is noise.
  const Vec3 a{0.5 - 0.5 * noise, 0.5, 1.5}, b{0.5 + 0.5 * noise, 0.5, 1.5};
  const std::vector<TopoDS_Face> roof{
      polygon({{0, 0, 1}, {1, 0, 1}, b, a}), polygon({{1, 0, 1}, {1, 1, 1}, b}),
      polygon({{1, 1, 1}, {0, 1, 1}, a, b}), polygon({{0, 1, 1}, {0, 0, 1}, a})};
  closed_model(cube_with_top(roof), 9, 1, 1 + 0.5 / 3);
}

TEST(Noise, WiderStripsStay) {
  const double wide = 1e-4;
  const Domain domain =
      shapes::prepare_fluid(shapes::prism({{0, -0.2}, {1, -0.5 * wide}, {1, 0.5 * wide}, {0, 0.2}}, 1));
  EXPECT_EQ(domain.model.face_count(), 6);
  EXPECT_TRUE(shapes::changes_about(domain.report.changes, "noise").empty());
}

TEST(Noise, LooseFacesToo) {
  const TopoDS_Shape wedge = shapes::prism({{0, -0.2}, {1, -0.5 * noise}, {1, 0.5 * noise}, {0, 0.2}}, 1);
  const Domain domain = shapes::prepare_fluid(shapes::compound_of(shapes::loose_faces(wedge)));
  EXPECT_EQ(domain.model.face_count(), 5);
  EXPECT_GT(shortest_edge(domain.model), 1e-3);
  checks::expect_watertight(domain.model);
}

}  // namespace
}  // namespace aeroloom::cad
