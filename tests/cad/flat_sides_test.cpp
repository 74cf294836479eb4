#include "cad/domain/flat_sides.hpp"

#include "geometry/angle.hpp"
#include "tests/cad/cad_shapes.hpp"
#include "tests/cad/half_models.hpp"
#include "tests/cad/model_checks.hpp"
#include "tests/cad/prisms.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <BRepBuilderAPI_NurbsConvert.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <gp_Ax2.hxx>

namespace aeroloom::cad {
namespace {

using shapes::changes_about;

DomainOptions half_at(std::optional<double> position, Symmetry symmetry = Symmetry::z) {
  DomainOptions options;
  options.far_field = FarFieldOptions{
      .shape = FarFieldShape::hemisphere, .extent = 3, .symmetry = symmetry, .symmetry_position = position};
  return options;
}

/// A box of 2 x 1 x 1 whose side at z = 0 leaves the plane by these distances.
TopoDS_Shape tilted(double at_front, double at_back) {
  return shapes::prism({{0, at_front}, {2, at_back}, {2, 1}, {0, 1}}, 1);
}

void expect_exact_half(const Domain& domain, int axis) {
  checks::expect_watertight(domain.model);
  const std::vector<FaceId> plane = shapes::faces_of_patch(domain.model, "symmetry");
  ASSERT_EQ(plane.size(), 1u);
  EXPECT_EQ(domain.model.face(plane.front()).loops.size(), 2u);
  half_models::ExactCoordinate(axis, 0).check_face(domain.model, plane.front());
}

// 1e-4 of the diagonal is 2.4e-4 here.
TEST(FlatSides, BelowTheToleranceArePutOnThePlane) {
  struct Case {
    double front, back;
    std::optional<double> position;
  };
  for (const Case& each : {Case{0, 2e-4, {}}, Case{0, 2e-4, 0}, Case{1e-5, 1e-5, 0}, Case{2e-4, 2e-4, 0},
                           Case{-1e-4, 1e-4, 0}, Case{-2e-4, 0, {}}}) {
    const Domain domain = shapes::prepare(tilted(each.front, each.back), half_at(each.position));
    expect_exact_half(domain, 2);
    const Changes put = changes_about(domain.report.changes, "of a flat side beside the plane of symmetry");
    ASSERT_EQ(put.size(), 1u);
    EXPECT_NEAR(put.front().how_much, std::max(std::abs(each.front), std::abs(each.back)), 1e-9);
  }
}

TEST(FlatSides, ThatMissThePlaneAreRefusedInDegreesAndLengths) {
  for (const std::optional<double> position : {std::optional<double>(), std::optional<double>(0)}) {
    const std::string message = shapes::refusal(tilted(0, 0.002), half_at(position));
    EXPECT_NE(message.find("tilted by 0.0573 degrees, and its distance goes from 0 to 0.002"),
              std::string::npos)
        << message;
  }
  const std::string across = shapes::refusal(tilted(-0.001, 0.001), half_at(0));
  EXPECT_NE(across.find("tilted by 0.0573 degrees, and its distance goes from 0 to 0.001"), std::string::npos)
      << across;
  const std::string away = shapes::refusal(tilted(0.002, 0.002), half_at(0));
  EXPECT_NE(away.find("reaches from 0.002 to 1, by more than the 0.000245"), std::string::npos) << away;
}

// Thin plates have a side near the plane that looks the other way.
TEST(FlatSides, LookAtThePlane) {
  const TopoDS_Shape plate = BRepPrimAPI_MakeBox(gp_Pnt(0, 0, 0), gp_Pnt(2, 1e-4, 1)).Shape();
  expect_exact_half(shapes::prepare(plate, half_at(0, Symmetry::y)), 1);
}

// An edge that all but lies in the plane: the CAD library keeps the whole body then.
TEST(FlatSides, BodiesAreCutWhereEdgesAllButLieInThePlane) {
  constexpr double more = 0.03 * geometry::degree;
  const auto lune = [](double from, double angle) {
    const gp_Ax2 axes({0, 0, 0}, {0, 0, 1}, {std::cos(from), std::sin(from), 0});
    const TopoDS_Shape wedge = BRepPrimAPI_MakeSphere(axes, 1, angle).Shape();
    for (const TopoDS_Face& face : shapes::faces_of(wedge)) {
      if (norm(shapes::center_of(face)) > 0.45)
        return TopoDS::Face(BRepBuilderAPI_NurbsConvert(face).Shape());
    }
    return TopoDS_Face();
  };
  const double straight = std::numbers::pi;
  const Domain domain = shapes::prepare(
      shapes::compound_of<TopoDS_Face>({lune(0, straight + more), lune(straight + more, straight - more)}),
      half_at({}, Symmetry::y));
  expect_exact_half(domain, 1);
  EXPECT_NEAR(domain.model.body_bounds().low.y, 0, 1e-3);
}

}  // namespace
}  // namespace aeroloom::cad
