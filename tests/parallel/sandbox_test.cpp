#include "parallel/sandbox/sandbox.hpp"

#include "parallel/observation/timers.hpp"
#include "parallel/sandbox/fault.hpp"
#include "tests/scoped_fault.hpp"
#include "tests/several_ranks.hpp"

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <numeric>
#include <stdexcept>

#include <gtest/gtest.h>
#include <unistd.h>

namespace aeroloom::parallel {
namespace {

Bytes reverse(std::span<const std::byte> input) {
  return {input.rbegin(), input.rend()};
}

Bytes throw_error(std::span<const std::byte> input) {
  std::fprintf(stderr, "last words\n");
  throw std::runtime_error("bad facet " + std::to_string(input.size()));
}

Bytes throw_number(std::span<const std::byte>) {
  throw 3;
}

Bytes abort_at_once(std::span<const std::byte>) {
  std::fprintf(stderr, "assertion failed: it is flat\n");
  std::abort();
}

Bytes write_to_null(std::span<const std::byte>) {
  volatile int* nowhere = nullptr;
  *nowhere = 1;
  return {};
}

/// Recursion deeper than any stack.
int descend(int depth) {
  volatile int frame[1024];
  frame[0] = depth;
  if (depth == 1'000'000'000) return 0;
  return descend(depth + 1) + frame[0];
}

Bytes overflow_the_stack(std::span<const std::byte>) {
  return Bytes(static_cast<std::size_t>(descend(0)));
}

Bytes exit_early(std::span<const std::byte>) {
  std::exit(0);
}

Bytes spin(std::span<const std::byte>) {
  volatile std::uint64_t count = 0;
  for (;;) count = count + 1;
}

Bytes doze(std::span<const std::byte>) {
  for (;;) sleep(1);
}

/// Dies of a signal where the file named by the input is not there yet, as a machine short of memory kills.
Bytes die_once(std::span<const std::byte> input) {
  const auto letters = from_bytes<char>(input);
  const std::string file(letters.begin() + 1, letters.end());
  if (access(file.c_str(), F_OK) == 0) return Bytes(1);
  std::fclose(std::fopen(file.c_str(), "w"));
  std::raise(letters.front());
  return {};
}

Bytes die_always(std::span<const std::byte>) {
  std::raise(SIGKILL);
  return {};
}

Bytes allocate_without_end(std::span<const std::byte>) {
  std::vector<Bytes> hoard;
  for (;;) hoard.emplace_back(10'000'000, std::byte{1});
}

/// As a C library does that does not look at what malloc returns.
Bytes allocate_unchecked(std::span<const std::byte>) {
  for (;;) std::memset(std::malloc(1'000'000), 1, 1'000'000);
}

/// As a library does that catches everything.
Bytes allocate_and_swallow(std::span<const std::byte>) {
  try {
    allocate_without_end({});
  } catch (...) {
  }
  return {};
}

Bytes count_up(std::span<const std::byte> input) {
  const auto count = from_bytes<std::int64_t>(input).at(0);
  std::vector<std::int64_t> numbers(static_cast<std::size_t>(count));
  std::iota(numbers.begin(), numbers.end(), 0);
  return to_bytes(std::span<const std::int64_t>(numbers));
}

Bytes print_much(std::span<const std::byte>) {
  for (int i = 0; i < 200'000; ++i) std::printf("line %d\n", i);
  throw std::runtime_error("after much printing");
}

Bytes close_streams(std::span<const std::byte>) {
  close(STDOUT_FILENO);
  close(STDERR_FILENO);
  return Bytes(3);
}

const bool registered = [] {
  register_sandbox_task("reverse", reverse);
  register_sandbox_task("throw_error", throw_error);
  register_sandbox_task("throw_number", throw_number);
  register_sandbox_task("abort_at_once", abort_at_once);
  register_sandbox_task("write_to_null", write_to_null);
  register_sandbox_task("overflow_the_stack", overflow_the_stack);
  register_sandbox_task("exit_early", exit_early);
  register_sandbox_task("spin", spin);
  register_sandbox_task("doze", doze);
  register_sandbox_task("die_once", die_once);
  register_sandbox_task("die_always", die_always);
  register_sandbox_task("allocate_without_end", allocate_without_end);
  register_sandbox_task("allocate_unchecked", allocate_unchecked);
  register_sandbox_task("allocate_and_swallow", allocate_and_swallow);
  register_sandbox_task("count_up", count_up);
  register_sandbox_task("print_much", print_much);
  register_sandbox_task("close_streams", close_streams);
  return true;
}();

SandboxResult run(const std::string& name, SandboxLimits limits = {}) {
  return run_sandboxed(name, {}, limits);
}

/// A run after whatever happened before must work.
void expect_still_working() {
  const Bytes input{std::byte{1}, std::byte{2}, std::byte{3}};
  const auto result = run_sandboxed("reverse", input, {});
  ASSERT_EQ(result.status, SandboxStatus::ok) << result.message;
  EXPECT_EQ(result.output, (Bytes{std::byte{3}, std::byte{2}, std::byte{1}}));
}

TEST(SandboxTest, ReturnsTheOutput) {
  ASSERT_TRUE(registered);
  expect_still_working();
  const auto empty = run("reverse");
  EXPECT_EQ(empty.status, SandboxStatus::ok);
  EXPECT_TRUE(empty.output.empty());
  EXPECT_TRUE(empty.message.empty());
}

TEST(SandboxLocal, BringsBackTheException) {
  const Bytes input(5);
  const auto result = run_sandboxed("throw_error", input, {});
  EXPECT_EQ(result.status, SandboxStatus::threw);
  EXPECT_EQ(result.message, "bad facet 5\nIt printed last:\nlast words");
  EXPECT_TRUE(result.output.empty());
  EXPECT_EQ(run("throw_number").status, SandboxStatus::threw);
  EXPECT_NE(run("throw_number").message.find('3'), std::string::npos);
  expect_still_working();
}

TEST(SandboxLocal, SurvivesAbort) {
  const auto result = run("abort_at_once");
  EXPECT_EQ(result.status, SandboxStatus::aborted);
  EXPECT_EQ(result.message, "SIGABRT\nIt printed last:\nassertion failed: it is flat");
  expect_still_working();
}

TEST(SandboxLocal, SurvivesSegmentationFaults) {
  for (const char* task : {"write_to_null", "overflow_the_stack"}) {
    const auto result = run(task);
    EXPECT_EQ(result.status, SandboxStatus::aborted) << task;
#if !defined(__SANITIZE_ADDRESS__)
    EXPECT_EQ(result.message, "SIGSEGV") << task;
#endif
  }
  expect_still_working();
}

TEST(SandboxLocal, AnExitIsNoSuccess) {
  const auto result = run("exit_early");
  EXPECT_EQ(result.status, SandboxStatus::aborted);
  EXPECT_EQ(result.message, "exited with code 0");
  expect_still_working();
}

TEST(SandboxLocal, EndsWhatUsesUpItsCpuTime) {
  SandboxLimits limits;
  limits.cpu_seconds = 1;
  const auto result = run("spin", limits);
  EXPECT_EQ(result.status, SandboxStatus::out_of_time);
  EXPECT_GE(result.cpu_seconds, 0.5);  // the kernel counts the limit in ticks, the usage exactly
  EXPECT_LT(result.cpu_seconds, 3);
  expect_still_working();
}

TEST(SandboxLocal, EndsWhatSleeps) {
  SandboxLimits limits;
  limits.cpu_seconds = 0.05;
  limits.idle_seconds = 0.5;
  const double start = wall_seconds();
  EXPECT_THROW(run("doze", limits), SandboxInterrupted);
  EXPECT_GE(wall_seconds() - start, 2.0);
  EXPECT_LT(wall_seconds() - start, 20.0);
  expect_still_working();
}

// What comes from outside says nothing of the task: it is done again, as it was.
TEST(SandboxLocal, StartsAgainWhatIsEndedFromOutside) {
  for (const int signal : {SIGKILL, SIGTERM, SIGHUP, SIGBUS}) {
    std::string input(1, static_cast<char>(signal));
    const std::string file = testing::TempDir() + "contained_" + std::to_string(getpid());
    input += file;
    const auto result =
        run_sandboxed("die_once", std::as_bytes(std::span<const char>(input.data(), input.size())), {});
    EXPECT_EQ(result.status, SandboxStatus::ok) << result.message;
    EXPECT_EQ(result.output.size(), 1u);
    std::remove(file.c_str());
  }
  try {
    run("die_always");
    FAIL() << "ended twice, and nobody said so";
  } catch (const SandboxInterrupted& interrupted) {
    const std::string text = interrupted.what();
    EXPECT_NE(text.find("ended from outside (SIGKILL), twice"), std::string::npos) << text;
    EXPECT_NE(text.find("--max-memory"), std::string::npos) << text;
  }
  expect_still_working();
}

TEST(SandboxLocal, EndsWhatExhaustsMemory) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "the address sanitizer ends the child itself";
#endif
  SandboxLimits limits;
  limits.address_space_bytes = 300'000'000;
  for (const char* task : {"allocate_without_end", "allocate_unchecked", "allocate_and_swallow"}) {
    const auto result = run(task, limits);
    EXPECT_EQ(result.status, SandboxStatus::out_of_memory) << task << ": " << result.message;
    EXPECT_GT(result.peak_resident_bytes, 200'000'000) << task;
    EXPECT_LT(result.peak_resident_bytes, 400'000'000) << task;
  }
  expect_still_working();
}

TEST(SandboxLocal, CarriesLargeInputAndOutput) {
  const std::vector<std::int64_t> count{8'000'000};  // 64 MB
  const auto result = run_sandboxed("count_up", std::as_bytes(std::span(count)), {});
  ASSERT_EQ(result.status, SandboxStatus::ok) << result.message;
  ASSERT_EQ(result.output.size(), 64'000'000u);
  std::vector<std::int64_t> expected(8'000'000);
  std::iota(expected.begin(), expected.end(), 0);
  EXPECT_EQ(std::memcmp(result.output.data(), expected.data(), result.output.size()), 0);
  EXPECT_GE(result.peak_resident_bytes, 64'000'000);
  const auto back = run_sandboxed("reverse", result.output, {});
  ASSERT_EQ(back.output.size(), result.output.size());
  EXPECT_TRUE(std::equal(back.output.begin(), back.output.end(), result.output.rbegin()));
}

TEST(SandboxLocal, KeepsTheTailOfMuchPrinting) {
  const auto result = run("print_much");
  EXPECT_EQ(result.status, SandboxStatus::threw);
  EXPECT_EQ(result.message.rfind("after much printing\n", 0), 0u);
  EXPECT_EQ(result.message.substr(result.message.size() - 11), "line 199999");
  EXPECT_LT(result.message.size(), 8192u);
}

TEST(SandboxLocal, CopesWithClosedStreams) {
  const auto result = run("close_streams");
  EXPECT_EQ(result.status, SandboxStatus::ok) << result.message;
  EXPECT_EQ(result.output.size(), 3u);
}

TEST(SandboxLocal, RunsManyTimesInARow) {
  const auto descriptors = [] {
    const int probe = dup(STDERR_FILENO);
    close(probe);
    return probe;
  };
  const int before = descriptors();
  for (std::uint32_t i = 0; i < 300; ++i) {
    const Bytes input(i, static_cast<std::byte>(i));
    const auto result = run_sandboxed("reverse", input, {});
    ASSERT_EQ(result.status, SandboxStatus::ok) << result.message;
    ASSERT_EQ(result.output, input);
  }
  EXPECT_EQ(descriptors(), before) << "file descriptors leak";
}

TEST(SandboxLocal, AlternatesFailuresAndSuccesses) {
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(run(i % 2 ? "abort_at_once" : "throw_error").status,
              i % 2 ? SandboxStatus::aborted : SandboxStatus::threw);
    expect_still_working();
  }
}

TEST(SandboxTest, MessagesMoveWhileAChildWorks) {
  const auto world = Communicator::world();
  NEEDS_SEVERAL_RANKS();
  if (world.is_root()) {
    SandboxLimits limits;
    limits.cpu_seconds = 1;
    EXPECT_EQ(run("spin", limits).status, SandboxStatus::out_of_time);
  }
  EXPECT_EQ(world.sum(std::int64_t{1}), world.size());
}

TEST(SandboxLocal, RefusesUnknownTasksAndLateRegistration) {
  EXPECT_THROW(run("no such task"), std::logic_error);
  EXPECT_THROW(register_sandbox_task("late", reverse), std::logic_error);
  EXPECT_THROW(register_sandbox_task("reverse", spin), std::logic_error);
  EXPECT_NO_THROW(register_sandbox_task("reverse", reverse));
}

TEST(RequestedFault, IsReadFromTheEnvironmentOrRefused) {
  EXPECT_EQ(requested_fault("zone").fault, Fault::none);
  {
    const ScopedFault injected("zone=aborts@3");
    EXPECT_EQ(requested_fault("zone").fault, Fault::aborts);
    EXPECT_EQ(requested_fault("zone").number, 3);
    EXPECT_EQ(requested_fault("domain").fault, Fault::none);
  }
  for (const char* request :
       {"aborts", "zone=", "zone=burns", "zone=aborts@", "zone=aborts@x", "zone=aborts@-1"}) {
    const ScopedFault injected(request);
    EXPECT_THROW(requested_fault("zone"), std::invalid_argument) << request;
  }
}

}  // namespace
}  // namespace aeroloom::parallel
