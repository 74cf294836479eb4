#include "cad/domain/far_field.hpp"

#include "tests/cad/cad_shapes.hpp"
#include "tests/cad/half_models.hpp"
#include "tests/cad/model_checks.hpp"

#include <cmath>
#include <numbers>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>

namespace aeroloom::cad {
namespace {

using shapes::changes_about;
using shapes::volume_of;
using std::numbers::pi;

DomainOptions around(const FarFieldOptions& far_field) {
  DomainOptions options;
  options.far_field = far_field;
  return options;
}

/// A small box away from the origin: its extent is 2, its centre (4, 5, 6).
TopoDS_Shape make_body() {
  return BRepPrimAPI_MakeBox(gp_Pnt(3, 4.5, 5.75), 2, 1, 0.5).Shape();
}
const Vec3 body_center{4, 5, 6};
constexpr double body_extent = 2, body_volume = 1, extent = 5, radius = extent * body_extent;

struct Whole {
  const char* name;
  FarFieldOptions far_field;
  double volume;  ///< of the far field
  int faces;
};

const Whole wholes[] = {
    {"Sphere", {.shape = FarFieldShape::sphere, .extent = extent}, 4.0 / 3 * pi* std::pow(radius, 3), 1},
    {"Box", {.shape = FarFieldShape::box, .extent = extent}, std::pow(2 * radius, 3), 6},
    {"CylinderAlongX",
     {.shape = FarFieldShape::cylinder, .extent = extent, .axis = Axis::x},
     2 * pi* std::pow(radius, 3),
     3},
    {"CylinderAlongY",
     {.shape = FarFieldShape::cylinder, .extent = extent, .axis = Axis::y},
     2 * pi* std::pow(radius, 3),
     3},
    {"CylinderAlongZ",
     {.shape = FarFieldShape::cylinder, .extent = extent, .axis = Axis::z},
     2 * pi* std::pow(radius, 3),
     3},
};

class WholeFarFields : public testing::TestWithParam<Whole> {};

TEST_P(WholeFarFields, SurroundTheBody) {
  const Whole& whole = GetParam();
  const Domain domain = shapes::prepare(make_body(), around(whole.far_field));
  const Model& model = domain.model;
  EXPECT_EQ(domain.report.kind, DomainKind::body);
  EXPECT_NEAR(domain.report.reference_length, body_extent, 1e-9);
  EXPECT_EQ(model.region_count(), 1);
  EXPECT_EQ(model.face_count(), whole.faces + 6);
  checks::expect_watertight(model);
  checks::expect_closed_loops(model, 1e-6);
  EXPECT_NEAR(volume_of(model.data().shape), whole.volume - body_volume, 1e-6 * whole.volume);
  EXPECT_NEAR(checks::facets_volume(model, 0.01, 0.1), whole.volume, 0.01 * whole.volume);
  EXPECT_LT(distance(model.bounds().center(), body_center), 1e-6);
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(model.bounds().size()[axis], 2 * radius, 1e-6);
  EXPECT_EQ(shapes::faces_of_patch(model, "farfield").size(), static_cast<std::size_t>(whole.faces));
  for (FaceId f = 0; f < model.face_count(); ++f)
    EXPECT_EQ(model.is_far_field(f), model.patches()[model.face(f).patch] == "farfield");
  EXPECT_TRUE(shapes::faces_of_patch(model, "symmetry").empty());
}

TEST_P(WholeFarFields, MustClearTheBody) {
  FarFieldOptions far_field = GetParam().far_field;
  far_field.extent = 0.5;
  const std::string message = shapes::refusal(make_body(), around(far_field));
  EXPECT_NE(message.find("the far field cuts the body: its extent of 0.5 lengths of the body (2)"),
            std::string::npos)
      << message;
  far_field.extent = 0.6;
  EXPECT_EQ(shapes::prepare(make_body(), around(far_field)).model.region_count(), 1);
}

TEST(FarField, ExtendsInTheUnitAskedFor) {
  FarFieldOptions far_field{.shape = FarFieldShape::box, .extent = 30, .unit = ExtentUnit::model};
  EXPECT_NEAR(shapes::prepare(make_body(), around(far_field)).model.bounds().size().x, 60, 1e-9);
  far_field.unit = ExtentUnit::reference, far_field.unit_length = 0.5;
  EXPECT_NEAR(shapes::prepare(make_body(), around(far_field)).model.bounds().size().x, 30, 1e-9);
  far_field.extent = 1;
  EXPECT_NE(shapes::refusal(make_body(), around(far_field)).find("its extent of 1 reference lengths (0.5)"),
            std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(FarField, WholeFarFields, testing::ValuesIn(wholes),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(FarField, CylindersEndAcrossTheirAxis) {
  for (const Axis along : {Axis::x, Axis::y, Axis::z}) {
    const FarFieldOptions far_field{.shape = FarFieldShape::cylinder, .extent = extent, .axis = along};
    const Model model = shapes::prepare(make_body(), around(far_field)).model;
    int ends = 0;
    for (const FaceId f : shapes::faces_of_patch(model, "farfield")) {
      if (!model.is_planar(f)) continue;
      ++ends;
      EXPECT_NEAR(model.face_area(f), pi * radius * radius, 1e-6);
      const Vec3 normal = model.face_frame(f, model.facets(f, 1, 0.5).uv.front()).normal;
      EXPECT_NEAR(std::abs(normal[static_cast<int>(along)]), 1, 1e-12);
    }
    EXPECT_EQ(ends, 2);
  }
}

TEST(FarField, MustClearTheBodyByItsOwnShape) {
  // The body is 2 x 1 x 0.5: a cylinder along x passes it nearer than a sphere.
  const auto refuses = [](const FarFieldOptions& far_field) {
    try {
      shapes::prepare(make_body(), around(far_field));
      return false;
    } catch (const CadError&) {
      return true;
    }
  };
  EXPECT_FALSE(refuses({.shape = FarFieldShape::cylinder, .extent = 0.53, .axis = Axis::x}));
  EXPECT_TRUE(refuses({.shape = FarFieldShape::cylinder, .extent = 0.53, .axis = Axis::z}));
  EXPECT_FALSE(refuses({.shape = FarFieldShape::cylinder, .extent = 0.57, .axis = Axis::z}));
  EXPECT_TRUE(refuses({.shape = FarFieldShape::sphere, .extent = 0.57}));
  EXPECT_FALSE(refuses({.shape = FarFieldShape::box, .extent = 0.51}));
}

TEST(FarField, CavitiesAreLeftOut) {
  const TopoDS_Shape hollow =
      BRepAlgoAPI_Cut(make_body(), BRepPrimAPI_MakeSphere(gp_Pnt(4, 5, 6), 0.2).Shape()).Shape();
  const Domain domain = shapes::prepare(hollow, around({.extent = extent}));
  EXPECT_EQ(domain.model.face_count(), 1 + 6);
  EXPECT_EQ(changes_about(domain.report.changes, "closed cavities inside a body").size(), 1u);
  const double whole = 4.0 / 3 * pi * std::pow(radius, 3);
  EXPECT_NEAR(volume_of(domain.model.data().shape), whole - body_volume, 1e-6 * whole);
}

TEST(FarField, SeveralBodiesAreSeveralHoles) {
  const TopoDS_Shape other = BRepPrimAPI_MakeSphere(gp_Pnt(4, 8, 6), 0.5).Shape();
  const Domain domain = shapes::prepare(shapes::compound_of<TopoDS_Shape>({make_body(), other}),
                                        around({.shape = FarFieldShape::box, .extent = 2}));
  EXPECT_EQ(domain.model.face_count(), 6 + 6 + 1);
  const double length = 8.5 - 4.5;
  EXPECT_NEAR(domain.report.reference_length, length, 1e-9);
  EXPECT_NEAR(volume_of(domain.model.data().shape), std::pow(4 * length, 3) - body_volume - pi / 6, 1e-5);
}

TEST(FarField, HalfModelsMustClearTheBodyToo) {
  for (const auto& [name, shape, axis] : half_models::far_fields) {
    FarFieldOptions far_field{.shape = shape, .extent = 0.45, .axis = axis, .symmetry = Symmetry::y};
    far_field.symmetry_position = 5;
    const std::string message = shapes::refusal(make_body(), around(far_field));
    EXPECT_NE(message.find("the far field cuts the body"), std::string::npos) << name << ": " << message;
  }
}

}  // namespace
}  // namespace aeroloom::cad
