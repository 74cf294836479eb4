#include "parallel/observation/progress.hpp"

#include "parallel/communication/host.hpp"
#include "parallel/observation/log.hpp"
#include "parallel/observation/log_line.hpp"
#include "parallel/observation/timers.hpp"

#include <algorithm>
#include <cstdio>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

namespace aeroloom::parallel {
namespace {

/// Seconds between two lines where lines stay.
double seconds_between_lines = 5;  // tests have it shorter
/// Seconds between two lines that are rewritten; between two looks at the processes of the node, of which
/// there may be hundreds.
constexpr double seconds_between_rewrites = 0.2, seconds_between_looks = 1;

/// The stage at hand, as far as it is known.
struct Stage {
  std::string name;
  double begin = 0, last_print = 0;
  Progress* innermost = nullptr;
};

Stage& stage() {
  static Stage instance;
  return instance;
}

/// Bytes that a process has to itself; 0 where the system does not tell.
std::int64_t own_bytes_of(pid_t process) {
  std::FILE* file = std::fopen(fmt::format("/proc/{}/statm", process).c_str(), "r");
  if (!file) return 0;
  long long size = 0, resident = 0, shared = 0;
  const int read = std::fscanf(file, "%lld %lld %lld", &size, &resident, &shared);
  std::fclose(file);
  return read == 3 ? (resident - shared) * sysconf(_SC_PAGESIZE) : 0;
}

std::vector<pid_t> children_of(pid_t process) {
  std::vector<pid_t> children;
  std::FILE* file = std::fopen(fmt::format("/proc/{}/task/{}/children", process, process).c_str(), "r");
  if (!file) return children;
  for (int child = 0; std::fscanf(file, "%d", &child) == 1;) children.push_back(child);
  std::fclose(file);
  return children;
}

/// Memory of the ranks of this node.
class NodeWatch {
public:
  void watch(std::vector<pid_t> ranks) { _ranks = std::move(ranks); }
  bool has_others() const { return _ranks.size() > 1; }
  std::int64_t bytes(double now) {
    if (now - _last_look < seconds_between_looks) return _bytes;
    _last_look = now;
    _bytes = std::max<std::int64_t>(0, resident_bytes() - own_bytes_of(getpid()));  // shared by all: once
    for (const pid_t rank : _ranks) {
      _bytes += own_bytes_of(rank);
      // A rank's child is the server of sandboxed runs, whose children run the tasks.
      for (const pid_t server : children_of(rank)) {
        for (const pid_t task : children_of(server)) _bytes += own_bytes_of(task);
      }
    }
    return _bytes;
  }

private:
  std::vector<pid_t> _ranks;
  double _last_look = -1e9;
  std::int64_t _bytes = 0;
};

NodeWatch& node_watch() {
  static NodeWatch instance;
  return instance;
}

/// "812 MB, node 1630 MB  6.2 s".
std::string memory_and_time(double now) {
  std::string text = fmt::format("{} MB", resident_bytes() / 1'000'000);
  if (node_watch().has_others())
    text += fmt::format(", all ranks here {} MB", node_watch().bytes(now) / 1'000'000);
  return text + fmt::format("  {:.1f} s", now - stage().begin);
}

bool is_due(double now) {
  const double interval = log_line::is_rewritten() ? seconds_between_rewrites : seconds_between_lines;
  return now - stage().last_print >= interval;
}

}  // namespace

Progress::Progress(std::string stage_name, std::int64_t total, std::string elements)
    : _stage(std::move(stage_name)),
      _elements(std::move(elements)),
      _total(total),
      _outer(stage().innermost) {
  stage().innermost = this;
  if (stage().name.empty()) stage().begin = stage().last_print = wall_seconds();
}

Progress::~Progress() {
  stage().innermost = _outer;
  if (_printed) log_line::erase();
}

std::string Progress::line() const {
  const double percent =
      _total > 0 ? 100.0 * static_cast<double>(_done) / static_cast<double>(_total) : 100.0;
  const std::string elements = _elements.empty() ? "" : fmt::format("  {} {}", _made, _elements);
  return fmt::format("{:<10} {:3.0f} %{}", _stage, percent, elements);
}

void Progress::show(double now) {
  stage().last_print = now;
  _printed = true;
  log_line::show(line() + "  " + memory_and_time(now));
}

void Progress::set_done(std::int64_t done, std::int64_t elements) {
  const bool ends = _done != _total && done == _total;
  _done = done;
  _made = elements;
  if (!log_line::is_wanted()) return;
  const double now = wall_seconds();
  if (is_due(now) || (_printed && ends)) show(now);
}

void set_seconds_between_lines(double seconds) {
  seconds_between_lines = seconds;
}

void stage_begins(const std::string& name) {
  stage().name = name;
  stage().begin = stage().last_print = wall_seconds();
}

void stage_ends() {
  stage().name.clear();
  log_line::erase();
}

void beat() {
  if (stage().name.empty() || !log_line::is_wanted()) return;
  const double now = wall_seconds();
  if (!is_due(now)) return;
  if (stage().innermost != nullptr) return stage().innermost->show(now);
  stage().last_print = now;
  log_line::show(fmt::format("{:<10}        {}", stage().name, memory_and_time(now)));
}

void watch_node_memory(const Communicator& communicator) {
  MPI_Comm node = MPI_COMM_NULL;
  if (MPI_Comm_split_type(host_communicator(communicator), MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &node) !=
      MPI_SUCCESS)
    return;
  int size = 1;
  MPI_Comm_size(node, &size);
  const pid_t mine = getpid();
  std::vector<pid_t> ranks(static_cast<std::size_t>(size));
  static_assert(sizeof(pid_t) == sizeof(int));
  MPI_Gather(&mine, 1, MPI_INT, ranks.data(), 1, MPI_INT, 0, node);
  MPI_Comm_free(&node);
  if (communicator.is_root()) node_watch().watch(std::move(ranks));
}

}  // namespace aeroloom::parallel
