#include "parallel/termination.hpp"

#include "parallel/environment.hpp"
#include "parallel/session.hpp"

#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

#include <pthread.h>

namespace aeroloom::parallel {
namespace {

/// How often the thread looks whether it is still wanted.
constexpr long look_up_nanoseconds = 200'000'000;

sigset_t termination_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGTERM, SIGINT, SIGHUP}) sigaddset(&signals, signal);
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
  std::atomic<bool> over = false;
  std::thread thread;

  void watch() {
    const sigset_t signals = termination_signals();
    const timespec patience{0, look_up_nanoseconds};
    while (!over) {
      const int signal = sigtimedwait(&signals, nullptr, &patience);
      if (signal > 0) end(signal);
    }
  }

  [[noreturn]] static void end(int signal) {
    if (session::world()->rank == 0) {
      std::fprintf(stderr, "error: ended by SIG%s\n", sigabbrev_np(signal));
      const std::lock_guard guard(last_words().mutex);
      if (last_words().say) last_words().say(signal);
    }
    abort_all_ranks(128 + signal);
  }
};

TerminationWatch::TerminationWatch() : _state(std::make_unique<State>()) {
  _state->thread = std::thread([state = _state.get()] { state->watch(); });
}

TerminationWatch::~TerminationWatch() {
  _state->over = true;
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
