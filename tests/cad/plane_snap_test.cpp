#include "cad/model/evaluation/plane_snap.hpp"

#include "tests/cad/cad_shapes.hpp"
#include "tests/cad/model_checks.hpp"
#include "tests/cad/prisms.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include <BRepBuilderAPI_Transform.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <gp_Trsf.hxx>

namespace aeroloom::cad {
namespace {

using shapes::prepare_fluid;
using shapes::prism;

/// The lowest and highest coordinate that the model gives anywhere on a face.
struct Spread {
  double low = std::numeric_limits<double>::max(), high = std::numeric_limits<double>::lowest();

  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  double width() const { return high - low; }
};

Spread spread_of(const Model& model, FaceId f, int axis) {
  Spread spread;
  const Facets facets = model.facets(f, 0.01, 0.2);
  for (std::size_t i = 0; i < facets.points.size(); ++i) {
    spread.add(facets.points[i][axis]);
    spread.add(model.face_point(f, facets.uv[i])[axis]);
    spread.add(model.face_frame(f, facets.uv[i]).point[axis]);
    const Vec3 beside = facets.points[i] + Vec3{1e-3, 2e-3, 3e-3};
    spread.add(model.project(f, beside, facets.uv[i]).point[axis]);
  }
  for (const auto& loop : model.face(f).loops) {
    for (const Coedge& use : loop) {
      const Edge& edge = model.edge(use.edge);
      spread.add(model.vertex(edge.first)[axis]);
      spread.add(model.vertex(edge.last)[axis]);
      for (const double share : {0.0, 0.137, 0.5, 0.861, 1.0}) {
        const double t = edge.first_parameter + share * (edge.last_parameter - edge.first_parameter);
        spread.add(model.edge_point(use.edge, t)[axis]);
      }
    }
  }
  return spread;
}

/// Faces that look along an axis, at a position to 1e-4.
std::vector<FaceId> faces_at(const Model& model, int axis, double position) {
  std::vector<FaceId> faces;
  for (FaceId f = 0; f < model.face_count(); ++f) {
    const Vec2 uv = model.facets(f, 0.1, 0.5).uv.front();
    const SurfaceFrame frame = model.face_frame(f, uv);
    if (std::abs(frame.normal[axis]) > 0.999 && std::abs(frame.point[axis] - position) < 1e-4)
      faces.push_back(f);
  }
  return faces;
}

/// Bit for bit: a negative zero is no zero.
void expect_exact(const Model& model, int axis, double position) {
  const std::vector<FaceId> faces = faces_at(model, axis, position);
  EXPECT_FALSE(faces.empty()) << "no face at " << position << " on axis " << axis;
  for (const FaceId f : faces) {
    const Spread spread = spread_of(model, f, axis);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(spread.low), std::bit_cast<std::uint64_t>(position))
        << spread.low << " for " << position;
    EXPECT_EQ(spread.width(), 0) << "face " << f << " at " << position;
  }
}

TopoDS_Shape turned(const TopoDS_Shape& shape, const gp_Dir& about, double angle) {
  gp_Trsf turn;
  turn.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), about), angle);
  return BRepBuilderAPI_Transform(shape, turn, true).Shape();
}

/// Two towers side by side, the second taller by a step.
TopoDS_Shape make_towers(double step) {
  return prism({{0, 0}, {3, 0}, {3, 1 + step}, {2, 1 + step}, {2, 0.5}, {1, 0.5}, {1, 1}, {0, 1}}, 2);
}

TEST(PlaneSnap, NoiseAroundZeroIsZero) {
  const gp_Pnt low(1e-12, -1e-12, 3e-13), high(1, 2, 3);
  const Model model = prepare_fluid(BRepPrimAPI_MakeBox(low, high).Shape()).model;
  for (int axis = 0; axis < 3; ++axis) {
    expect_exact(model, axis, 0);
    expect_exact(model, axis, high.Coord(axis + 1));
  }
  checks::expect_watertight(model);
}

TEST(PlaneSnap, EveryPointOfAFaceHasItsCoordinate) {
  const gp_Pnt low(-0.1, 0.3, 1.0 / 3), high(0.7, std::numbers::pi, 2.2);
  const Model model = prepare_fluid(BRepPrimAPI_MakeBox(low, high).Shape()).model;
  const Model rebuilt = Model::from_bytes(model.serialise());
  for (int axis = 0; axis < 3; ++axis) {
    for (const Model* each : {&model, &rebuilt}) {
      const double position = spread_of(*each, faces_at(*each, axis, low.Coord(axis + 1))[0], axis).low;
      EXPECT_NEAR(position, low.Coord(axis + 1), 1e-14);
      expect_exact(*each, axis, position);
    }
  }
}

TEST(PlaneSnap, TurningLeavesNoNoise) {
  const TopoDS_Shape upright = BRepPrimAPI_MakeCylinder(1.1, 2.3).Shape();
  const TopoDS_Shape lying = turned(upright, gp_Dir(1, 0, 0), -std::numbers::pi / 2);
  const Model model = prepare_fluid(lying).model;
  expect_exact(model, 1, 0);
  const std::vector<FaceId> far_end = faces_at(model, 1, 2.3);
  ASSERT_EQ(far_end.size(), 1u);
  EXPECT_EQ(spread_of(model, far_end[0], 1).width(), 0);
}

TEST(PlaneSnap, PlanesThatNearlyCoincideAreOne) {
  const Model model = prepare_fluid(make_towers(1e-12)).model;
  EXPECT_EQ(faces_at(model, 2, 1).size(), 2u);
  expect_exact(model, 2, 1);
}

TEST(PlaneSnap, PlanesApartStayApart) {
  constexpr double step = 1e-6;
  const Model model = prepare_fluid(make_towers(step)).model;
  std::vector<double> heights;
  for (const FaceId f : faces_at(model, 2, 1)) {
    const Spread spread = spread_of(model, f, 2);
    EXPECT_EQ(spread.width(), 0);
    heights.push_back(spread.low);
  }
  ASSERT_EQ(heights.size(), 2u);
  EXPECT_NEAR(std::abs(heights[1] - heights[0]), step, 1e-12);
}

TEST(PlaneSnap, TiltedPlanesAreLeftAlone) {
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(1, 2, 3).Shape();
  for (const double tilt : {1e-3, 1e-6, 1e-8}) {
    const Model model = prepare_fluid(turned(box, gp_Dir(0, 0, 1), tilt)).model;
    for (const FaceId f : faces_at(model, 2, 0)) EXPECT_EQ(spread_of(model, f, 2).width(), 0);
    int tilted = 0;
    for (FaceId f = 0; f < model.face_count(); ++f) {
      const Vec3 normal = model.face_frame(f, model.facets(f, 0.1, 0.5).uv.front()).normal;
      if (std::abs(normal.x) < 0.9) continue;
      EXPECT_NEAR(spread_of(model, f, 0).width(), 2 * std::sin(tilt), 0.01 * tilt) << tilt;
      ++tilted;
    }
    EXPECT_EQ(tilted, 2);
  }
}

// A slanted face keeps its points but for those on the edges it shares with exact planes.
TEST(PlaneSnap, NeighboursMeetThePlaneOnly) {
  const Model model = prepare_fluid(prism({{0, 1e-12}, {3, 1e-12}, {1, 1}, {0, 1}}, 2)).model;
  expect_exact(model, 2, 0);
  int slanted = 0;
  for (FaceId f = 0; f < model.face_count(); ++f) {
    const SurfaceFrame frame = model.face_frame(f, model.facets(f, 0.1, 0.5).uv.front());
    if (std::abs(frame.normal.x) < 0.1 || std::abs(frame.normal.z) < 0.1) continue;
    ++slanted;
    const Spread spread = spread_of(model, f, 2);
    EXPECT_NEAR(spread.low, 0, 1e-3);
    EXPECT_GT(spread.width(), 0.99);
    for (const Vec3 p : model.facets(f, 0.01, 0.2).points)
      EXPECT_NEAR(dot(p - frame.point, frame.normal), 0, 1e-11);
  }
  EXPECT_EQ(slanted, 1);
}

}  // namespace
}  // namespace aeroloom::cad
