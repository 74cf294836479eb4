/// The message passing library between its start and its end. Internal to parallel/.
#pragma once

#include <memory>

#include <mpi.h>

namespace aeroloom::parallel {

/// The group of ranks that a Communicator refers to.
struct CommunicatorHandle {
  MPI_Comm communicator = MPI_COMM_NULL;
  int rank = 0;
  int size = 1;
  unsigned exchanges = 0;                  ///< so far; consecutive ones must not share a tag
  std::shared_ptr<const void> nodes = {};  ///< its ranks by node, once somebody has asked (node_array.cpp)
};

namespace session {

/// Throws std::runtime_error with the library's own text unless `code` is success.
void check(int code, const char* operation);

/// Starts the library, unless the host program has, and makes the group of all ranks. Collective.
void start(int& argc, char**& argv);
/// Ends what start() began. Collective.
void finish();
/// Whether start() has been called, and finish() not yet.
bool is_running();
/// Whether the library runs, whoever started it.
bool is_library_running();

/// A group of our own with the members of `original`: messages of other libraries cannot mix with ours. Freed
/// with the last reference. Collective.
std::shared_ptr<CommunicatorHandle> duplicate(MPI_Comm original);

/// Throws std::logic_error unless start() has been called.
std::shared_ptr<CommunicatorHandle> world();
/// Throws std::logic_error unless the library runs.
std::shared_ptr<CommunicatorHandle> self();

/// The time that this process has spent in the operations of communicators so far: wall seconds, waiting for
/// other ranks included, and CPU seconds of the calling thread.
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

/// Lets the library work on messages under way, without waiting. Nothing when it is not running.
void make_progress();

}  // namespace session
}  // namespace aeroloom::parallel
