#include "parallel/sandbox/sandbox.hpp"

#include "parallel/communication/session.hpp"
#include "parallel/observation/log.hpp"
#include "parallel/observation/memory_limit.hpp"
#include "parallel/observation/progress.hpp"
#include "parallel/observation/timers.hpp"
#include "parallel/sandbox/crash_note.hpp"
#include "parallel/sandbox/sandbox_server.hpp"
#include "parallel/storage/file_descriptor.hpp"

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

/// How long the rank sleeps between two looks at its messages while a child works. Others wait for answers
/// meanwhile; the core is the child's. Chosen, not measured.
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
  throw std::logic_error("no sandboxed task is registered as '" + name + "'");
}

/// Shared memory without a name.
FileDescriptor shared_memory(const char* label) {
  FileDescriptor memory(memfd_create(label, MFD_CLOEXEC));
  if (!memory.is_open()) throw_system_error("creating shared memory");
  return memory;
}

[[noreturn]] void throw_server_gone() {
  throw std::runtime_error(
      "the worker server of sandboxed runs is gone; was it killed, or the machine out of memory?");
}

void send_request(int socket, const SandboxRequest& request, const FileDescriptor& input,
                  const FileDescriptor& output) {
  const int descriptors[2] = {input.number(), output.number()};
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof descriptors)] = {};
  iovec content{const_cast<SandboxRequest*>(&request), sizeof request};
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

SandboxReply await_reply(int socket) {
  pollfd waiting{socket, POLLIN, 0};
  while (poll(&waiting, 1, progress_interval_ms) <= 0) {
    session::make_progress();
    beat();
  }
  SandboxReply reply;
  ssize_t received = 0;
  do {
    received = recv(socket, &reply, sizeof reply, 0);
  } while (received < 0 && errno == EINTR);
  if (received != static_cast<ssize_t>(sizeof reply)) throw_server_gone();
  return reply;
}

Bytes read_output(const FileDescriptor& memory) {
  struct stat facts {};
  if (fstat(memory.number(), &facts) != 0) throw_system_error("looking at the output of a sandboxed run");
  Bytes output(static_cast<std::size_t>(facts.st_size));
  for (std::size_t done = 0; done < output.size();) {
    const ssize_t count =
        pread(memory.number(), output.data() + done, output.size() - done, static_cast<off_t>(done));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) throw_system_error("reading the output of a sandboxed run");
    done += static_cast<std::size_t>(count);
  }
  return output;
}

std::string describe_interruption(const std::string& task, const SandboxReply& reply) {
  return "a child process (task '" + task + "') " + std::string(reply.message, reply.message_length) +
         ", twice; is the machine short of memory? Remedy: fewer ranks on it, or --max-memory";
}

/// Ends the server, which sees that nobody asks any more.
void end_server() {
  server().socket.close();
  if (server().process < 0) return;
  while (waitpid(server().process, nullptr, 0) < 0 && errno == EINTR) {
  }
  server().process = -1;
}

/// Runs a task in this process.
SandboxResult run_unsandboxed(const RegisteredTask& task, std::span<const std::byte> input) {
  static bool warned = false;
  if (!warned && !server().unwanted) {
    const std::string why = server().refusal.empty()
                                ? "no server of sandboxed runs was started before MPI"
                                : "this machine allows no child processes (" + server().refusal + ")";
    log_warning(why + ": what crashes in '" + task.name +
                "' ends the program, and limits of time and memory do not hold (parallel::SandboxServer)");
  }
  warned = true;
  SandboxResult result;
  const double start = cpu_seconds();
  try {
    result.output = task.run(input);
  } catch (const std::bad_alloc&) {
    result.status = SandboxStatus::out_of_memory;
  } catch (const std::exception& error) {
    result.status = SandboxStatus::threw;
    result.message = error.what();
  } catch (...) {
    result.status = SandboxStatus::threw;
    result.message = "an exception of unknown type";
  }
  result.cpu_seconds = cpu_seconds() - start;
  result.peak_resident_bytes = resident_bytes();
  return result;
}

}  // namespace

void register_sandbox_task(const std::string& name, SandboxTask task) {
  for (const RegisteredTask& known : registry().tasks) {
    if (known.name != name) continue;
    if (known.run == task) return;
    throw std::logic_error("two sandboxed tasks are registered as '" + name + "'");
  }
  if (registry().sealed) {
    throw std::logic_error("sandboxed task '" + name + "' is registered after the start of the server");
  }
  registry().tasks.push_back({name, task});
}

const std::vector<RegisteredTask>& sandbox_tasks() {
  return registry().tasks;
}

bool has_sandbox_server() {
  return server().socket.is_open();
}

SandboxServer::SandboxServer() {
  if (has_sandbox_server()) throw std::logic_error("a second server of sandboxed runs is started");
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
    serve_sandboxed_runs(theirs.number());
  }
  server().process = process;
  server().socket = std::move(mine);
}

SandboxServer::~SandboxServer() {
  end_server();
  registry().sealed = false;
}

std::unique_ptr<SandboxServer> start_server_if_allowed() {
  try {
    return std::make_unique<SandboxServer>();
  } catch (const std::system_error& error) {
    // Short of processes or memory is another matter: that may be gone in a minute.
    if (error.code().value() != EPERM && error.code().value() != ENOSYS && error.code().value() != EACCES)
      throw;
    server().refusal = error.what();
    return nullptr;
  }
}

const std::string& sandbox_refusal() {
  return server().refusal;
}

void run_without_sandbox(const Communicator& communicator) {
  end_server();
  server().unwanted = true;
  tell_crashes(communicator.rank());
}

SandboxResult run_sandboxed(const std::string& name, std::span<const std::byte> input,
                            const SandboxLimits& limits) {
  SandboxRequest request{position_of_task(name), limits};
  if (!has_sandbox_server()) return run_unsandboxed(registry().tasks[request.task], input);
  FileDescriptor input_memory = shared_memory("input"), output_memory = shared_memory("output");
  if (!write_all(input_memory.number(), input)) throw std::bad_alloc();
  return_free_memory();
  request.limits.address_space_bytes = allowed_for_child(limits.address_space_bytes);
  const auto attempt = [&] {
    send_request(server().socket.number(), request, input_memory, output_memory);
    return await_reply(server().socket.number());
  };
  SandboxReply reply = attempt();
  if (reply.interrupted) {
    if (ftruncate(output_memory.number(), 0) != 0)
      throw_system_error("emptying the output of a sandboxed run");
    reply = attempt();
    if (reply.interrupted) throw SandboxInterrupted(describe_interruption(name, reply));
  }
  const std::int64_t allowed = request.limits.address_space_bytes;
  SandboxResult result;
  // A task that asks for much at once has little of it in use when it fails.
  result.short_of_memory =
      allowed < limits.address_space_bytes &&
      (reply.status == SandboxStatus::out_of_memory || reply.peak_resident_bytes > allowed / 2);
  if (reply.status != SandboxStatus::ok && result.short_of_memory) throw std::bad_alloc();
  result.status = reply.status;
  result.cpu_seconds = reply.cpu_seconds;
  result.peak_resident_bytes = reply.peak_resident_bytes;
  result.message.assign(reply.message, reply.message_length);
  if (result.status == SandboxStatus::ok) result.output = read_output(output_memory);
  return result;
}

}  // namespace aeroloom::parallel
