#include "parallel/observation/log.hpp"

#include "parallel/observation/log_line.hpp"
#include "parallel/observation/warnings.hpp"

#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

namespace aeroloom::parallel {

namespace {

/// Whether the user or the terminal wants neither colours nor lines that are rewritten.
bool wants_plain_lines() {
  const char *no_colour = std::getenv("NO_COLOR"), *terminal = std::getenv("TERM");
  return (no_colour && *no_colour) || (terminal && std::strcmp(terminal, "dumb") == 0);
}

/// Facts go to standard output, warnings and errors to standard error.
class Log {
public:
  void configure(Rank rank, int ranks, LogLevel level) {
    _configured = true;
    _rank = rank;
    _ranks = ranks;
    _level = level;
    // Under a launcher standard output may look like a terminal when the launcher's own is a file.
    _rewrites = isatty(STDOUT_FILENO) && isatty(STDERR_FILENO) && !wants_plain_lines();
    if (_facts) return;
    const auto colours = wants_plain_lines() ? spdlog::color_mode::never : spdlog::color_mode::automatic;
    _facts = spdlog::stdout_color_mt("aeroloom facts", colours);
    _troubles = spdlog::stderr_color_mt("aeroloom troubles", colours);
    _facts->set_pattern("%v");
    _troubles->set_pattern("%^%v%$");
    _facts->flush_on(spdlog::level::info);
  }
  void fact(const std::string& message, LogLevel from) {
    if (!speaks_at(from)) return;
    erase_line();
    _facts->info(printable(message));
  }
  void trouble(spdlog::level::level_enum severity, const char* word, const std::string& message) {
    if (!_configured) {
      std::fprintf(stderr, "%s: %s\n", word, printable(message).c_str());
      return;
    }
    erase_line();
    _troubles->log(severity, "{}{}: {}", word, _ranks > 1 ? fmt::format(" (rank {})", _rank) : "",
                   printable(message));
  }
  bool speaks_at(LogLevel level) const { return _configured && _rank == 0 && _level >= level; }
  bool rewrites() const { return _rewrites; }
  void show_line(const std::string& line) {
    std::fputs((_rewrites ? "\r\033[K" + line : line + "\n").c_str(), stdout);
    std::fflush(stdout);
    _line_stands = _rewrites;
  }
  void erase_line() {
    if (!_line_stands) return;
    std::fputs("\r\033[K", stdout);
    std::fflush(stdout);
    _line_stands = false;
  }

private:
  bool _configured = false, _rewrites = false, _line_stands = false;
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

std::string printable(std::string_view text) {
  std::string shown;
  shown.reserve(text.size());
  for (const char letter : text) {
    const auto code = static_cast<unsigned char>(letter);
    if ((code < 0x20 && letter != '\n' && letter != '\t') || code == 0x7f)
      shown += fmt::format("\\x{:02x}", code);
    else
      shown += letter;
  }
  return shown;
}

void configure_log(const Communicator& communicator, LogLevel level) {
  log().configure(communicator.rank(), communicator.size(), level);
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

namespace log_line {

bool is_wanted() {
  return log().speaks_at(LogLevel::normal);
}

bool is_rewritten() {
  return log().rewrites();
}

void show(const std::string& line) {
  log().show_line(line);
}

void erase() {
  log().erase_line();
}

}  // namespace log_line

}  // namespace aeroloom::parallel
