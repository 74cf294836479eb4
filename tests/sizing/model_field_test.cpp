#include "sizing/features/face_samples.hpp"
#include "sizing/features/model_sources.hpp"
#include "sizing/field/size_field.hpp"
#include "tests/cad/primitives.hpp"
#include "tests/several_ranks.hpp"
#include "tests/wall_bodies.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <random>

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <gp_Ax2.hxx>
#include <gp_Elips.hxx>
#include <gtest/gtest.h>

using namespace aeroloom;
using cad::Model;
using cad::PrimitiveKind;
using geometry::Vec3;
using sizing::SizeField;
using sizing::SizingOptions;

namespace {

SizeField build(const Model& model, const SizingOptions& options) {
  return sizing::build_size_field(parallel::Communicator::world(), model, options);
}

Vec3 random_direction(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return geometry::normalized(Vec3{normal(random), normal(random), normal(random)});
}

Model box_with_sphere(double side, double radius) {
  cad::PrimitiveDimensions dimensions;
  dimensions.box = {side, side, side};
  dimensions.radius = radius;
  return make_primitive_domain(PrimitiveKind::box_with_sphere, dimensions);
}

std::int64_t hash(const SizeField& field) {
  std::mt19937_64 random(5);
  const Vec3 low = field.domain().low, size = field.domain().size();
  std::uniform_real_distribution<double> unit(0, 1);
  std::uint64_t result = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p = low + Vec3{unit(random) * size.x, unit(random) * size.y, unit(random) * size.z};
    result = std::rotl(result, 7) * 3 ^ std::bit_cast<std::uint64_t>(field(p));
  }
  return static_cast<std::int64_t>(result >> 1);
}

}  // namespace

/// What was sampled for other sizes, finer or coarser, does not show.
TEST(FaceSamplesLocal, AnswerAsIfAskedForTheFirstTime) {
  cad::PrimitiveDimensions dimensions;
  dimensions.radius = 0.3;
  dimensions.major_radius = 1;
  const Model torus = make_primitive_domain(PrimitiveKind::torus, dimensions);
  const cad::Facets facets = sizing::sampling_facets(torus, 0, false);
  sizing::FaceSamples kept(torus.is_planar(0));
  int finer = 0;
  for (const double minimum : {0.05, 0.01, 0.2, 0.02}) {
    const SizingOptions options{minimum, 2, 300 * minimum, 1.3, 2 * minimum};
    sizing::FaceSamples fresh(torus.is_planar(0));
    const auto expected = fresh.sources(torus, 0, facets, false, options);
    const auto sources = kept.sources(torus, 0, facets, false, options);
    finer += expected.size() > facets.points.size();
    ASSERT_EQ(sources.size(), expected.size()) << minimum;
    for (std::size_t i = 0; i < sources.size(); ++i) {
      EXPECT_EQ(sources[i].size, expected[i].size);
      EXPECT_EQ(distance(sources[i].point, expected[i].point), 0);
    }
  }
  EXPECT_EQ(finer, 3) << "all but the coarsest ask for more than the facets have";
}

/// Long facets, narrower than the size, are covered along some of them, and no more densely than that.
TEST(FaceSamplesLocal, AreAsManyAlongSlenderFacetsAsTheirLengthHasRoomFor) {
  constexpr double length = 1000, size = 4;
  const Model pipe = shapes::domain_of(BRepPrimAPI_MakeCylinder(1, length).Shape());
  cad::FaceId side = 0;
  while (pipe.is_planar(side)) ++side;
  const cad::Facets facets = sizing::sampling_facets(pipe, side, false);
  ASSERT_LT(facets.triangles.size(), 100);
  sizing::FaceSamples samples(false);
  const auto sources = samples.sources(pipe, side, facets, false, {size, 100, 15, 1.3, size});
  EXPECT_LT(static_cast<double>(sources.size()),
            0.6 * static_cast<double>(facets.triangles.size()) * length / size);
  const double parts = samples.overview(pipe, side, facets, false, {size, 100, 15, 1.3, size}).parts;
  EXPECT_LT(parts, 3 * static_cast<double>(sources.size()));
  EXPECT_GT(parts, static_cast<double>(sources.size()) / 3);
  for (double along = 0; along < length; along += 0.7) {
    const Vec3 place{std::cos(along), std::sin(along), along};
    double nearest = length;
    for (const sizing::SizeSource& source : sources)
      nearest = std::min(nearest, distance(source.point, place));
    EXPECT_LT(nearest, 0.5 * size);
  }
}

TEST(ModelField, SphereGetsTheCurvatureAngle) {
  const SizingOptions options{0.001, 2, 12, 1.3, 0};
  const SizeField field = build(box_with_sphere(10, 1), options);
  const double asked = 12 * std::numbers::pi / 180;
  std::mt19937_64 random(1);
  double sum = 0;
  for (int i = 0; i < 5000; ++i) {
    const double h = field(random_direction(random));
    EXPECT_GT(h, 0.95 * asked);
    EXPECT_LT(h, 1.1 * asked);
    sum += h;
  }
  EXPECT_NEAR(sum / 5000, asked, 0.03 * asked);
  EXPECT_GT(field({4.9, 4.9, 4.9}), 1.5);
}

TEST(ModelField, BoundsRule) {
  const SizeField coarse = build(box_with_sphere(10, 1), {0.3, 0.5, 12, 1.3, 0});
  EXPECT_NEAR(coarse({1, 0, 0}), 0.3, 1e-6);
  EXPECT_NEAR(coarse({5, 5, 5}), 0.5, 1e-6);
}

TEST(ModelField, SurfaceMaximumCapsTheBodyAlone) {
  const SizeField field = build(box_with_sphere(40, 1), {0.01, 4, 90, 1.3, 0.1});
  std::mt19937_64 random(2);
  for (int i = 0; i < 2000; ++i) EXPECT_NEAR(field(random_direction(random)), 0.1, 0.012);
  EXPECT_GT(field({20, 20, 20}), 3.9);
}

TEST(ModelField, CylinderIsCoveredAllAlong) {
  cad::PrimitiveDimensions dimensions;
  dimensions.radius = 0.5;
  dimensions.height = 8;
  const SizeField field =
      build(make_primitive_domain(PrimitiveKind::cylinder, dimensions), {0.001, 5, 15, 1.5, 0});
  const double asked = 0.5 * 15 * std::numbers::pi / 180;
  for (int i = 0; i < 2000; ++i) {
    const double z = -4 + 8 * (i + 0.5) / 2000, angle = 2.4 * i;
    EXPECT_NEAR(field({0.5 * std::cos(angle), 0.5 * std::sin(angle), z}), asked, 0.1 * asked);
  }
}

TEST(ModelField, ShortEdgesAskForTheirLength) {
  cad::PrimitiveDimensions dimensions;
  dimensions.box = {4, 4, 0.05};
  const Model plate = make_primitive_domain(PrimitiveKind::box, dimensions);
  EXPECT_NEAR(build(plate, {0.01, 1, 12, 1.3, 0})({2, 2, 0}), 0.05, 1e-6);
  EXPECT_NEAR(build(plate, {0.1, 1, 12, 1.3, 0})({2, 2, 0}), 0.05, 1e-6);
  EXPECT_NEAR(build(plate, {0.8, 1, 12, 1.3, 0})({2, 2, 0}), 0.05, 1e-6);
  // The minimum binds features at a twentieth of it, or as told.
  EXPECT_NEAR(build(plate, {2, 3, 12, 1.3, 0})({2, 2, 0}), 0.1, 1e-6);
  SizingOptions bound{0.8, 1, 12, 1.3, 0};
  bound.feature_minimum = 0.2;
  EXPECT_NEAR(build(plate, bound)({2, 2, 0}), 0.2, 1e-6);
}

TEST(ModelField, NarrowFacesAskForTheirWidth) {
  cad::PrimitiveDimensions dimensions;
  dimensions.box = {4, 4, 0.05};
  const SizeField field =
      build(make_primitive_domain(PrimitiveKind::box, dimensions), {0.04, 1, 12, 1.3, 0, 0});
  for (double x = -2; x <= 2; x += 0.01) EXPECT_NEAR(field({x, 2, 0.025}), 0.05, 1e-6);
  EXPECT_GT(field({0, 0, 0.025}), 0.3);
  // A disc with opposite edges far apart is not narrow.
  dimensions.radius = 1;
  dimensions.height = 2;
  const SizeField round =
      build(make_primitive_domain(PrimitiveKind::cylinder, dimensions), {0.01, 0.5, 60, 1.3, 0});
  EXPECT_NEAR(round({1, 0, 0}), 0.5, 1e-6);
}

TEST(ModelField, NarrowPlacesBetweenPartsOfOneEdgeAskForTheirWidth) {
  // Top and bottom have one edge each, an ellipse.
  const gp_Elips ellipse(gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), 2, 0.05);
  BRepBuilderAPI_MakeWire outline(BRepBuilderAPI_MakeEdge(ellipse).Edge());
  const Model plate = shapes::domain_of(
      BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(outline.Wire()), gp_Vec(0, 0, 1)).Shape());
  const SizeField field = build(plate, {0.03, 1, 60, 1.3, 0, 0});
  for (double x = -1.5; x <= 1.5; x += 0.05) {
    const double half = 0.05 * std::sqrt(1 - x * x / 4);
    EXPECT_LT(field({x, half, 1}), 1.1 * 2 * half) << x;
    EXPECT_GT(field({x, half, 1}), 0.7 * 2 * half) << x;
  }
}

TEST(ModelField, WidthsAreThoseBetweenTheNearestLinesThatFaceEachOther) {
  // The top of the box is a strip of half the width of its sides: these do not face each other across it.
  cad::PrimitiveDimensions dimensions;
  dimensions.box = {4, 0.1, 0.2};
  const SizeField field =
      build(make_primitive_domain(PrimitiveKind::box, dimensions), {0.05, 1, 12, 1.3, 0, 0});
  for (double x = -1.9; x <= 1.9; x += 0.01) {
    EXPECT_NEAR(field({x, 0.05, 0.1}), 0.1, 1e-6) << x;
  }
}

TEST(ModelField, IsTheSameForAnyRankCount) {
  NEEDS_SEVERAL_RANKS();
  const SizingOptions options{0.01, 1, 12, 1.3, 0.3};
  for (const PrimitiveKind kind :
       {PrimitiveKind::torus, PrimitiveKind::cylinder, PrimitiveKind::box_with_sphere}) {
    const Model model = cad::make_primitive_domain(kind);
    const std::int64_t alone = hash(sizing::build_size_field(parallel::Communicator::self(), model, options));
    const std::int64_t together = hash(build(model, options));
    EXPECT_EQ(alone, together);
    const auto world = parallel::Communicator::world();
    EXPECT_EQ(world.minimum(together), world.maximum(together));
  }
}

TEST(ModelField, RefusesImpossibleOptionsOnEveryRank) {
  const Model model = cad::make_primitive_domain(PrimitiveKind::box);
  EXPECT_THROW(build(model, {0, 1, 12, 1.3, 0}), std::invalid_argument);
}
