#include "parallel/log.hpp"

#include "parallel/progress.hpp"

#include <algorithm>
#include <chrono>
#include <functional>
#include <string>
#include <thread>

#include <gtest/gtest.h>

namespace aeroloom::parallel {
namespace {

/// What a piece of code prints.
struct Printed {
  std::string out, err;
};

Printed printed_by(const std::function<void()>& work) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  work();
  const std::string out = testing::internal::GetCapturedStdout();
  return {out, testing::internal::GetCapturedStderr()};
}

class LogTest : public testing::Test {
protected:
  Printed at(LogLevel level) const {
    return printed_by([&] {
      configure_log(world, level);
      log_info("a fact");
      log_verbose("a detail");
      log_warning("a doubt");
      log_error("a failure");
    });
  }
  const Communicator world = Communicator::world();
};

TEST_F(LogTest, RootAloneTellsFacts) {
  EXPECT_EQ(at(LogLevel::normal).out, world.is_root() ? "a fact\n" : "");
  EXPECT_EQ(at(LogLevel::verbose).out, world.is_root() ? "a fact\na detail\n" : "");
  EXPECT_EQ(at(LogLevel::quiet).out, "");
}

TEST_F(LogTest, EveryRankWarnsWithItsNumber) {
  const std::string who = world.size() > 1 ? " (rank " + std::to_string(world.rank()) + ")" : "";
  for (const LogLevel level : {LogLevel::quiet, LogLevel::normal, LogLevel::verbose}) {
    EXPECT_EQ(at(level).err, "warning" + who + ": a doubt\nerror" + who + ": a failure\n");
  }
}

TEST_F(LogTest, BracesAreNothingSpecial) {
  const auto printed = printed_by([&] {
    configure_log(world, LogLevel::normal);
    log_warning("a {} in '%v' {0}");
  });
  EXPECT_NE(printed.err.find("a {} in '%v' {0}"), std::string::npos) << printed.err;
}

TEST_F(LogTest, QuickProgressIsNotWorthALine) {
  const auto printed = printed_by([&] {
    configure_log(world, LogLevel::normal);  // the captured output is no terminal
    Progress progress("surface", 1000);
    for (int i = 0; i < 1000; ++i) progress.advance();
  });
  EXPECT_EQ(printed.out, "");
}

TEST_F(LogTest, LongProgressGetsPlainLinesAndALastOne) {
  const auto work = [&](LogLevel level) {
    return printed_by([&] {
      configure_log(world, level);
      Progress progress("surface", 2, "triangles");
      std::this_thread::sleep_for(std::chrono::milliseconds(level == LogLevel::quiet ? 0 : 5100));
      progress.advance(1, 20);
      progress.advance(1, 30);
    });
  };
  const Printed printed = work(LogLevel::normal);
  EXPECT_EQ(printed.err, "");
  if (world.is_root()) {
    EXPECT_NE(printed.out.find("surface     50 %  20 triangles  "), std::string::npos) << printed.out;
    EXPECT_NE(printed.out.find("surface    100 %  50 triangles  "), std::string::npos) << printed.out;
    EXPECT_EQ(printed.out.find('\r'), std::string::npos);
    EXPECT_EQ(std::count(printed.out.begin(), printed.out.end(), '\n'), 2);
  } else {
    EXPECT_EQ(printed.out, "");
  }
  EXPECT_EQ(work(LogLevel::quiet).out, "");
}

}  // namespace
}  // namespace aeroloom::parallel
