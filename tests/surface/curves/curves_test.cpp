#include "surface/curves/curves.hpp"

#include "surface/curves/curve_metric.hpp"
#include "tests/cad/primitives.hpp"
#include "tests/several_ranks.hpp"
#include "tests/surface/face_fixture.hpp"

#include <cmath>
#include <map>
#include <numbers>

#include <gtest/gtest.h>

namespace aeroloom::surface {
namespace {

using cad::make_primitive_domain;
using cad::Model;
using cad::PrimitiveKind;
using testing::graded_field;
using testing::uniform_field;

TEST(MetricLengthLocal, IntegratesAndInvertsASmoothDensity) {
  const MetricLength length([](double t) { return std::exp(t); }, {0, 1, 3});
  EXPECT_NEAR(length.total(), std::exp(3) - 1, 1e-4);
  for (const double value : {0.0, 0.1, 5.0, 12.3}) {
    EXPECT_NEAR(length.parameter_at(value), std::log(1 + value), 1e-5);
  }
}

TEST(MetricLengthLocal, InvertsWithoutAskingForTheDensityAgain) {
  int asked = 0;
  const MetricLength length(
      [&](double t) {
        ++asked;
        return 10 + t;
      },
      {0, 1});
  const int before = asked;
  EXPECT_EQ(equal_parts(length, 10).size(), 9U);
  EXPECT_EQ(asked, before);
}

TEST(MetricLengthLocal, CopesWithKinksAndJumps) {
  const MetricLength length([](double t) { return t < 0.31 ? 100.0 : 1.0 + std::abs(t - 0.7); }, {0, 1});
  const double exact = 31 + 0.69 + 0.5 * (0.39 * 0.39 + 0.3 * 0.3);
  EXPECT_NEAR(length.total(), exact, 2e-3);
  EXPECT_NEAR(length.parameter_at(30.5), 0.305, 1e-5);
  EXPECT_NEAR(length.parameter_at(length.total()), 1, 1e-12);
}

TEST(MetricLengthLocal, DividesASymmetricDensitySymmetrically) {
  const MetricLength length([](double t) { return 1 + 10 * t * t; }, {-1, 1});
  const auto parts = equal_parts(length, 8);
  ASSERT_EQ(parts.size(), 7u);
  for (std::size_t i = 0; i < parts.size(); ++i) EXPECT_NEAR(parts[i], -parts[parts.size() - 1 - i], 1e-9);
}

TEST(Curves, DivideStraightEdgesEvenly) {
  const Model model = make_primitive_domain(PrimitiveKind::box);
  const CurveMesh curves = discretise_curves(model, uniform_field(model, 0.1));
  ASSERT_EQ(model.edge_count(), 12);
  for (cad::EdgeId e = 0; e < model.edge_count(); ++e) {
    const auto chain = curves.chain(model, e);
    ASSERT_EQ(chain.size(), 11u);
    EXPECT_EQ(chain.front(), model.edge(e).first);
    EXPECT_EQ(chain.back(), model.edge(e).last);
    for (std::size_t i = 1; i < chain.size(); ++i) {
      EXPECT_NEAR(distance(curves.points[chain[i - 1]], curves.points[chain[i]]), 0.1, 1e-9);
    }
    for (std::size_t i = 1; i + 1 < chain.size(); ++i) EXPECT_EQ(curves.edge_of(model, chain[i]), e);
    EXPECT_EQ(curves.edge_of(model, chain.front()), cad::no_entity);
  }
}

TEST(Curves, CirclesHaveEqualSegmentsAndSeamsNone) {
  const Model model = make_primitive_domain(PrimitiveKind::cylinder);
  const CurveMesh curves = discretise_curves(model, uniform_field(model, 0.05));
  int circles = 0;
  for (cad::EdgeId e = 0; e < model.edge_count(); ++e) {
    const auto chain = curves.chain(model, e);
    if (!is_constraining(model, e)) {
      EXPECT_TRUE(chain.empty());
      continue;
    }
    ++circles;
    EXPECT_EQ(static_cast<long>(chain.size()) - 1, std::lround(2 * std::numbers::pi * 0.25 / 0.05));
    const double side = 2 * 0.25 * std::sin(std::numbers::pi / static_cast<double>(chain.size() - 1));
    for (std::size_t i = 1; i < chain.size(); ++i) {
      EXPECT_NEAR(distance(curves.points[chain[i - 1]], curves.points[chain[i]]), side, 1e-7);
    }
  }
  EXPECT_EQ(circles, 2);
}

TEST(Curves, SegmentsAreEqualInTheMetricOfAGradedField) {
  const Model model = make_primitive_domain(PrimitiveKind::box);
  const auto field = graded_field(model, model.bounds().low, 0.004, 0.2);
  const CurveMesh curves = discretise_curves(model, field);
  for (cad::EdgeId e = 0; e < model.edge_count(); ++e) {
    const auto parameters = curves.chain_parameters(model, e);
    std::vector<double> lengths;
    for (std::size_t i = 1; i < parameters.size(); ++i) {
      constexpr int samples = 400;
      double sum = 0;
      for (int k = 0; k < samples; ++k) {
        const double t = parameters[i - 1] + (parameters[i] - parameters[i - 1]) * (k + 0.5) / samples;
        sum += norm(model.edge_tangent(e, t)) / field(model.edge_point(e, t));
      }
      lengths.push_back(sum * (parameters[i] - parameters[i - 1]) / samples);
    }
    ASSERT_GT(lengths.size(), 4u);
    const auto [least, most] = std::minmax_element(lengths.begin(), lengths.end());
    EXPECT_LT(*most / *least, 1.005) << "edge " << e;
    EXPECT_NEAR(*most, 1, 0.5 / static_cast<double>(lengths.size()) + 0.02);
  }
}

TEST(Curves, CoarseSizesStillLeaveConformingLoops) {
  for (const PrimitiveKind kind :
       {PrimitiveKind::box, PrimitiveKind::cylinder, PrimitiveKind::box_with_sphere}) {
    const Model model = make_primitive_domain(kind);
    const CurveMesh curves = discretise_curves(model, uniform_field(model, 100));
    std::map<std::pair<CurveVertex, CurveVertex>, int> single;
    for (cad::EdgeId e = 0; e < model.edge_count(); ++e) {
      const auto chain = curves.chain(model, e);
      if (chain.size() == 2) ++single[std::minmax(chain.front(), chain.back())];
      if (!chain.empty() && chain.front() == chain.back()) {
        EXPECT_EQ(chain.size(), 5u);
      }
    }
    for (const auto& [ends, count] : single) EXPECT_EQ(count, 1);
    for (cad::FaceId f = 0; f < model.face_count(); ++f) {
      for (const auto& loop : model.face(f).loops) {
        std::size_t segments = 0;
        bool any = false;
        for (const auto& use : loop) {
          const auto chain = curves.chain(model, use.edge);
          any = any || !chain.empty();
          if (!chain.empty()) segments += chain.size() - 1;
        }
        EXPECT_TRUE(!any || segments >= 3);
      }
    }
  }
}

TEST(Curves, AreTheSameOnAnyNumberOfRanks) {
  NEEDS_SEVERAL_RANKS();
  const Model model = make_primitive_domain(PrimitiveKind::cylinder);
  const auto curves_on = [&](const parallel::Communicator& ranks) {
    return discretise_curves(model, graded_field(model, model.bounds().low, 0.01, 0.2, ranks));
  };
  const CurveMesh together = curves_on(parallel::Communicator::world());
  const CurveMesh alone = curves_on(parallel::Communicator::self());
  EXPECT_EQ(together.points, alone.points);
  EXPECT_EQ(together.parameters, alone.parameters);
  EXPECT_EQ(together.first_interior, alone.first_interior);
}

}  // namespace
}  // namespace aeroloom::surface
