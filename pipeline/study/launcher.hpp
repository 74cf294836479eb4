/// Starts runs on any number of ranks.
#pragma once

#include "pipeline/study/shell_text.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <sys/types.h>

namespace aeroloom::study {

/// A shell line in which {ranks}, {nodes} and {command} are replaced; the command is quoted as quotes around
/// it ask for.
struct Launcher {
  std::string pattern;
  bool starts_single = true;  ///< also starts one rank; else the command is started directly

  std::string line(int ranks, int nodes, const std::vector<std::string>& command) const;
};

/// Within a job of SLURM.
Launcher srun_launcher();
/// Elsewhere; a single rank is started directly. `settings` (NAME=VALUE, with a blank behind) and `options`
/// (with a blank before) are shell text.
Launcher mpirun_launcher(const std::string& settings = "", const std::string& options = "");

/// The user's launcher; else srun inside a SLURM job; else mpirun. Throws std::invalid_argument for a pattern
/// without {command} or {ranks}, or where {command} cannot be quoted.
Launcher make_launcher(const std::string& pattern);

/// How a shell line ended.
struct Ended {
  int code = 0;  ///< 128 + signal if a signal ended it
  double seconds = 0;
};

/// Runs a line in a shell, in its own session and in the environment with which this process was started
/// (without changes by MPI). Output goes to `log`. `began` is called with the session once it runs. What a
/// line that a signal ended has left is ended, too. A handler of termination signals must call end_lines().
template <class Began>
Ended run_line(const std::string& line, const std::filesystem::path& log, Began began);
Ended run_line(const std::string& line, const std::filesystem::path& log);

namespace detail {
pid_t start_line(const std::string& line, const std::filesystem::path& log);
int await_line(pid_t session);
double now_seconds();
}  // namespace detail

/// Ends the current line, if any, and all its processes: SIGTERM, then SIGKILL after a few seconds. They are
/// gone when it returns, ranks in process groups of their own included, unless the system cannot end them
/// within some seconds more.
void end_line();
/// The same for a program that is about to end: no other line begins, and what would begin one waits.
void end_lines();
/// Ends a session left by an earlier call, as end_line(). Does nothing if it is gone or belongs to another
/// program.
void end_session(pid_t session, const std::string& program);

template <class Began>
Ended run_line(const std::string& line, const std::filesystem::path& log, Began began) {
  const double begin = detail::now_seconds();
  const pid_t session = detail::start_line(line, log);
  began(session);
  const int code = detail::await_line(session);
  return {code, detail::now_seconds() - begin};
}

}  // namespace aeroloom::study
