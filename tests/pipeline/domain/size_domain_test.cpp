#include "pipeline/domain/size_domain.hpp"

#include "pipeline/stage_products.hpp"
#include "sizing/choice/predict_counts.hpp"
#include "sizing/lifting/trailing_edges.hpp"
#include "tests/cad/blunt_shapes.hpp"
#include "tests/cad/strip_shapes.hpp"
#include "tests/references.hpp"

#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace aeroloom::domain {
namespace {

using cad::Model;

SizedDomain size(const Model& model, double minimum, cases::NarrowFaces narrow_faces) {
  cases::SizingRequest request;
  request.minimum = minimum;
  request.maximum = 1;
  return size_domain(parallel::Communicator::world(), model, request, {narrow_faces});
}

TEST(SizeDomain, JoinsNarrowFacesAndSaysSo) {
  const Model model = cad::shapes::split_cylinder(2, 1.5);
  const SizedDomain joined = size(model, 0.1, cases::NarrowFaces::join);
  EXPECT_EQ(joined.model.face_count(), model.face_count() - 1);
  ASSERT_EQ(joined.findings.joined.changes.size(), 1u);
  EXPECT_TRUE(joined.findings.joined.changes[0].where);
  EXPECT_NE(joined.findings.joined.changes[0].what.find("joined with"), std::string::npos);
  EXPECT_LT(joined.findings.joined.changes[0].how_much, 1e-6);
  const SizedDomain kept = size(model, 0.1, cases::NarrowFaces::keep);
  EXPECT_EQ(kept.model.face_count(), model.face_count());
  EXPECT_TRUE(kept.findings.joined.changes.empty());
  // Half-way up, where the strip's ends are far away, its width asks for nothing any more.
  EXPECT_GT(joined.field({1, 0, 0.75}), 2 * kept.field({1, 0, 0.75}));
}

TEST(SizeDomainLocal, LeavesFacesAsWideAsElements) {
  const Model model = cad::shapes::split_cylinder(2, 1.5);
  EXPECT_TRUE(size(model, 0.01, cases::NarrowFaces::join).findings.joined.changes.empty());
}

// Chosen sizes, given ones and those of regions alike; what is done to the model does not depend on the
// scale.
TEST(SizeDomainLocal, AScaleMultipliesTheWholeField) {
  const Model model = cad::shapes::split_cylinder(0.5, 1.5);
  const auto world = parallel::Communicator::world();
  const auto sized_at = [&](double scale, std::optional<double> target) {
    cases::SizingRequest request;
    if (target)
      request.target_tetrahedra = *target;
    else
      request.minimum = 0.1, request.maximum = 1, request.chordal_deviation = 0.01;
    request.sources.push_back({"ball", sizing::SphereShape{{0, 0, 1}, 0.2}, 0.06});
    request.scale = scale;
    return size_domain(world, model, request, {cases::NarrowFaces::join});
  };
  using Target = std::optional<double>;
  for (const auto& [target, scale] : {std::pair(Target(), 0.4), {Target(20'000), 2.5}}) {
    const SizedDomain one = sized_at(1, target), scaled = sized_at(scale, target);
    EXPECT_EQ(scaled.model.face_count(), one.model.face_count());
    EXPECT_EQ(scaled.findings.joined.changes.size(), one.findings.joined.changes.size());
    for (int i = 0; i < 100; ++i) {
      const geometry::Vec3 place{std::cos(0.7 * i) * 0.01 * i, std::sin(0.7 * i) * 0.01 * i, 0.02 * i};
      ASSERT_NEAR(scaled.field(place) / one.field(place), scale, 1e-12 * scale);
    }
    EXPECT_NEAR(scaled.sizes.minimum, scale * one.sizes.minimum, 1e-12);
    EXPECT_NEAR(std::log(scaled.field.options().growth), scale * std::log(one.sizes.growth), 1e-12);
    EXPECT_NEAR(scaled.sizes.chordal_deviation, scale * scale * one.sizes.chordal_deviation, 1e-12);
    const double fewer = std::pow(scale, 3) * scaled.findings.counts.tetrahedra;
    EXPECT_NEAR(fewer / one.findings.counts.tetrahedra, 1, 1e-9);
    const sizing::SampledModel sampled(world, scaled.model);
    const double counted = sizing::predict_counts(sampled, scaled.field).tetrahedra;
    EXPECT_NEAR(counted / scaled.findings.counts.tetrahedra, 1, 0.03) << "the field gives what is said";
  }
}

// Sizes from the model go by what is left of it.
TEST(SizeDomainLocal, ChoosesSizesForTheJoinedModel) {
  const Model model = cad::shapes::split_cylinder(0.5, 1.5);
  cases::SizingRequest request;
  request.target_tetrahedra = 20'000;
  const auto world = parallel::Communicator::world();
  const SizedDomain sized = size_domain(world, model, request, {cases::NarrowFaces::join});
  ASSERT_EQ(sized.findings.joined.changes.size(), 1u);
  const sizing::SampledModel sampled(world, sized.model);
  const double predicted = sizing::predict_counts(sampled, sized.field).tetrahedra;
  EXPECT_GT(predicted, 14'000);
  EXPECT_LT(predicted, 28'000);
}

/// Keys that may stand beside a target.
const std::vector<void (*)(cases::SizingRequest&)> keys{
    [](cases::SizingRequest& request) { request.growth = 1.15; },
    [](cases::SizingRequest& request) { request.curvature_angle = 6; },
    [](cases::SizingRequest& request) { request.chordal_deviation = 0.002; },
    [](cases::SizingRequest& request) { request.minimum = 0.01; },
    [](cases::SizingRequest& request) { request.proximity = 3; },
    [](cases::SizingRequest& request) { request.maximum = 0.4; },
};
cases::SizingRequest target_beside(unsigned chosen) {
  cases::SizingRequest request;
  request.target_tetrahedra = 12'000;
  for (std::size_t k = 0; k < keys.size(); ++k)
    if (chosen >> k & 1) keys[k](request);
  return request;
}

// The search goes around what is given; where that forbids the target, a warning names the key and the count.
TEST(SizeDomainLocal, MeetsTheTargetWhateverElseIsGiven) {
  const Model model = cad::shapes::split_cylinder(0.5, 1.5);
  const auto world = parallel::Communicator::world();
  int met = 0;
  for (unsigned chosen = 0; chosen < 1u << keys.size(); chosen += 13) {
    const cases::SizingRequest request = target_beside(chosen);
    const SizedDomain sized = size_domain(world, model, request, {cases::NarrowFaces::join});
    const double error = std::log(sized.findings.counts.tetrahedra / 12'000);
    met += std::abs(error) < std::log(1.25);
    if (std::abs(error) > std::log(1.45)) {
      EXPECT_GT(error, 0) << chosen;
      const std::string& text = sized.findings.missed_target;
      EXPECT_NE(text.find("; "), std::string::npos) << chosen << ": " << text;
    }
    EXPECT_EQ(sized.sizes, sizing::with_given(sized.sizes, request)) << chosen;
  }
  EXPECT_GE(met, 2);
}

TEST(SizeDomain, ChoosesTheSameOnAnyNumberOfRanks) {
  const Model model = cad::shapes::split_cylinder(0.5, 1.5);
  references::expect_as_on_one_rank([&](const parallel::Communicator& communicator) {
    std::string text;  // of all keys, each once
    for (const unsigned chosen : {21u, 42u}) {
      const SizedDomain sized =
          size_domain(communicator, model, target_beside(chosen), {cases::NarrowFaces::join});
      text += fmt::format("{:a} {:a} {:a} {:a} {:a} {}\n", sized.findings.counts.tetrahedra,
                          sized.findings.counts.triangles, sized.sizes.minimum, sized.sizes.surface_maximum,
                          sized.findings.features ? sized.findings.features->resolution.ratio : 1,
                          sized.field.leaf_count());
    }
    return text;
  });
}

// A target that a key forbids: which, and what it costs.
TEST(SizeDomain, NamesTheKeyThatForbidsTheTarget) {
  const Model model = cad::shapes::split_cylinder(0.5, 1.5);
  const auto world = parallel::Communicator::world();
  cases::SizingRequest request;
  request.target_tetrahedra = 1000;
  request.curvature_angle = 4;
  request.minimum = 0.01;
  const SizedDomain sized = size_domain(world, model, request, {cases::NarrowFaces::join});
  EXPECT_GT(sized.findings.counts.tetrahedra, 2000);
  const std::string& text = sized.findings.missed_target;
  EXPECT_NE(text.find("sizing.curvature_angle makes it"), std::string::npos) << text;
  EXPECT_EQ(text.find("sizing.growth makes it"), std::string::npos) << text;
}

// Bounds that were chosen follow those that are given.
TEST(SizeDomainLocal, LetsChosenBoundsFollowGivenOnes) {
  const Model model = cad::shapes::split_cylinder(0.5, 1.5);
  cases::SizingRequest request;
  request.target_tetrahedra = 1000;
  request.surface_maximum = 0.05;
  const auto sized = size_domain(parallel::Communicator::world(), model, request, {cases::NarrowFaces::join});
  EXPECT_EQ(sized.sizes.surface_maximum, 0.05);
  EXPECT_LE(sized.sizes.minimum, 0.05);
}

// What the budget cannot resolve is told with its face, width and place, and what it would take.
TEST(SizeDomainLocal, TellsWhichStripsTheBudgetLeavesUnresolved) {
  const Model model = cad::shapes::blunt_wedge(0.0005);
  cases::SizingRequest request;
  request.target_tetrahedra = 20'000;
  request.proximity = 0;  // the space behind the blunt end is a gap too
  const auto size_within = [&](double budget) {
    request.feature_budget = budget;
    return size_domain(parallel::Communicator::world(), model, request, {cases::NarrowFaces::join});
  };
  const SizedDomain small = size_within(1.3);
  ASSERT_TRUE(small.findings.features);
  ASSERT_EQ(small.findings.features->regions.size(), 3u) << "the blunt end, and the sides beside it";
  EXPECT_NEAR(small.findings.features->regions[0].width, 0.0005, 1e-6);
  EXPECT_NEAR(small.findings.features->regions[0].place.x, 1, 1e-9);
  const double aspect = small.findings.features->resolution.aspect;
  EXPECT_GT(aspect, 1);
  EXPECT_NEAR(std::tan(small.findings.features->regions[0].surface_degrees * std::numbers::pi / 180),
              1 / aspect, 1e-6);
  EXPECT_GT(small.findings.features->wanted_tetrahedra(), 2 * 20'000);
  const std::string text = describe(*small.findings.features);
  EXPECT_NE(text.find("'" + small.findings.features->regions[0].face + "'"), std::string::npos) << text;
  EXPECT_NE(text.find("sizing.feature_budget"), std::string::npos) << text;
  const SizedDomain large = size_within(500);
  ASSERT_TRUE(large.findings.features);
  EXPECT_TRUE(large.findings.features->regions.empty());
  EXPECT_TRUE(describe(*large.findings.features).empty());
  EXPECT_LT(large.sizes.narrow_minimum, 0.0005);
  EXPECT_NEAR(small.findings.features->wanted_tetrahedra(), large.findings.counts.tetrahedra,
              0.4 * large.findings.counts.tetrahedra);
}

io::CheckpointContent as_read(const io::CheckpointDraft& draft) {
  parallel::Bytes common = draft.common;
  parallel::Communicator::world().broadcast(common);
  return {std::move(common), {}};
}

// What a checkpoint gives back is what was put in.
TEST(SizeDomain, ComesBackFromACheckpoint) {
  const auto world = parallel::Communicator::world();
  const Model model = cad::shapes::split_cylinder(2, 1.5);
  const SizedDomain sized = size(model, 0.1, cases::NarrowFaces::join);
  const SizedDomain found = pipeline::unpack_sizes(world, as_read(pipeline::pack_sizes(sized)), model);
  EXPECT_EQ(found.field.digest(), sized.field.digest());
  EXPECT_EQ(found.field.leaf_count(), sized.field.leaf_count());
  EXPECT_EQ(found.field({1, 0, 0.75}), sized.field({1, 0, 0.75}));
  EXPECT_EQ(found.sizes, sized.sizes);
  EXPECT_EQ(found.model.face_count(), sized.model.face_count());
  EXPECT_EQ(found.findings.joined.groups, sized.findings.joined.groups);
  EXPECT_EQ(found.findings.joined.changes.at(0).what, sized.findings.joined.changes.at(0).what);
}

/// A half wing of unit chord and three times that span, as a body.
Model thin_wing(double thickness) {
  cad::DomainOptions options;
  options.kind = cad::DomainKind::body;
  return cad::shapes::prepare(cad::shapes::blunt_wing({{0, 0, thickness}, {3, 0, thickness}}), options).model;
}

SizedDomain size_automatically(const Model& model, const cases::SizingRequest& request) {
  return size_domain(parallel::Communicator::world(), model, request,
                     {cases::NarrowFaces::join, cad::TrailingEdges::automatic});
}

const JudgedEdge& only_edge(const SizedDomain& sized) {
  EXPECT_EQ(sized.findings.edges.size(), 1u);
  return sized.findings.edges.front();
}

// Thick enough for the budget: kept. Thin enough that nobody sees it: closed. Between: graded.
TEST(TrailingEdgesLocal, AreKeptClosedOrGraded) {
  cases::SizingRequest request;
  request.target_tetrahedra = 20'000;
  const auto judged = [&](double thickness, double budget) {
    const Model model = thin_wing(thickness);
    request.feature_budget = budget;
    const SizedDomain sized = size_automatically(model, request);
    JudgedEdge edge = only_edge(sized);
    EXPECT_NEAR(edge.narrowest, thickness, 0.01 * thickness);
    EXPECT_NEAR(edge.widest, thickness, 0.01 * thickness);
    EXPECT_NEAR(edge.chord, 1, 0.1);
    EXPECT_EQ(sized.model.face_count(), model.face_count() - (edge.fate == EdgeFate::closed ? 1 : 0));
    return edge;
  };
  const JudgedEdge kept = judged(0.02, 20);
  EXPECT_EQ(kept.fate, EdgeFate::kept);
  EXPECT_LE(kept.aspect, largest_kept_aspect);
  const JudgedEdge graded = judged(0.002, 1.2);
  EXPECT_EQ(graded.fate, EdgeFate::graded);
  EXPECT_GT(graded.aspect, largest_kept_aspect);
  EXPECT_NE(graded.what.find("0.1 % of the local chord"), std::string::npos) << graded.what;
  const JudgedEdge closed = judged(0.0005, 5);
  EXPECT_EQ(closed.fate, EdgeFate::closed);
  EXPECT_NE(closed.what.find("was closed"), std::string::npos) << closed.what;
  EXPECT_NE(closed.what.find("drag counts"), std::string::npos) << closed.what;
  // Resolved where somebody pays for it.
  EXPECT_EQ(judged(0.0005, 500).fate, EdgeFate::kept);
}

// Where all sizes are given, the smallest that features may have takes the budget's place.
TEST(TrailingEdgesLocal, GoByTheGivenSizesOfFeatures) {
  cases::SizingRequest request;
  request.minimum = 0.05, request.maximum = 1;
  const Model model = thin_wing(0.0007);
  request.feature_minimum = 0.0015;
  EXPECT_EQ(only_edge(size_automatically(model, request)).fate, EdgeFate::kept);
  request.feature_minimum = 0.004;
  EXPECT_EQ(only_edge(size_automatically(model, request)).fate, EdgeFate::closed);
}

// How far borders may move goes by the size elements would have there, not by the smallest of all.
TEST(TrailingEdgesLocal, MayMoveAsElementsThereAreLarge) {
  constexpr double width = 0.0007, aspect = 5, minimum = 0.002;
  const Model model = thin_wing(width);
  const sizing::SampledModel sampled(parallel::Communicator::world(), model);
  const std::vector<sizing::TrailingEdge> edges = sizing::find_trailing_edges(sampled, 0.05);
  const auto fate_of = [&](double root, double tip) {
    const auto sizes = [&](const std::vector<geometry::Vec3>& places) {
      std::vector<double> result;
      for (const geometry::Vec3 place : places) result.push_back(root + place.y / 3 * (tip - root));
      return result;
    };
    return judge_trailing_edges(model, edges, {[&](double) { return aspect; }, minimum, sizes}).at(0).fate;
  };
  EXPECT_EQ(fate_of(0.02, 0.02), EdgeFate::closed);
  EXPECT_EQ(fate_of(0.002, 0.02), EdgeFate::graded);
  EXPECT_EQ(fate_of(0.02, 0.002), EdgeFate::graded);
}

// So thin as corners are closed by and ending in a point: sizes ask for nothing there, and it is not
// resolved.
TEST(TrailingEdgesLocal, ThatEndInAPointAndAskForNothingAreClosed) {
  constexpr double minimum = 0.02;
  cad::DomainOptions options;
  options.kind = cad::DomainKind::body;
  const Model model =
      cad::shapes::prepare(cad::shapes::blunt_wing({{0, 0, 0.0005}, {3, 0, 0}}), options).model;
  const sizing::SampledModel sampled(parallel::Communicator::world(), model);
  const std::vector<sizing::TrailingEdge> edges = sizing::find_trailing_edges(sampled, minimum);
  ASSERT_EQ(edges.size(), 1u);
  const auto sizes = [&](const std::vector<geometry::Vec3>& places) {
    return std::vector<double>(places.size(), minimum);
  };
  const auto resolved = [](double) { return 1.0; };
  EXPECT_EQ(judge_trailing_edges(model, edges, {resolved, minimum, sizes}).at(0).fate, EdgeFate::closed);
  EXPECT_EQ(judge_trailing_edges(model, edges, {resolved, 0.005, sizes}).at(0).fate, EdgeFate::kept);
}

// A blunt end of 0.08 % of the chord: about half a drag count.
TEST(TrailingEdgesLocal, HoernersBaseDrag) {
  EXPECT_NEAR(base_drag_counts(8e-4), 0.55, 0.01);
  EXPECT_EQ(base_drag_counts(0), 0);
}

TEST(TrailingEdges, ClosedOnesComeBackFromACheckpoint) {
  const Model model = thin_wing(0.0005);
  cases::SizingRequest request;
  request.minimum = 0.05, request.maximum = 1;
  const SizedDomain sized = size_automatically(model, request);
  ASSERT_TRUE(has_closed(sized.findings.edges));
  const auto world = parallel::Communicator::world();
  const SizedDomain found = pipeline::unpack_sizes(world, as_read(pipeline::pack_sizes(sized)), model);
  EXPECT_EQ(found.model.face_count(), sized.model.face_count());
  EXPECT_EQ(found.model.edge_count(), sized.model.edge_count());
  EXPECT_EQ(found.findings.edges.at(0).what, sized.findings.edges.at(0).what);
}

// Where joined faces could not be meshed, the surface is that of other sizes than the stage before has kept.
TEST(SizeDomain, OtherSizesComeWithTheSurface) {
  const auto world = parallel::Communicator::world();
  const Model model = cad::shapes::split_cylinder(2, 1.5);
  const SizedDomain joined = size(model, 0.1, cases::NarrowFaces::join),
                    kept = size(model, 0.1, cases::NarrowFaces::keep);
  const surface::SurfaceMesh empty{{mesh::number_mesh(mesh::DistributedMesh(world)), kept.field}, {}};
  SizedDomain sized = joined;
  const auto with = pipeline::pack_surface({empty, kept, true});
  EXPECT_TRUE(pipeline::unpack_surface(as_read(with), model, sized));
  EXPECT_TRUE(sized.findings.joined.groups.empty());
  EXPECT_EQ(sized.field.digest(), kept.field.digest());
  sized = joined;
  const auto without = pipeline::pack_surface({empty, kept, false});
  EXPECT_FALSE(pipeline::unpack_surface(as_read(without), model, sized));
  EXPECT_EQ(sized.field.digest(), joined.field.digest());
}

}  // namespace
}  // namespace aeroloom::domain
