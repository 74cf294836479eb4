#include "parallel/observation/log.hpp"

#include "parallel/observation/progress.hpp"
#include "parallel/observation/warnings.hpp"

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

TEST_F(LogTest, WarningsAreKeptOnceForTheReport) {
  take_warnings(world);
  printed_by([&] {
    log_warning("everybody");
    log_warning("everybody");
    log_warning("of rank " + std::to_string(world.rank()));
  });
  const Warnings warnings = take_warnings(world);
  EXPECT_TRUE(take_warnings(world).kept.empty()) << "they are taken once";
  if (!world.is_root()) {
    EXPECT_TRUE(warnings.kept.empty());
    return;
  }
  ASSERT_EQ(warnings.kept.size(), 1U + static_cast<std::size_t>(world.size()));
  EXPECT_EQ(warnings.kept[0].message, "everybody");
  EXPECT_EQ(warnings.kept[0].times, 2 * world.size());
  EXPECT_EQ(warnings.kept[0].rank, 0);
  EXPECT_EQ(warnings.kept.back().rank, world.size() - 1);
  EXPECT_EQ(warnings.left_out, 0);
}

TEST_F(LogTest, TooManyWarningsAreCounted) {
  take_warnings(world);
  const std::string long_text = std::string(3999, 'x') + "\u00e9\u00e9";
  for (int i = 0; i < 1000; ++i) keep_warning("number " + std::to_string(i));
  for (int i = 0; i < 7; ++i) keep_warning(long_text);
  const Warnings many = take_warnings(world);
  keep_warning(long_text);
  const Warnings one = take_warnings(world);
  if (!world.is_root()) return;
  EXPECT_EQ(many.kept.size(), 100U);
  std::int64_t said = many.left_out;
  for (const Warning& warning : many.kept) said += warning.times;
  EXPECT_EQ(said, 1007 * world.size());
  ASSERT_EQ(one.kept.size(), 1U);
  EXPECT_EQ(one.kept[0].message, std::string(3999, 'x') + " ...");
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
      std::this_thread::sleep_for(std::chrono::milliseconds(120));
      progress.advance(1, 20);
      progress.advance(1, 30);
    });
  };
  set_seconds_between_lines(0.1);
  const Printed printed = work(LogLevel::normal), quiet = work(LogLevel::quiet);
  set_seconds_between_lines(5);
  EXPECT_EQ(printed.err, "");
  if (world.is_root()) {
    EXPECT_NE(printed.out.find("surface     50 %  20 triangles  "), std::string::npos) << printed.out;
    EXPECT_NE(printed.out.find("surface    100 %  50 triangles  "), std::string::npos) << printed.out;
    EXPECT_EQ(printed.out.find('\r'), std::string::npos);
    EXPECT_EQ(std::count(printed.out.begin(), printed.out.end(), '\n'), 2);
  } else {
    EXPECT_EQ(printed.out, "");
  }
  EXPECT_EQ(quiet.out, "");
}

}  // namespace
}  // namespace aeroloom::parallel
