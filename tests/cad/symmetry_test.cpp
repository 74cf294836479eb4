#include "cad/domain/symmetry.hpp"

#include "cad/domain/far_field.hpp"
#include "tests/cad/cad_shapes.hpp"
#include "tests/cad/half_models.hpp"
#include "tests/cad/model_checks.hpp"

#include <cmath>
#include <iterator>
#include <numbers>
#include <tuple>
#include <vector>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <fmt/format.h>
#include <gp_Ax2.hxx>

namespace aeroloom::cad {
namespace {

using half_models::FarField;
using shapes::changes_about;
using shapes::volume_of;
using std::numbers::pi;

constexpr double extent = 3;

TopoDS_Shape make_box(gp_Pnt low, gp_Pnt high) {
  return BRepPrimAPI_MakeBox(low, high).Shape();
}

TopoDS_Shape make_ball(gp_Pnt center, double radius) {
  return BRepPrimAPI_MakeSphere(center, radius).Shape();
}

TopoDS_Shape make_tube(gp_Pnt from, gp_Dir along, double length) {
  const gp_Ax2 axis(from, along);
  return BRepAlgoAPI_Cut(BRepPrimAPI_MakeCylinder(axis, 1, length).Shape(),
                         BRepPrimAPI_MakeCylinder(axis, 0.6, length).Shape())
      .Shape();
}

TopoDS_Shape make_torus(gp_Dir axis) {
  return BRepPrimAPI_MakeTorus(gp_Ax2(gp_Pnt(0, 0, 0), axis), 1, 0.3).Shape();
}

/// A body and what its half model at y = 0 is like.
struct Body {
  const char* name;
  TopoDS_Shape (*make)();
  double length;            ///< its extent, uncut
  double volume;            ///< of its half, cavities included
  std::size_t outlines;     ///< holes in the plane of symmetry
  std::size_t islands = 0;  ///< fluid on the plane inside the body's section
  std::vector<std::string> changes = {};
  bool positive = true;
};

const char* const cut = "1 bodies cut at the plane of symmetry y = 0, 0 on its other side dropped";
const char* const ends = "plane of symmetry y = 0: the body ends there in planar faces";

const Body bodies[] = {
    {"Ball",
     [] {
       return make_ball({0, 0, 0}, 1);
     },
     2,
     2 * pi / 3,
     1,
     0,
     {cut}},
    {"BoxAcross",
     [] {
       return make_box({-1, -0.5, -1}, {1, 0.75, 1});
     },
     2,
     3,
     1,
     0,
     {cut}},
    {"BoxOnThePlane",
     [] {
       return make_box({-1, 0, -1}, {1, 1, 1});
     },
     2,
     4,
     1,
     0,
     {ends}},
    {"BoxAlmostOnThePlane",
     [] {
       return make_box({-1, 1e-7, -1}, {1, 1, 1});
     },
     2,
     4,
     1,
     0,
     {ends}},
    {"BoxUnderThePlane",
     [] {
       return make_box({-1, -1, -1}, {1, 0, 1});
     },
     2,
     4,
     1,
     0,
     {ends},
     false},
    {"TorusThroughThePlane",
     [] {
       return make_torus({0, 0, 1});
     },
     2.6,
     0.09 * pi* pi,
     2,
     0,
     {cut}},
    {"TorusInThePlane",
     [] {
       return make_torus({0, 1, 0});
     },
     2.6,
     0.09 * pi* pi,
     1,
     1,
     {cut}},
    {"TubeAlongThePlane",
     [] {
       return make_tube({-2, 0, 0}, {1, 0, 0}, 4);
     },
     4,
     1.28 * pi,
     2,
     0,
     {cut}},
    {"TubeOnThePlane",
     [] {
       return make_tube({0, 0, 0}, {0, 1, 0}, 2);
     },
     2,
     1.28 * pi,
     1,
     1,
     {ends}},
    {"TubeThroughThePlane",
     [] {
       return make_tube({0, -2, 0}, {0, 1, 0}, 4);
     },
     4,
     1.28 * pi,
     1,
     1,
     {cut}},
    {"HollowBall",
     [] {
       return BRepAlgoAPI_Cut(make_ball({0, 0, 0}, 1), make_ball({0, 0, 0}, 0.5)).Shape();
     },
     2,
     2 * pi / 3,
     1,
     0,
     {cut, "a cavity inside a body, cut open by the plane of symmetry"}},
    {"HollowBoxOnThePlane",
     [] {
       return BRepAlgoAPI_Cut(make_box({-1, 0, -1}, {1, 1, 1}), make_ball({0, 0.5, 0}, 0.3)).Shape();
     },
     2,
     4,
     1,
     0,
     {ends, "1 closed cavities inside a body do not reach the fluid"}},
    {"ThreeBoxes",
     [] {
       return TopoDS_Shape(shapes::compound_of<TopoDS_Shape>({make_box({-1, -2, -1}, {1, -1.5, 1}),
                                                              make_box({-1, -1, -1}, {1, 0.5, 1}),
                                                              make_box({-1, 1, -1}, {1, 1.5, 1})}));
     },
     3.5,
     4,
     1,
     0,
     {"1 bodies cut at the plane of symmetry y = 0, 1 on its other side dropped"}},
};

DomainOptions half(const FarField& far_field, Symmetry symmetry, std::optional<double> position = {}) {
  DomainOptions options;
  options.far_field = FarFieldOptions{.shape = far_field.shape,
                                      .extent = extent,
                                      .axis = far_field.axis,
                                      .symmetry = symmetry,
                                      .symmetry_position = position};
  return options;
}

/// The loops of the faces on the plane: one face reaches the far field, islands have one loop each here.
void expect_plane(const Model& model, const Body& body) {
  const std::vector<FaceId> plane = shapes::faces_of_patch(model, "symmetry");
  ASSERT_EQ(plane.size(), 1 + body.islands);
  std::vector<std::size_t> loops;
  for (const FaceId f : plane) {
    EXPECT_TRUE(model.is_far_field(f));
    EXPECT_TRUE(model.is_planar(f));
    loops.push_back(model.face(f).loops.size());
    const double inward = model.face_frame(f, model.facets(f, 1, 0.5).uv.front()).normal.y;
    EXPECT_EQ(inward < 0, body.positive) << "the face looks into the fluid";
    half_models::ExactCoordinate(1, 0).check_face(model, f);
  }
  std::sort(loops.begin(), loops.end());
  EXPECT_EQ(loops.back(), 1 + body.outlines);
  EXPECT_EQ(loops.front(), body.islands > 0 ? 1u : 1 + body.outlines);
}

class HalfModels : public testing::TestWithParam<std::tuple<FarField, Body>> {};

TEST_P(HalfModels, AreSoundAndExactOnThePlane) {
  const auto& [far_field, body] = GetParam();
  const Domain domain = shapes::prepare(body.make(), half(far_field, Symmetry::y));
  const Model& model = domain.model;
  EXPECT_EQ(model.region_count(), 1);
  checks::expect_watertight(model);
  checks::expect_closed_loops(model, 1e-6);
  expect_plane(model, body);
  half_models::expect_one_side(model, 1, 0, body.positive);
  const double far_volume = half_models::volume(far_field, extent * body.length);
  EXPECT_NEAR(volume_of(model.data().shape), far_volume - body.volume, 2e-6 * far_volume);
  EXPECT_NEAR(checks::facets_volume(model, 0.01, 0.1), far_volume - body.volume, 0.01 * far_volume);
  for (const std::string& words : body.changes)
    EXPECT_EQ(changes_about(domain.report.changes, words).size(), 1u) << words;
  const bool was_cut = !changes_about(domain.report.changes, "bodies cut at the plane").empty();
  EXPECT_EQ(was_cut, body.changes.front() != ends);
}

/// Every body in the hemisphere and in one other far field, all of these in turn.
std::vector<std::tuple<FarField, Body>> pairs() {
  std::vector<std::tuple<FarField, Body>> pairs;
  std::size_t next = 0;
  for (const Body& body : bodies) {
    pairs.emplace_back(half_models::far_fields[0], body);
    pairs.emplace_back(half_models::far_fields[1 + next++ % (std::size(half_models::far_fields) - 1)], body);
  }
  return pairs;
}

INSTANTIATE_TEST_SUITE_P(Symmetry, HalfModels, testing::ValuesIn(pairs()), [](const auto& info) {
  return fmt::format("{}_{}", std::get<1>(info.param).name, std::get<0>(info.param).name);
});

class Positions : public testing::TestWithParam<FarField> {};

// Positions that are no short binary fractions, on every axis.
TEST_P(Positions, AreKeptBitForBit) {
  constexpr double position = 0.1 + 0.2;
  const Symmetry axes[] = {Symmetry::x, Symmetry::y, Symmetry::z};
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 center{1, 2, 3};
    center[axis] = 0.7;
    const TopoDS_Shape ball = make_ball({center.x, center.y, center.z}, 1);
    const Model model = shapes::prepare(ball, half(GetParam(), axes[axis], position)).model;
    checks::expect_watertight(model);
    for (const FaceId f : shapes::faces_of_patch(model, "symmetry"))
      half_models::ExactCoordinate(axis, position).check_face(model, f);
    half_models::expect_one_side(model, axis, position, true);
  }
}

INSTANTIATE_TEST_SUITE_P(Symmetry, Positions, testing::ValuesIn(half_models::far_fields),
                         [](const auto& info) { return std::string(info.param.name); });

const FarField& hemisphere = half_models::far_fields[0];

TEST(Symmetry, PlanesAreFoundWhereBodiesEnd) {
  const Domain domain = shapes::prepare(make_box({0, 2, 0}, {1, 4, 1}), half(hemisphere, Symmetry::y));
  EXPECT_EQ(changes_about(domain.report.changes, "plane of symmetry y = 2: the body ends there").size(), 1u);
  for (const FaceId f : shapes::faces_of_patch(domain.model, "symmetry"))
    half_models::ExactCoordinate(1, 2).check_face(domain.model, f);
}

TEST(Symmetry, HemispheresFindTheirPlane) {
  const auto found = [](const TopoDS_Shape& body, const char* words) {
    const Domain domain = shapes::prepare(body, half(hemisphere, Symmetry::automatic));
    EXPECT_EQ(changes_about(domain.report.changes, words).size(), 1u) << words;
    EXPECT_EQ(shapes::faces_of_patch(domain.model, "symmetry").size(), 1u);
  };
  found(make_ball({0, 0, 0}, 1), "plane of symmetry y = 0: the body is symmetric about it");
  found(make_box({1, 3, 0}, {2, 5, 1}), "plane of symmetry z = 0: the body ends there in planar faces");
  const std::string message = shapes::refusal(make_ball({3, 3, 3}, 1), half(hemisphere, Symmetry::automatic));
  EXPECT_NE(message.find("a hemisphere needs a plane of symmetry"), std::string::npos) << message;
}

TEST(Symmetry, HemispheresNeedOne) {
  const std::string message = shapes::refusal(make_ball({0, 0, 0}, 1), half(hemisphere, Symmetry::none));
  EXPECT_NE(message.find("a hemisphere is half a far field"), std::string::npos) << message;
}

TEST(Symmetry, PlanesMustMeetTheBody) {
  for (const FarField& far_field : half_models::far_fields) {
    const std::string message =
        shapes::refusal(make_box({-1, 2, -1}, {1, 4, 1}), half(far_field, Symmetry::y, 0));
    EXPECT_NE(message.find("the plane of symmetry y = 0 misses the body, which reaches from 2 to 4"),
              std::string::npos)
        << message;
  }
  const std::string nowhere = shapes::refusal(make_ball({0, 3, 0}, 1), half(hemisphere, Symmetry::y));
  EXPECT_NE(nowhere.find("the body reaches from y = 2 to 4 and ends at neither"), std::string::npos)
      << nowhere;
}

// The fluid would have no thickness there.
TEST(Symmetry, BodiesThatOnlyTouchThePlaneAreRefused) {
  const TopoDS_Shape trunk = BRepPrimAPI_MakeCylinder(gp_Ax2({0, 1, 0}, {1, 0, 0}), 1, 3).Shape();
  for (const TopoDS_Shape& body : {make_ball({0, 1, 0}, 1), trunk}) {
    const std::string message = shapes::refusal(body, half(hemisphere, Symmetry::y, 0));
    EXPECT_NE(message.find("a body only touches the plane of symmetry y = 0, near ("), std::string::npos)
        << message;
  }
}

TEST(Symmetry, FacesKeepTheirLabels) {
  NamedShape box;
  box.shape = make_box({-1, -1, -1}, {1, 2, 1});
  for (const TopoDS_Face& face : shapes::faces_of(box.shape)) {
    const Vec3 at = shapes::center_of(face);
    FaceLabel label;
    label.name = at.y < 0 ? "below" : at.y > 1.9 ? "above" : fmt::format("side {} {}", at.x, at.z);
    box.labels.Bind(face, label);
  }
  Volumes volumes;
  Changes changes;
  const NamedShape fluid = surround(box, *half(hemisphere, Symmetry::y).far_field, volumes, changes);
  std::vector<std::string> names;
  for (const TopoDS_Face& face : shapes::faces_of(fluid.shape)) {
    const FaceLabel* label = fluid.labels.Seek(face);
    ASSERT_NE(label, nullptr);
    if (label->far_field) continue;
    const Vec3 at = shapes::center_of(face);
    EXPECT_EQ(label->name, at.y > 1.9 ? "above" : fmt::format("side {} {}", at.x, at.z));
    names.push_back(label->name);
  }
  EXPECT_EQ(names.size(), 5u);
}

}  // namespace
}  // namespace aeroloom::cad
