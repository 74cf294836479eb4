#include "parallel/sandbox/sandbox_child.hpp"

#include "parallel/communication/termination.hpp"
#include "parallel/storage/file_descriptor.hpp"

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>

namespace aeroloom::parallel {

namespace {

[[noreturn]] void leave(ChildExit code) {
  _exit(static_cast<int>(code));
}

/// Address space this process maps now, bytes. Safe in a signal handler.
std::int64_t mapped_bytes() {
  const int statm = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  if (statm < 0) return 0;
  char digits[32] = {};
  const ssize_t count = read(statm, digits, sizeof digits - 1);
  close(statm);
  std::int64_t pages = 0;
  for (ssize_t i = 0; i < count && digits[i] >= '0' && digits[i] <= '9'; ++i)
    pages = 10 * pages + (digits[i] - '0');
  return pages * sysconf(_SC_PAGESIZE);
}

/// More mapped than this when a signal strikes: the task ran out of memory without checking for it.
std::int64_t nearly_everything_mapped = 0;

void on_crash(int signal) {
  if (mapped_bytes() > nearly_everything_mapped) leave(ChildExit::out_of_memory);
  std::signal(signal, SIG_DFL);
  raise(signal);
}

/// Tells crashes for want of memory from others. On a stack of its own: the task's may have overflowed.
void watch_crashes() {
  static char stack[64 * 1024];
  stack_t alternative{};
  alternative.ss_sp = stack;
  alternative.ss_size = sizeof stack;
  sigaltstack(&alternative, nullptr);
  struct sigaction action {};
  action.sa_handler = on_crash;
  action.sa_flags = SA_ONSTACK | SA_RESETHAND | SA_NODEFER;
  for (const int signal : {SIGSEGV, SIGBUS, SIGABRT}) sigaction(signal, &action, nullptr);
}

void limit_resources(const SandboxLimits& limits) {
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  // The system counts whole seconds; the second limit is for a task that survives the signal of the first.
  const auto seconds = static_cast<rlim_t>(std::max(1.0, std::ceil(limits.cpu_seconds)));
  const rlimit cpu{seconds, seconds + 1};
  setrlimit(RLIMIT_CPU, &cpu);
  const std::int64_t allowed = mapped_bytes() + limits.address_space_bytes;
  constexpr std::int64_t nearly = 16;  // what failed to be allocated may have been a sixteenth of all
  nearly_everything_mapped = allowed - limits.address_space_bytes / nearly;
  const rlimit address_space{static_cast<rlim_t>(allowed), static_cast<rlim_t>(allowed)};
  setrlimit(RLIMIT_AS, &address_space);
}

/// The input, mapped; empty for no input.
std::span<const std::byte> map_input(int input) {
  struct stat facts {};
  if (fstat(input, &facts) != 0) leave(ChildExit::refused);
  const auto size = static_cast<std::size_t>(facts.st_size);
  if (size == 0) return {};
  const void* start = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, input, 0);
  if (start == MAP_FAILED) leave(ChildExit::refused);
  return {static_cast<const std::byte*>(start), size};
}

bool in_child = false;

[[noreturn]] void leave_with_exception(int output, const std::string& text) {
  write_all(output, std::as_bytes(std::span(text)));
  leave(ChildExit::threw);
}

}  // namespace

bool is_sandbox_child() {
  return in_child;
}

void run_child(const SandboxRequest& request, int input, int output, int printed) {
  dup2(printed, STDOUT_FILENO);
  dup2(printed, STDERR_FILENO);
  release_termination_signals();  // the server lives as long as its rank
  in_child = true;
  const SandboxTask task = sandbox_tasks()[static_cast<std::size_t>(request.task)].run;
  const std::span<const std::byte> content = map_input(input);
  // Third-party code may swallow bad_alloc or be unable to pass it on: do not let it come to that.
  std::set_new_handler([] { leave(ChildExit::out_of_memory); });
  watch_crashes();
  limit_resources(request.limits);
  try {
    const Bytes result = task(content);
    std::fflush(nullptr);
    leave(write_all(output, result) ? ChildExit::ok : ChildExit::refused);
  } catch (const std::bad_alloc&) {
    leave(ChildExit::out_of_memory);
  } catch (const std::exception& error) {
    std::fflush(nullptr);
    leave_with_exception(output, error.what());
  } catch (int code) {
    std::fflush(nullptr);
    leave_with_exception(output, "exception of type int with value " + std::to_string(code));
  } catch (...) {
    std::fflush(nullptr);
    leave_with_exception(output, "exception of unknown type");
  }
}

}  // namespace aeroloom::parallel
