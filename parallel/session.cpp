#include "parallel/session.hpp"

#include <stdexcept>
#include <string>

namespace aeroloom::parallel::session {

namespace {

struct Groups {
  std::shared_ptr<CommunicatorHandle> world, self;
};

Groups& groups() {
  static Groups instance;
  return instance;
}

/// A group of our own with the members of `original`: messages of other libraries cannot mix with ours.
std::shared_ptr<CommunicatorHandle> duplicate(MPI_Comm original) {
  auto handle = std::make_shared<CommunicatorHandle>();
  check(MPI_Comm_dup(original, &handle->communicator), "duplicating a communicator");
  check(MPI_Comm_set_errhandler(handle->communicator, MPI_ERRORS_RETURN), "setting the error handler");
  check(MPI_Comm_rank(handle->communicator, &handle->rank), "asking for the rank");
  check(MPI_Comm_size(handle->communicator, &handle->size), "asking for the number of ranks");
  return handle;
}

void release(std::shared_ptr<CommunicatorHandle>& handle) {
  MPI_Comm_free(&handle->communicator);
  handle.reset();
}

const std::shared_ptr<CommunicatorHandle>& require(const std::shared_ptr<CommunicatorHandle>& handle) {
  if (!handle) throw std::logic_error("a communicator was asked for without a living parallel::Environment");
  return handle;
}

}  // namespace

void check(int code, const char* operation) {
  if (code == MPI_SUCCESS) return;
  char text[MPI_MAX_ERROR_STRING];
  int length = 0;
  MPI_Error_string(code, text, &length);
  throw std::runtime_error(std::string("message passing failed while ") + operation + ": " +
                           std::string(text, static_cast<std::size_t>(length)));
}

void start(int& argc, char**& argv) {
  if (is_running()) throw std::logic_error("parallel::Environment is constructed a second time");
  int provided = MPI_THREAD_SINGLE;
  check(MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided), "starting");
  groups().world = duplicate(MPI_COMM_WORLD);
  groups().self = duplicate(MPI_COMM_SELF);
}

void finish() {
  release(groups().self);
  release(groups().world);
  MPI_Finalize();
}

bool is_running() {
  return groups().world != nullptr;
}

std::shared_ptr<CommunicatorHandle> world() {
  return require(groups().world);
}

std::shared_ptr<CommunicatorHandle> self() {
  return require(groups().self);
}

void make_progress() {
  if (!is_running()) return;
  int arrived = 0;
  check(MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, groups().world->communicator, &arrived, MPI_STATUS_IGNORE),
        "probing");
}

}  // namespace aeroloom::parallel::session
