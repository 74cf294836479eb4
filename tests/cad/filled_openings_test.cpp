#include "tests/cad/cad_shapes.hpp"
#include "tests/cad/model_checks.hpp"

#include <cmath>
#include <numbers>

#include <BRepAdaptor_Surface.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <gp_Ax2.hxx>

namespace aeroloom::cad {
namespace {

using shapes::changes_about;
using std::numbers::pi;
using Faces = std::vector<TopoDS_Face>;

constexpr double height = 3;

/// A cylinder of radius 1 whose side has a hole, cut by a tool without its walls.
Faces with_hole(const TopoDS_Shape& tool) {
  Faces faces = shapes::faces_of(BRepAlgoAPI_Cut(BRepPrimAPI_MakeCylinder(1, height).Shape(), tool).Shape());
  std::erase_if(faces, [](const TopoDS_Face& face) {
    const Vec3 center = shapes::center_of(face);
    return center.x > 0.1 && center.z > 0.1 && center.z < height - 0.1;
  });
  EXPECT_EQ(faces.size(), 3u);
  return faces;
}

TopoDS_Shape drill(double radius, double from) {
  return BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(from, 0, 0.5 * height), gp_Dir(1, 0, 0)), radius, 3).Shape();
}

DomainOptions as_body() {
  DomainOptions options;
  options.kind = DomainKind::fluid;
  return options;
}

struct Hole {
  const char* name;
  TopoDS_Shape (*tool)();
};

const Hole holes[] = {
    {"Round", [] { return drill(0.1, 0.5); }},
    {"FourSided", [] { return BRepPrimAPI_MakeBox(gp_Pnt(0.5, -0.1, 1.2), gp_Pnt(2, 0.15, 1.4)).Shape(); }},
};

class UnevenHoles : public testing::TestWithParam<Hole> {};

// A missing piece of a curved face gets a face, which is told with area and place.
TEST_P(UnevenHoles, AreFilledWhereTheyAreSmall) {
  const Domain domain = shapes::prepare(shapes::compound_of(with_hole(GetParam().tool())), as_body());
  const Model& model = domain.model;
  checks::expect_watertight(model);
  EXPECT_EQ(model.face_count(), 4);
  EXPECT_NEAR(model.region_volume(0), pi * height, 1e-3);
  EXPECT_NEAR(checks::facets_volume(model, 0.005, 0.1), pi * height, 0.01 * pi * height);
  const Changes made = changes_about(domain.report.changes, "an uneven opening of area");
  ASSERT_EQ(made.size(), 1u);
  EXPECT_NE(made[0].what.find("closed by a face named 'cap_1'"), std::string::npos) << made[0].what;
  ASSERT_TRUE(made[0].where);
  EXPECT_NEAR(made[0].where->x, 1, 0.02);
  EXPECT_LT(made[0].how_much, 1e-5 * std::hypot(2, 2, height));
}

INSTANTIATE_TEST_SUITE_P(FilledOpenings, UnevenHoles, testing::ValuesIn(holes),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(FilledOpenings, RefuseClosesNone) {
  DomainOptions options = as_body();
  options.close = {"refuse"};
  EXPECT_THROW(shapes::prepare(shapes::compound_of(with_hole(drill(0.1, 0.5))), options), CadError);
}

// Wide ones are refused with their size, place and faces, and closed where the case names them.
TEST(FilledOpenings, WideOnesAreNamed) {
  const TopoDS_Shape open = shapes::compound_of(with_hole(drill(0.6, 0.2)));
  const std::string message = shapes::refusal(open, as_body());
  EXPECT_NE(message.find("The longest of 1 opening(s) has "), std::string::npos) << message;
  EXPECT_NE(message.find(", beside 'face_"), std::string::npos) << message;
  EXPECT_NE(message.find("DomainOptions::close"), std::string::npos) << message;
  DomainOptions options = as_body();
  options.close = {"0 -1 0.5 2 1 2.5"};
  const Domain domain = shapes::prepare(open, options);
  checks::expect_watertight(domain.model);
  EXPECT_NEAR(domain.model.region_volume(0), pi * height, 0.1);
  options.close = {"0 -1 2.5 2 1 3"};
  EXPECT_THROW(shapes::prepare(open, options), CadError);
}

// A small opening is no gap, however long the body is.
TEST(FilledOpenings, SmallHolesOfLongBodies) {
  const TopoDS_Shape bar = BRepPrimAPI_MakeBox(1000, 10, 10).Shape();
  const TopoDS_Shape notched =
      BRepAlgoAPI_Cut(bar, BRepPrimAPI_MakeBox(gp_Pnt(500, 5, 9), gp_Pnt(501, 6, 11)).Shape()).Shape();
  Faces faces = shapes::faces_of(notched);
  std::erase_if(faces, [](const TopoDS_Face& face) {
    const Vec3 center = shapes::center_of(face);
    return center.z > 8.9 && center.z < 9.9 && center.x > 499 && center.x < 502;
  });
  ASSERT_EQ(faces.size(), 6u);
  const Domain domain = shapes::prepare(shapes::compound_of(faces), as_body());
  EXPECT_NEAR(domain.model.region_volume(0), 1e5, 1e-3);
}

}  // namespace
}  // namespace aeroloom::cad
