/// How far a run is, told by rank 0 of its own work while a stage takes its time. Nothing here is collective,
/// but for watch_node_memory(), and nothing changes a result.
#pragma once

#include "parallel/communication/communicator.hpp"

#include <cstdint>
#include <string>

namespace aeroloom::parallel {

/// Progress of a loop within a stage: percentage, elements so far, memory, time since the stage began. On a
/// terminal one line rewritten in place and erased at the end and before anything else is printed; elsewhere,
/// and where NO_COLOR is set or TERM is dumb, a plain line every few seconds, and one at the end of what was
/// long enough to have had one. Silent at LogLevel::quiet.
class Progress {
public:
  /// `total`: of what advance() counts, in any unit of work. `elements`: what is made, in the plural.
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

/// How often a line comes where lines stay; every five seconds unless a test has less patience.
void set_seconds_between_lines(double seconds);

/// A stage begins: the time that is told counts from here. StageClock calls it.
void stage_begins(const std::string& name);
void stage_ends();
/// Tells that the stage at hand goes on, if it is time to. Cheap: what runs for long calls it now and then;
/// StageClock's scopes and waiting for sandboxed runs do.
void beat();

/// Lets progress tell the memory of all ranks of rank 0's node, children included, not only its own.
/// Collective, once.
void watch_node_memory(const Communicator& communicator);

}  // namespace aeroloom::parallel
