/// The message passing library between its start and its end. Internal to parallel/: the only header that
/// includes mpi.h.
#pragma once

#include <memory>

#include <mpi.h>

namespace aeroloom::parallel {

/// What a Communicator refers to.
struct CommunicatorHandle {
  MPI_Comm communicator = MPI_COMM_NULL;
  int rank = 0;
  int size = 1;
  unsigned exchanges = 0;  ///< so far; consecutive ones must not share a tag
};

namespace session {

/// Throws std::runtime_error with the library's own text unless `code` is success.
void check(int code, const char* operation);

/// Starts the library and makes the groups of all ranks and of this rank alone.
void start(int& argc, char**& argv);
/// Ends the library. Collective.
void finish();
bool is_running();

/// Throw std::logic_error unless the library is running.
std::shared_ptr<CommunicatorHandle> world();
std::shared_ptr<CommunicatorHandle> self();

/// Lets the library work on messages under way, without waiting. Nothing when it is not running.
void make_progress();

}  // namespace session
}  // namespace aeroloom::parallel
