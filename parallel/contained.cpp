#include "parallel/contained.hpp"

#include "parallel/contained_server.hpp"
#include "parallel/crash_note.hpp"
#include "parallel/file_descriptor.hpp"
#include "parallel/log.hpp"
#include "parallel/memory_limit.hpp"
#include "parallel/progress.hpp"
#include "parallel/session.hpp"
#include "parallel/timers.hpp"

#include <cstring>
#include <new>
#include <stdexcept>
#include <system_error>

#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>

namespace aeroloom::parallel {

namespace {

/// How long the rank sleeps between two looks at its messages while a child works.
constexpr int progress_interval_ms = 2;

struct Registry {
  std::vector<RegisteredTask> tasks;
  bool sealed = false;
};

Registry& registry() {
  static Registry instance;
  return instance;
}

/// The rank's end of its server.
struct Server {
  pid_t process = -1;
  FileDescriptor socket;
  std::string refusal;    // of the machine to have one
  bool unwanted = false;  // by the user
};

Server& server() {
  static Server instance;
  return instance;
}

std::int32_t position_of_task(const std::string& name) {
  const std::vector<RegisteredTask>& tasks = registry().tasks;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    if (tasks[i].name == name) return static_cast<std::int32_t>(i);
  }
  throw std::logic_error("no contained task is registered as '" + name + "'");
}

/// Shared memory without a name.
FileDescriptor shared_memory(const char* label) {
  FileDescriptor memory(memfd_create(label, MFD_CLOEXEC));
  if (!memory.is_open()) throw_system_error("creating shared memory");
  return memory;
}

[[noreturn]] void throw_server_gone() {
  throw std::runtime_error(
      "the worker server of contained runs is gone; was it killed, or the machine out of memory?");
}

void send_request(int socket, const ContainedRequest& request, const FileDescriptor& input,
                  const FileDescriptor& output) {
  const int descriptors[2] = {input.number(), output.number()};
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof descriptors)] = {};
  iovec content{const_cast<ContainedRequest*>(&request), sizeof request};
  msghdr message{};
  message.msg_iov = &content;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof control;
  cmsghdr* header = CMSG_FIRSTHDR(&message);
  header->cmsg_level = SOL_SOCKET;
  header->cmsg_type = SCM_RIGHTS;
  header->cmsg_len = CMSG_LEN(sizeof descriptors);
  std::memcpy(CMSG_DATA(header), descriptors, sizeof descriptors);
  while (sendmsg(socket, &message, MSG_NOSIGNAL) < 0) {
    if (errno != EINTR) throw_server_gone();
  }
}

ContainedReply await_reply(int socket) {
  pollfd waiting{socket, POLLIN, 0};
  while (poll(&waiting, 1, progress_interval_ms) <= 0) {
    session::make_progress();
    beat();
  }
  ContainedReply reply;
  ssize_t received = 0;
  do {
    received = recv(socket, &reply, sizeof reply, 0);
  } while (received < 0 && errno == EINTR);
  if (received != static_cast<ssize_t>(sizeof reply)) throw_server_gone();
  return reply;
}

Bytes read_output(const FileDescriptor& memory) {
  struct stat facts {};
  if (fstat(memory.number(), &facts) != 0) throw_system_error("looking at the output of a contained run");
  Bytes output(static_cast<std::size_t>(facts.st_size));
  for (std::size_t done = 0; done < output.size();) {
    const ssize_t count =
        pread(memory.number(), output.data() + done, output.size() - done, static_cast<off_t>(done));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) throw_system_error("reading the output of a contained run");
    done += static_cast<std::size_t>(count);
  }
  return output;
}

std::string describe_interruption(const std::string& task, const ContainedReply& reply) {
  return "a child process (task '" + task + "') " + std::string(reply.message, reply.message_length) +
         ", twice; is the machine short of memory? Remedy: fewer ranks on it, or --max-memory";
}

/// It ends when it sees that nobody asks any more.
void end_server() {
  server().socket.close();
  if (server().process < 0) return;
  while (waitpid(server().process, nullptr, 0) < 0 && errno == EINTR) {
  }
  server().process = -1;
}

/// Runs a task in this process.
ContainedResult run_uncontained(const RegisteredTask& task, std::span<const std::byte> input) {
  static bool warned = false;
  if (!warned && !server().unwanted) {
    const std::string why = server().refusal.empty()
                                ? "no server of contained runs was started before MPI"
                                : "this machine allows no child processes (" + server().refusal + ")";
    log_warning(why + ": what crashes in '" + task.name +
                "' ends the program, and limits of time and memory do not hold (parallel::ContainedServer)");
  }
  warned = true;
  ContainedResult result;
  const double start = cpu_seconds();
  try {
    result.output = task.run(input);
  } catch (const std::bad_alloc&) {
    result.status = ContainedStatus::out_of_memory;
  } catch (const std::exception& error) {
    result.status = ContainedStatus::threw;
    result.message = error.what();
  } catch (...) {
    result.status = ContainedStatus::threw;
    result.message = "an exception of unknown type";
  }
  result.cpu_seconds = cpu_seconds() - start;
  result.peak_resident_bytes = resident_bytes();
  return result;
}

}  // namespace

void register_contained_task(const std::string& name, ContainedTask task) {
  for (const RegisteredTask& known : registry().tasks) {
    if (known.name != name) continue;
    if (known.run == task) return;
    throw std::logic_error("two contained tasks are registered as '" + name + "'");
  }
  if (registry().sealed) {
    throw std::logic_error("contained task '" + name + "' is registered after the start of the server");
  }
  registry().tasks.push_back({name, task});
}

const std::vector<RegisteredTask>& contained_tasks() {
  return registry().tasks;
}

bool is_containment_ready() {
  return server().socket.is_open();
}

ContainedServer::ContainedServer() {
  if (is_containment_ready()) throw std::logic_error("a second server of contained runs is started");
  registry().sealed = true;
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0) {
    throw_system_error("connecting to the worker server");
  }
  FileDescriptor mine(ends[0]), theirs(ends[1]);
  const pid_t rank_process = getpid();
  const pid_t process = fork();
  if (process < 0) throw_system_error("starting a child process");
  if (process == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != rank_process) _exit(0);  // the rank died before we asked to be told
    mine.close();
    serve_contained_runs(theirs.number());
  }
  server().process = process;
  server().socket = std::move(mine);
}

ContainedServer::~ContainedServer() {
  end_server();
  registry().sealed = false;
}

std::unique_ptr<ContainedServer> start_server_if_allowed() {
  try {
    return std::make_unique<ContainedServer>();
  } catch (const std::system_error& error) {
    // Short of processes or memory is another matter: that may be gone in a minute.
    if (error.code().value() != EPERM && error.code().value() != ENOSYS && error.code().value() != EACCES)
      throw;
    server().refusal = error.what();
    return nullptr;
  }
}

const std::string& containment_refusal() {
  return server().refusal;
}

void do_without_containment(const Communicator& communicator) {
  end_server();
  server().unwanted = true;
  tell_crashes(communicator.rank());
}

ContainedResult run_contained(const std::string& name, std::span<const std::byte> input,
                              const ContainedLimits& limits) {
  ContainedRequest request{position_of_task(name), limits};
  if (!is_containment_ready()) return run_uncontained(registry().tasks[request.task], input);
  FileDescriptor input_memory = shared_memory("input"), output_memory = shared_memory("output");
  if (!write_all(input_memory.number(), input)) throw std::bad_alloc();
  return_free_memory();
  request.limits.address_space_bytes = allowed_for_child(limits.address_space_bytes);
  const auto attempt = [&] {
    send_request(server().socket.number(), request, input_memory, output_memory);
    return await_reply(server().socket.number());
  };
  ContainedReply reply = attempt();
  if (reply.interrupted) {
    if (ftruncate(output_memory.number(), 0) != 0)
      throw_system_error("emptying the output of a contained run");
    reply = attempt();
    if (reply.interrupted) throw ContainedInterrupted(describe_interruption(name, reply));
  }
  const std::int64_t allowed = request.limits.address_space_bytes;
  ContainedResult result;
  // What asks for much at once has little of it in use.
  result.short_of_memory =
      allowed < limits.address_space_bytes &&
      (reply.status == ContainedStatus::out_of_memory || reply.peak_resident_bytes > allowed / 2);
  if (reply.status != ContainedStatus::ok && result.short_of_memory) throw std::bad_alloc();
  result.status = reply.status;
  result.cpu_seconds = reply.cpu_seconds;
  result.peak_resident_bytes = reply.peak_resident_bytes;
  result.message.assign(reply.message, reply.message_length);
  if (result.status == ContainedStatus::ok) result.output = read_output(output_memory);
  return result;
}

}  // namespace aeroloom::parallel
