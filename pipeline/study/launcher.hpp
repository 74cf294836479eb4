/// Starts runs on any number of ranks, through whatever starts them on this machine.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <sys/types.h>

namespace aeroloom::study {

/// How a command is started: a line for the shell in which {ranks}, {nodes} and {command} are replaced.
struct Launcher {
  std::string pattern;
  bool starts_single = true;  ///< also one rank; else the command is started itself

  std::string line(int ranks, int nodes, const std::vector<std::string>& command) const;
};

/// The launcher that the user gave, else srun within a job of SLURM, else mpirun on this machine. Throws
/// std::invalid_argument for a pattern without {command} or {ranks}.
Launcher make_launcher(const std::string& pattern);

/// A word that the shell gives on as it is.
std::string quoted(const std::string& word);
/// Words of a command, as a text for the shell.
std::string quoted(const std::vector<std::string>& words);

/// How a line ended.
struct Ended {
  int code = 0;  ///< 128 and the signal where one ended it
  double seconds = 0;
};

/// Runs a line in a shell, in a process group of its own and in the environment that this process was started
/// with, not what message passing has made of it. What it prints goes to `log`. `began` is called with the
/// group once it runs. Where this process is asked to end meanwhile, end_line() is to be called from the
/// watch.
template <class Began>
Ended run_line(const std::string& line, const std::filesystem::path& log, Began began);
Ended run_line(const std::string& line, const std::filesystem::path& log);

namespace detail {
pid_t start_line(const std::string& line, const std::filesystem::path& log);
int await_line(pid_t group);
double now_seconds();
}  // namespace detail

/// Ends the line that runs now, if any, and all that it has started: asked first, killed after a few seconds.
void end_line();
/// Ends a process group that an earlier call has left; does nothing where it is gone or another program's.
void end_group(pid_t group, const std::string& program);

template <class Began>
Ended run_line(const std::string& line, const std::filesystem::path& log, Began began) {
  const double begin = detail::now_seconds();
  const pid_t group = detail::start_line(line, log);
  began(group);
  const int code = detail::await_line(group);
  return {code, detail::now_seconds() - begin};
}

}  // namespace aeroloom::study
