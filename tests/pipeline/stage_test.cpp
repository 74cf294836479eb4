// How what goes wrong in a stage ends the program: by its kind, else by its stage.
#include "pipeline/stage.hpp"

#include "parallel/sandbox/sandbox.hpp"

#include <filesystem>
#include <functional>
#include <ios>
#include <optional>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

namespace aeroloom::pipeline {
namespace {

using parallel::CollectiveError;
using parallel::FailureKind;
using report::ExitCode;

/// The failure of a stage called "surface" that does this.
std::optional<report::StageFailure> failure_of(const std::function<void()>& work) {
  parallel::StageClock clock;
  try {
    run_stage(clock, "surface", ExitCode::surface, work);
  } catch (const report::StageFailure& failure) {
    EXPECT_EQ(failure.stage(), "surface");
    return failure;
  }
  return std::nullopt;
}

void expect_code(ExitCode code, const std::string& word, const std::function<void()>& work) {
  const std::optional<report::StageFailure> failure = failure_of(work);
  ASSERT_TRUE(failure) << word;
  EXPECT_EQ(failure->code(), code) << failure->what();
  EXPECT_NE(std::string(failure->what()).find(word), std::string::npos) << failure->what();
}

TEST(StageTest, GivesWhatItsWorkGives) {
  parallel::StageClock clock;
  EXPECT_EQ(run_stage(clock, "sizing", ExitCode::cad, [] { return 42; }), 42);
  ASSERT_EQ(clock.costs().size(), 1u);
  EXPECT_EQ(clock.costs().front().name, "sizing");
  EXPECT_EQ(current_stage(), "sizing");
}

TEST(StageTest, ClosesItsClockWhateverItsWorkThrows) {
  parallel::StageClock clock;
  EXPECT_THROW(run_stage(clock, "one", ExitCode::cad, []() -> int { throw std::runtime_error("no"); }),
               report::StageFailure);
  run_stage(clock, "two", ExitCode::cad, [] {});
  ASSERT_EQ(clock.costs().size(), 2u);
  EXPECT_EQ(clock.costs().back().name, "two");
}

TEST(StageTest, EndsWithTheCodeOfTheKindOrOfTheStage) {
  expect_code(ExitCode::surface, "input", [] { throw CollectiveError(FailureKind::input, "input"); });
  expect_code(ExitCode::files, "files", [] { throw CollectiveError(FailureKind::files, "files"); });
  expect_code(ExitCode::resources, "memory", [] { throw CollectiveError(FailureKind::resources, "memory"); });
  expect_code(ExitCode::bug, "bug", [] { throw CollectiveError(FailureKind::bug, "bug"); });
}

TEST(StageTest, EndsWithTheCodeOfTheException) {
  expect_code(ExitCode::usage, "argument", [] { throw std::invalid_argument("argument"); });
  expect_code(ExitCode::bug, "logic", [] { throw std::logic_error("logic"); });
  expect_code(ExitCode::surface, "other", [] { throw std::runtime_error("other"); });
  expect_code(ExitCode::surface, "stream", [] { throw std::ios_base::failure("stream"); });
  expect_code(ExitCode::resources, "gone", [] { throw parallel::SandboxInterrupted("gone"); });
}

// Where there are other ranks, which wait, a failure of memory that was not agreed on ends them all.
TEST(StageTest, SaysThatMemoryIsOut) {
  if (parallel::Communicator::world().size() > 1) return;
  expect_code(ExitCode::resources, "out of memory", [] { throw std::bad_alloc(); });
}

TEST(StageTest, CodesOfKindsAreThoseOfThePage) {
  for (const ExitCode of_stage : {ExitCode::cad, ExitCode::surface, ExitCode::volume}) {
    EXPECT_EQ(code_of({FailureKind::input, ""}, of_stage), of_stage);
    EXPECT_EQ(code_of({FailureKind::files, ""}, of_stage), ExitCode::files);
    EXPECT_EQ(code_of({FailureKind::resources, ""}, of_stage), ExitCode::resources);
    EXPECT_EQ(code_of({FailureKind::bug, ""}, of_stage), ExitCode::bug);
  }
}

}  // namespace
}  // namespace aeroloom::pipeline
