/// Clocks: time and memory of each stage.
#pragma once

#include "parallel/communication/communicator.hpp"
#include "parallel/communication/message_counts.hpp"
#include "parallel/observation/task_kind.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace aeroloom::parallel {

/// CPU seconds of the calling thread (CLOCK_THREAD_CPUTIME_ID).
double cpu_seconds();
/// Wall seconds from an arbitrary start, monotonic.
double wall_seconds();
/// Wall seconds since this process was started; 0 if the system does not say.
double process_age_seconds();
/// Largest resident set of this process so far, bytes; children not included.
std::int64_t peak_resident_bytes();
/// Returns freed memory, which the allocator keeps for later, to the system, so that other processes of the
/// node can use it.
void return_free_memory();
/// Resident set of this process now, bytes.
std::int64_t resident_bytes();

/// Schedule and cost of one task. The replay of a run on other numbers of ranks reads it.
struct TaskRecord {
  TaskKind kind = {};            ///< what it makes
  std::int64_t number = 0;       ///< of the face, zone, piece or cavity
  double predicted = 0;          ///< the load it was scheduled by, in the unit of its kind
  double cpu_seconds = 0;        ///< children included
  std::int64_t bytes = 0;        ///< of the result at rest
  std::int64_t child_bytes = 0;  ///< peak of its child process; 0 if it ran in the rank
  double burden = 0;             ///< its load in the schedule of later tasks of the round, in their unit
  std::string stage = {};        ///< filled in by the clock
  int round = 0;                 ///< within the stage; filled in by the clock
};

/// The cost of one stage on this rank.
struct StageCost {
  std::string name;
  double wall_seconds = 0;
  double task_cpu_seconds = 0;      ///< CPU around task work, waiting excluded, children included
  double serial_cpu_seconds = 0;    ///< task work that more ranks do not shorten (serial or repeated)
  double repeated_cpu_seconds = 0;  ///< serial work that every rank repeats
  double check_cpu_seconds = 0;     ///< CPU of checks of results; no task work
  double waiting_seconds = 0;       ///< wall time in messages, with the wait for other ranks
  double other_cpu_seconds = 0;     ///< all other CPU time of this rank
  std::int64_t pieces = 0;
  std::int64_t peak_resident_bytes = 0;  ///< this rank within the stage, children included
  /// Peak memory of this rank within the stage, an upper bound. Pages shared by several processes (program,
  /// libraries, arrays held once per node) are divided among them.
  std::int64_t peak_own_bytes = 0;
  MessageCounts messages = {};    ///< sent by this rank
  ExchangeCounts exchanges = {};  ///< called by this rank
  int rounds = 0;                 ///< that have begun
};

/// A stage's cost over all ranks, the same on every rank.
struct StageSummary {
  std::string name;
  double wall_seconds = 0;  ///< of the slowest rank
  double cpu_seconds_min = 0, cpu_seconds_mean = 0, cpu_seconds_max = 0;
  double serial_seconds = 0;    ///< largest over ranks
  double repeated_seconds = 0;  ///< serial work that all ranks repeat, largest over ranks
  double check_seconds = 0;     ///< CPU, largest over ranks
  double other_seconds = 0;     ///< CPU, largest over ranks
  double waiting_seconds_mean = 0, waiting_seconds_max = 0;  ///< wall
  std::int64_t pieces = 0;                                   ///< sum over ranks
  std::int64_t peak_resident_bytes_max = 0, peak_resident_bytes_sum = 0;
  std::int64_t peak_own_bytes_max = 0, peak_own_bytes_sum = 0;
  MessageSummary collective, neighbour, rendezvous;  ///< messages, by kind
  ExchangeCounts exchanges;                          ///< of all ranks together
  std::vector<double> cpu_seconds_of_ranks;          ///< of tasks, by rank
};

/// Collects the cost of the stages, of which one is open at a time. All work of this thread counts to the
/// open stage, so that the clock is no parameter. A clock with an open stage must not be moved, and no other
/// clock of the thread may open one.
class StageClock {
public:
  StageClock() = default;
  StageClock(const StageClock&) = default;
  StageClock& operator=(const StageClock&) = default;
  ~StageClock();

  /// Opens a stage, or continues one of this name. Its peak memory does not include memory that earlier
  /// stages have freed. Throws std::logic_error if a stage is open in this thread.
  void begin(const std::string& name);
  void end();
  /// Adds a stage from before the clock existed; it gets all CPU of the thread so far. Throws as begin().
  void note(const std::string& name, double wall_seconds);
  /// Adds CPU time of other threads or processes to the open stage; ignored if none is open. (ScopedCpu
  /// counts the calling thread.)
  void add_task_cpu(double seconds);
  void add_serial_cpu(double seconds);
  void add_pieces(std::int64_t count);
  /// Begins a round: its tasks wait for those of earlier rounds on all ranks. Every rank calls it equally
  /// often; ignored if no stage is open.
  void begin_round();
  /// Records a task of the open stage; ignored if none is open.
  void note_task(TaskRecord task);
  /// Tasks of this rank, in their order.
  const std::vector<TaskRecord>& tasks() const { return _tasks; }
  /// Adds the memory of a child process to the present memory of this process, for the peak.
  void note_child_memory(std::int64_t bytes);
  const std::vector<StageCost>& costs() const { return _costs; }
  /// Throws std::logic_error unless all ranks have closed the same stages. Collective.
  std::vector<StageSummary> summarise(const Communicator& communicator) const;

private:
  friend class ScopedCpu;
  StageCost& current() { return _costs[_current]; }

  std::vector<StageCost> _costs;  // in the order in which they were begun first
  std::vector<TaskRecord> _tasks;
  std::size_t _current = 0;
  bool _open = false;
  double _wall_start = 0, _cpu_start = 0;
  double _scoped_start = 0;
  double _message_wall_start = 0, _message_cpu_start = 0;
  MessageCounts _messages_at_start;
  ExchangeCounts _exchanges_at_start;
  std::int64_t _shared_at_start = 0;     // resident bytes that other processes may have in memory too
  std::int64_t _of_others_at_start = 0;  // of that, what other processes count as theirs
};

// As the members of StageClock, for the stage that is open in this thread; ignored if none is open.

void add_task_cpu(double seconds);
void add_serial_cpu(double seconds);
void add_pieces(std::int64_t count);
void begin_round();
void note_task(TaskRecord task);
void note_child_memory(std::int64_t bytes);
/// The tasks of all stages of the clock with the open stage; none if no stage is open.
std::span<const TaskRecord> noted_tasks();

/// Adds the CPU time of a scope to the open stage of this thread: as task time, serial work of one rank, work
/// that every rank repeats, or a check of results. Time in messages and in inner scopes does not count.
class ScopedCpu {
public:
  enum class As { task, serial, repeated, check };
  explicit ScopedCpu(As as);
  ~ScopedCpu();
  ScopedCpu(const ScopedCpu&) = delete;
  ScopedCpu& operator=(const ScopedCpu&) = delete;

private:
  As _as;
  double _start, _scoped_before;
};

/// agree() (parallel/communication/collective_error.hpp), with a ScopedCpu around the work.
void collectively(const Communicator& communicator, ScopedCpu::As as, const std::function<void()>& work);

}  // namespace aeroloom::parallel
