// What a run is expected to take, from predicted counts; levels beside the one that was counted; amounts of
// memory.
#include "pipeline/commands/memory_option.hpp"
#include "pipeline/forecast.hpp"
#include "pipeline/level_forecast.hpp"

#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

namespace aeroloom::pipeline {
namespace {

sizing::PredictedCounts counts_of(double triangles, double tetrahedra) {
  sizing::PredictedCounts counts;
  counts.triangles = triangles;
  counts.tetrahedra = tetrahedra;
  return counts;
}

TEST(Forecast, GrowsWithTheMesh) {
  const sizing::PredictedCounts small = counts_of(1e4, 1e5), large = counts_of(1e5, 1e7);
  EXPECT_GT(predicted_seconds(small), 0);
  EXPECT_GT(predicted_seconds(large), 10 * predicted_seconds(small));
  EXPECT_GT(predicted_bytes(large, 1), predicted_bytes(small, 1));
}

TEST(Forecast, EveryRankTakesMemoryOfItsOwn) {
  const sizing::PredictedCounts counts = counts_of(1e4, 1e5);
  const double each = predicted_bytes(counts, 2) - predicted_bytes(counts, 1);
  EXPECT_GT(each, 1e6);
  EXPECT_NEAR(predicted_bytes(counts, 9) - predicted_bytes(counts, 1), 8 * each, 1e-6 * each);
}

TEST(LevelForecast, FollowsSquareAndCubeOfTheFactors) {
  cases::SizingRequest request;
  request.level = sizing::Level::b;
  const std::vector<LevelForecast> levels =
      forecast_levels(sizing::Level::b, counts_of(1000, 100000), request, 2);
  ASSERT_EQ(levels.size(), 6u);
  const std::map<int, double> factors = {{0, 1.5}, {1, 1.0},     {2, 2.0 / 3},
                                         {3, 0.5}, {4, 1.0 / 3}, {5, 2.0 / 9}};
  double seconds = 0;
  for (const LevelForecast& forecast : levels) {
    const double finer =
        1 / factors.at(static_cast<int>(forecast.level) - static_cast<int>(sizing::Level::a));
    EXPECT_NEAR(forecast.counts.triangles, 1000 * finer * finer, 1e-6 * forecast.counts.triangles);
    EXPECT_NEAR(forecast.counts.tetrahedra, 100000 * finer * finer * finer,
                1e-6 * forecast.counts.tetrahedra);
    EXPECT_GT(forecast.seconds, seconds) << "finer levels take longer";
    EXPECT_GT(forecast.bytes, 0);
    seconds = forecast.seconds;
  }
}

TEST(MemoryOption, UnderstandsUnitsAndShares) {
  constexpr std::int64_t node = 200;
  EXPECT_EQ(memory_size("8G", node), std::int64_t{8} << 30);
  EXPECT_EQ(memory_size("8GiB", node), std::int64_t{8} << 30);
  EXPECT_EQ(memory_size("500M", node), std::int64_t{500} << 20);
  EXPECT_EQ(memory_size("1.5t", node), std::int64_t{3} << 39);
  EXPECT_EQ(memory_size("64k", node), 64 << 10);
  EXPECT_EQ(memory_size("80%", node), 160);
  EXPECT_EQ(memory_size("100%", node), 200);
}

TEST(MemoryOption, RefusesWhatIsNoAmount) {
  for (const char* text : {"", "8X", "0G", "101%", "G", "-1G", "12", "1e30G", "8GB", "8 G", "0.1%"})
    EXPECT_THROW(memory_size(text, 200), std::invalid_argument) << text;
}

}  // namespace
}  // namespace aeroloom::pipeline
