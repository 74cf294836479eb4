/// Start, state and end of MPI. Internal to parallel/.
#pragma once

#include <memory>

#include <mpi.h>

namespace aeroloom::parallel {

/// The group of ranks that a Communicator refers to.
struct CommunicatorHandle {
  MPI_Comm communicator = MPI_COMM_NULL;
  int rank = 0;
  int size = 1;
  unsigned exchanges = 0;                  ///< so far; consecutive exchanges use different tags
  std::shared_ptr<const void> nodes = {};  ///< ranks by node, made on first use (node_array.cpp)
};

namespace session {

/// Throws std::runtime_error with MPI's own text unless `code` is success.
void check(int code, const char* operation);

/// Starts MPI, unless the host program has, and makes the group of all ranks. Collective.
void start(int& argc, char**& argv);
/// Ends MPI if start() has started it. Collective.
void finish();
/// Whether start() has been called, and finish() not yet.
bool is_running();
/// Whether MPI runs, whoever started it.
bool is_library_running();

/// A duplicate of `original`, so that messages of other libraries cannot mix with ours. Freed with the last
/// reference. Collective.
std::shared_ptr<CommunicatorHandle> duplicate(MPI_Comm original);

/// Throws std::logic_error unless start() has been called.
std::shared_ptr<CommunicatorHandle> world();
/// Throws std::logic_error unless MPI runs.
std::shared_ptr<CommunicatorHandle> self();

/// The time that this process has spent in communicators so far: wall seconds, including the wait for other
/// ranks, and CPU seconds of the calling thread.
struct MessageTime {
  double wall_seconds = 0, cpu_seconds = 0;
};
const MessageTime& message_time();

/// Adds a scope to the time spent in messages. Scopes do not nest.
class MessageScope {
public:
  MessageScope();
  ~MessageScope();
  MessageScope(const MessageScope&) = delete;
  MessageScope& operator=(const MessageScope&) = delete;

private:
  MessageTime _start;
};

/// Lets MPI work on pending messages, without waiting. Does nothing if MPI is not running.
void make_progress();

}  // namespace session
}  // namespace aeroloom::parallel
