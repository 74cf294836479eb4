#include "parallel/sandbox/sandbox_server.hpp"

#include "parallel/observation/timers.hpp"
#include "parallel/sandbox/sandbox_child.hpp"
#include "parallel/storage/file_descriptor.hpp"

#include <algorithm>
#include <csignal>
#include <cstring>
#include <optional>

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>

namespace aeroloom::parallel {

namespace {

/// Characters of a child's printing that are kept: its last lines, for a message.
constexpr std::size_t printed_tail = 4000;

/// A task that sleeps uses no CPU. It is given up after this many wall seconds; generous, because the clock
/// must not decide about a task that works on a busy machine.
double wall_limit(const SandboxLimits& limits) {
  constexpr double wall_over_cpu = 10;  // as if ten tasks shared its core
  return wall_over_cpu * limits.cpu_seconds + limits.idle_seconds;
}

struct Assignment {
  SandboxRequest request;
  FileDescriptor input, output;
};

/// The next request; nothing when the rank has closed its end.
std::optional<Assignment> receive_assignment(int socket) {
  Assignment assignment;
  int descriptors[2] = {-1, -1};
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof descriptors)] = {};
  iovec content{&assignment.request, sizeof assignment.request};
  msghdr message{};
  message.msg_iov = &content;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof control;
  ssize_t received = 0;
  do {
    received = recvmsg(socket, &message, MSG_CMSG_CLOEXEC);
  } while (received < 0 && errno == EINTR);
  const cmsghdr* header = CMSG_FIRSTHDR(&message);
  if (received != static_cast<ssize_t>(sizeof assignment.request) || !header ||
      header->cmsg_len != CMSG_LEN(sizeof descriptors)) {
    return std::nullopt;
  }
  std::memcpy(descriptors, CMSG_DATA(header), sizeof descriptors);
  assignment.input = FileDescriptor(descriptors[0]);
  assignment.output = FileDescriptor(descriptors[1]);
  return assignment;
}

/// The last lines that a child printed.
class PrintedTail {
public:
  explicit PrintedTail(FileDescriptor pipe) : _pipe(std::move(pipe)) {
    fcntl(_pipe.number(), F_SETFL, O_NONBLOCK);
  }
  /// Waits for printing at most so long and takes in what is there.
  void wait(int milliseconds) {
    pollfd waiting{_pipe.number(), POLLIN, 0};  // a negative descriptor only waits
    if (poll(&waiting, 1, _pipe.is_open() ? milliseconds : 1) > 0) take();
  }
  void take() {
    char buffer[4096];
    while (_pipe.is_open()) {
      const ssize_t count = read(_pipe.number(), buffer, sizeof buffer);
      if (count < 0) return;
      if (count == 0) return _pipe.close();
      _text.append(buffer, static_cast<std::size_t>(count));
      if (_text.size() > 2 * printed_tail) _text.erase(0, _text.size() - printed_tail);
    }
  }
  std::string text() const {
    std::string tail = _text.size() > printed_tail ? _text.substr(_text.size() - printed_tail) : _text;
    while (!tail.empty() && (tail.back() == '\n' || tail.back() == ' ')) tail.pop_back();
    return tail;
  }

private:
  FileDescriptor _pipe;
  std::string _text;
};

/// How a child ended.
struct Ending {
  int status = 0;  // as of wait4
  rusage usage{};
  bool overslept = false;  // the wall limit ended it
};

Ending await_child(pid_t child, const SandboxLimits& limits, PrintedTail& printed) {
  Ending ending;
  const double deadline = wall_seconds() + wall_limit(limits);
  for (;;) {
    constexpr int milliseconds_between_looks = 100;
    printed.wait(milliseconds_between_looks);
    const pid_t ended = wait4(child, &ending.status, WNOHANG, &ending.usage);
    if (ended == child) break;
    if (!ending.overslept && wall_seconds() > deadline) {
      ending.overslept = true;
      kill(child, SIGKILL);
    }
  }
  printed.take();
  return ending;
}

double cpu_seconds_of(const rusage& usage) {
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

struct Verdict {
  SandboxStatus status;
  std::string message;
  bool interrupted = false;
};

/// Signals that say what a task did; the others come from outside.
bool comes_of_the_task(int signal) {
  switch (signal) {
    case SIGSEGV:
    case SIGABRT:
    case SIGFPE:
    case SIGILL:
    case SIGSYS:
    case SIGTRAP:
    case SIGPIPE:
    case SIGXFSZ:
      return true;
    default:
      return false;
  }
}

Verdict judge_exit(int code, int output) {
  switch (static_cast<ChildExit>(code)) {
    case ChildExit::ok:
      return {SandboxStatus::ok, ""};
    case ChildExit::out_of_memory:
      return {SandboxStatus::out_of_memory, "out of memory"};
    case ChildExit::refused:
      return {SandboxStatus::aborted, "found no room for its input or output", true};
    case ChildExit::threw: {
      char text[1024];
      const ssize_t count = pread(output, text, sizeof text, 0);
      return {SandboxStatus::threw, std::string(text, static_cast<std::size_t>(std::max<ssize_t>(count, 0)))};
    }
  }
  return {SandboxStatus::aborted, "exited with code " + std::to_string(code)};
}

Verdict judge_signal(int signal, const Ending& ending, const SandboxLimits& limits) {
  const std::string name = std::string("SIG") + sigabbrev_np(signal);
  const bool cpu_used_up = cpu_seconds_of(ending.usage) >= limits.cpu_seconds;
  if (ending.overslept)
    return {SandboxStatus::out_of_time, "was stopped, or hung without using its CPU time", true};
  if (signal == SIGXCPU || (signal == SIGKILL && cpu_used_up)) {
    return {SandboxStatus::out_of_time, "used up its CPU time"};
  }
  if (comes_of_the_task(signal)) return {SandboxStatus::aborted, name};
  return {SandboxStatus::aborted, "was ended from outside (" + name + ")", true};
}

Verdict judge(const Ending& ending, const Assignment& assignment) {
  if (WIFSIGNALED(ending.status))
    return judge_signal(WTERMSIG(ending.status), ending, assignment.request.limits);
  return judge_exit(WEXITSTATUS(ending.status), assignment.output.number());
}

SandboxReply make_reply(const Verdict& verdict, const Ending& ending, const std::string& printed) {
  SandboxReply reply{};
  reply.status = verdict.status;
  reply.interrupted = verdict.interrupted;
  reply.cpu_seconds = cpu_seconds_of(ending.usage);
  reply.peak_resident_bytes = 1024 * static_cast<std::int64_t>(ending.usage.ru_maxrss);
  std::string message = verdict.message;
  if (verdict.status != SandboxStatus::ok && !printed.empty()) message += "\nIt printed last:\n" + printed;
  reply.message_length = static_cast<std::uint32_t>(std::min(message.size(), SandboxReply::message_capacity));
  std::memcpy(reply.message, message.data(), reply.message_length);
  return reply;
}

SandboxReply carry_out(const Assignment& assignment) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return make_reply({SandboxStatus::aborted, "found no pipe", true}, {}, "");
  FileDescriptor printed_here(ends[0]), printed_there(ends[1]);
  const pid_t server = getpid();
  const pid_t child = fork();
  if (child < 0) return make_reply({SandboxStatus::aborted, "could not be started", true}, {}, "");
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != server) _exit(0);
    run_child(assignment.request, assignment.input.number(), assignment.output.number(),
              printed_there.number());
  }
  printed_there.close();
  PrintedTail printed(std::move(printed_here));
  const Ending ending = await_child(child, assignment.request.limits, printed);
  return make_reply(judge(ending, assignment), ending, printed.text());
}

/// The server must not hold the terminal or the launcher's pipes open, nor read from them.
void detach_standard_streams() {
  const FileDescriptor nothing(open("/dev/null", O_RDWR));
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nothing.number(), stream);
}

}  // namespace

void serve_sandboxed_runs(int socket) {
  detach_standard_streams();
  while (const std::optional<Assignment> assignment = receive_assignment(socket)) {
    const SandboxReply reply = carry_out(*assignment);
    if (send(socket, &reply, sizeof reply, MSG_NOSIGNAL) < 0) break;
  }
  _exit(0);
}

}  // namespace aeroloom::parallel
