#include "parallel/communication/environment.hpp"

#include "parallel/communication/session.hpp"
#include "parallel/sandbox/sandbox.hpp"
#include "parallel/sandbox/sandbox_server.hpp"

#include <cstdio>
#include <cstdlib>
#include <exception>

#include <fcntl.h>
#include <unistd.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace aeroloom::parallel {

namespace {

/// Exit code of a program error.
constexpr int exit_bug = 70;

/// An exception nobody caught: says what it was, then ends all ranks. Without this the other ranks would wait
/// for ever.
[[noreturn]] void report_and_abort() {
  const int rank = session::is_running() ? session::world()->rank : 0;
  const char* text = "ended without an exception";
  if (const std::exception_ptr current = std::current_exception()) {
    try {
      std::rethrow_exception(current);
    } catch (const std::exception& error) {
      std::fprintf(stderr, "[rank %d] uncaught exception: %s\n", rank, error.what());
      abort_all_ranks(exit_bug);
    } catch (...) {
      text = "uncaught exception of unknown type";
    }
  }
  std::fprintf(stderr, "[rank %d] %s\n", rank, text);
  abort_all_ranks(exit_bug);
}

/// Large arrays are mapped one by one and go back to the system when they are freed. Left alone, the
/// allocator moves the bound up to the largest one that was freed, and keeps their memory for what may come.
void return_large_arrays() {
#ifdef __GLIBC__
  constexpr int large = 8 << 20, kept_at_most = 32 << 20;  // bytes; chosen, not measured
  mallopt(M_MMAP_THRESHOLD, large);
  mallopt(M_TRIM_THRESHOLD, kept_at_most);
#endif
}

/// Descriptors 0 to 2 that whoever started us has closed: what is opened next would be taken for them.
void open_standard_streams() {
  for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream) {
    if (fcntl(stream, F_GETFD) < 0 && open("/dev/null", O_RDWR) != stream) _exit(exit_bug);
  }
}

}  // namespace

Environment::Environment(int& argc, char**& argv) : _exceptions_at_start(std::uncaught_exceptions()) {
  open_standard_streams();
  if (!session::is_library_running() && !has_sandbox_server()) _server = start_server_if_allowed();
  // Not in sandboxed runs, whose memory goes with them.
  if (!session::is_library_running()) return_large_arrays();
  session::start(argc, argv);
  std::set_terminate(report_and_abort);
}

Environment::~Environment() {
  if (std::uncaught_exceptions() > _exceptions_at_start) {
    // Other ranks may be inside a collective call this rank will never join.
    std::fprintf(stderr, "[rank %d] an exception leaves the parallel environment\n", session::world()->rank);
    abort_all_ranks(exit_bug);
  }
  session::finish();
}

void abort_all_ranks(int exit_code) {
  std::fflush(stdout);
  std::fflush(stderr);
  if (session::is_library_running()) MPI_Abort(MPI_COMM_WORLD, exit_code);
  _exit(exit_code);
}

}  // namespace aeroloom::parallel
