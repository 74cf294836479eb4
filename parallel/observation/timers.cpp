#include "parallel/observation/timers.hpp"

#include "parallel/communication/collective_error.hpp"
#include "parallel/communication/session.hpp"
#include "parallel/observation/process_memory.hpp"
#include "parallel/observation/progress.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include <unistd.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace aeroloom::parallel {

namespace {

double seconds_of(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Resident pages of files and of shared memory.
std::int64_t shared_bytes() {
  return status_bytes("RssFile") + status_bytes("RssShmem");
}

/// This process's share of the bytes that it shares: each page over the number of processes that have it. All
/// of them where the system does not tell.
std::int64_t share_of_shared_bytes() {
  const char* path = "/proc/self/smaps_rollup";
  const std::int64_t share = process_memory(path, "Pss_File") + process_memory(path, "Pss_Shmem");
  return share > 0 ? share : shared_bytes();
}

/// The peak before the system's own counter was last reset.
std::int64_t earlier_peak = 0;

/// Lets the system's peak start anew from what is resident now, so that a stage's peak is its own. Where the
/// system refuses, a stage's peak is that of the run so far.
void restart_peak() {
  earlier_peak = peak_resident_bytes();
  if (std::FILE* control = std::fopen("/proc/self/clear_refs", "w")) {
    std::fputs("5", control);
    std::fclose(control);
  }
}

/// The clock that has a stage open in this thread.
thread_local StageClock* open_clock = nullptr;
/// CPU of this thread that was in scopes, since the start of the program.
thread_local double scoped_cpu = 0;

/// Throws on every rank unless all have closed the stages of rank 0.
void require_same_stages(const Communicator& communicator, const std::vector<StageCost>& costs, bool open) {
  std::vector<std::string> mine;
  mine.reserve(costs.size());
  for (const StageCost& cost : costs) mine.push_back(cost.name);
  std::vector<std::string> expected = mine;
  communicator.broadcast_value(expected);
  const bool differs = open || mine != expected;
  if (communicator.sum(std::int64_t{differs ? 1 : 0}) > 0) {
    throw std::logic_error("the ranks have not closed the same stages");
  }
}

}  // namespace

double cpu_seconds() {
  return seconds_of(CLOCK_THREAD_CPUTIME_ID);
}

double wall_seconds() {
  return seconds_of(CLOCK_MONOTONIC);
}

double process_age_seconds() {
  std::FILE* file = std::fopen("/proc/self/stat", "r");
  if (!file) return 0;
  char text[1024];
  const std::size_t length = std::fread(text, 1, sizeof text - 1, file);
  std::fclose(file);
  text[length] = 0;
  // The program's name, in parentheses, may hold anything; what follows are fields 3 and on, of which the
  // 22nd is the start in ticks since the boot.
  const char* field = std::strrchr(text, ')');
  for (int i = 2; field != nullptr && i < 22; ++i) field = std::strchr(field + 1, ' ');
  long long ticks = 0;
  if (field == nullptr || std::sscanf(field, "%lld", &ticks) != 1) return 0;
  const double start = static_cast<double>(ticks) / static_cast<double>(sysconf(_SC_CLK_TCK));
  return std::max(0.0, seconds_of(CLOCK_BOOTTIME) - start);
}

std::int64_t peak_resident_bytes() {
  return std::max(earlier_peak, status_bytes("VmHWM"));
}

void return_free_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

std::int64_t resident_bytes() {
  return status_bytes("VmRSS");
}

StageClock::~StageClock() {
  if (open_clock == this) open_clock = nullptr;
}

void StageClock::begin(const std::string& name) {
  if (open_clock) {
    throw std::logic_error("stage '" + name + "' begins inside '" + open_clock->current().name + "'");
  }
  return_free_memory();
  restart_peak();
  _open = true;
  open_clock = this;
  const auto known =
      std::find_if(_costs.begin(), _costs.end(), [&](const StageCost& cost) { return cost.name == name; });
  _current = static_cast<std::size_t>(known - _costs.begin());
  if (known == _costs.end()) _costs.emplace_back().name = name;
  _shared_at_start = shared_bytes();
  _of_others_at_start = std::max<std::int64_t>(0, _shared_at_start - share_of_shared_bytes());
  _wall_start = wall_seconds();
  _cpu_start = cpu_seconds();
  _scoped_start = scoped_cpu;
  _message_wall_start = session::message_time().wall_seconds;
  _message_cpu_start = session::message_time().cpu_seconds;
  _messages_at_start = message_counts();
  _exchanges_at_start = exchange_counts();
  stage_begins(name);
}

void StageClock::end() {
  if (!_open) throw std::logic_error("a stage ends that has not begun");
  StageCost& cost = current();
  cost.wall_seconds += wall_seconds() - _wall_start;
  const session::MessageTime& messages = session::message_time();
  cost.waiting_seconds += messages.wall_seconds - _message_wall_start;
  const double known = scoped_cpu - _scoped_start + messages.cpu_seconds - _message_cpu_start;
  cost.other_cpu_seconds += std::max(0.0, cpu_seconds() - _cpu_start - known);
  cost.messages += message_counts();
  cost.messages -= _messages_at_start;
  cost.exchanges += exchange_counts();
  cost.exchanges -= _exchanges_at_start;
  const std::int64_t peak = status_bytes("VmHWM");
  cost.peak_resident_bytes = std::max(cost.peak_resident_bytes, peak);
  // The shared part of the peak is not known: the least that it may have been leaves the most for the rest.
  const std::int64_t own = peak - std::min(_shared_at_start, shared_bytes()) + share_of_shared_bytes();
  cost.peak_own_bytes = std::max(cost.peak_own_bytes, std::min(own, peak));
  _open = false;
  open_clock = nullptr;
  stage_ends();
}

void StageClock::note(const std::string& name, double wall_seconds) {
  begin(name);
  current().wall_seconds += wall_seconds;
  current().other_cpu_seconds += cpu_seconds();
  end();
}

void StageClock::add_task_cpu(double seconds) {
  if (_open) current().task_cpu_seconds += seconds;
}

void StageClock::add_serial_cpu(double seconds) {
  if (_open) current().serial_cpu_seconds += seconds;
}

void StageClock::add_pieces(std::int64_t count) {
  if (_open) current().pieces += count;
}

void StageClock::begin_round() {
  if (_open) ++current().rounds;
}

void StageClock::note_task(TaskRecord task) {
  if (!_open) return;
  task.stage = current().name;
  task.round = current().rounds;
  _tasks.push_back(std::move(task));
}

void StageClock::note_child_memory(std::int64_t bytes) {
  if (!_open) return;
  StageCost& cost = current();
  const std::int64_t here = resident_bytes();
  cost.peak_resident_bytes = std::max(cost.peak_resident_bytes, here + bytes);
  // The share that others have of it is asked for once per stage: the system walks all pages for an answer.
  cost.peak_own_bytes = std::max(cost.peak_own_bytes, here - _of_others_at_start + bytes);
}

std::vector<StageSummary> StageClock::summarise(const Communicator& communicator) const {
  require_same_stages(communicator, _costs, _open);
  const auto ranks = static_cast<double>(communicator.size());
  std::vector<StageSummary> summaries;
  for (const StageCost& cost : _costs) {
    StageSummary summary;
    summary.name = cost.name;
    summary.wall_seconds = communicator.maximum(cost.wall_seconds);
    summary.cpu_seconds_min = communicator.minimum(cost.task_cpu_seconds);
    summary.cpu_seconds_mean = communicator.sum(cost.task_cpu_seconds) / ranks;
    summary.cpu_seconds_max = communicator.maximum(cost.task_cpu_seconds);
    summary.serial_seconds = communicator.maximum(cost.serial_cpu_seconds);
    summary.repeated_seconds = communicator.maximum(cost.repeated_cpu_seconds);
    summary.check_seconds = communicator.maximum(cost.check_cpu_seconds);
    summary.other_seconds = communicator.maximum(cost.other_cpu_seconds);
    summary.waiting_seconds_mean = communicator.sum(cost.waiting_seconds) / ranks;
    summary.waiting_seconds_max = communicator.maximum(cost.waiting_seconds);
    summary.cpu_seconds_of_ranks = communicator.all_gather_items(std::span(&cost.task_cpu_seconds, 1));
    summary.pieces = communicator.sum(cost.pieces);
    summary.peak_resident_bytes_max = communicator.maximum(cost.peak_resident_bytes);
    summary.peak_resident_bytes_sum = communicator.sum(cost.peak_resident_bytes);
    summary.peak_own_bytes_max = communicator.maximum(cost.peak_own_bytes);
    summary.peak_own_bytes_sum = communicator.sum(cost.peak_own_bytes);
    for (const MessageCounts& of_a_rank : communicator.all_gather_items(std::span(&cost.messages, 1))) {
      summary.collective.add(of_a_rank.collective);
      summary.neighbour.add(of_a_rank.neighbour);
      summary.rendezvous.add(of_a_rank.rendezvous);
    }
    for (const ExchangeCounts& of_a_rank : communicator.all_gather_items(std::span(&cost.exchanges, 1)))
      summary.exchanges.join(of_a_rank);
    summaries.push_back(summary);
  }
  return summaries;
}

void add_task_cpu(double seconds) {
  if (open_clock) open_clock->add_task_cpu(seconds);
}

void add_serial_cpu(double seconds) {
  if (open_clock) open_clock->add_serial_cpu(seconds);
}

void add_pieces(std::int64_t count) {
  if (open_clock) open_clock->add_pieces(count);
}

void begin_round() {
  if (open_clock) open_clock->begin_round();
}

void note_task(TaskRecord task) {
  if (open_clock) open_clock->note_task(std::move(task));
}

void note_child_memory(std::int64_t bytes) {
  if (open_clock) open_clock->note_child_memory(bytes);
}

std::span<const TaskRecord> noted_tasks() {
  return open_clock ? std::span(open_clock->tasks()) : std::span<const TaskRecord>();
}

ScopedCpu::ScopedCpu(As as)
    : _as(as), _start(cpu_seconds() - session::message_time().cpu_seconds), _scoped_before(scoped_cpu) {
  beat();  // not at the end: what allocates has no place in a destructor
}

ScopedCpu::~ScopedCpu() {
  const double all = cpu_seconds() - session::message_time().cpu_seconds - _start;
  const double used = all - (scoped_cpu - _scoped_before);
  scoped_cpu += used;
  if (!open_clock) return;
  StageCost& cost = open_clock->current();
  (_as == As::check ? cost.check_cpu_seconds : cost.task_cpu_seconds) += used;
  if (_as == As::serial || _as == As::repeated) cost.serial_cpu_seconds += used;
  if (_as == As::repeated) cost.repeated_cpu_seconds += used;
}

void collectively(const Communicator& communicator, ScopedCpu::As as, const std::function<void()>& work) {
  agree(communicator, [&] {
    const ScopedCpu cpu(as);
    work();
  });
}

}  // namespace aeroloom::parallel
