#include "cad/repair/half_shells.hpp"

#include "tests/cad/cad_shapes.hpp"
#include "tests/cad/half_models.hpp"
#include "tests/cad/model_checks.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include <BRepAlgoAPI_Common.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepFill.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <gp_Ax1.hxx>
#include <gp_Ax2.hxx>
#include <gp_Trsf.hxx>

namespace aeroloom::cad {
namespace {

using shapes::changes_about;
using std::numbers::pi;

DomainOptions with_plane(std::optional<double> position = {}) {
  DomainOptions options;
  options.far_field = FarFieldOptions{.shape = FarFieldShape::hemisphere,
                                      .extent = 3,
                                      .symmetry = Symmetry::y,
                                      .symmetry_position = position};
  return options;
}

using Faces = std::vector<TopoDS_Face>;

TopoDS_Shape box(gp_Pnt low, gp_Pnt high) {
  return BRepPrimAPI_MakeBox(low, high).Shape();
}

/// Faces but those at which a coordinate of the centre of mass has a value; loose ones.
Faces open_at(const TopoDS_Shape& shape, const std::vector<std::pair<int, double>>& planes) {
  Faces faces = shapes::loose_faces(shape);
  std::erase_if(faces, [&](const TopoDS_Face& face) {
    const Vec3 center = shapes::center_of(face);
    return std::ranges::any_of(
        planes, [&](const auto& plane) { return std::abs(center[plane.first] - plane.second) < 1e-9; });
  });
  return faces;
}

TopoDS_Face polygon(const std::vector<gp_Pnt>& points) {
  BRepBuilderAPI_MakePolygon wire;
  for (const gp_Pnt& point : points) wire.Add(point);
  wire.Close();
  return BRepBuilderAPI_MakeFace(wire.Wire()).Face();
}

TopoDS_Shape moved(const Faces& faces, double by) {
  gp_Trsf along;
  along.SetTranslation(gp_Vec(0, by, 0));
  return BRepBuilderAPI_Transform(shapes::compound_of(faces), along, true).Shape();
}

/// A flat body, open where it is widest.
Faces flat_box() {
  return open_at(box({0, 0, 0}, {2, 0.2, 1}), {{1, 0}});
}

/// A flat body without its base, whose border crosses the plane: no edge of it is within reach.
TopoDS_Shape tilted() {
  gp_Trsf turn;
  turn.SetRotation(gp_Ax1({1, 0, 0}, {0, 0, 1}), 5e-4);
  const Faces faces = open_at(box({0, 0, 0}, {2, 0.1, 1}), {{1, 0}, {0, 2}});
  return BRepBuilderAPI_Transform(shapes::compound_of(faces), turn, true).Shape();
}

/// A tube along the plane, whose half has two openings on it.
Faces nacelle() {
  const gp_Ax2 axis({0, 0, 0}, {1, 0, 0});
  const TopoDS_Shape tube = BRepAlgoAPI_Cut(BRepPrimAPI_MakeCylinder(axis, 1, 4).Shape(),
                                            BRepPrimAPI_MakeCylinder(axis, 0.6, 4).Shape())
                                .Shape();
  return open_at(BRepAlgoAPI_Common(tube, box({-1, 0, -2}, {5, 2, 2})).Shape(), {{1, 0}});
}

/// A fuselage with a fin that lies on the plane. The fin has neither its blunt base nor its tip.
Faces fin() {
  const TopoDS_Shape fuselage = box({0, 0, 0}, {3, 0.5, 0.5}), on_it = box({1, 0, 0.5}, {2.5, 0.05, 1.5});
  Faces faces = open_at(BRepAlgoAPI_Fuse(fuselage, on_it).Shape(), {{1, 0}, {2, 1.5}});
  std::erase_if(faces, [](const TopoDS_Face& face) {
    const Vec3 center = shapes::center_of(face);
    return std::abs(center.x - 2.5) < 1e-9 && center.y < 0.1;
  });
  return faces;
}

/// One wall has jags at the plane: a notch with upright sides and a triangle.
Faces jagged() {
  Faces faces = open_at(box({0, 0, 0}, {2, 1, 1}), {{1, 0}, {2, 1}});
  faces.push_back(polygon({{0, 0, 1},
                           {0.5, 0, 1},
                           {0.5, 0.01, 1},
                           {0.52, 0.01, 1},
                           {0.52, 0, 1},
                           {1, 0, 1},
                           {1.01, 0.02, 1},
                           {1.02, 0, 1},
                           {2, 0, 1},
                           {2, 1, 1},
                           {0, 1, 1}}));
  return faces;
}

Faces half_torus() {
  return open_at(BRepPrimAPI_MakeTorus(gp_Ax2({0, 0, 0}, {0, 0, 1}, {1, 0, 0}), 1, 0.3, pi).Shape(),
                 {{1, 0}});
}

Faces two_bodies() {
  Faces faces = flat_box();
  for (const TopoDS_Face& face : open_at(box({3, 0, 0}, {4, 1, 1}), {{1, 0}})) faces.push_back(face);
  return faces;
}

/// A swept wing, open at its root, whose trailing edge is blunt and has no face; `twist` turns it at the tip.
Faces blunt_wing(double twist) {
  const gp_Pnt nose(0, 0, 0), high(1, 0, 0.01), low(1, 0, -0.01);
  const gp_Pnt far_nose(1, 4, 0), far_high(2 + twist, 4, 0.01), far_low(2 - twist, 4, -0.01);
  const auto wall = [](const gp_Pnt& a, const gp_Pnt& b, const gp_Pnt& c, const gp_Pnt& d) {
    return BRepFill::Face(BRepBuilderAPI_MakeEdge(a, b).Edge(), BRepBuilderAPI_MakeEdge(d, c).Edge());
  };
  return {wall(nose, high, far_high, far_nose), wall(nose, far_nose, far_low, low),
          polygon({far_nose, far_high, far_low})};
}

/// As blunt_wing, of two panels with different sweep: the trailing edge has a kink.
Faces kinked_wing() {
  const auto at = [](double x, double chord, double y) {
    return std::array<gp_Pnt, 3>{gp_Pnt(x, y, 0), gp_Pnt(x + chord, y, 0.01), gp_Pnt(x + chord, y, -0.01)};
  };
  const std::array stations{at(0, 1, 0), at(0.5, 1, 2), at(2, 1, 4)};
  const auto wall = [](const gp_Pnt& a, const gp_Pnt& b, const gp_Pnt& c, const gp_Pnt& d) {
    return BRepFill::Face(BRepBuilderAPI_MakeEdge(a, b).Edge(), BRepBuilderAPI_MakeEdge(d, c).Edge());
  };
  Faces faces{polygon({stations[2][0], stations[2][1], stations[2][2]})};
  for (std::size_t i = 0; i < 2; ++i) {
    const auto &in = stations[i], &out = stations[i + 1];
    faces.push_back(wall(in[0], in[1], out[1], out[0]));
    faces.push_back(wall(in[0], out[0], out[2], in[2]));
  }
  return faces;
}

/// The border is no plane curve: its corners are off the plane by up to 1e-4.
Faces uneven() {
  const gp_Pnt a(0, 0, 0), b(2, 1e-4, 0), c(2, 0, 1), d(0, 5e-5, 1), e(0, 1, 0), f(2, 1, 0), g(2, 1, 1),
      h(0, 1, 1);
  return {polygon({a, b, f, e}), polygon({b, c, g, f}), polygon({c, d, h, g}), polygon({d, a, e, h}),
          polygon({e, f, g, h})};
}

/// Loose faces of an open half beside a closed body.
TopoDS_Shape beside_solid(const TopoDS_Shape& solid) {
  return shapes::compound_of<TopoDS_Shape>({moved(flat_box(), 0), solid});
}

/// A wedge whose tip is cut by a cylinder and open: three edges that are in no plane.
Faces open_round_tip() {
  const TopoDS_Face root = polygon({{0, 0, 0}, {1, 0, 0.05}, {1, 0, -0.05}});
  const TopoDS_Shape wedge = BRepPrimAPI_MakePrism(root, gp_Vec(0, 3, 0)).Shape();
  const gp_Ax2 axis({0.5, 0, -1}, {0, 0, 1});
  Faces faces =
      open_at(BRepAlgoAPI_Common(wedge, BRepPrimAPI_MakeCylinder(axis, 2, 2).Shape()).Shape(), {{1, 0}});
  std::erase_if(faces, [](const TopoDS_Face& face) { return shapes::center_of(face).y > 1.9; });
  return faces;
}

struct OpenHalf {
  const char* name;
  TopoDS_Shape (*make)();
  std::optional<double> position;  ///< as the case asks for it
  double volume, area;             ///< of the body and of its walls
  std::size_t outlines;
  double at = 0;  ///< the plane
};

const OpenHalf halves[] = {
    {"WingOpenAtItsRoot", [] { return moved(flat_box(), 0); }, {}, 0.4, 3.2, 1},
    {"NacelleOnThePlane", [] { return moved(nacelle(), 0); }, {}, 1.28 * pi, 7.04 * pi, 2},
    {"FinOnThePlane", [] { return moved(fin(), 0); }, {}, 0.825, 6.6, 1},
    {"Jagged", [] { return moved(jagged(), 0); }, {}, 2, 8, 1},
    {"TwoLoops", [] { return moved(half_torus(), 0); }, {}, 0.09 * pi* pi, 0.6 * pi* pi, 2},
    {"TwoBodies", [] { return moved(two_bodies(), 0); }, {}, 1.4, 8.2, 2},
    {"BesideByALittle", [] { return moved(flat_box(), 2e-5); }, 0, 0.4, 3.2, 1},
    {"BesideByALittleFound", [] { return moved(flat_box(), 2e-5); }, {}, 0.4, 3.2, 1},
    {"BesideByMore", [] { return moved(flat_box(), 2e-3); }, {}, 0.4, 3.2, 1, 2e-3},
    {"Across", [] { return moved(flat_box(), -0.1); }, 0, 0.2, 2.6, 1},
    {"AcrossByALittle", [] { return moved(flat_box(), -2e-3); }, 0, 0.396, 3.188, 1},
    {"BluntWing", [] { return moved(blunt_wing(0), 0); }, {}, 0.04, 8.1, 1},
    {"BluntWingBeside", [] { return moved(blunt_wing(0.02), 1e-4); }, 0, 0.04, 8.13, 1},
    {"BesideAClosedBody",
     [] {
       return beside_solid(box({5, 0.5, 0}, {6, 1.5, 1}));
     },
     {},
     1.4,
     9.2,
     1},
    {"BesideAClosedHalf",
     [] {
       return beside_solid(box({5, 0, 0}, {6, 1, 1}));
     },
     {},
     1.4,
     8.2,
     2},
    {"OpenRoundTip", [] { return moved(open_round_tip(), 0); }, {}, 0.098948, 4.207063, 1},
    {"KinkedWing", [] { return moved(kinked_wing(), 0); }, {}, 0.040000, 8.101756, 1},
    {"Tilted", tilted, {}, 0.2, 2.6, 1},
    {"Uneven", [] { return moved(uneven(), 0); }, {}, 2, 8, 1},
};

class OpenHalves : public testing::TestWithParam<OpenHalf> {};

TEST_P(OpenHalves, AreClosedByTheirPlane) {
  const OpenHalf& half = GetParam();
  const Domain domain = shapes::prepare(half.make(), with_plane(half.position));
  const Model& model = domain.model;
  checks::expect_watertight(model);
  const std::vector<FaceId> plane = shapes::faces_of_patch(model, "symmetry");
  ASSERT_EQ(plane.size(), 1u);
  EXPECT_EQ(model.face(plane.front()).loops.size(), 1 + half.outlines);
  half_models::ExactCoordinate(1, half.at).check_face(model, plane.front());
  double walls = 0;
  for (FaceId f = 0; f < model.face_count(); ++f)
    if (!model.is_far_field(f)) walls += model.face_area(f);
  EXPECT_NEAR(walls, half.area, 1e-3 * half.area);
  const double radius = 3 * domain.report.reference_length;
  EXPECT_NEAR(model.region_volume(0), 2 * pi / 3 * std::pow(radius, 3) - half.volume,
              2e-3 * half.volume + 1e-6);
}

INSTANTIATE_TEST_SUITE_P(HalfShells, OpenHalves, testing::ValuesIn(halves),
                         [](const auto& info) { return std::string(info.param.name); });

// Everything that is closed is in the list of changes.
TEST(HalfShells, TellWhatTheyClose) {
  const Changes fin_changes = shapes::prepare(moved(fin(), 0), with_plane()).report.changes;
  const Changes down = changes_about(fin_changes, "closed down to the plane by 2 face(s)");
  ASSERT_EQ(down.size(), 1u);
  ASSERT_TRUE(down.front().where);
  EXPECT_NEAR(down.front().where->y, 0.05, 1e-9);
  EXPECT_EQ(changes_about(fin_changes, "closed by its plane of symmetry y = 0").size(), 1u);
  const Changes put = changes_about(shapes::prepare(moved(flat_box(), 2e-5), with_plane(0)).report.changes,
                                    "put on the plane of symmetry y = 0");
  ASSERT_EQ(put.size(), 1u);
  EXPECT_NEAR(put.front().how_much, 2e-5, 1e-9);
}

TEST(HalfShells, RefuseWhatIsOpenWideBesideThePlane) {
  const gp_Pnt a(0, 0, 0), b(2, 0, 0), c(2, 1, 0), d(0, 1, 0), e(0, 0, 1), f(2, 0, 1), g(2, 1, 1.5),
      h(0, 1, 1);
  const Faces faces = {polygon({a, b, c, d}), polygon({a, d, h, e}), polygon({b, c, g, f}),
                       polygon({c, d, h, g})};
  const std::string message = shapes::refusal(shapes::compound_of(faces), with_plane());
  EXPECT_NE(
      message.find("Nor does the plane of symmetry close them: an opening of 3 edges, 4.18 long, of 'face_"),
      std::string::npos)
      << message;
  EXPECT_NE(message.find("leaves the plane of symmetry y = 0 by up to 1 at ("), std::string::npos) << message;
}

// A face that is drawn on the plane bounds no half, nor does a stray one that ends there.
TEST(HalfShells, StrayFacesAtThePlaneAreDropped) {
  for (const TopoDS_Face& stray : {polygon({{-5, 0, -5}, {9, 0, -5}, {9, 0, 5}, {-5, 0, 5}}),
                                   polygon({{5, 0, 0}, {6, 0, 0}, {6, 1, 0}, {5, 1, 0}})}) {
    const Domain domain =
        shapes::prepare(shapes::compound_of<TopoDS_Shape>({box({0, 0, 0}, {2, 1, 1}), stray}), with_plane());
    EXPECT_EQ(changes_about(domain.report.changes, "belongs to no solid: dropped").size(), 1u);
    EXPECT_EQ(shapes::faces_of_patch(domain.model, "symmetry").size(), 1u);
  }
}

// A hemisphere takes the coordinate plane with most open edges, as for triangles.
TEST(HalfShells, AHemisphereFindsTheirPlane) {
  for (const int axis : {0, 1, 2}) {
    DomainOptions options = with_plane();
    options.far_field->symmetry = Symmetry::automatic;
    gp_Pnt low(-1, -1, -1), high(1, 2, 3);
    low.SetCoord(axis + 1, 0);
    Faces faces = open_at(box(low, high), {{axis, 0}});
    const double flat = high.Coord(axis + 1);
    std::erase_if(faces, [&](const TopoDS_Face& face) {  // not closed by planar caps alone
      return std::abs(shapes::center_of(face)[axis] - flat) > 1e-9 &&
             shapes::center_of(face)[(axis + 1) % 3] < -0.9;
    });
    faces.push_back([&] {
      gp_Pnt a(low), b(low), c(low), d(low);
      const int across = (axis + 2) % 3;
      for (gp_Pnt* p : {&b, &c}) p->SetCoord(across + 1, high.Coord(across + 1));
      for (gp_Pnt* p : {&c, &d}) p->SetCoord(axis + 1, flat);
      a.SetCoord(axis + 1, 0.01);
      return polygon({a, b, c, d});
    }());
    const Domain domain = shapes::prepare(shapes::compound_of(faces), options);
    const std::vector<FaceId> plane = shapes::faces_of_patch(domain.model, "symmetry");
    ASSERT_EQ(plane.size(), 1u);
    half_models::ExactCoordinate(axis, 0).check_face(domain.model, plane.front());
    EXPECT_EQ(changes_about(domain.report.changes, " = 0: the body is open there").size(), 1u);
  }
}

TEST(HalfShells, AreRecognisedWithoutAPlane) {
  const std::string wing = shapes::refusal(moved(blunt_wing(0), 0));
  EXPECT_NE(wing.find("half of a model, open on the plane y = 0"), std::string::npos) << wing;
  const gp_Ax2 axes({0, 0, 0}, {1, 0, 0}, {0, 0, -1});
  const Faces bent = open_at(BRepPrimAPI_MakeCylinder(axes, 1, 4, pi).Shape(), {{0, 0}, {0, 4}, {1, 0}});
  ASSERT_EQ(bent.size(), 1u);
  const std::string face = shapes::refusal(moved(bent, 0));
  EXPECT_NE(face.find("half of a model, open on the plane y = 0"), std::string::npos) << face;
  const std::string message = shapes::refusal(moved(flat_box(), 0));
  EXPECT_NE(message.find("half of a model, open on the plane y = 0: FarFieldOptions::symmetry 'y' closes it"),
            std::string::npos)
      << message;
  DomainOptions off;
  const std::string solid =
      shapes::refusal(shapes::compound_of(open_at(box({0, 0, 0}, {1, 1, 1}), {{0, 0}, {1, 0}, {2, 0}})), off);
  EXPECT_EQ(solid.find("half of a model"), std::string::npos) << solid;
}

}  // namespace
}  // namespace aeroloom::cad
