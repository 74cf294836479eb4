#include "parallel/communication/network_probe.hpp"

#include <stdexcept>

#include <gtest/gtest.h>

namespace aeroloom::parallel {
namespace {

TEST(NetworkProbeTest, MeasuresBetweenRanks) {
  const auto world = Communicator::world();
  if (world.size() == 1) {
    EXPECT_THROW(probe_network(world), std::invalid_argument);
    return;
  }
  const NetworkProbe probe = probe_network(world);
  ASSERT_EQ(probe.messages.front().bytes, 8);
  EXPECT_EQ(probe.messages.back().bytes, 1 << 22);
  EXPECT_GE(probe.latency_seconds, probe.messages.front().seconds);
  EXPECT_GT(probe.messages.back().seconds, 0);
  EXPECT_GT(probe.bytes_per_second, 1e6);
  EXPECT_GT(probe.reduction_seconds, 0);
  EXPECT_EQ(world.minimum(probe.latency_seconds), world.maximum(probe.latency_seconds));
}

}  // namespace
}  // namespace aeroloom::parallel
