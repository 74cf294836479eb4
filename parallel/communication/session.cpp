#include "parallel/communication/session.hpp"

#include "parallel/observation/timers.hpp"

#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace aeroloom::parallel::session {

namespace {

struct Session {
  std::shared_ptr<CommunicatorHandle> world;
  bool started_library = false;
};

Session& current() {
  static Session instance;
  return instance;
}

MessageTime& spent() {
  static MessageTime instance;
  return instance;
}

/// Whether the launcher says that all ranks are on this machine, or there is none.
bool is_on_one_machine() {
  const char* const ranks = std::getenv("OMPI_COMM_WORLD_SIZE");
  const char* const here = std::getenv("OMPI_COMM_WORLD_LOCAL_SIZE");
  if (ranks != nullptr && here != nullptr) return std::strcmp(ranks, here) == 0;
  return std::getenv("PMIX_RANK") == nullptr && std::getenv("PMI_RANK") == nullptr;
}

/// Open MPI looks for every kind of network before it starts, for a quarter of a second; on one machine there
/// is none to be found. What the user or the launcher asked for stays.
void skip_networks() {
  constexpr int keep = 0;
  if (is_on_one_machine()) setenv("OMPI_MCA_pml", "ob1", keep);
}

/// Whether this process may keep something in the memory that processes of a machine share (/dev/shm).
bool has_shared_memory() {
  const std::string name = "/aeroloom." + std::to_string(getpid());
  const int file = shm_open(name.c_str(), O_RDWR | O_CREAT | O_EXCL, S_IRUSR | S_IWUSR);
  if (file < 0) return false;
  constexpr off_t a_page = 4096;
  const bool has_room = posix_fallocate(file, 0, a_page) == 0;
  close(file);
  shm_unlink(name.c_str());
  return has_room;
}

/// Ranks that open a file together share a semaphore for a position in it, which nothing here uses. Where
/// there is no place for it, Open MPI refuses to open the file; without it, files are opened as well.
void open_files_without_shared_memory() {
  constexpr int keep = 0;
  if (!has_shared_memory()) setenv("OMPI_MCA_sharedfp", "^sm", keep);
}

/// Frees the group, unless the library has ended before.
void release(CommunicatorHandle* handle) {
  if (is_library_running()) MPI_Comm_free(&handle->communicator);
  delete handle;
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

bool is_library_running() {
  int started = 0, ended = 0;
  MPI_Initialized(&started);
  MPI_Finalized(&ended);
  return started != 0 && ended == 0;
}

std::shared_ptr<CommunicatorHandle> duplicate(MPI_Comm original) {
  std::shared_ptr<CommunicatorHandle> handle(new CommunicatorHandle, release);
  check(MPI_Comm_dup(original, &handle->communicator), "duplicating a communicator");
  check(MPI_Comm_set_errhandler(handle->communicator, MPI_ERRORS_RETURN), "setting the error handler");
  check(MPI_Comm_rank(handle->communicator, &handle->rank), "asking for the rank");
  check(MPI_Comm_size(handle->communicator, &handle->size), "asking for the number of ranks");
  return handle;
}

void start(int& argc, char**& argv) {
  if (is_running()) throw std::logic_error("parallel::Environment is constructed a second time");
  if (!is_library_running()) {
    skip_networks();
    open_files_without_shared_memory();
    int provided = MPI_THREAD_SINGLE;
    check(MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided), "starting");
    current().started_library = true;
  }
  current().world = duplicate(MPI_COMM_WORLD);
}

void finish() {
  current().world.reset();
  if (current().started_library) MPI_Finalize();
  current().started_library = false;
}

bool is_running() {
  return current().world != nullptr;
}

std::shared_ptr<CommunicatorHandle> world() {
  if (!is_running())
    throw std::logic_error("the group of all ranks was asked for without a living parallel::Environment");
  return current().world;
}

std::shared_ptr<CommunicatorHandle> self() {
  if (!is_library_running()) throw std::logic_error("a communicator was asked for before MPI runs, or after");
  return duplicate(MPI_COMM_SELF);
}

const MessageTime& message_time() {
  return spent();
}

MessageScope::MessageScope() : _start{parallel::wall_seconds(), parallel::cpu_seconds()} {}

MessageScope::~MessageScope() {
  spent().wall_seconds += parallel::wall_seconds() - _start.wall_seconds;
  spent().cpu_seconds += parallel::cpu_seconds() - _start.cpu_seconds;
}

void make_progress() {
  if (!is_library_running()) return;
  int arrived = 0;
  MPI_Comm group = is_running() ? current().world->communicator : MPI_COMM_SELF;
  check(MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, group, &arrived, MPI_STATUS_IGNORE), "probing");
}

}  // namespace aeroloom::parallel::session
