#include "parallel/log.hpp"

#include "parallel/timers.hpp"
#include "parallel/warnings.hpp"

#include <cstdio>

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

namespace aeroloom::parallel {

namespace {

/// Seconds between two lines of progress where lines stay, and where they are rewritten.
constexpr double seconds_between_lines = 5;
constexpr double seconds_between_rewrites = 0.2;

/// Facts go to standard output, warnings and errors to standard error.
class Log {
public:
  void configure(const Communicator& communicator, LogLevel level) {
    _configured = true;
    _rank = communicator.rank();
    _ranks = communicator.size();
    _level = level;
    // Under a launcher standard output may look like a terminal when the launcher's own is a file.
    _rewrites = isatty(STDOUT_FILENO) && isatty(STDERR_FILENO);
    if (_facts) return;
    _facts = spdlog::stdout_color_mt("aeroloom facts");
    _troubles = spdlog::stderr_color_mt("aeroloom troubles");
    _facts->set_pattern("%v");
    _troubles->set_pattern("%^%v%$");
    _facts->flush_on(spdlog::level::info);
  }
  void fact(const std::string& message, LogLevel from) {
    if (speaks_at(from)) _facts->info(message);
  }
  void trouble(spdlog::level::level_enum severity, const char* word, const std::string& message) {
    if (!_configured) {
      std::fprintf(stderr, "%s: %s\n", word, message.c_str());
      return;
    }
    _troubles->log(severity, "{}{}: {}", word, _ranks > 1 ? fmt::format(" (rank {})", _rank) : "", message);
  }
  bool speaks_at(LogLevel level) const { return _configured && _rank == 0 && _level >= level; }
  bool rewrites() const { return _rewrites; }

private:
  bool _configured = false, _rewrites = false;
  Rank _rank = 0;
  int _ranks = 1;
  LogLevel _level = LogLevel::normal;
  std::shared_ptr<spdlog::logger> _facts, _troubles;
};

Log& log() {
  static Log instance;
  return instance;
}

}  // namespace

void configure_log(const Communicator& communicator, LogLevel level) {
  log().configure(communicator, level);
}

void log_info(const std::string& message) {
  log().fact(message, LogLevel::normal);
}

void log_verbose(const std::string& message) {
  log().fact(message, LogLevel::verbose);
}

void log_warning(const std::string& message) {
  keep_warning(message);
  log().trouble(spdlog::level::warn, "warning", message);
}

void log_error(const std::string& message) {
  log().trouble(spdlog::level::err, "error", message);
}

Progress::Progress(std::string stage, std::int64_t total)
    : _stage(std::move(stage)), _total(total), _last_print(wall_seconds()) {}

Progress::~Progress() {
  if (_printed && log().rewrites()) std::fputc('\n', stdout);
}

void Progress::advance(std::int64_t count) {
  _done += count;
  if (!log().speaks_at(LogLevel::normal)) return;
  const double interval = log().rewrites() ? seconds_between_rewrites : seconds_between_lines;
  const double now = wall_seconds();
  const bool last_rewrite = _printed && log().rewrites() && _done == _total;
  if (now - _last_print < interval && !last_rewrite) return;
  _last_print = now;
  _printed = true;
  const double percent =
      _total > 0 ? 100.0 * static_cast<double>(_done) / static_cast<double>(_total) : 100.0;
  const std::string line = fmt::format("{:<10} {:3.0f} %  {} of {}  {} MB", _stage, percent, _done, _total,
                                       resident_bytes() / 1'000'000);
  std::fputs((log().rewrites() ? "\r\033[K" + line : line + "\n").c_str(), stdout);
  std::fflush(stdout);
}

}  // namespace aeroloom::parallel
