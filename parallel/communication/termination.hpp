/// The end of all ranks when the system, a queue or the user asks the program to end.
#pragma once

#include <functional>
#include <memory>

namespace aeroloom::parallel {

/// Keeps SIGTERM, SIGINT, SIGHUP and SIGUSR1 (by which queues tell that time is nearly over) from ending this
/// process without a word, until a TerminationWatch takes them. To be called before there are other threads:
/// they inherit it.
void hold_termination_signals();
/// Lets them through again, in a process that was forked meanwhile.
void release_termination_signals();

/// Waits for these signals on a thread of its own while it lives, between start and end of the message
/// passing library; one at a time. Where one comes, rank 0 says so, calls the LastWords there are, and all
/// ranks end with 128 and the signal's number, as shells do.
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

/// The last act of rank 0 when it is asked to end while this lives; one at a time. Called at most once, on
/// the thread of the watch while the others go on: it must touch nothing of theirs.
class LastWords {
public:
  explicit LastWords(std::function<void(int signal)> say);
  ~LastWords();
  LastWords(const LastWords&) = delete;
  LastWords& operator=(const LastWords&) = delete;
};

}  // namespace aeroloom::parallel
