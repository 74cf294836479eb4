// Sizes fall to the thickness of thin parts and to the width of gaps, but not along wedges.
#include "sizing/features/proximity.hpp"

#include "cad/domain/domain.hpp"
#include "sizing/features/model_sources.hpp"
#include "sizing/field/size_field.hpp"
#include "tests/cad/primitives.hpp"
#include "tests/wall_bodies.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeWedge.hxx>
#include <BRepTools.hxx>
#include <TopoDS_Shape.hxx>
#include <gp_Ax2.hxx>
#include <gp_Circ.hxx>
#include <gp_Dir.hxx>
#include <gp_Pnt.hxx>
#include <gp_Vec.hxx>
#include <gtest/gtest.h>
#include <unistd.h>

using namespace aeroloom;
using cad::Model;
using cad::PrimitiveKind;
using geometry::Vec3;
using sizing::SizeField;
using sizing::SizingOptions;

namespace {

SizeField build(const Model& model, double proximity, double minimum = 0.001) {
  const SizingOptions options{minimum, 1, 30, 1.3, 0, proximity};
  return sizing::build_size_field(parallel::Communicator::world(), model, options);
}

Model plate(double thickness, double side = 2) {
  cad::PrimitiveDimensions dimensions;
  dimensions.box = {side, side, thickness};
  return make_primitive_domain(PrimitiveKind::box, dimensions);
}

/// A wedge with a sharp edge of the given angle: a body in a far field, or the fluid.
Model wedge(double degrees, cad::DomainKind kind = cad::DomainKind::body) {
  const std::string file =
      (std::filesystem::temp_directory_path() / ("aeroloom_wedge_" + std::to_string(::getpid()) + ".brep"))
          .string();
  // A right triangle extruded: legs 1 and tan(angle).
  const double height = std::tan(degrees * M_PI / 180);
  BRepTools::Write(BRepPrimAPI_MakeWedge(1, height, 1, 0).Shape(), file.c_str());
  cad::DomainOptions options;
  options.file = file;
  options.kind = kind;
  Model model = prepare_domain(options).model;
  std::filesystem::remove(file);
  return model;
}

}  // namespace

TEST(Proximity, ThinPlateGetsItsThickness) {
  const Model thin = plate(0.02, 0.8);
  for (const double layers : {1.0, 3.0}) {
    const SizeField field = build(thin, layers);
    for (const double x : {-0.3, 0.0, 0.25}) {
      const double h = field({x, 0.12, 0});
      EXPECT_LE(h, 1.7 * 0.02 / layers);
      EXPECT_GE(h, 0.5 * 0.02 / layers);
    }
  }
}

TEST(Proximity, ZeroTurnsItOff) {
  EXPECT_GT(build(plate(0.02), 0)({0, 0, 0}), 5 * 0.02);
}

TEST(Proximity, MinimumBinds) {
  EXPECT_GE(build(plate(0.02), 1, 0.05)({0, 0, 0}), 0.05);
}

TEST(Proximity, WidePartsAskForNothing) {
  const Model cube = plate(2);
  EXPECT_NEAR(build(cube, 1)({0, 0, 0.9}), build(cube, 0)({0, 0, 0.9}), 1e-6);
}

TEST(Proximity, ASharpEdgeDoesNotDriveSizesDown) {
  const Model sharp = wedge(20);
  const SizeField field = build(sharp, 1);
  // On the sloping side, close to the sharp edge, which lies along z at x = 1, y = 0 or x = 0, y = height.
  double least = 1e300;
  for (cad::FaceId f = 0; f < sharp.face_count(); ++f) {
    if (sharp.is_far_field(f)) continue;
    for (const Vec3 p : sharp.facets(f, 0.01, 0.3).points) least = std::min(least, field(p));
  }
  EXPECT_GT(least, 0.05);
}

namespace {

SizeField build_with_gaps(const Model& model, double gap_minimum) {
  SizingOptions options{0.1, 1, 30, 1.3, 0, 1};
  options.feature_minimum = options.minimum;
  options.gap_minimum = gap_minimum;
  return sizing::build_size_field(parallel::Communicator::world(), model, options);
}

}  // namespace

TEST(OpenGaps, AskForLessThanTheMinimumWhereAllowedTo) {
  // Narrower than a hundredth of what rays are apart at first.
  const Model slot = plate(0.004, 1);
  EXPECT_GE(build_with_gaps(slot, 0)({0, 0, 0}), 0.0999);
  const SizeField resolved = build_with_gaps(slot, 0.001);
  for (double x = -0.47; x < 0.5; x += 0.0513) {
    const double h = resolved({x, 0.16, 0});
    EXPECT_LE(h, 2 * 0.004);
    EXPECT_GE(h, 0.5 * 0.004);
  }
  EXPECT_GE(build_with_gaps(slot, 0.05)({0, 0, 0}), 0.0499);
}

namespace {

/// The same as a body, from (0, 0, 0) to (side, thickness, side).
Model plate_in_far_field(double thickness, double side = 2) {
  cad::DomainOptions options;
  options.kind = cad::DomainKind::body;
  const std::string file =
      (std::filesystem::temp_directory_path() / ("aeroloom_plate_" + std::to_string(::getpid()) + ".brep"))
          .string();
  BRepTools::Write(BRepPrimAPI_MakeWedge(side, thickness, side, side).Shape(), file.c_str());
  options.file = file;
  Model body = prepare_domain(options).model;
  std::filesystem::remove(file);
  return body;
}

/// Elements wanted across thin parts, and across gaps.
SizeField build_with_elements(const Model& model, double thin, double gap) {
  SizingOptions options{0.008, 1, 30, 1.3, 0, thin};
  options.gap_proximity = gap;
  return sizing::build_size_field(parallel::Communicator::world(), model, options);
}

}  // namespace

TEST(OpenGaps, AreMeshed) {
  // Nothing is between the sides of a body.
  EXPECT_GE(build_with_gaps(plate_in_far_field(0.01), 0.001)({1, 0.01, 1}), 0.0999);
}

TEST(OpenGaps, AreToldFromThinParts) {
  const Model gap = plate(0.04, 1.2), part = plate_in_far_field(0.04, 1.2);
  const auto in_gap = [&](double thin, double of_gap) {
    return build_with_elements(gap, thin, of_gap)({0, 0, 0});
  };
  const auto on_part = [&](double thin, double of_gap) {
    return build_with_elements(part, thin, of_gap)({0.6, 0.04, 0.6});
  };
  const double open = in_gap(1, 4), both = in_gap(4, 4), thin = on_part(4, 1);
  EXPECT_LT(open, 0.6 * 0.04);
  EXPECT_EQ(open, in_gap(0, 4));
  EXPECT_EQ(in_gap(4, -1), both);
  EXPECT_GT(in_gap(4, 1), 2.2 * both);
  EXPECT_NEAR(thin, 0.01, 0.004);
  EXPECT_EQ(thin, on_part(4, 0));
  EXPECT_GT(on_part(1, 4), 2.2 * thin);
}

TEST(OpenGaps, AWedgeIsNone) {
  const Model sharp = wedge(4, cad::DomainKind::fluid);
  const SizeField field = build_with_gaps(sharp, 0.001);
  double least = 1e300;
  for (cad::FaceId f = 0; f < sharp.face_count(); ++f) {
    for (const Vec3 p : sharp.facets(f, 0.01, 0.3).points) least = std::min(least, field(p));
  }
  EXPECT_GE(least, 0.0999);
}

TEST(OpenGaps, AreBetweenSurfacesWhereFacetsAreFartherOff) {
  // Facets of both are about 0.003 off.
  const Model annulus = shapes::domain_of(
      BRepAlgoAPI_Cut(BRepPrimAPI_MakeCylinder(1.008, 0.1).Shape(), BRepPrimAPI_MakeCylinder(1, 0.1).Shape())
          .Shape());
  const SizeField field = build_with_gaps(annulus, 0.001);
  for (double turn = 0.1; turn < 6; turn += 0.7) {
    const double h = field({1.004 * std::cos(turn), 1.004 * std::sin(turn), 0.05});
    EXPECT_LE(h, 2 * 0.008);
    EXPECT_GE(h, 0.5 * 0.008);
  }
}

namespace {

/// Between two arcs that run together in a cusp, the upper one of radius 1, the lower one of radius 2; 0.2
/// high.
Model cusp() {
  constexpr double turn = 0.9;
  const auto on_circle = [](double radius, double angle) {
    return gp_Pnt(radius * std::sin(angle), radius * (1 - std::cos(angle)), 0);
  };
  const auto arc = [&](double radius, double angle) {
    const gp_Circ circle(gp_Ax2(gp_Pnt(0, radius, 0), gp_Dir(0, 0, 1)), radius);
    return BRepBuilderAPI_MakeEdge(circle, on_circle(radius, 0), on_circle(radius, angle)).Edge();
  };
  const double below = std::asin(0.5 * std::sin(turn));
  BRepBuilderAPI_MakeWire wire(arc(2, below), arc(1, turn));
  wire.Add(BRepBuilderAPI_MakeEdge(on_circle(2, below), on_circle(1, turn)).Edge());
  return shapes::domain_of(
      BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(wire.Wire()), gp_Vec(0, 0, 0.2)).Shape());
}

std::vector<sizing::ModelFacet> facets_of(const Model& model, cad::FaceId face, const cad::Facets& facets) {
  std::vector<sizing::ModelFacet> all;
  const std::vector<double> deviations = sizing::facet_deviations(model, face, facets);
  const std::vector<double> curvatures = sizing::facet_curvatures(model, face, facets);
  for (std::size_t i = 0; i < deviations.size(); ++i) {
    const auto& [a, b, c] = facets.triangles[i];
    all.push_back({face,
                   {facets.points[a], facets.points[b], facets.points[c]},
                   {facets.uv[a], facets.uv[b], facets.uv[c]},
                   deviations[i],
                   curvatures[i]});
  }
  return all;
}

/// The first face with that curvature.
cad::FaceId face_of_curvature(const Model& model, double curvature) {
  for (cad::FaceId f = 0; f < model.face_count(); ++f) {
    const auto there = model.face_curvatures(f, model.facets(f, 1, 0.3).uv[0]);
    if (there.defined && std::abs(std::abs(there.largest) - curvature) < 1e-6) return f;
  }
  return cad::no_entity;
}

}  // namespace

TEST(OpenGaps, AreNotToldFromACuspByFacetsThatReachToIt) {
  const Model model = cusp();
  const cad::FaceId upper = face_of_curvature(model, 1), lower = face_of_curvature(model, 0.5);
  ASSERT_NE(upper, cad::no_entity);
  ASSERT_NE(lower, cad::no_entity);
  // Beside the cusp some facets of the upper one are as steep as those below them, or less.
  for (const auto& [angle, angle_below] : {std::pair(0.45, 0.15), std::pair(0.3, 0.1)}) {
    const cad::Facets facets = model.facets(upper, 1, angle);
    const sizing::ModelFacets walls(facets_of(model, lower, model.facets(lower, 1, angle_below)));
    sizing::FaceGapSearch search(model, upper, facets, walls, {1, 0.01, 1, true});
    sizing::Gaps gaps;
    search.go_on(10'000'000, gaps);
    EXPECT_GT(gaps.seen.size(), 100);
    for (const sizing::Gap& gap : gaps.open) EXPECT_GT(gap.point.x, 0.25) << gap.width;
  }
}

// Behind the corners of the slender side faces elements fit between the edges, and nothing is finer than
// that.
TEST(SharpCorners, SizesFitBetweenTheEdges) {
  const double half = 5 * M_PI / 180;
  const Model sharp = wedge(10);
  SizingOptions options{1e-4, 1, 30, 1.3, 0.2, 0};
  const auto least_on_bisector = [&](double feature_minimum) {
    options.feature_minimum = feature_minimum;
    const SizeField field = sizing::build_size_field(parallel::Communicator::world(), sharp, options);
    double least = 1;
    for (double r = 0.02; r < 1; r += 0.01) {
      // The sharp corners lie at x = 1, z = 0 and 1; the other sides at x = 0.
      for (const double z : {0.0, 1.0}) {
        const double size = field({1 - r * std::cos(half), r * std::sin(half), z});
        least = std::min(least, size);
        if (r > 0.25 && r < 0.4) {
          EXPECT_LE(size, 1.0001 * std::max(feature_minimum, 1.15 * 2 * r * std::sin(half)));
        }
      }
    }
    return least;
  };
  EXPECT_GT(least_on_bisector(0), 0.5 * 0.2 * 2 * std::sin(half));
  EXPECT_GE(least_on_bisector(0.1), 0.0999);
}

namespace {

/// The search of one face of a plate, with so many nodes at a time.
struct PlateSearch {
  PlateSearch() = default;
  PlateSearch(Model other, const sizing::GapLimits& what) : model(std::move(other)), limits(what) {}

  Model model = plate(0.02);
  sizing::GapLimits limits{0.1, 0.005, 1, true};
  cad::FaceId face = [&] {
    cad::FaceId largest = cad::no_entity;
    for (cad::FaceId f = 0; f < model.face_count(); ++f) {
      if (!model.is_far_field(f) &&
          (largest == cad::no_entity || model.face_area(f) > model.face_area(largest)))
        largest = f;
    }
    return largest;
  }();
  cad::Facets facets = model.facets(face, 0.1, 0.3);
  sizing::ModelFacets walls = [&] {
    std::vector<sizing::ModelFacet> all;
    for (cad::FaceId f = 0; f < model.face_count(); ++f) {
      if (model.is_far_field(f)) continue;
      const std::vector<sizing::ModelFacet> more = facets_of(model, f, model.facets(f, 0.1, 0.3));
      all.insert(all.end(), more.begin(), more.end());
    }
    return sizing::ModelFacets(std::move(all));
  }();
  sizing::FaceGapSearch search{model, face, facets, walls, limits};
  sizing::Gaps gaps;
};

}  // namespace

TEST(FaceGapSearch, EndsEarlyWithTheWorkAndSaysWhatWasNotLookedAt) {
  PlateSearch whole, part;
  const std::int64_t all = whole.search.go_on(100'000'000, whole.gaps);
  ASSERT_TRUE(whole.gaps.unseen.empty());
  ASSERT_GT(whole.gaps.seen.size(), 100);
  const std::int64_t quarter = all / 4, visited = part.search.go_on(quarter, part.gaps);
  EXPECT_NEAR(visited, quarter, 0.1 * all);
  EXPECT_FALSE(part.gaps.unseen.empty());
  // Every part of the face has its share.
  double low = 1e300, high = -1e300;
  for (const sizing::Gap& gap : part.gaps.seen) {
    const double along = gap.point.x + gap.point.y + gap.point.z;
    low = std::min(low, along), high = std::max(high, along);
  }
  double lowest = 1e300, highest = -1e300;
  for (const sizing::Gap& gap : whole.gaps.seen) {
    const double along = gap.point.x + gap.point.y + gap.point.z;
    lowest = std::min(lowest, along), highest = std::max(highest, along);
  }
  EXPECT_GT(high - low, 0.8 * (highest - lowest));
  // What is left over is looked at later.
  for (int more = 0; more < 40 && !part.gaps.unseen.empty(); ++more) part.search.go_on(all / 4, part.gaps);
  EXPECT_TRUE(part.gaps.unseen.empty());
  EXPECT_EQ(part.gaps.seen.size(), whole.gaps.seen.size());
  EXPECT_EQ(part.gaps.open.size(), whole.gaps.open.size());
}

/// A slot that closes towards one end: few rays find about how narrow it is there, wherever a search begins.
TEST(FaceGapSearch, LooksCloserWhereGapsAreNarrowest) {
  for (const bool turned : {false, true}) {
    const double left = turned ? 0.002 : 0.05, right = turned ? 0.05 : 0.002;
    const Model model = shapes::prism({{0, 0}, {1, 0}, {1, right}, {0, left}});
    PlateSearch slot(model, {0.1, 0.3, 1});
    slot.search.go_on(1'000'000, slot.gaps);
    ASSERT_FALSE(slot.gaps.narrow.empty());
    const auto narrowest = [&] {
      double width = 1;
      for (const sizing::Gap& gap : slot.gaps.open) width = std::min(width, gap.width);
      return width;
    };
    EXPECT_GT(narrowest(), 0.0035);
    const sizing::LookedAt took = slot.search.look_closer(1, {2000, 1'000'000}, slot.gaps);
    EXPECT_LE(took.rays, 2001);
    EXPECT_LT(narrowest(), 0.0023);
    EXPECT_FALSE(slot.gaps.narrow.empty());
    const auto coarseness = [](const sizing::Gaps::Part& part) {
      return sizing::longest_edge(part.triangle).length / part.gap;
    };
    double least = 1e300, most = 0;
    for (const sizing::Gaps::Part& part : slot.gaps.narrow) {
      least = std::min(least, coarseness(part));
      most = std::max(most, coarseness(part));
    }
    EXPECT_LT(most, 3 * least);
  }
}
