/// Ends all ranks when the system, a batch queue or the user sends a signal to end.
#pragma once

#include <functional>
#include <memory>

namespace aeroloom::parallel {

/// Blocks SIGTERM, SIGINT, SIGHUP and SIGUSR1 in this process, until a TerminationWatch takes them. (Batch
/// queues send SIGUSR1 shortly before the time limit.) Call it before other threads start: they inherit it.
void hold_termination_signals();
/// Unblocks the signals, in a process that was forked meanwhile.
void release_termination_signals();

/// Waits for these signals on its own thread while it lives, between start and end of MPI. At most one exists
/// at a time. On a signal, rank 0 prints a message and calls LastWords, if there are any. Then all ranks end
/// with exit code 128 plus the signal's number, as in shells.
class TerminationWatch {
public:
  TerminationWatch();
  ~TerminationWatch();
  TerminationWatch(const TerminationWatch&) = delete;
  TerminationWatch& operator=(const TerminationWatch&) = delete;

private:
  struct State;
  std::unique_ptr<State> _state;
};

/// A function that rank 0 calls when a signal ends the program while this object lives. At most one exists at
/// a time. It is called at most once, on the thread of the watch, and must not touch data of other threads.
class LastWords {
public:
  explicit LastWords(std::function<void(int signal)> say);
  ~LastWords();
  LastWords(const LastWords&) = delete;
  LastWords& operator=(const LastWords&) = delete;
};

}  // namespace aeroloom::parallel
