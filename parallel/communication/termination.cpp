#include "parallel/communication/termination.hpp"

#include "parallel/communication/environment.hpp"
#include "parallel/communication/session.hpp"

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <memory>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

#include <poll.h>
#include <pthread.h>
#include <sys/eventfd.h>
#include <sys/signalfd.h>
#include <unistd.h>

namespace aeroloom::parallel {
namespace {

sigset_t termination_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGTERM, SIGINT, SIGHUP, SIGUSR1}) sigaddset(&signals, signal);
  return signals;
}

struct Words {
  std::mutex mutex;
  std::function<void(int)> say;
};
Words& last_words() {
  static Words words;
  return words;
}

}  // namespace

void hold_termination_signals() {
  const sigset_t signals = termination_signals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
}

void release_termination_signals() {
  const sigset_t signals = termination_signals();
  pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
}

struct TerminationWatch::State {
  /// A descriptor that is closed at the end of its life.
  class Descriptor {
  public:
    explicit Descriptor(int number) : _number(number) {
      if (number < 0) throw std::system_error(errno, std::generic_category(), "watching for signals");
    }
    ~Descriptor() { ::close(_number); }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int number() const { return _number; }

  private:
    int _number;
  };

  sigset_t watched = termination_signals();
  Descriptor signals{::signalfd(-1, &watched, SFD_CLOEXEC)};
  Descriptor over{::eventfd(0, EFD_CLOEXEC)};  // readable once nobody needs the watch
  std::thread thread;

  void watch() const {
    std::array<pollfd, 2> awaited{pollfd{signals.number(), POLLIN, 0}, pollfd{over.number(), POLLIN, 0}};
    while (awaited[1].revents == 0) {
      if (::poll(awaited.data(), awaited.size(), -1) < 0) continue;
      signalfd_siginfo came{};
      if (awaited[0].revents != 0 && ::read(signals.number(), &came, sizeof(came)) == sizeof(came))
        end(static_cast<int>(came.ssi_signo));
    }
  }

  [[noreturn]] static void end(int signal) {
    constexpr int signal_code = 128;  // exit codes of shells for programs that a signal ended
    if (session::world()->rank == 0) {
      std::fprintf(stderr, "error: ended by SIG%s\n", sigabbrev_np(signal));
      const std::lock_guard guard(last_words().mutex);
      if (last_words().say) last_words().say(signal);
    } else {
      // The first that aborts ends all: rank 0 is left the time to speak. Launchers kill some seconds after a
      // signal.
      constexpr std::chrono::milliseconds time_to_speak(500);
      std::this_thread::sleep_for(time_to_speak);
    }
    abort_all_ranks(signal_code + signal);
  }
};

TerminationWatch::TerminationWatch() : _state(std::make_unique<State>()) {
  _state->thread = std::thread([state = _state.get()] { state->watch(); });
}

TerminationWatch::~TerminationWatch() {
  ::eventfd_write(_state->over.number(), 1);
  _state->thread.join();
}

LastWords::LastWords(std::function<void(int signal)> say) {
  const std::lock_guard guard(last_words().mutex);
  last_words().say = std::move(say);
}

LastWords::~LastWords() {
  const std::lock_guard guard(last_words().mutex);
  last_words().say = nullptr;
}

}  // namespace aeroloom::parallel
