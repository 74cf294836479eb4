/// Progress of a stage: rank 0 prints how much of its own work is done. Only watch_node_memory() is
/// collective. Nothing here changes a result.
#pragma once

#include "parallel/communication/communicator.hpp"

#include <cstdint>
#include <string>

namespace aeroloom::parallel {

/// Progress of a loop within a stage: percentage, elements so far, memory, time since the stage began. On a
/// terminal it is one line, rewritten in place and erased at the end or before other output. Elsewhere, or if
/// NO_COLOR is set or TERM is dumb, it is a plain line every few seconds, and one at the end if there was one
/// before. Silent at LogLevel::quiet.
class Progress {
public:
  /// `total`: of the work, in any unit. `elements`: the name of what is made, in the plural.
  Progress(std::string stage, std::int64_t total, std::string elements = "");
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `done` more units of work are done, `elements` more elements are made.
  void advance(std::int64_t done = 1, std::int64_t elements = 0) { set_done(_done + done, _made + elements); }
  /// `done` units of work are done, `elements` elements are made.
  void set_done(std::int64_t done, std::int64_t elements);

private:
  friend void beat();
  std::string line() const;
  void show(double now);

  std::string _stage, _elements;
  std::int64_t _total, _done = 0, _made = 0;
  bool _printed = false;
  Progress* _outer;
};

/// The time between plain lines; five seconds unless a test sets another.
void set_seconds_between_lines(double seconds);

/// Begins a stage: printed times count from here. StageClock calls it.
void stage_begins(const std::string& name);
void stage_ends();
/// Prints progress of the present stage if it is time to. Cheap: long loops call it now and then. ScopedCpu
/// and the wait for sandboxed runs call it too.
void beat();

/// From now on progress shows the memory of all ranks on the node of rank 0, children included. Collective;
/// to be called once.
void watch_node_memory(const Communicator& communicator);

}  // namespace aeroloom::parallel
