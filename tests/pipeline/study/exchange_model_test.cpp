#include "pipeline/study/exchange_model.hpp"

#include <gtest/gtest.h>

namespace aeroloom::study {
namespace {

constexpr Network by_latency{1, 1e30}, by_bandwidth{0, 1};

double seconds(const StageExchanges& exchanges, int ranks, const Network& network, int recorded = 1) {
  return exchange_seconds(exchanges, recorded, ranks, network);
}

TEST(ExchangeModel, OneRankWaitsForNobody) {
  StageExchanges exchanges;
  exchanges.asked.broadcast = exchanges.asked.rendezvous = exchanges.asked.neighbour = {5, 1000};
  EXPECT_EQ(seconds(exchanges, 1, {}), 0);
  EXPECT_GT(seconds(exchanges, 2, {}), 0);
}

TEST(ExchangeModel, CollectivesTakeLogarithmsOfRanks) {
  StageExchanges exchanges;
  exchanges.asked.reduction = {3, 24};
  EXPECT_DOUBLE_EQ(seconds(exchanges, 2, by_latency), 3);
  EXPECT_DOUBLE_EQ(seconds(exchanges, 8, by_latency), 9);
  EXPECT_DOUBLE_EQ(seconds(exchanges, 9, by_latency), 12);
  EXPECT_DOUBLE_EQ(seconds(exchanges, 8, by_bandwidth), 3 * 24);
}

TEST(ExchangeModel, BytesOfCollectives) {
  StageExchanges exchanges;
  exchanges.asked.broadcast = {1, 100};
  EXPECT_DOUBLE_EQ(seconds(exchanges, 16, by_bandwidth), 100);
  exchanges = {};
  exchanges.asked.all_gather = {1, 100};  // of all together, however many they are
  EXPECT_DOUBLE_EQ(seconds(exchanges, 4, by_bandwidth), 75);
  exchanges = {};
  exchanges.asked.table = {1, 8};  // of each
  EXPECT_DOUBLE_EQ(seconds(exchanges, 1000, by_bandwidth), 8 * 999);
}

TEST(ExchangeModel, RendezvousSpreadAtRandomOrAsRecorded) {
  StageExchanges exchanges;
  exchanges.asked.rendezvous = {1, 1000};
  EXPECT_DOUBLE_EQ(seconds(exchanges, 4, by_bandwidth), 1000.0 / 4 * 3 / 4);
  exchanges.sent.rendezvous = {1, 250};  // on two ranks, where 500 would have gone at random
  EXPECT_DOUBLE_EQ(seconds(exchanges, 4, by_bandwidth, 2), 1000.0 / 4 * 3 / 4 / 2);
  // Announced and answered by everybody around, agreed upon, sent.
  EXPECT_DOUBLE_EQ(seconds(exchanges, 4, by_latency), 2 * 2 + 2 * 3);
  EXPECT_DOUBLE_EQ(seconds(exchanges, 1024, by_latency), 2 * 10 + 2 * 26);
}

TEST(ExchangeModel, BordersGrowWithTheCubeRoot) {
  StageExchanges exchanges;
  exchanges.asked.neighbour = {1, 1000};
  const double two = seconds(exchanges, 2, by_bandwidth, 2),
               sixteen = seconds(exchanges, 16, by_bandwidth, 2);
  EXPECT_DOUBLE_EQ(two, 500);
  EXPECT_DOUBLE_EQ(sixteen, 1000.0 / 16 * 2);
}

}  // namespace
}  // namespace aeroloom::study
