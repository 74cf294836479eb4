/// Where time and memory go, per stage.
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
/// Wall seconds since this process was started; 0 where the system does not tell.
double process_age_seconds();
/// Largest resident set of this process so far, bytes; children not included.
std::int64_t peak_resident_bytes();
/// Gives memory that was freed, and that the allocator keeps for what may come, back to the system: what
/// other processes of the node need must not wait for it.
void return_free_memory();
/// Resident set of this process now, bytes.
std::int64_t resident_bytes();

/// One task as it was scheduled and what it cost: what a replay of the run on other numbers of ranks needs.
struct TaskRecord {
  TaskKind kind = {};            ///< what it makes
  std::int64_t number = 0;       ///< of that face, the piece's face, zone, piece or cavity
  double predicted = 0;          ///< the load it was scheduled by, in the unit of its kind
  double cpu_seconds = 0;        ///< children included
  std::int64_t bytes = 0;        ///< of what it made, at rest
  std::int64_t child_bytes = 0;  ///< peak of the child it ran in; 0 where it ran in the rank
  double burden = 0;  ///< what it counts for when further tasks of its round are scheduled, in their unit
  std::string stage = {};  ///< filled in by the clock
  int round = 0;           ///< within the stage; filled in by the clock
};

/// The cost of one stage on this rank.
struct StageCost {
  std::string name;
  double wall_seconds = 0;
  double task_cpu_seconds = 0;      ///< CPU around task work, waiting excluded, children included
  double serial_cpu_seconds = 0;    ///< task work that does not shrink with more ranks (serial or repeated)
  double repeated_cpu_seconds = 0;  ///< the serial work that every rank does alike
  double check_cpu_seconds = 0;     ///< CPU around checks of what was made; no task work
  double waiting_seconds = 0;       ///< wall time in messages: until other ranks come, and on the way
  double other_cpu_seconds = 0;     ///< CPU of this rank that is none of these
  std::int64_t pieces = 0;
  std::int64_t peak_resident_bytes = 0;  ///< this rank within the stage, children included
  /// Peak memory of this rank within the stage, an upper bound: of pages that several processes have in
  /// memory (program, libraries, arrays held once per node) this rank's share alone.
  std::int64_t peak_own_bytes = 0;
  MessageCounts messages = {};    ///< sent by this rank
  ExchangeCounts exchanges = {};  ///< asked for by this rank
  int rounds = 0;                 ///< that were begun
};

/// A stage's cost over all ranks, the same on every rank.
struct StageSummary {
  std::string name;
  double wall_seconds = 0;  ///< of the slowest rank
  double cpu_seconds_min = 0, cpu_seconds_mean = 0, cpu_seconds_max = 0;
  double serial_seconds = 0;    ///< largest over ranks
  double repeated_seconds = 0;  ///< serial work that all ranks do alike, largest over ranks
  double check_seconds = 0;     ///< CPU, largest over ranks
  double other_seconds = 0;     ///< CPU, largest over ranks
  double waiting_seconds_mean = 0, waiting_seconds_max = 0;  ///< wall
  std::int64_t pieces = 0;                                   ///< sum over ranks
  std::int64_t peak_resident_bytes_max = 0, peak_resident_bytes_sum = 0;
  std::int64_t peak_own_bytes_max = 0, peak_own_bytes_sum = 0;
  MessageSummary collective, neighbour, rendezvous;  ///< messages, by kind
  ExchangeCounts exchanges;                          ///< of all ranks together
  std::vector<double> cpu_seconds_of_ranks;          ///< of tasks, as min, mean and max are
};

/// Collects the cost of the stages, one open at a time. While a stage is open, what this thread does counts
/// to it: nobody passes the clock on. A clock with an open stage must not be moved; another clock of the same
/// thread cannot open one.
class StageClock {
public:
  StageClock() = default;
  StageClock(const StageClock&) = default;
  StageClock& operator=(const StageClock&) = default;
  ~StageClock();

  /// A stage begun again goes on where it was. What earlier stages have freed is not counted as its. Throws
  /// std::logic_error when a stage is open, of this clock or of another of this thread.
  void begin(const std::string& name);
  void end();
  /// Notes a stage before there was a clock, which has all CPU of the thread so far. Throws as begin.
  void note(const std::string& name, double wall_seconds);
  /// Adds to the open stage; ignored when none is open. CPU is that of others than the calling thread
  /// (ScopedCpu has its own).
  void add_task_cpu(double seconds);
  void add_serial_cpu(double seconds);
  void add_pieces(std::int64_t count);
  /// Tasks noted from now on wait for those before on all ranks: another mending round of the surface,
  /// another filling, another round of cavities. On every rank alike; ignored when no stage is open.
  void begin_round();
  /// Puts a task of the open stage on record; ignored when none is open.
  void note_task(TaskRecord task);
  /// Tasks of this rank, in their order.
  const std::vector<TaskRecord>& tasks() const { return _tasks; }
  /// Memory of a child that ran for this stage while this process held what it holds now.
  void note_child_memory(std::int64_t bytes);
  const std::vector<StageCost>& costs() const { return _costs; }
  /// Collective. All ranks must have closed the same stages; else throws std::logic_error.
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

// To the stage that is open in this thread; nothing where none is. As the members of StageClock.

void add_task_cpu(double seconds);
void add_serial_cpu(double seconds);
void add_pieces(std::int64_t count);
void begin_round();
void note_task(TaskRecord task);
void note_child_memory(std::int64_t bytes);
/// The tasks of all stages of the clock that has it.
std::span<const TaskRecord> noted_tasks();

/// Adds the CPU time of a scope to the stage that is open in this thread, as task time, as serial work of one
/// rank, as work that every rank repeats, or as a check of what was made; less what it spent in messages and
/// in scopes within.
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

/// As agree() (parallel/communication/collective_error.hpp), and counts the CPU time of the work.
void collectively(const Communicator& communicator, ScopedCpu::As as, const std::function<void()>& work);

}  // namespace aeroloom::parallel
