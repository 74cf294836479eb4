#include "sizing/lifting/lifting.hpp"

#include "cad/domain/domain.hpp"
#include "sizing/sources/surface_request.hpp"
#include "tests/cad/real_files.hpp"
#include "tests/sizing/thin_aircraft.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

namespace aeroloom::sizing {
namespace {

using geometry::Vec3;

/// The built-in aircraft of the default dimensions, made once.
const cad::Model& built_in_aircraft() {
  static const cad::Model model = [] {
    cad::DomainOptions options;
    options.transport = cad::TransportDimensions{};
    return cad::prepare_domain(options).model;
  }();
  return model;
}

LiftingBodies find(const cad::Model& model, const std::vector<FaceRole>& roles = {}) {
  const SampledModel sampled(parallel::Communicator::world(), model, roles);
  return find_lifting_bodies(sampled, {1, 0, 0});
}

LiftingBodies find(const cad::DomainOptions& options) {
  return find(cad::prepare_domain(options).model);
}

LiftingBodies find_in(const std::string& name) {
  cad::DomainOptions options;
  options.file = cad::real::file(name);
  return find(options);
}

/// The chord of the outermost station.
double tip_chord(const LiftingBodies& bodies) {
  const LiftingStation* tip = nullptr;
  for (const LiftingElement& element : bodies.elements) {
    for (const LiftingStation& station : element.stations)
      if (tip == nullptr || std::abs(station.trailing.y) > std::abs(tip->trailing.y)) tip = &station;
  }
  return tip == nullptr ? 0 : tip->chord;
}

double degrees(double angle) {
  return angle * std::numbers::pi / 180;
}

TEST(Lifting, OfTheBuiltInAircraft) {
  const LiftingBodies bodies = find(built_in_aircraft());
  ASSERT_EQ(bodies.elements.size(), 5u);
  const cad::LiftingSurface wing = cad::TransportDimensions{}.wing;
  EXPECT_NEAR(bodies.semispan, wing.half_span, 0.01 * wing.half_span);
  int wings = 0;
  for (const LiftingElement& element : bodies.elements) {
    const Vec3 at = element.stations.front().leading;
    if (at.x > 25) continue;
    ++wings;
    for (const LiftingStation& station : element.stations) {
      const double y = std::abs(station.leading.y), share = y / wing.half_span;
      const double chord = wing.root_chord * (1 - share * (1 - wing.taper));
      EXPECT_NEAR(station.chord, chord, 0.01 * chord);
      // Incidence turns the section about its quarter chord: the nose moves by a few thousandths.
      EXPECT_NEAR(station.leading.x, wing.x + y * std::tan(degrees(wing.sweep)), 0.002 * chord);
    }
    double innermost = 100, outermost = 0;
    ASSERT_EQ(element.leading.size(), 1u);
    for (const Vec3 p : element.leading.front().points)
      innermost = std::min(innermost, std::abs(p.y)), outermost = std::max(outermost, std::abs(p.y));
    EXPECT_LT(innermost, 0.5 * cad::TransportDimensions{}.fuselage_diameter);
    EXPECT_GT(outermost, 0.995 * wing.half_span);
  }
  EXPECT_EQ(wings, 2);
}

TEST(Wakes, BeginAtBothBordersOfAStrip) {
  const cad::Model& model = built_in_aircraft();
  const auto length_behind = [&](const std::vector<std::string>& names, Vec3 flow) {
    double length = 0;
    for (const auto& [a, b] : trailing_segments(model, faces_like(model, names), flow))
      length += distance(a, b);
    return length;
  };
  const double of_strip = length_behind({"wing_left_trailing_edge"}, {3, 0, 0});
  EXPECT_GT(of_strip, 2 * 14);  // both, each longer than the half span outside the fuselage
  EXPECT_NEAR(of_strip, length_behind({"wing_left_upper", "wing_left_lower"}, {1, 0, 0}), 0.01 * of_strip);
  EXPECT_EQ(of_strip, length_behind({"wing_left_trailing_edge"}, {1, 0, 0}));
  EXPECT_EQ(length_behind({"wing_left_trailing_edge"}, {-1, 0, 0}), 0);
}

TEST(Lifting, OfNamedFacesAlone) {
  const cad::Model& model = built_in_aircraft();
  const SampledModel sampled(parallel::Communicator::world(), model);
  const auto named = [&](const std::vector<std::string>& names) {
    return find_lifting_bodies(sampled, {1, 0, 0}, names);
  };
  EXPECT_EQ(named({"wing_*"}).elements.size(), 2u);
  EXPECT_EQ(named({"wing_left*", "vertical_tail*"}).elements.size(), 2u);
  EXPECT_TRUE(named({"fuselage*"}).elements.empty());
  try {
    named({"wing_*", "canard*"});
    FAIL();
  } catch (const std::exception& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("sizing.lifting: no face and no patch of this model is like 'canard*'"),
              std::string::npos)
        << text;
  }
}

TEST(Lifting, OfSharpEdges) {
  const LiftingBodies bodies = find(shapes::thin_aircraft());
  ASSERT_EQ(bodies.elements.size(), 5u);
  for (const LiftingElement& element : bodies.elements) {
    const Vec3 at = element.stations.front().leading;
    const bool of_horizontal_tail = at.x > 25 && std::abs(at.y) > 0.5;
    EXPECT_EQ(element.blunt_face == cad::no_entity, of_horizontal_tail) << at.x << " " << at.y;
  }
}

// Half a wing in two parts with a nacelle below it; its pylon ends in an edge of its own.
TEST(Lifting, OfAHalfModelWithNacelle) {
  const char* name = "aircraft/gmsh_dlr_f6.brep";
  if (!cad::real::has(name)) GTEST_SKIP();
  cad::DomainOptions options;
  options.file = cad::real::file(name);
  const cad::Model model = cad::prepare_domain(options).model;
  std::vector<FaceRole> roles;  // its box ends near the wing tip
  for (cad::FaceId f = 0; f < model.face_count(); ++f)
    roles.push_back(model.patches()[model.face(f).patch] == "body" ? FaceRole::open : FaceRole::far_field);
  const LiftingBodies bodies = find(model, roles);
  ASSERT_EQ(bodies.elements.size(), 4u);
  EXPECT_NEAR(bodies.semispan, 586, 1);
  EXPECT_NEAR(tip_chord(bodies), 61, 1);
  // The nacelle is an annular wing of one chord.
  const auto is_nacelle = [](const LiftingElement& element) {
    return std::all_of(element.stations.begin(), element.stations.end(),
                       [](const LiftingStation& at) { return std::abs(at.chord - 180) < 1; });
  };
  EXPECT_EQ(std::count_if(bodies.elements.begin(), bodies.elements.end(), is_nacelle), 1);
}

// One wing of three panels, beside a fuselage of 238 faces.
TEST(Lifting, OfPanelsOneAfterTheOther) {
  const char* name = "aircraft/tigl_D150_fused_aircraft.brep";
  if (!cad::real::has(name)) GTEST_SKIP();
  const LiftingBodies bodies = find_in(name);
  ASSERT_EQ(bodies.elements.size(), 3u);
  EXPECT_NEAR(tip_chord(bodies), 1.57, 0.05);
  EXPECT_NEAR(bodies.reference_chord, 3.9, 0.1);
  // Panels do not reach into one another.
  for (const LiftingElement& element : bodies.elements) {
    ASSERT_EQ(element.leading.size(), 1u);
    for (const Vec3 p : element.leading.front().points) {
      EXPECT_GT(p.y, element.stations.front().leading.y - 0.7);
      EXPECT_LT(p.y, element.stations.back().leading.y + 0.2);
    }
  }
}

}  // namespace
}  // namespace aeroloom::sizing
