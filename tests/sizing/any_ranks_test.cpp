/// What tells sizes from a model is the same on any number of ranks, bit for bit. What else it has to be is
/// tested on one.
#include "cad/domain/domain.hpp"
#include "cad/model/topology/joined_faces.hpp"
#include "sizing/choice/choose_sizes.hpp"
#include "sizing/choice/coincident_faces.hpp"
#include "sizing/choice/narrow_regions.hpp"
#include "sizing/choice/predict_counts.hpp"
#include "sizing/features/narrow_faces.hpp"
#include "sizing/lifting/level_requests.hpp"
#include "sizing/lifting/lifting.hpp"
#include "sizing/lifting/trailing_edges.hpp"
#include "tests/cad/made_once.hpp"
#include "tests/cad/primitives.hpp"
#include "tests/cad/strip_shapes.hpp"
#include "tests/references.hpp"
#include "tests/wall_bodies.hpp"

#include <functional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::sizing {
namespace {

using cad::Model;
using geometry::Vec3;
using parallel::Communicator;

/// Values as text, each bit of them.
class Findings {
public:
  Findings& operator<<(double value) {
    _text << std::hexfloat << value << '\n';
    return *this;
  }
  Findings& operator<<(std::int64_t value) {
    _text << value << '\n';
    return *this;
  }
  Findings& operator<<(std::int32_t value) { return *this << std::int64_t{value}; }
  Findings& operator<<(Vec3 p) { return *this << p.x << p.y << p.z; }
  Findings& operator<<(const PredictedCounts& counts) {
    return *this << counts.triangles << counts.tetrahedra;
  }
  Findings& operator<<(const FeatureResolution& features) {
    return *this << features.aspect << features.floor << features.ratio << std::int64_t{features.limited}
                 << features.resolved_ratio << features.gap_floor << features.gap_ratio;
  }
  Findings& operator<<(const SizingOptions& options) {
    return *this << options.minimum << options.maximum << options.surface_maximum << options.curvature_angle;
  }
  Findings& operator<<(const SizeField& field) {
    *this << field.leaf_count();
    for (std::int64_t leaf = 0; leaf < field.leaf_count(); ++leaf) *this << field.leaf(leaf).size;
    return *this;
  }
  std::string text() const { return _text.str(); }

private:
  std::ostringstream _text;
};

using Outcome = std::function<void(const Communicator&, Findings&)>;

void expect_same(const Outcome& outcome) {
  references::expect_as_on_one_rank([&](const Communicator& communicator) {
    Findings findings;
    outcome(communicator, findings);
    EXPECT_GT(findings.text().size(), 20u);
    return findings.text();
  });
}

Model plate(double thickness) {
  cad::PrimitiveDimensions dimensions;
  dimensions.box = {2, 2, thickness};
  return make_primitive_domain(cad::PrimitiveKind::box, dimensions);
}

TEST(OnAnyRanks, FieldsOfThinPartsAndGaps) {
  expect_same([](const Communicator& ranks, Findings& findings) {
    SizingOptions options{0.008, 1, 30, 1.3, 0, 1};
    options.gap_proximity = 2;
    findings << build_size_field(ranks, plate(0.04), options);
    SizingOptions with_gaps{0.1, 1, 30, 1.3, 0, 1};
    with_gaps.feature_minimum = with_gaps.minimum;
    with_gaps.gap_minimum = 0.01;
    findings << build_size_field(ranks, plate(0.02), with_gaps)
             << build_size_field(ranks, shapes::slotted_block(0.02), with_gaps);
    const GapSearch gaps(SampledModel(ranks, plate(0.02)), {1});
    findings << gaps.narrowest_gap();
    for (const UnseenGaps& unseen : gaps.unseen_gaps())
      findings << unseen.face << unseen.place << unseen.size;
  });
}

TEST(OnAnyRanks, CountsOfTetrahedra) {
  expect_same([](const Communicator& ranks, Findings& findings) {
    const Model model = make_primitive_domain(cad::PrimitiveKind::box_with_sphere);
    const SizingOptions options{0.02, 0.2, 12, 1.3, 0};
    FieldFactory factory(SampledModel(ranks, model), {0}, Fields::several);
    findings << predict_counts(factory.sampled(), factory.build_field(options))
             << factory.build_coarse_field(options).counts
             << factory.estimate_tetrahedra(options, 4, 1'000'000'000).value_or(-1)
             << count_triangles(factory.sampled(), factory.build_field(options));
    for (const BoundedFace& face : factory.faces_bounded_by_minimum(options))
      findings << face.face << face.fraction << face.degrees;
  });
}

TEST(OnAnyRanks, StripsAndNarrowFaces) {
  expect_same([](const Communicator& ranks, Findings& findings) {
    const SizingOptions options{0.05, 0.2, 15, 1.3, 0};
    const std::vector<double> aspects{1, 4, 20};
    for (const Model& model : {cad::shapes::split_cylinder(3, 2), cad::shapes::tapered_wedge(0.01, 0.001),
                               cad::shapes::creased_prism(10)}) {
      FieldFactory factory(SampledModel(ranks, model), {0}, Fields::one);
      for (const NarrowRegion& strip : narrow_regions_below(factory.sampled(), 0.06, 0.05))
        findings << strip.face << strip.width << strip.place;
      for (const double elements : elements_along_narrow_regions(factory.sampled(), aspects, options))
        findings << elements;
      const std::vector<Vec3> places{{0, 0, 0}, {1, 0.5, 0.2}};
      for (const double size : factory.sizes_without_features(places, options)) findings << size;
      for (const NarrowFace& face : find_narrow_faces(ranks, model, 0.06, 0.1))
        findings << face.face << face.into << face.width << face.degrees << face.deviation << face.place;
    }
  });
}

TEST(OnAnyRanks, FieldsOfAModelWhoseFacesAreJoined) {
  expect_same([](const Communicator& ranks, Findings& findings) {
    const Model model = cad::shapes::split_cylinder(3, 2);
    std::vector<NarrowFace> narrow = find_narrow_faces(ranks, model, 0.06, 1e-3);
    const Model joined = cad::join_faces(model, group_narrow_faces(model, narrow, 1e-3));
    EXPECT_LT(joined.face_count(), model.face_count());
    const SizingOptions options{0.05, 0.5, 15, 1.3, 0, 1};
    FieldFactory before(SampledModel(ranks, model), {1}, Fields::several);
    findings << before.build_field(options);
    FieldFactory after(std::move(before), joined);
    const SizeField field = after.build_field(options);
    findings << field << predict_counts(after.sampled(), field) << after.gaps().narrowest_gap();
  });
}

TEST(OnAnyRanks, CoincidentFaces) {
  expect_same([](const Communicator& ranks, Findings& findings) {
    for (const Model& model : {shapes::cracked_block(4e-7), shapes::slotted_block(2e-5)}) {
      const auto found = find_coincident_faces(SampledModel(ranks, model));
      EXPECT_EQ(found.size(), 1u);
      for (const CoincidentFaces& pair : found)
        findings << pair.first << pair.second << pair.area << pair.place << pair.apart;
    }
  });
}

TEST(OnAnyRanks, SharesOfFeatures) {
  expect_same([](const Communicator& ranks, Findings& findings) {
    SizingOptions options{0.05, 0.2, 15, 1.3, 0};
    options.feature_minimum = options.minimum;
    FieldFactory blunt(SampledModel(ranks, cad::shapes::blunt_wedge(0.004)), {0}, Fields::several);
    for (const double budget : {1.0, 1.5, 1e9})
      findings << choose_feature_resolution(blunt, options, {budget}, 1, 1'000'000'000);
    FieldFactory thin(SampledModel(ranks, cad::shapes::tapered_wedge(0.01, 0.0005)), {0}, Fields::several);
    findings << choose_feature_resolution(thin, options, {4}, 1, 60'000);
    FieldFactory slot(SampledModel(ranks, plate(0.02)), {1}, Fields::several);
    findings << choose_feature_resolution(slot, options, {1e9, 1e9}, 1, 1'000'000'000);
  });
}

TEST(OnAnyRanks, ChosenSizes) {
  expect_same([](const Communicator& ranks, Findings& findings) {
    const auto choose = [&](const Model& model, double layers, double target, double budget) {
      FieldFactory factory(SampledModel(ranks, model), {layers}, Fields::several);
      const ChosenSizes chosen = choose_sizes(factory, target, budget);
      findings << chosen.options << chosen.counts << chosen.features << chosen.field.leaf_count();
    };
    choose(make_primitive_domain(cad::PrimitiveKind::box_with_sphere), 1, 6e4, default_feature_budget);
    choose(make_primitive_domain(cad::PrimitiveKind::torus), 1, 5e4, default_feature_budget);
    choose(cad::shapes::blunt_wedge(0.001), 0, 20'000, 8);
  });
}

TEST(OnAnyRanks, TrailingEdgesAndLevels) {
  expect_same([](const Communicator& ranks, Findings& findings) {
    const Model model = cad::made_once(ranks, [] {
      cad::DomainOptions aircraft;
      aircraft.transport = cad::TransportDimensions{};
      return cad::prepare_domain(aircraft).model;
    });
    const Vec3 flow{1, 0, 0};
    FieldFactory factory(SampledModel(ranks, model), {0}, Fields::one);
    for (const TrailingEdge& edge : find_trailing_edges(factory.sampled(), 1))
      findings << edge.strip.face << edge.strip.narrowest << edge.chord << edge.fraction;
    const LiftingBodies bodies = find_lifting_bodies(factory.sampled(), flow);
    findings << bodies.reference_chord << bodies.semispan;
    for (const LiftingElement& element : bodies.elements) {
      findings << element.blunt_face << element.edge;
      for (const LiftingStation& station : element.stations)
        findings << station.trailing << station.leading << station.chord << station.thickness;
    }
    const LevelSizes level = sizes_of(Level::a);
    GivenSizes given = level_bounds(model, bodies, level);
    given.growth = 2.5, given.curvature_angle = 60, given.surface_maximum = 1;
    // One of five surfaces: a field a fifth as large.
    const LiftingBodies tail = find_lifting_bodies(factory.sampled(), flow, {"vertical_tail*"});
    factory.request_lines(level_lines(model, tail, level, flow));
    const SizeField field = factory.build_field(with_given({}, given));
    findings << field.leaf_count();
    for (const LiftingElement& element : tail.elements) {
      for (const LiftingStation& station : element.stations)
        findings << field(station.leading) << field(station.trailing);
    }
  });
}

TEST(OnAnyRanks, RefusalsAreThoseOfAllRanks) {
  const auto world = Communicator::world();
  const Model model = cad::shapes::split_cylinder(3, 2);
  FieldFactory factory(SampledModel(world, model), {0}, Fields::several);
  EXPECT_THROW(factory.build_field({1e-7, 1e-7, 15, 1.3, 0}), std::invalid_argument);
  EXPECT_THROW(choose_sizes(factory, 0), std::invalid_argument);
  EXPECT_THROW(choose_feature_resolution(factory, {0.05, 0.5, 15, 1.3, 0}, {0.5}, 1, 1000),
               std::invalid_argument);
}

}  // namespace
}  // namespace aeroloom::sizing
