#include "sizing/features/local_chord.hpp"

#include "sizing/lifting/trailing_edges.hpp"
#include "tests/cad/blunt_shapes.hpp"
#include "tests/sizing/thin_aircraft.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::sizing {
namespace {

using geometry::Vec3;

/// A swept wing of unit root chord along y, tapered to a half at y = 2, its section a rhombus that is cut off
/// at `end` of the chord behind the nose; facets of many strips along the span.
struct Wing {
  double first = 0, last = 1;  // of the chord that is covered

  static double chord(double y) { return 1 - 0.25 * y; }
  static Vec3 at(double x, double y, double side) {
    const double half = 0.12 * (x < 0.4 ? x / 0.4 : (1 - x) / 0.6);
    return {0.5 * y + chord(y) * x, y, side * chord(y) * half};
  }

  Skin skin() const {
    constexpr int spans = 20, chords = 16;
    Skin skin;
    const auto x = [&](int i) { return first + (last - first) * i / chords; };
    for (const double side : {-1.0, 1.0}) {
      for (int i = 0; i < chords; ++i) {
        for (int j = 0; j < spans; ++j) {
          const double y = 2.0 * j / spans, y_next = 2.0 * (j + 1) / spans;
          const Vec3 a = at(x(i), y, side), b = at(x(i + 1), y, side), c = at(x(i + 1), y_next, side),
                     d = at(x(i), y_next, side);
          skin.facets.push_back({a, b, c});
          skin.facets.push_back({a, c, d});
          if (i == 0 && first > 0) skin.border.push_back({a, d});
        }
        for (const double y : {0.0, 2.0}) skin.border.push_back({at(x(i), y, side), at(x(i + 1), y, side)});
      }
    }
    return skin;
  }
};

ChordPlace behind(double y) {
  return {Wing::at(1, y, 0), normalized(Wing::at(1, 2, 0) - Wing::at(1, 0, 0)), {-1, 0, 0}, 1e-3};
}

TEST(LocalChord, IsThatOfTheSectionAcross) {
  const Skin skin = Wing().skin();
  for (const double y : {0.2, 0.6, 1.0, 1.4, 1.8}) {
    const double found = local_chord(skin, behind(y));
    EXPECT_GT(found, 0.85 * Wing::chord(y)) << y;
    EXPECT_LT(found, 1.03 * Wing::chord(y)) << y;
  }
}

TEST(LocalChord, WithoutANoseIsTheBreadth) {
  const Skin skin = Wing{0.5, 1}.skin();
  const double found = local_chord(skin, behind(1));
  EXPECT_GT(found, 0.4 * Wing::chord(1));
  EXPECT_LT(found, 0.55 * Wing::chord(1));
  EXPECT_EQ(local_chord({}, behind(1)), 0);
}

TEST(LocalChord, OfTheBuiltInAircraft) {
  constexpr double share = shapes::thin_share;
  const cad::TransportDimensions aircraft = shapes::thin_dimensions();
  const cad::Model& model = shapes::thin_aircraft();
  const SampledModel sampled(parallel::Communicator::world(), model);
  const std::vector<TrailingEdge> edges = find_trailing_edges(sampled, 0.1);
  ASSERT_EQ(edges.size(), 3u);
  for (const TrailingEdge& edge : edges) {
    const std::string& name = model.face(edge.strip.face).name;
    const cad::LiftingSurface& surface = name.starts_with("wing") ? aircraft.wing : aircraft.vertical_tail;
    const double tip = surface.taper * surface.root_chord;
    EXPECT_NEAR(edge.strip.narrowest, share * tip, 0.05 * share * tip) << name;
    EXPECT_GT(edge.chord, 0.7 * tip) << name;
    EXPECT_LT(edge.chord, 1.05 * tip) << name;
    EXPECT_GT(edge.fraction, 0.95 * share) << name;
    EXPECT_LT(edge.fraction, 1.35 * share) << name << ": sections across swept edges are shorter";
    // Thickness and chord fall alike from root to tip.
    for (const cad::BluntStation& station : edge.strip.stations) {
      EXPECT_LT(station.width, 1.02 * edge.strip.widest) << name;
      EXPECT_GT(station.width, 0.98 * edge.strip.narrowest) << name;
    }
  }
}

}  // namespace
}  // namespace aeroloom::sizing
