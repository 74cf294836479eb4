#include "cad/repair/plane_loops.hpp"
#include "tests/cad/cad_shapes.hpp"
#include "tests/cad/model_checks.hpp"

#include <cmath>
#include <numbers>

#include <BRepAdaptor_Surface.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <fmt/format.h>
#include <gp_Ax2.hxx>

namespace aeroloom::cad {
namespace {

using shapes::changes_about;
using shapes::compound_of;
using shapes::faces_of;
using shapes::prepare_fluid;
using shapes::volume_of;
using shapes::without;
using std::numbers::pi;

constexpr double outer_radius = 1, inner_radius = 0.6, height = 2;

TopoDS_Shape make_box() {
  return BRepPrimAPI_MakeBox(1, 2, 3).Shape();
}

TopoDS_Shape make_tube() {
  return BRepAlgoAPI_Cut(BRepPrimAPI_MakeCylinder(outer_radius, height).Shape(),
                         BRepPrimAPI_MakeCylinder(inner_radius, height).Shape())
      .Shape();
}

/// What is known of one cap.
struct Expected {
  std::string name;
  Vec3 center;
  double area;
};

std::vector<FaceId> faces_called(const Model& model, const std::string& name) {
  std::vector<FaceId> faces;
  for (FaceId f = 0; f < model.face_count(); ++f)
    if (model.face(f).name == name) faces.push_back(f);
  return faces;
}

void expect_cap(const Domain& domain, const Expected& cap) {
  const Changes made = changes_about(domain.report.changes, fmt::format("named '{}'", cap.name));
  ASSERT_EQ(made.size(), 1u) << cap.name;
  EXPECT_NE(made[0].what.find(fmt::format("a planar opening of area {:.6g} closed", cap.area)),
            std::string::npos)
      << made[0].what;
  ASSERT_TRUE(made[0].where.has_value());
  EXPECT_LT(distance(*made[0].where, cap.center), 1e-6);
  EXPECT_LT(made[0].how_much, 1e-9);
  const std::vector<FaceId> faces = faces_called(domain.model, cap.name);
  ASSERT_EQ(faces.size(), 1u) << cap.name;
  EXPECT_TRUE(shapes::faces_of_patch(domain.model, cap.name).empty()) << "it joins the wall around it";
  EXPECT_NEAR(domain.model.face_area(faces[0]), cap.area, 1e-6);
  checks::expect_sound_facets(domain.model, faces[0], 0.01, 0.2, 1e-6);
}

/// Caps in the order of their places.
void expect_capped(const Domain& domain, int faces, double volume, const std::vector<Expected>& caps) {
  EXPECT_EQ(domain.model.region_count(), 1);
  EXPECT_EQ(domain.model.face_count(), faces);
  checks::expect_watertight(domain.model);
  EXPECT_NEAR(volume_of(domain.model.data().shape), volume, 1e-6);
  EXPECT_GT(checks::facets_volume(domain.model, 0.01, 0.2), 0.95 * volume);
  EXPECT_EQ(changes_about(domain.report.changes, "planar opening").size(), caps.size());
  for (const Expected& cap : caps) expect_cap(domain, cap);
}

TEST(Caps, CloseABoxWithoutLid) {
  const Domain domain = prepare_fluid(compound_of(without(faces_of(make_box()), {{0.5, 1, 3}})));
  expect_capped(domain, 6, 6, {{"cap_1", {0.5, 1, 3}, 2}});
}

TEST(Caps, JoinThePatchOfMostOfTheirBorder) {
  const TopoDS_Shape open = compound_of(without(faces_of(make_box()), {{0.5, 1, 3}}));
  const Model joined = prepare_fluid(open).model;
  const std::string patch = joined.patches()[joined.face(faces_called(joined, "cap_1").at(0)).patch];
  EXPECT_TRUE(patch == "xmin" || patch == "xmax") << patch;
  DomainOptions options;
  options.kind = DomainKind::fluid;
  options.caps = Caps::name;
  EXPECT_EQ(shapes::faces_of_patch(shapes::prepare(open, options).model, "cap_1").size(), 1u);
}

TEST(Caps, CloseABoxOfLooseFaces) {
  const Domain domain = prepare_fluid(compound_of(without(shapes::loose_faces(make_box()), {{0.5, 1, 3}})));
  expect_capped(domain, 6, 6, {{"cap_1", {0.5, 1, 3}, 2}});
}

TEST(Caps, CloseBothEndsOfABox) {
  const Domain domain = prepare_fluid(compound_of(without(faces_of(make_box()), {{0.5, 1, 3}, {0.5, 1, 0}})));
  const Changes made = changes_about(domain.report.changes, "planar opening");
  ASSERT_EQ(made.size(), 2u);
  const double first = made[0].where->z, second = made[1].where->z;
  EXPECT_NEAR(first + second, 3, 1e-9);
  expect_capped(domain, 6, 6, {{"cap_1", {0.5, 1, first}, 2}, {"cap_2", {0.5, 1, second}, 2}});
}

TEST(Caps, BetweenTwoWallsAreAnnular) {
  const double ring = pi * (outer_radius * outer_radius - inner_radius * inner_radius);
  const std::vector<TopoDS_Face> faces = faces_of(make_tube());
  const Domain one = prepare_fluid(compound_of(without(faces, {{0, 0, height}})));
  expect_capped(one, 4, ring * height, {{"cap_1", {0, 0, height}, ring}});
  const Domain both = prepare_fluid(compound_of(without(faces, {{0, 0, height}, {0, 0, 0}})));
  const double first = changes_about(both.report.changes, "'cap_1'").at(0).where->z;
  expect_capped(both, 4, ring * height,
                {{"cap_1", {0, 0, first}, ring}, {"cap_2", {0, 0, height - first}, ring}});
  for (const FaceId f : faces_called(both.model, "cap_2")) EXPECT_EQ(both.model.face(f).loops.size(), 2u);
}

TEST(Caps, CloseABallWithASmallHole) {
  constexpr double latitude = -1.2;
  const TopoDS_Shape ball = BRepPrimAPI_MakeSphere(1, latitude, pi / 2).Shape();
  const Vec3 hole{0, 0, std::sin(latitude)};
  const Domain domain = prepare_fluid(compound_of(without(faces_of(ball), {hole})));
  expect_capped(domain, 2, volume_of(ball), {{"cap_1", hole, pi * std::pow(std::cos(latitude), 2)}});
}

TEST(Caps, CurvedRimsAreRefusedWithTheirEdges) {
  const gp_Ax2 across(gp_Pnt(-2, 0, height), gp_Dir(1, 0, 0));
  const TopoDS_Shape saddle = BRepAlgoAPI_Cut(BRepPrimAPI_MakeCylinder(outer_radius, height).Shape(),
                                              BRepPrimAPI_MakeCylinder(across, 1.5, 4).Shape())
                                  .Shape();
  std::vector<TopoDS_Face> faces = faces_of(saddle);
  std::erase_if(faces, [](const TopoDS_Face& face) {
    const BRepAdaptor_Surface surface(face);
    return surface.GetType() == GeomAbs_Cylinder && std::abs(surface.Cylinder().Axis().Direction().X()) > 0.9;
  });
  ASSERT_EQ(faces.size(), 2u);
  const std::string message = shapes::refusal(compound_of(faces));
  EXPECT_NE(message.find("open edges: at ("), std::string::npos) << message;
  EXPECT_NE(message.find("openings are no small planar ones"), std::string::npos) << message;
}

TEST(Caps, DoNotMakeASheetABody) {
  const TopoDS_Face square = faces_of(make_box())[0];
  EXPECT_NE(shapes::refusal(square).find("bounds no volume: 4 open edges: at ("), std::string::npos);
  // Of a cylinder and of a ball: patches with little curvature.
  const TopoDS_Shape bent = BRepPrimAPI_MakeCylinder(1, 2, 0.8).Shape();
  const TopoDS_Shape dome = BRepPrimAPI_MakeSphere(1, 0.6, pi / 2).Shape();
  for (const TopoDS_Shape& solid : {bent, dome}) {
    const std::string message = shapes::refusal(faces_of(solid)[0]);
    EXPECT_NE(message.find("bounds no volume"), std::string::npos) << message;
  }
}

TEST(Caps, AreAsWideAsTheCaseWants) {
  const TopoDS_Shape tray =
      compound_of(without(faces_of(BRepPrimAPI_MakeBox(3, 3, 0.2).Shape()), {{1.5, 1.5, 0.2}}));
  DomainOptions options;
  options.kind = DomainKind::fluid;
  EXPECT_THROW(shapes::prepare(tray, options), CadError);
  options.close = {"-1 -1 0.1 4 4 1"};
  EXPECT_NEAR(shapes::prepare(tray, options).model.region_volume(0), 1.8, 1e-9);
  options.close = {"-1 -1 -1 -0.5 4 1"};
  EXPECT_THROW(shapes::prepare(tray, options), CadError);
  options.close = {"refuse"};
  const TopoDS_Shape box = compound_of(without(faces_of(make_box()), {{0.5, 1, 3}}));
  EXPECT_THROW(shapes::prepare(box, options), CadError);
}

TEST(Caps, DoNotMakeSheetsOfSeveralFacesABody) {
  const TopoDS_Shape first = BRepPrimAPI_MakeBox(gp_Pnt(0, 0, 0), 1, 1, 1).Shape();
  const TopoDS_Shape second = BRepPrimAPI_MakeBox(gp_Pnt(1, 0, 0), 1, 1, 1).Shape();
  std::vector<TopoDS_Face> floor;
  for (const TopoDS_Shape& box : {first, second}) {
    for (const TopoDS_Face& face : faces_of(box)) {
      if (shapes::center_of(face).z == 0) floor.push_back(face);
    }
  }
  ASSERT_EQ(floor.size(), 2u);
  const std::string message = shapes::refusal(compound_of(floor));
  EXPECT_NE(message.find("6 open edges"), std::string::npos) << message;
}

/// Edges along a polygon with common vertices.
std::vector<TopoDS_Edge> polygon(const std::vector<gp_Pnt>& corners) {
  std::vector<TopoDS_Vertex> vertices;
  for (const gp_Pnt& corner : corners) vertices.push_back(BRepBuilderAPI_MakeVertex(corner).Vertex());
  std::vector<TopoDS_Edge> edges;
  for (std::size_t i = 0; i < vertices.size(); ++i)
    edges.push_back(BRepBuilderAPI_MakeEdge(vertices[i], vertices[(i + 1) % vertices.size()]).Edge());
  return edges;
}

std::vector<gp_Pnt> square(double half, double z) {
  return {{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}};
}

TEST(Openings, TellHowFarTheyLeaveTheirPlane) {
  std::vector<gp_Pnt> corners = square(1, 0);
  corners[2].SetZ(1e-5);
  const std::vector<Cap> caps = cap_openings(polygon(corners), 1e-4);
  ASSERT_EQ(caps.size(), 1u);
  EXPECT_NEAR(caps[0].area, 4, 1e-6);
  EXPECT_GT(caps[0].deviation, 1e-6);
  EXPECT_LT(caps[0].deviation, 1e-5);
  EXPECT_TRUE(cap_openings(polygon(corners), 1e-6).empty());
}

TEST(Openings, OfOnePlaneAreNested) {
  std::vector<TopoDS_Edge> edges;
  for (const double half : {1.0, 3.0, 2.0}) {
    for (const TopoDS_Edge& edge : polygon(square(half, 0.5))) edges.push_back(edge);
  }
  for (const TopoDS_Edge& edge : polygon(square(0.5, 4))) edges.push_back(edge);
  const std::vector<Cap> caps = cap_openings(edges, 1e-6);
  ASSERT_EQ(caps.size(), 3u);
  EXPECT_NEAR(caps[0].area, 4, 1e-9);
  EXPECT_NEAR(caps[1].area, 36 - 16, 1e-9);
  EXPECT_NEAR(caps[2].area, 1, 1e-9);
  EXPECT_NEAR(caps[2].center.z, 4, 1e-9);
}

TEST(Openings, MustBeSimpleClosedLoops) {
  std::vector<TopoDS_Edge> chain = polygon(square(1, 0));
  chain.pop_back();
  EXPECT_TRUE(cap_openings(chain, 1e-6).empty());
  // Two triangles that meet in a vertex.
  const TopoDS_Vertex common = BRepBuilderAPI_MakeVertex(gp_Pnt(0, 0, 0)).Vertex();
  std::vector<TopoDS_Edge> eight;
  for (const double side : {-1.0, 1.0}) {
    const TopoDS_Vertex a = BRepBuilderAPI_MakeVertex(gp_Pnt(side, -1, 0)).Vertex();
    const TopoDS_Vertex b = BRepBuilderAPI_MakeVertex(gp_Pnt(side, 1, 0)).Vertex();
    eight.push_back(BRepBuilderAPI_MakeEdge(common, a).Edge());
    eight.push_back(BRepBuilderAPI_MakeEdge(a, b).Edge());
    eight.push_back(BRepBuilderAPI_MakeEdge(b, common).Edge());
  }
  EXPECT_TRUE(cap_openings(eight, 1e-6).empty());
}

}  // namespace
}  // namespace aeroloom::cad
